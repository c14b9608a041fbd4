"""One hostile run of the gate: random requests, reports, losses, delays and pilots, from one seed.

The real gate with a policy as it is, a point-mass vehicle at 50 Hz (`point_mass.py`), a link with a
delay and with outages, and somebody who asks for anything at any time.  What is checked, always:

- the truth never leaves the fence by more than the margin, from the moment in which the gate takes
  control until somebody else flies, the frame or the fence moves, or the link is dead;
- every request has one verdict, and every accepted one an ending, but for the one under way;
- every setpoint and every command that moves has a permit, and every setpoint is inside the fence.
"""

from __future__ import annotations

import math
import random
from collections import Counter, deque
from dataclasses import dataclass
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.stopping import stop_point
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.effects import (
    CancelCommand,
    CommandKind,
    Effect,
    Outcome,
    Ruling,
    SendCommand,
    SendSetpoint,
    SwitchedFence,
    Transition,
    Verdict,
)
from gcs.gate.inputs import (
    ClimbEndSeen,
    CommandEnded,
    HeartbeatSeen,
    HomeSeen,
    Input,
    LandedSeen,
    MissionSeen,
    PositionSeen,
    Requested,
    ReturnHeightSeen,
    ReturnPlacesSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.gate import MOTION
from gcs.gate.permit import Permit
from gcs.gate.policy.policy import Policy
from gcs.gate.requests import (
    Request,
)
from gcs.gate.states import Control, FlightMode, State
from tests.proof.edge import Edge
from tests.proof.invariants import objections
from tests.soak.hostile_counts import CountingGate, Seen
from tests.soak.point_mass import STEP_NS, STILL, TO_RETURN_UP_M, PointMass

TICK_NS: Final = 50_000_000
MS_NS: Final = 1_000_000
SECOND_NS: Final = 1_000_000_000
NOSES_RAD: Final = (0.5, 2.5, 0.5, None)
NOSE_MS: Final = 4_000
"""Where the nose is told to point, for so long each: where goals ask for it, elsewhere, nowhere."""
OLDEST_S: Final = 0.9
"""The session hands on no position that is older than `position_age_s` when it comes."""
SETTLED_S: Final = 3.0
"""So long after an outage of the link its effects may last, beside the time that the vehicle needs
to brake: told to hold at last, at 9 m/s, it rests six seconds later."""

Told = tuple[int, State, object]
"""When, in which state, and what: a line of the trace."""


def along3(a: Vec3, b: Vec3, part: float) -> Vec3:
    """The place on the line from `a` to `b`, at this part of it."""
    return (
        a[0] + part * (b[0] - a[0]),
        a[1] + part * (b[1] - a[1]),
        a[2] + part * (b[2] - a[2]),
    )


class Broken(AssertionError):  # noqa: N818 - it is what a test raises
    """A promise of the gate was broken."""


@dataclass(slots=True)
class Awaited:
    """A command on its way, which is sent again until it is answered or too late."""

    sent: SendCommand
    next_ns: int


class HostileRun:
    """`fly()` raises Broken, with the last inputs in `trace`."""

    def __init__(self, seed: int, policy: Policy, *, judged: bool = False) -> None:
        self.seed, self.policy, self.judged = seed, policy, judged
        self.dice = dice = random.Random(seed)
        self.autopilot = dice.choice(("px4", "ardupilot"))
        self.now_ns = SECOND_NS
        self.gate = CountingGate(policy, self.autopilot, self.now_ns)
        self.gate.met = Counter()
        self.vehicle = PointMass(self.autopilot, policy, dice)
        self.seen = Seen(runs=1)
        self.trace: deque[Told] = deque(maxlen=60)
        self.positions: deque[Told] = deque(maxlen=8)
        braking = policy.braking_of(self.autopilot)
        late_s = dice.choice((0.0, 0.0, 0.3, 0.9)) * (braking.react_s - 0.1)
        self.report_delay_ns = round(min(late_s * dice.random(), OLDEST_S) * SECOND_NS)
        self.is_late_by(late_s)
        self.loss = dice.choice((0.0, 0.0, 0.1, 0.3))
        self.home_ned: Vec3 = (0.0, 0.0, 0.0)
        self.fence_on = True
        self._verifiers: dict[tuple[Vec3, bool], Verifier] = {}
        self.promised = False
        self._stoppable = False
        self._taken_ns = 0
        self._told_anew = True
        """The vehicle was told something that was sent after it was taken away."""
        self.deaf_until_ns = self.mute_until_ns = self.unanswered_until_ns = 0
        self._settled_ns = 0
        self._down: deque[tuple[int, Input]] = deque()
        self._up: deque[tuple[int, SendSetpoint | SendCommand]] = deque()
        self._awaited: dict[tuple[int, CommandKind], Awaited] = {}
        self._next_id = 0
        self._rulings: dict[int, Ruling] = {}
        self._ended: set[int] = set()
        self._asked: set[int] = set()
        self._next_tick_ns = self.now_ns + TICK_NS
        self._shown_mode: FlightMode | None = None
        self._steps = 0
        self._items = 0
        self._clear_ns = 0

    def is_late_by(self, late_s: float) -> None:
        """Its reports are, and say so; and what it is told is, for the rest of this time.

        That counts as the vehicle's own: it reacts the sooner, and slows down the sooner."""
        up_s = max(0.0, late_s - self.report_delay_ns / SECOND_NS)
        vehicle = self.vehicle
        most_s = min(vehicle.braking.react_s, vehicle.pace.level.lag_s) - TICK_NS / SECOND_NS
        up_s = min(up_s, most_s)
        self.up_delay_ns = round(up_s * SECOND_NS)
        vehicle.hold_react_s = vehicle.braking.react_s - up_s - 0.04
        own_s = up_s + TICK_NS / SECOND_NS
        level, vertical = vehicle.pace.level.lag_s, vehicle.pace.vertical.lag_s
        vehicle.lags = (max(0.0, level - own_s), max(0.0, vertical - own_s))

    @property
    def vehicle_is_late(self) -> bool:
        """Are its reports, or what it is told, under way for long?"""
        return self.report_delay_ns + self.up_delay_ns > 0

    # ----------------------------------------------------------------------------- gate

    def feed(self, given: Input, *, judged: bool = True) -> None:
        """`judged` False: an input that the gate drops, so that no invariant speaks of it."""
        gate = self.gate
        if not isinstance(given, Tick):
            told = self.positions if isinstance(given, PositionSeen) else self.trace
            told.append((self.now_ns, gate.state, given))
        before = gate.memory if self.judged and judged else None
        effects = gate.handle(given, self.now_ns)
        if before is not None:
            edge = Edge(self.policy, before, given, self.now_ns, effects, gate.memory)
            broken = [str(objection) for objection in objections(edge)]
            if broken:
                self._fail(f"{broken} by {given}: {effects}")
        for effect in effects:
            self._perform(effect)

    def _perform(self, effect: Effect) -> None:
        match effect:
            case SendSetpoint(permit):
                self._check_setpoint(permit)
                self._up.append((self.now_ns + self.up_delay_ns, effect))
            case SendCommand():
                if effect.kind in MOTION and not isinstance(effect.permit, Permit):
                    self._fail(f"without a permit: {effect}")
                self.trace.append((self.now_ns, self.gate.state, effect.kind))
                self._awaited[effect.request_id, effect.kind] = Awaited(effect, self.now_ns)
            case CancelCommand(request_id, kind):
                self._awaited.pop((request_id, kind), None)
            case SwitchedFence(on):
                self.fence_on = on
                if not on:
                    self.promised = False
                self.feed(VerifierChanged(self.verifier()))
            case Verdict():
                self._count(effect)
            case Outcome(request_id, _, code):
                if self._rulings.get(request_id) is not Ruling.ACCEPTED:
                    self._fail(f"an ending of what was not accepted: {effect}")
                if request_id in self._ended:
                    self._fail(f"a second ending: {effect}")
                self._ended.add(request_id)
                if code is not None:
                    self.seen.codes[code.value] += 1
            case Transition():
                self.trace.append((self.now_ns, effect.after, f"by {effect.event}"))

    def _count(self, verdict: Verdict) -> None:
        if verdict.request_id in self._rulings or verdict.request_id not in self._asked:
            self._fail(f"a second verdict: {verdict}")
        self._rulings[verdict.request_id] = verdict.ruling
        if verdict.refusal is not None:
            self.seen.codes[verdict.refusal.code.value] += 1
        elif verdict.ruling is not Ruling.ACCEPTED:
            self._fail(f"no reason: {verdict}")

    def _check_setpoint(self, permit: Permit) -> None:
        assert type(permit) is Permit
        asked = (permit.pos_ned, permit.v_ned, permit.a_ned)
        if asked == (None, None, None) or not all(math.isfinite(x) for v in asked for x in v or ()):
            self._fail(f"a setpoint that says nothing: {permit}")
        pos_ned = permit.pos_ned
        if pos_ned is None or not self.fence_on:
            return
        # From outside it leads back inside, and no farther out.
        least_m = min(-self._allowed(), self.clearance(self.gate.pos_ned or pos_ned) - 1e-6)
        if self.clearance(pos_ned) < least_m:
            self._fail(f"a setpoint outside: {pos_ned}")

    def all_answered(self) -> None:
        """After a tick no verdict is owed but on a goal that waits for control; one ending at
        most."""
        memory = self.gate.memory
        waits = set() if memory.pending is None else {memory.pending.request_id}
        if waits and memory.control is not Control.TAKING:
            self._fail(f"no verdict on {waits} at the tick")
        if self._asked - waits != set(self._rulings):
            self._fail(f"no verdict on {self._asked - waits - set(self._rulings)}")
        accepted = {n for n, ruling in self._rulings.items() if ruling is Ruling.ACCEPTED}
        under_way = set() if memory.task is None else {memory.task.requested.request_id}
        if accepted - self._ended != under_way:
            self._fail(f"no ending of {accepted - self._ended - under_way}")

    def _fail(self, what: str) -> None:
        told = sorted((*self.trace, *self.positions), key=lambda line: line[0])
        lines = "\n".join(
            f"{(now_ns - SECOND_NS) / 1e9:.2f} {state.name}: {str(given)[:160]}"
            for now_ns, state, given in told
        )
        kind = f"{self.autopilot}, policy {self.policy.name}, seed {self.seed}"
        raise Broken(f"{what}\n{kind}, the last inputs:\n{lines}")

    # --------------------------------------------------------------------------- fence

    def verifier(self) -> Verifier:
        """Placed once for each home: that costs as much as twenty steps of a flight."""
        key = (self.home_ned, self.fence_on)
        if key not in self._verifiers:
            self._verifiers[key] = verifier_for(
                self.policy, self.autopilot, self.home_ned, None, fence_on=self.fence_on
            )
        return self._verifiers[key]

    def clearance(self, pos_ned: Vec3) -> float:
        """The least of all faces, in metres; floors are the ground's business."""
        verifier = self.gate._step.memory.verifier
        if verifier is None:
            return math.inf
        en, up_m = (pos_ned[1], pos_ned[0]), -pos_ned[2]
        least_m = math.inf
        for zone in verifier.zones:
            beside_m = zone.shape.clearance(en)
            if zone.inclusion:
                least_m = min(least_m, beside_m, zone.ceiling_up_m - up_m)
            else:
                stacked_m = max(zone.floor_up_m - up_m, up_m - zone.ceiling_up_m)
                least_m = min(least_m, max(-beside_m, stacked_m))
        return least_m

    def _allowed(self) -> float:
        return max(self.policy.margin_h_m, self.policy.brake_slack_h_m) + 1e-6

    def _check_truth(self) -> None:
        """The promise begins where the gate flies the vehicle, or has it take off."""
        flown = self.gate.control is Control.OURS and self.vehicle.mode is FlightMode.GUIDED
        climbs = self.gate.state is State.TAKING_OFF and self.vehicle.speed_m_s == 0.0
        if (flown or climbs) and not self.promised and self._told_anew:
            self.promised = self.clearance(self.vehicle.at) > 0.0 and not self._hurled()
        if not self.vehicle.armed:
            self.promised = False  # it falls, or stands
        outage_ns = max(self.deaf_until_ns, self.mute_until_ns)
        if self.now_ns < outage_ns:
            brakes_s = self.vehicle.speed_m_s / self.vehicle.braking.a_brake_h_m_s2
            self._settled_ns = outage_ns + round((SETTLED_S + brakes_s) * SECOND_NS)
        if not self.promised or not self.fence_on or self.now_ns < self._settled_ns:
            return
        clear_m = self.clearance(self.vehicle.at)
        self.seen.under_promise += 1
        if clear_m < self.seen.worst_m:
            self.seen.worst_m = clear_m
        if clear_m < -self._allowed():
            self._fail(f"the truth {self.vehicle.pos} is {-clear_m:.2f} m outside")

    def taken_away(self) -> None:
        """Somebody else flies it, or the place or the fence has moved: no promise holds until we
        have it again, and as one that can be stopped inside.  Until then it flies what it was told
        last, which may be a place that is far outside now."""
        self.promised, self._stoppable = False, False
        self._taken_ns, self._told_anew = self.now_ns, False

    def _hurled(self) -> bool:
        """Did others leave it so fast, so near to the edge, that no hold could stop it inside?"""
        if not self._stoppable:
            v, b = self.vehicle, self.vehicle.braking
            rest_ned = stop_point(v.at, (v.vel[0], v.vel[1], v.vel[2]), b)
            way = (along3(v.at, rest_ned, part / 8.0) for part in range(1, 9))
            self._stoppable = all(self.clearance(spot) > 0.0 for spot in way)
        return not self._stoppable

    # ---------------------------------------------------------------------------- time

    def step(self) -> None:
        """20 ms of everything."""
        self.now_ns += STEP_NS
        self._steps += 1
        vehicle = self.vehicle
        vehicle.step()
        self._report()
        while self._up and self._up[0][0] <= self.now_ns:
            due_ns, what = self._up.popleft()
            self._deliver(what)
            if due_ns - self.up_delay_ns >= self._taken_ns and self.now_ns >= self.deaf_until_ns:
                self._told_anew = True
        self._send_again()
        while self._down and self._down[0][0] <= self.now_ns:
            self.feed(self._down.popleft()[1])
        if self.now_ns >= self._next_tick_ns:
            self._next_tick_ns += TICK_NS
            self.feed(Tick(0))
        self._check_truth()

    def _say(self, given: Input) -> None:
        if self.now_ns >= self.mute_until_ns:
            self._down.append((self.now_ns + self.report_delay_ns, given))

    def _report(self) -> None:
        v, n = self.vehicle, self._steps
        if n % 50 == 0 or v.mode is not self._shown_mode:
            self._shown_mode = v.mode
            self._say(HeartbeatSeen(v.armed, v.mode, v.mode.value, v.failsafe))
        if n % 25 == 0:
            self._say(LandedSeen(v.landed))
        if v.items_flown != self._items:
            self._items = v.items_flown
            if v.mode is FlightMode.MISSION or not v.path:
                self._say(MissionSeen(self._items, self._items + len(v.path), not v.path))
        if n % 5 == 0 or v.speed_m_s > STILL:
            north, east, down = v.vel
            late_s, now_ms = self.report_delay_ns / SECOND_NS, self.now_ns // MS_NS
            yaw_rad = NOSES_RAD[now_ms // NOSE_MS % len(NOSES_RAD)]
            self._say(
                PositionSeen(
                    v.reported(), (north, east, down), now_ms, late_s=late_s, yaw_rad=yaw_rad
                )
            )

    def _send_again(self) -> None:
        for key, awaited in list(self._awaited.items()):
            if key not in self._awaited:
                continue  # the end of the one before has cancelled it
            if self.now_ns >= awaited.sent.deadline_ns:
                del self._awaited[key]
                self.feed(CommandEnded(*key, None))
            elif self.now_ns >= awaited.next_ns:
                awaited.next_ns = self.now_ns + 500 * MS_NS
                lost = self.dice.random() < self.loss or self.now_ns < self.deaf_until_ns
                if not lost:
                    self._up.append((self.now_ns + self.up_delay_ns, awaited.sent))

    def _deliver(self, what: SendSetpoint | SendCommand) -> None:
        if self.now_ns < self.deaf_until_ns:
            return
        if isinstance(what, SendSetpoint):
            self.vehicle.hears_setpoint(what.permit.pos_ned, what.permit.v_ned)
            return
        result = self.vehicle.hears_command(what)
        key = (what.request_id, what.kind)
        lost = self.dice.random() < self.loss or self.now_ns < self.unanswered_until_ns
        if key in self._awaited and not lost:
            del self._awaited[key]
            self._say(CommandEnded(*key, result))

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds * 50)):
            self.step()

    def until_tick(self) -> None:
        """Past the next tick."""
        due_ns = self._next_tick_ns
        while self._next_tick_ns == due_ns:
            self.step()

    def passes(self, passes_ns: int) -> None:
        """Time in which nothing is done: the vehicle stays where it is."""
        self.now_ns += passes_ns
        self.vehicle.now_s += passes_ns / SECOND_NS
        self.vehicle.setpoint_s += passes_ns / SECOND_NS
        self._next_tick_ns = max(self._next_tick_ns, self.now_ns)

    def never_hears(self, key: tuple[int, CommandKind]) -> None:
        """A command is answered in the vehicle's name before it is there."""
        self._awaited.pop(key, None)

    def leap(self, seconds: float) -> None:
        """A long time in which nothing moves: the vehicle is only heard."""
        end_ns = self.now_ns + round(seconds * SECOND_NS)
        while self.now_ns < end_ns and self.vehicle.speed_m_s < 0.05:
            self.now_ns += 900 * MS_NS
            self.vehicle.now_s += 0.9
            self.vehicle.setpoint_s += 0.9
            self._next_tick_ns = self.now_ns + TICK_NS
            v = self.vehicle
            self.feed(HeartbeatSeen(v.armed, v.mode, v.mode.value, v.failsafe))
            self.feed(LandedSeen(v.landed))
            self.feed(PositionSeen(v.reported(), (0.0, 0.0, 0.0), self.now_ns // MS_NS))
            self._send_again()
            self.feed(Tick(0))

    def ask(self, request: Request, source: str = "operator") -> None:
        self._next_id += 1
        self._asked.add(self._next_id)
        self.feed(Requested(self._next_id, source, request))

    def tells(self) -> None:
        """All of how the vehicle is, at once."""
        v = self.vehicle
        self.feed(HeartbeatSeen(v.armed, v.mode, v.mode.value, v.failsafe))
        self.feed(LandedSeen(v.landed))
        north, east, down = v.vel
        self.feed(PositionSeen(v.reported(), (north, east, down), self.now_ns // MS_NS))

    def connects(self) -> None:
        """What a station knows soon after it has heard the vehicle."""
        self.tells()
        self.feed(HomeSeen(self.home_ned))
        self.feed(ReturnHeightSeen(TO_RETURN_UP_M))
        self.feed(ReturnPlacesSeen(()))
        self.feed(ClimbEndSeen(0.8 if self.autopilot == "px4" else 0.0))
        self.feed(VerifierChanged(self.verifier()))
