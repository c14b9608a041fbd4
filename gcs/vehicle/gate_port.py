"""The gate of one vehicle, its fence, and what becomes of the gate's effects.

The gate decides; what it decides is turned into work for the rest of the session here.  Nothing
reaches the vehicle's motion on any other path.
"""

from __future__ import annotations

import math
from typing import Final

from gcs.frames import Vec3
from gcs.gate import effects, inputs
from gcs.gate.airspace.stopping import ways_to_stop
from gcs.gate.airspace.verifier import Verifier, check_start, verifier_for
from gcs.gate.condition import Condition
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo
from gcs.gate.states import State
from gcs.report import FenceShape, StopItem
from gcs.session import announcements
from gcs.session.effects import Record
from gcs.session.work import (
    GATE_ANSWERED,
    CheckStart,
    GateInput,
    GiveVerdict,
    Log,
    PlaceFence,
    Work,
    condition,
)
from gcs.vehicle.leg_ahead import LegAhead
from gcs.vehicle.talk.telemetry import Telemetry

NOT_FLYING: Final = frozenset({State.NO_VEHICLE, State.STALE, State.GROUNDED})
OF_THE_STATION: Final = frozenset(
    {Condition.RECORDER_FAILED, Condition.TICK_LATE, Condition.OTHER_STATION}
)
"""Conditions that every vehicle's gate has, as they are no vehicle's own."""
RETOLD: Final = frozenset({Condition.VEHICLE_FAILSAFE_WEAK, Condition.PREFLIGHT_FAILED})
"""Conditions that the gate is told of once more when their reason is another one.  The reasons of
the others hold numbers, which are others with each message."""


