"""L17 and the invariants over random runs: any interleaving, any order, any numbers."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field, replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from msgspec import structs

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.effects import CommandKind, Outcome, Ruling, SendSetpoint, SwitchedFence, Verdict
from gcs.gate.inputs import (
    ClimbEndSeen,
    HeartbeatSeen,
    HomeSeen,
    Input,
    LandedSeen,
    MissionLoaded,
    OperatorLost,
    PositionSeen,
    Requested,
    ReturnHeightSeen,
    StreamSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.events import Event
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.rows.row import Branch
from gcs.gate.machine.step_context import Reply
from gcs.gate.machine.table import TABLE, Table
from gcs.gate.permit import Permit
from gcs.gate.policy.policy import Policy
from gcs.gate.requests import GoTo, Resume, TakeControl
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.proof.alphabet import ALPHABET, TICK_NS
from tests.proof.edge import Edge
from tests.proof.invariants import objections
from tests.proof.world import YARD, World
from tests.shares import examples

HOME = (0.0, 0.0, 0.0)
BACK_M = 2.5 / 0.95
"""[pace.px4.level] back_m_s, follow_per_s."""
RADIUS_M, CEILING_M = 20.0, 30.0
MARGIN_M = 2.0


@dataclass
class Run:
    """Feeds a gate, checks every step, and keeps the books over the whole run."""

    policy: Policy = YARD
    autopilot: str = "px4"
    table: Table = field(default_factory=lambda: TABLE)
    now_ns: int = SECOND_NS
    verdicts: Counter[int] = field(default_factory=Counter)
    accepted: set[int] = field(default_factory=set)
    endings: Counter[int] = field(default_factory=Counter)
    goals: dict[int, Vec3] = field(default_factory=dict)
    asked: set[int] = field(default_factory=set)
    places: set[Vec3] = field(default_factory=set)
    streamed: dict[StreamSeen, int] = field(default_factory=dict)
    sent_ned: Vec3 | None = None
    last_id: int = 0

    def __post_init__(self) -> None:
        self.gate = Gate(self.policy, self.autopilot, self.now_ns, self.table)
        self.verifier = verifier_for(self.policy, self.autopilot, HOME, None)
        self.world = World(self.policy, self.verifier, 10.0, 0.8)
        for told in (
            HomeSeen(HOME),
            ReturnHeightSeen(10.0),
            ClimbEndSeen(0.8),
            VerifierChanged(self.verifier),
            MissionLoaded("square", 4),
        ):
            self.feed(told)

    def hover(self) -> Run:
        """In the middle of the yard, under our control."""
        self.feed(HeartbeatSeen(True, FlightMode.HOLD, "hold"))
        self.feed(LandedSeen(LandedState.IN_AIR))
        self.feed(PositionSeen((0.0, 0.0, -5.0), (0.0, 0.0, 0.0), 0))
        self.ask(TakeControl())
        for _ in range(21):
            self.feed(PositionSeen((0.0, 0.0, -5.0), (0.0, 0.0, 0.0), 0), TICK_NS)
            self.feed(Tick(0))
        self.feed(HeartbeatSeen(True, FlightMode.GUIDED, "guided"))
        assert self.gate.state is State.HOVERING
        return self

    def ask(self, request: GoTo | TakeControl) -> None:
        self.last_id += 1
        self.feed(Requested(self.last_id, "test", request))

    def letter(self, name: str) -> None:
        for passes_ns, told in ALPHABET[name](self.world, self.gate.memory, self.now_ns):
            if isinstance(told, Requested):
                self.last_id += 1
                told = replace(told, request_id=self.last_id)
            self.feed(told, passes_ns)

    def feed(self, told: Input, passes_ns: int = 1) -> None:
        self.now_ns += passes_ns
        before = self.gate.memory
        effects = self.gate.handle(told, self.now_ns)
        edge = Edge(self.policy, before, told, self.now_ns, effects, self.gate.memory)
        assert not list(objections(edge))
        if isinstance(told, Requested):
            self.asked.add(told.request_id)
        if isinstance(told, PositionSeen):
            self.places.add(told.pos_ned)
        if isinstance(told, StreamSeen):
            self.streamed[told] = self.now_ns
        for effect in effects:
            match effect:
                case Verdict(request_id, _, request, ruling):
                    self.verdicts[request_id] += 1
                    if ruling is Ruling.ACCEPTED:
                        self.accepted.add(request_id)
                        if isinstance(request, GoTo):
                            self.goals[request_id] = request.goal_ned
                case Outcome(request_id):
                    self.endings[request_id] += 1
                case SendSetpoint(permit):
                    self.on_the_wire(permit)
                case SwitchedFence():
                    self.feed(VerifierChanged(self.verifier))
                case _:
                    pass

    def on_the_wire(self, permit: Permit) -> None:
        pos_ned, hold = permit.pos_ned, self.gate.memory.hold
        if hold is None and permit.reason == State.STREAMING.name:
            self.as_it_came(permit)
            return
        assert (permit.v_ned, permit.a_ned, permit.yaw_rate_rad_s) == (None, None, None)
        assert pos_ned is not None
        north_m, east_m, down_m = pos_ned
        # From outside it leads back inside, and no farther out.
        here_north_m, here_east_m, here_down_m = self.gate.pos_ned or pos_ned
        beside_m = max(RADIUS_M, math.hypot(here_north_m, here_east_m))
        assert math.hypot(north_m, east_m) <= beside_m + 1e-9
        assert min(0.0, -here_down_m) <= -down_m <= max(CEILING_M, -here_down_m)
        if hold is not None and permit.reason.startswith("brake"):
            self.places.add(hold.pos_ned)
        if hold is not None and hold.evidence[0][0] == "ahead_m":
            inside = math.hypot(*hold.pos_ned[:2]) <= RADIUS_M - MARGIN_M
            assert inside or hold.pos_ned in self.places
            self.places.add(hold.pos_ned)
        assert any(self.leads_to(pos_ned, to) for to in self.places | set(self.goals.values()))
        self.sent_ned = pos_ned

    def leads_to(self, sent_ned: Vec3, to_ned: Vec3) -> bool:
        """There, or straight on the way there from the last report, or as far behind it as a PX4
        may be asked to fly back; or sent before, where that is too old."""
        here_ned = self.gate.pos_ned
        if sent_ned in (to_ned, self.sent_ned) or here_ned is None:
            return True
        parts = [
            (x - a) / (b - a) if abs(b - a) > 1e-6 else None
            for a, x, b in zip(here_ned, sent_ned, to_ned, strict=True)
        ]
        beside = all(
            part is not None or abs(x - a) < 1e-6
            for part, x, a in zip(parts, sent_ned, here_ned, strict=True)
        )
        level = [part for part in parts[:2] if part is not None]
        straight = not level or max(level) - min(level) < 1e-4
        level_m = math.hypot(to_ned[0] - here_ned[0], to_ned[1] - here_ned[1])
        back = 0.0 if level_m == 0.0 else BACK_M / level_m
        ahead = all(-back - 1e-6 <= part <= 1.0 + 1e-6 for part in level)
        up_or_down = parts[2] is None or -1e-6 <= parts[2] <= 1.0 + 1e-6
        return beside and straight and ahead and up_or_down

    def as_it_came(self, permit: Permit) -> None:
        """A sample of a stream: one that came less than the dead-man's time ago."""
        sent = (permit.v_ned, permit.a_ned, permit.yaw_rad, permit.yaw_rate_rad_s)
        came = [
            at_ns
            for s, at_ns in self.streamed.items()
            if (s.v_ned, s.a_ned, s.yaw_rad, s.yaw_rate_rad_s) == sent
            and (permit.pos_ned is None) == (s.pos_ned is None)
            and (
                permit.pos_ned is None
                or s.pos_ned is None
                or self.leads_to(permit.pos_ned, s.pos_ned)
            )
        ]
        assert self.now_ns - max(came) < SECOND_NS // 2

    def closed(self) -> None:
        """Three minutes later nothing is open that could have ended."""
        for _ in range(10):
            self.feed(Tick(0), 20 * SECOND_NS)
        assert self.gate.state is State.NO_VEHICLE
        assert self.verdicts == dict.fromkeys(self.asked, 1)
        assert self.endings == dict.fromkeys(self.accepted, 1)


