"""A flight during which the gate's promises are checked, on the bytes that were sent.

What was verified is learnt by listening to the verifier itself, what was accepted from the
verdicts; what was sent is read by pymavlink.  None of the three looks at the gate's state.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from operator import sub
from typing import Any
from unittest import mock

from gcs import ipc
from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.questions.back_inside import WayBack
from gcs.gate.airspace.questions.braking import Breach
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.effects import Effect
from gcs.gate.inputs import Input
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import Policy
from gcs.gate.states import LandedState
from gcs.session import effects, inputs
from tests.loopback import pymavlink_decoder
from tests.loopback.flight import Flight
from tests.proof.edge import Edge
from tests.proof.invariants import objections

Vec3 = tuple[float, float, float]

FLIGHT_TERMINATION = 185
ARM_DISARM = 400
TAKE_OFF = 22
FORCE = 21196.0
ROUNDING_M = 1e-4
BACK_M = 2.5 / 0.95
"""[pace.px4.level] back_m_s, follow_per_s."""
NEAR_GROUND_M = 0.3
LAB_REST_M = 0.5
"""The lab's brake acts only beyond half a metre outside the cage."""
HOME_MOVES_M = 0.5
"""The vehicle sets its home anew when it is armed; the gate knows the one before for a while."""


def float32(pos_ned: Vec3) -> Vec3:
    """As the wire carries it."""
    a, b, c = struct.unpack("<3f", struct.pack("<3f", *pos_ned))
    return (a, b, c)


class Witness:
    """Every position that a verifier cleared, as float32, and whether the fence was on then.

    `stops` are those to stay at, `tops` those that a climb ends at.
    """

    def __init__(self) -> None:
        self.cleared: dict[Vec3, bool] = {}
        self.stops: set[Vec3] = set()
        self.tops: set[Vec3] = set()

    @contextmanager
    def listening(self, policy: Policy) -> Iterator[None]:
        """While it lasts, every answer of the verifier is heard, and every step of the gate judged.

        The gate's own invariants are asked of each step; the wire is judged apart from them.
        """
        handle = Gate.handle

        def judged(gate: Gate, given: Input, now_ns: int) -> list[Effect]:
            before = gate.memory
            effects = handle(gate, given, now_ns)
            edge = Edge(policy, before, given, now_ns, effects, gate.memory)
            broken = [str(objection) for objection in objections(edge)]
            assert not broken, f"{broken} by {given} in {before.state.name}: {effects}"
            return effects

        goal, hold = Verifier.goal, Verifier.hold_point
        climb, stop = Verifier.takeoff, Verifier.predicted_stop

        def heard_goal(v: Verifier, goal_ned: Vec3, *rest: Any, **named: Any) -> Any:
            return self._note(v, goal(v, goal_ned, *rest, **named), goal_ned)

        def heard_hold(v: Verifier, pos_ned: Vec3, *rest: Any, floor_applies: bool) -> Any:
            answer = hold(v, pos_ned, *rest, floor_applies=floor_applies)
            if isinstance(answer, Cleared):
                self.stops.add(float32(pos_ned))
            return self._note(v, answer, pos_ned)

        def heard_climb(v: Verifier, up_m: float, pos_ned: Vec3) -> Any:
            answer, top_ned = climb(v, up_m, pos_ned), (*pos_ned[:2], pos_ned[2] - up_m)
            if isinstance(answer, Cleared):
                self.tops.add(float32(top_ned))
            return self._note(v, answer, top_ned)

        def heard_stop(v: Verifier, pos_ned: Vec3, *rest: Any, floor_applies: bool) -> Any:
            breach = stop(v, pos_ned, *rest, floor_applies=floor_applies)
            if isinstance(breach, Breach) and breach.brake_pos_ned is not None:
                self.stops.add(float32(breach.brake_pos_ned))
                self._note(v, Cleared(), breach.brake_pos_ned)
            return breach

        way_back = Verifier.way_back

        def heard_way_back(v: Verifier, pos_ned: Vec3, v_ned: Vec3) -> Any:
            way = way_back(v, pos_ned, v_ned)
            if isinstance(way, WayBack):
                self.stops.add(float32(way.to_ned))
                self._note(v, Cleared(), way.to_ned)
            return way

        with (
            mock.patch.object(Verifier, "way_back", heard_way_back),
            mock.patch.object(Gate, "handle", judged),
            mock.patch.object(Verifier, "goal", heard_goal),
            mock.patch.object(Verifier, "hold_point", heard_hold),
            mock.patch.object(Verifier, "takeoff", heard_climb),
            mock.patch.object(Verifier, "predicted_stop", heard_stop),
        ):
            yield

    def _note(self, verifier: Verifier, answer: Any, pos_ned: Vec3) -> Any:
        if isinstance(answer, Cleared):
            self.cleared[float32(pos_ned)] = verifier.fence_on
        return answer