class GatePort:
    """Before a vehicle is heard the gate is one that refuses everything: NO_VEHICLE."""

    def __init__(self, policy: Policy, now_ns: int, *, first: bool = True) -> None:
        """`policy` is on the session's clock: see `Times.policy`.  `first`: the fence of the record
        is that of this vehicle."""
        self.policy = policy
        self._first = first
        self.gate = Gate(self.policy, "", now_ns)
        self.bad_start: Refusal | None = None
        self.bad_home: Refusal | None = None
        """Why the vehicle's place at the start is outside the fence, once that is known."""
        self._verifier: Verifier | None = None
        self._start_checked = False
        self._fence_on = True
        self._leg_ahead = LegAhead()

    def meet(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """A vehicle was heard: a new gate, for its autopilot; what was wrong before still is, but
        for what was wrong with another vehicle."""
        before = self.gate.memory
        self.gate = Gate(self.policy, telemetry.autopilot.name, now_ns)
        conditions = [
            each
            for each in before.conditions
            if not before.heard_before or each[0] in OF_THE_STATION
        ]
        return [
            GateInput(inputs.ClimbEndSeen(telemetry.autopilot.climb_ends_within_m)),
            *(GateInput(inputs.ConditionChanged(name, True, text)) for name, text in conditions),
            *([GateInput(inputs.OperatorLost("nobody is left"))] if before.operator_lost else []),
        ]

    def lose_vehicle(self) -> list[Work]:
        """Another vehicle has the number of this one: the gate hears that this one is lost, so that
        what is under way has its ending, and sends nothing any more.  A new gate follows."""
        heard_ns = self.gate.memory.heard_ns
        if heard_ns is None:
            return []
        lost_ns = heard_ns + round(self.policy.heartbeat_age_s * 1e9)
        ended = self.gate.handle(inputs.Tick(0), lost_ns)
        self.bad_start = self.bad_home = self._verifier = None
        self._start_checked = False
        commanded = effects.SendCommand | effects.SendSetpoint
        return [each for each in ended if not isinstance(each, commanded)]

    def handle(self, given: inputs.Input, now_ns: int) -> list[Work]:
        """The gate's effects, then what the session owes itself after such an input."""
        if isinstance(given, inputs.ConditionChanged) and not self._is_news(given):
            return [GATE_ANSWERED]
        work: list[Work] = [*self.gate.handle(given, now_ns), GATE_ANSWERED]
        if isinstance(given, inputs.HomeSeen):
            work.append(PlaceFence())
        elif isinstance(given, inputs.PositionSeen):
            if given.reset:
                work.append(PlaceFence())
            if self._checks_start:
                work.append(CheckStart(given.pos_ned))
            work += self._breached(given.pos_ned)
        return work

    def _breached(self, pos_ned: Vec3) -> list[Work]:
        """Whether it flies outside the fence: it does from where that is certain, until it is
        inside for certain."""
        was = Condition.FENCE_BREACHED in self.gate.conditions
        outside = None
        if self._verifier is not None and self.gate.state not in NOT_FLYING:
            outside = self._verifier.outside(pos_ned, for_certain=not was)
        if was == (outside is not None):
            return []
        text = "" if outside is None else outside.sentence
        return [condition(Condition.FENCE_BREACHED, outside is not None, text)]

    def _is_news(self, given: inputs.ConditionChanged) -> bool:
        """Whether the condition changed; it is looked at far more often than it does."""
        if given.active != (given.condition in self.gate.conditions):
            return True
        retold = given.active and given.condition in RETOLD
        return retold and (given.condition, given.text) not in self.gate.reasons

    def tell(
        self,
        effect: effects.Verdict | effects.Transition | effects.Say | effects.SwitchedFence,
        sysid: int,
    ) -> list[Work]:
        """What the gate decided, for operator and record; and the fence's switch."""
        match effect:
            case effects.Verdict(request_id, _, request, ruling, refusal, _, evidence):
                goal_ned = request.goal_ned if isinstance(request, GoTo) else None
                return [GiveVerdict(request_id, ruling, refusal, evidence, goal_ned)]
            case effects.Transition():
                goal_ned = self.gate.active_goal_ned
                wrong = announcements.conditions(self.gate)
                return announcements.transition(effect, goal_ned, wrong, sysid)
            case effects.Say(level, text):
                return [Log(level, announcements.NODE, text)]
            case effects.SwitchedFence(on):
                self._fence_on = on
                return [PlaceFence()]

    def ahead(self, telemetry: Telemetry) -> list[Work]:
        """What a viewer is to draw ahead of the vehicle: the leg, and where it would come to
        rest."""
        leg = self._leg_ahead.look(self.gate.memory, telemetry.sysid)
        return [*([] if leg is None else [Record(leg)]), *self._predicted_stop(telemetry)]

    def _predicted_stop(self, telemetry: Telemetry) -> list[Work]:
        """In flight only."""
        if telemetry.pos_ned is None or self.gate.state in NOT_FLYING:
            return []
        memory, name = self.gate.memory, telemetry.autopilot.name
        (_, stop_ned), *_ = ways_to_stop(
            telemetry.pos_ned, telemetry.v_ned, memory.path, self.policy, name
        )
        paced = memory.paced
        on_its_way = paced is not None and paced.goal_ned == self.gate.active_goal_ned
        allowed_m_s = math.hypot(*paced.v_ned) if paced is not None and on_its_way else None
        return [Record(StopItem(telemetry.sysid, telemetry.pos_ned, stop_ned, allowed_m_s))]

    # -------------------------------------------------------------------------- the fence

    def place_fence(self, telemetry: Telemetry | None) -> list[Work]:
        """Home or origin became known, or moved: the fence stands anew, is shown and recorded."""
        if telemetry is None:
            return []
        verifier = self._verifier = verifier_for(
            self.policy,
            telemetry.autopilot.name,
            telemetry.home_ned,
            telemetry.origin,
            fence_on=self._fence_on,
        )
        fence = announcements.fence(verifier.zones, telemetry.origin, self.policy)
        return [
            GateInput(inputs.VerifierChanged(verifier)),
            *announcements.origin(telemetry.sysid, telemetry.origin),
            *(each for each in fence if self._first or not isinstance(each, Record)),
            *([] if telemetry.pos_ned is None else self._breached(telemetry.pos_ned)),
        ]

    @property
    def fence_shapes(self) -> list[FenceShape]:
        """For drawing; empty before it is placed."""
        return [] if self._verifier is None else announcements.shapes(self._verifier.zones)

    @property
    def _checks_start(self) -> bool:
        """It stands on the ground, there is a fence or it can never be placed here, and it was not
        looked at yet."""
        verifier = self._verifier
        if self._start_checked or verifier is None:
            return False
        placed = bool(verifier.zones) or _never_placed(verifier)
        return placed and self.gate.state is State.GROUNDED

    def check_start(self, at: CheckStart) -> None:
        """Once, on the ground: is the vehicle inside?  If not, the policy is for elsewhere.

        A vehicle that is met in the air is judged request by request: it must not be left alone.
        """
        if self._verifier is None or not self._checks_start:
            return
        self._start_checked = True
        home_ned = self._verifier.home_ned
        self.bad_home = None if home_ned is None else check_start(self._verifier, home_ned)
        self.bad_start = check_start(self._verifier, at.pos_ned)


def _never_placed(verifier: Verifier) -> bool:
    """Home and origin are known, and the fence is too far from there, or no polygon."""
    unplaced = verifier.unplaced
    return verifier.home_ned is not None and unplaced is not None and unplaced.code is Code.POLICY