words = st.lists(st.sampled_from(sorted(ALPHABET)), max_size=80)
numbers = st.floats(-60.0, 60.0) | st.sampled_from([math.nan, math.inf, -math.inf, 1e300])
goals = st.tuples(numbers, numbers, numbers).map(GoTo)
samples = st.builds(
    PositionSeen,
    st.tuples(st.floats(-25, 25), st.floats(-25, 25), st.floats(-35, 5)),
    st.tuples(st.floats(-15, 15), st.floats(-15, 15), st.floats(-5, 5)),
    st.just(0),
    st.booleans(),
)
asked = st.none() | st.tuples(numbers, numbers, numbers)
slow = st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(-1, 1))
stream_samples = st.builds(
    StreamSeen,
    st.just("test"),
    asked,
    asked | slow,
    asked,
    st.none() | numbers,
    st.none() | numbers,
) | st.builds(StreamSeen, st.just("test"), st.none(), slow, st.none(), st.none(), st.none())
steps = st.lists(
    st.sampled_from(sorted(ALPHABET))
    | goals
    | samples
    | stream_samples
    | st.integers(0, 2 * SECOND_NS),
    max_size=80,
)


@pytest.mark.slow
@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
@settings(max_examples=examples(150), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(word=words)
def test_L17_any_interleaving_from_nothing(autopilot: str, word: list[str]) -> None:
    run = Run(autopilot=autopilot)
    for name in word:
        run.letter(name)
    run.closed()


@pytest.mark.slow
@pytest.mark.parametrize("retarget", ["refuse", "replace"])
@settings(max_examples=examples(150), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(steps=steps)
def test_L17_any_interleaving_with_any_numbers_from_hovering(
    retarget: str, steps: list[str | GoTo | PositionSeen | StreamSeen | int]
) -> None:
    run = Run(structs.replace(YARD, retarget=retarget)).hover()
    for step in steps:
        match step:
            case str():
                run.letter(step)
            case GoTo():
                run.ask(step)
            case PositionSeen() | StreamSeen():
                run.feed(step)
            case passes_ns:
                run.feed(Tick(0), passes_ns)
    run.closed()


def test_the_books_notice_a_goal_that_is_queued() -> None:
    """A planted fault: what is sent while moving waits, and is flown later."""
    queued = {**TABLE, (State.MOVING, Event.GOTO): (Branch(reply=Reply.PENDING),)}
    run = Run(table=queued).hover()
    run.ask(GoTo((3.0, 0.0, -5.0)))
    run.feed(Tick(0), TICK_NS)
    with pytest.raises(AssertionError, match="a goal is taken in MOVING"):
        run.ask(GoTo((0.0, 3.0, -5.0)))


@pytest.mark.parametrize(("overdue_in_ns", "then"), [(0, State.HOLDING), (1, State.LANDING)])
def test_a_mode_that_is_overdue_is_dealt_with_before_the_operator_leaves(
    overdue_in_ns: int, then: State
) -> None:
    """Where no tick came between the two, the landing ends for the first of them."""
    now_ns = 10 * SECOND_NS
    memory = Memory(
        "px4",
        State.LANDING,
        Control.OURS,
        heard_ns=now_ns,
        heard_before=True,
        armed=True,
        mode=FlightMode.GUIDED,
        asked_mode=FlightMode.LAND,
        asked_until_ns=now_ns + overdue_in_ns,
    )
    gate, given = Gate.resumed(YARD, memory, now_ns), OperatorLost("the test ends")
    before = gate.memory
    effects = gate.handle(given, now_ns)
    edge = Edge(YARD, before, given, now_ns, effects, gate.memory)
    assert gate.state is then
    assert list(objections(edge)) == []
    ended = replace(edge, after=replace(edge.after, state=State.HOLDING))
    assert any(o.invariant == 0 for o in objections(ended)) is (then is State.LANDING)


@pytest.mark.parametrize(("overdue_in_ns", "then"), [(0, State.HOVERING), (1, State.LANDING)])
def test_a_mode_that_is_overdue_is_dealt_with_before_control_is_asked_for(
    overdue_in_ns: int, then: State
) -> None:
    """The landing that came to nothing ends in a hold, of which the operator takes control."""
    run = Run()
    now_ns = 10 * SECOND_NS
    memory = replace(
        run.gate.memory,
        state=State.LANDING,
        control=Control.OURS,
        heard_ns=now_ns,
        heard_before=True,
        armed=True,
        landed=LandedState.IN_AIR,
        landed_ns=now_ns,
        pos_ned=(0.0, 0.0, -5.0),
        v_ned=(0.0, 0.0, 0.0),
        pos_ns=now_ns,
        mode=FlightMode.GUIDED,
        asked_mode=FlightMode.LAND,
        asked_until_ns=now_ns + overdue_in_ns,
    )
    gate, given = Gate.resumed(YARD, memory, now_ns), Requested(1, "test", Resume())
    before = gate.memory
    effects = gate.handle(given, now_ns)
    edge = Edge(YARD, before, given, now_ns, effects, gate.memory)
    assert gate.state is then
    assert (CommandKind.HOLD in edge.commands) is (then is State.HOVERING)
    assert list(objections(edge)) == []
    lost = replace(edge, after=replace(edge.after, control=Control.OURS))
    assert any("has no next try" in str(o) for o in objections(lost)) is (then is State.HOVERING)