class CheckedFlight(Flight):
    """Raises AssertionError in the very moment in which a promise is broken."""

    witness: Witness
    requests: dict[int, tuple[str, Vec3 | None]]
    goals: set[Vec3]
    abandoned: set[Vec3]
    setpoint_count: int

    def __init__(self, *given: Any, **named: Any) -> None:
        self.witness = Witness()
        self.requests = {}
        self.goals = set()
        self.abandoned = set()
        self.setpoint_count = 0
        self._sent_ned: Vec3 | None = None
        super().__init__(*given, **named)

    def say(self, word: str, **named: Any) -> int:
        goal_enu = named.get("goal_enu") or (math.nan, math.nan, math.nan)
        usable = all(abs(value) < 1e30 for value in goal_enu)
        goal_ned = (goal_enu[1], goal_enu[0], -goal_enu[2])
        self.requests[self.last_id + 1] = (word, float32(goal_ned) if usable else None)
        return super().say(word, **named)

    def _carry_out(self, effect: effects.Effect) -> list[inputs.Input]:
        match effect:
            case effects.Transmit(_, data):
                self._sends(pymavlink_decoder.read(data))
            case effects.Emit(ipc.VerdictEvent() as verdict):
                self._judges(verdict)
            case effects.Emit(ipc.EndingEvent() as ending):
                self._ends(ending)
        return super()._carry_out(effect)

    # ------------------------------------------------------------------------- promises

    def _judges(self, verdict: ipc.VerdictEvent) -> None:
        assert not self.verdicts(verdict.id), f"a second verdict: {verdict}"
        assert verdict.word == self.requests[verdict.id][0]
        goal_ned = self.requests[verdict.id][1]
        if goal_ned is None:
            assert verdict.word != "goto" or verdict.outcome != "accepted", verdict
        elif verdict.outcome == "accepted":
            assert goal_ned in self.witness.cleared, f"accepted unverified: {verdict}"
            self.goals.add(goal_ned)
            self.abandoned.discard(goal_ned)

    def _ends(self, ending: ipc.EndingEvent) -> None:
        outcomes = [verdict.outcome for verdict in self.verdicts(ending.id)]
        assert outcomes == ["accepted"], f"an ending without a verdict: {ending}"
        assert not self.endings(ending.id), f"a second ending: {ending}"
        goal_ned = self.requests[ending.id][1]
        if goal_ned is not None and ending.ended != "complete":
            self.abandoned.add(goal_ned)

    def _sends(self, message: Any) -> None:
        setpoint = pymavlink_decoder.setpoint_of(message, self.now_ns)
        if setpoint is not None:
            self.setpoint_count += 1
            self._streams(setpoint)
        elif message.get_type() == "COMMAND_LONG":
            self._commands(message)
        else:
            assert "SET_" not in message.get_type(), message

    def _streams(self, setpoint: pymavlink_decoder.SeenSetpoint) -> None:
        pos_ned = setpoint.pos_ned
        assert setpoint.finite, setpoint
        assert setpoint.frame == pymavlink_decoder.LOCAL_NED
        assert setpoint.type_mask in (
            pymavlink_decoder.POSITION_ONLY,
            pymavlink_decoder.POSITION_AND_YAW,
        )
        held = [to_ned for to_ned in self.witness.stops if self._leads_to(pos_ned, to_ned)]
        goals = (self.goals | self.witness.tops) - self.abandoned
        goes_to = [to_ned for to_ned in goals if self._leads_to(pos_ned, to_ned)]
        assert held or goes_to, f"nobody verified {pos_ned}, or it was abandoned"
        self._sent_ned = pos_ned
        inside = (self.inside(to_ned, to_ned in held) for to_ned in (*held, *goes_to))
        unfenced = (not self.witness.cleared[to_ned] for to_ned in (*held, *goes_to))
        assert any(inside) or any(unfenced), f"{pos_ned} leads outside"

    def _leads_to(self, sent_ned: Vec3, to_ned: Vec3) -> bool:
        """It is that place, or straight between it and where the vehicle was reported, level and
        up or down apart, or so far behind it as a PX4 may be asked to fly back; or what was sent
        last, where the report is old."""
        seen = self.session.telemetry
        if sent_ned == to_ned:
            return True
        if seen is None or seen.pos_ned is None:
            return False
        if sent_ned == self._sent_ned:
            return True
        way_n, way_e, way_d = map(sub, to_ned, seen.pos_ned)
        n, e, d = map(sub, sent_ned, seen.pos_ned)
        away_m = max(math.hypot(way_n, way_e), ROUNDING_M)
        ahead_m, beside_m = (way_n * n + way_e * e) / away_m, abs(way_n * e - way_e * n) / away_m
        level: bool = (
            -BACK_M - ROUNDING_M <= ahead_m <= away_m + ROUNDING_M and beside_m <= ROUNDING_M
        )
        up_or_down: bool = min(0.0, way_d) - ROUNDING_M <= d <= max(0.0, way_d) + ROUNDING_M
        return level and up_or_down

    def inside(self, pos_ned: Vec3, held: bool) -> bool:
        """Inside the fence as this file understands it: the lab's cage, or 150 m of home.

        The floor does not apply to a hold at the beginning or the end of a flight.  The lab has no
        margin for goals and stops nobody who is less than half a metre outside, so there one may
        come to rest; a goal may not be there.
        """
        north_m, east_m, up_m = pos_ned[0], pos_ned[1], -pos_ned[2]
        floor_m = -NEAR_GROUND_M if held else -ROUNDING_M
        if self.policy.name == "lab":
            over_m = LAB_REST_M if held else ROUNDING_M
            sides = max(abs(north_m), abs(east_m)) <= 5.0 + over_m
            return sides and floor_m <= up_m <= 2.0 + over_m
        home_ned = self.vehicle.home_pos_ned or (0.0, 0.0, 0.0)
        away_m = math.hypot(north_m - home_ned[0], east_m - home_ned[1])
        home_up_m = -home_ned[2]
        return away_m <= 150.0 + HOME_MOVES_M and floor_m <= up_m - home_up_m <= 50.0 + HOME_MOVES_M

    def _commands(self, m: Any) -> None:
        assert m.command != FLIGHT_TERMINATION
        if m.command == ARM_DISARM and m.param1 == 0.0:
            assert m.param2 != FORCE, "a forced disarm"
            seen = self.session.telemetry
            assert seen is not None
            aloft = seen.landed in (LandedState.IN_AIR, LandedState.TAKEOFF)
            assert not aloft, f"a disarm though {seen.landed.name} is reported"
        if m.command == TAKE_OFF:
            assert math.isfinite(m.param7), "a take-off to the vehicle's own height"

    def all_answered(self) -> None:
        """Exactly one verdict for every request, exactly one ending for every accepted one."""
        for ask_id, (word, _) in self.requests.items():
            verdicts, endings = self.verdicts(ask_id), self.endings(ask_id)
            assert len(verdicts) == 1, f"{word} {ask_id}: verdicts {verdicts}"
            accepted = verdicts[0].outcome == "accepted"
            assert len(endings) == accepted, f"{word} {ask_id}: {verdicts} {endings}"
