"""The closed alphabet of the explorer: everything that can reach a gate, in few letters.

A letter is a short run of real inputs, made from what the gate remembers, each with the time
that passes before it.  Positions are three places in a yard: a spot, the goal, and a dash
towards the fence.  Time passes either by one tick or just until one thing is due, so every
order in which things can become due is a word over this alphabet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Final, TypeAlias

from msgspec import structs

from gcs.frames import Vec3
from gcs.gate.airspace.zones import Zone
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind
from gcs.gate.geometry import Circle
from gcs.gate.inputs import (
    CommandEnded,
    ConditionChanged,
    HeartbeatSeen,
    HomeSeen,
    Input,
    LandedSeen,
    MissionLoaded,
    MissionSeen,
    OperatorLost,
    PhotoSeen,
    PositionSeen,
    Requested,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Arrival, Policy
from gcs.gate.policy.zonespec import CircleSpec
from gcs.gate.proof.invariants import FORCE_REPEAT_NS
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    GoTo,
    Hold,
    Land,
    Request,
    Resume,
    ReturnHome,
    SetMode,
    StartMission,
    SwitchFence,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import FlightMode, LandedState

TICK_NS: Final = SECOND_NS // 20
STILL: Final[Vec3] = (0.0, 0.0, 0.0)
SPOT: Final[Vec3] = (0.0, 0.0, -5.0)
GOAL: Final[Vec3] = (3.0, 0.0, -5.0)
EDGE: Final[Vec3] = (18.0, 0.0, -5.0)
DASH: Final[Vec3] = (8.0, 0.0, 0.0)
TOP: Final[Vec3] = (0.0, 0.0, -10.0)
ABOVE: Final[Vec3] = (0.0, 0.0, -14.0)
OUTSIDE: Final[Vec3] = (50.0, 0.0, -5.0)
NOWHERE: Final[Vec3] = (float("nan"), 0.0, -5.0)

CONDITIONS: Final[Mapping[Condition, Severity]] = MappingProxyType(
    {
        Condition.TICK_LATE: Severity.CAUTION,
        Condition.BATTERY_LOW: Severity.HOLD,
        Condition.BATTERY_CRITICAL: Severity.RETURN,
        Condition.VEHICLE_FAILSAFE_ACTIVE: Severity.LAND,
        Condition.ORIGIN_MISMATCH: Severity.TERMINATE,
    }
)
"""One condition of each severity is enough: the gate knows conditions by severity alone."""

YARD: Final = structs.replace(
    DEFAULT,
    name="yard",
    fence=(
        CircleSpec(
            20.0,
            name="yard",
            frame="local",
            floor_up_m=0.0,
            ceiling_up_m=30.0,
        ),
    ),
    fence_switchable=True,
    arrival=Arrival(radius_m=0.5, speed_m_s=None, dwell_s=0.0),
    jump_speed_m_s=1e12,
    takeoff=structs.replace(DEFAULT.takeoff, max_up_m=20.0),
    severities={condition: CONDITIONS.get(condition, Severity.CAUTION) for condition in Condition},
    allow_force_disarm=True,
)
"""Every permission that opens a branch of the table is given; the rest is the default."""

ELSEWHERE: Final = Zone("elsewhere", True, Circle((200.0, 0.0), 20.0), 0.0, 30.0)

Step: TypeAlias = tuple[int, Input]
"""Nanoseconds that pass, then the input."""

Letter: TypeAlias = Callable[[Policy, Memory, int], Iterator[Step]]
"""From the policy, what the gate remembers, and now; no steps where it makes no sense."""

WISHES: Final[Mapping[str, Request]] = MappingProxyType(
    {
        "goto inside": GoTo(GOAL),
        "goto outside": GoTo(OUTSIDE),
        "goto nowhere": GoTo(NOWHERE),
        "control": TakeControl(),
        "resume": Resume(),
        "arm": Arm(),
        "disarm": Disarm(),
        "force disarm": Disarm(force=True),
        "take off": TakeOff(5.0),
        "take off too high": TakeOff(500.0),
        "land": Land(),
        "return": ReturnHome(),
        "hold": Hold(),
        "abort": Abort(),
        "photo": TakePhoto(),
        "mission": StartMission(),
        "other mode": SetMode("POSCTL", FlightMode.OTHER),
        "fence on": SwitchFence(on=True),
    }
)


def _request(request: Request) -> Letter:
    def letter(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
        yield 1, Requested(now_ns + 1, "explorer", request)

    return letter


def _input(given: Input) -> Letter:
    def letter(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
        yield 1, given

    return letter


def _mode(mode: FlightMode) -> Letter:
    def letter(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
        yield 1, HeartbeatSeen(memory.armed, mode, mode.value)

    return letter


def _toggle_armed(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.mode is not None:
        yield 1, HeartbeatSeen(not memory.armed, memory.mode, memory.mode.value)


def _answer(result: int | None) -> Letter:
    def letter(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
        for request_id, kind in memory.outstanding[-1:]:
            yield 1, CommandEnded(request_id, kind, result)

    return letter


def _condition(condition: Condition) -> Letter:
    """On where nothing is wrong, off where this is."""

    def letter(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
        active = [name for name, _ in memory.conditions]
        if active in ([], [condition]):
            yield 1, ConditionChanged(condition, not active)

    return letter


def _tick(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
    yield TICK_NS, Tick(0)


def _picture(after: int, *, ok: bool) -> Letter:
    """So many pictures after the last one."""

    def letter(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
        if after or memory.photo_index is not None:
            yield 1, PhotoSeen((memory.photo_index or 0) + after, ok)

    return letter


def _home_moves(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.home_ned is not None:
        yield 1, HomeSeen(OUTSIDE)
        yield 1, HomeSeen(memory.home_ned)


def _fence_moves(_policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.verifier is not None:
        yield 1, VerifierChanged(replace(memory.verifier, zones=(ELSEWHERE,)))
        yield 1, VerifierChanged(memory.verifier)


def _until(
    due: Callable[[Policy, Memory], int | None], *, told: bool = True, landed: bool = True
) -> Letter:
    """Just until something is due; the vehicle goes on reporting its position (`told`) and
    whether it has `landed` meanwhile."""

    def letter(policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
        due_ns = due(policy, memory)
        if due_ns is None or memory.mode is None:
            return
        passes_ns = max(1, due_ns - now_ns)
        if landed and memory.landed_ns is not None:
            yield passes_ns, LandedSeen(memory.landed)
            passes_ns = 0
        yield passes_ns, HeartbeatSeen(memory.armed, memory.mode, memory.mode.value)
        age_ns = memory.position_age_ns(now_ns)
        if told and age_ns is not None and age_ns <= policy.position_age_s * SECOND_NS:
            assert memory.pos_ned is not None
            assert memory.v_ned is not None
            yield 1, PositionSeen(memory.pos_ned, memory.v_ned, 0)
        yield 1, Tick(0)

    return letter


def _lost(policy: Policy, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.heard_ns is not None:
        yield round(policy.heartbeat_age_s * SECOND_NS) + 1, Tick(0)


def _stale_ns(policy: Policy, memory: Memory) -> int | None:
    if memory.pos_ns is None:
        return None
    return memory.pos_ns + round(policy.position_age_s * SECOND_NS) + 1


def _landed_old_ns(policy: Policy, memory: Memory) -> int | None:
    if memory.landed_ns is None:
        return None
    return memory.landed_ns + round(policy.heartbeat_age_s * SECOND_NS)


def _overdue_ns(policy: Policy, memory: Memory) -> int | None:
    return None if memory.asked_mode is None else memory.asked_until_ns


def _force_late_ns(_policy: Policy, memory: Memory) -> int | None:
    asked_ns = memory.force_asked_ns
    return None if asked_ns is None else asked_ns + FORCE_REPEAT_NS + 1


def _deadline_ns(policy: Policy, memory: Memory) -> int | None:
    return None if memory.task is None else memory.task.deadline_ns


ALPHABET: Final[Mapping[str, Letter]] = MappingProxyType(
    {
        "tick": _tick,
        "position": _input(PositionSeen(SPOT, STILL, 0)),
        "position at the goal": _input(PositionSeen(GOAL, STILL, 0)),
        "position at the top": _input(PositionSeen(TOP, STILL, 0)),
        "position above the top": _input(PositionSeen(ABOVE, STILL, 0)),
        "position dashing for the fence": _input(PositionSeen(EDGE, DASH, 0)),
        "position after a reset": _input(PositionSeen(SPOT, STILL, 0, reset=True)),
        **{f"{mode.value} mode": _mode(mode) for mode in FlightMode},
        "armed or disarmed": _toggle_armed,
        "on the ground": _input(LandedSeen(LandedState.ON_GROUND)),
        "in the air": _input(LandedSeen(LandedState.IN_AIR)),
        **{f"ask: {name}": _request(request) for name, request in WISHES.items()},
        "answer: accepted": _answer(0),
        "answer: refused": _answer(2),
        "answer: none": _answer(None),
        "answer: late": _input(CommandEnded(-1, CommandKind.ARM, 0)),
        "picture": _picture(1, ok=True),
        "no picture": _picture(1, ok=False),
        "a picture told again": _picture(0, ok=True),
        "mission loaded": _input(MissionLoaded("square", 4)),
        "mission at its last item": _input(MissionSeen(3, 4, finished=False)),
        "mission finished": _input(MissionSeen(3, 4, finished=True)),
        **{f"condition: {severity.name}": _condition(c) for c, severity in CONDITIONS.items()},
        "home moves, and back": _home_moves,
        "fence moves, and back": _fence_moves,
        "operator lost": _input(OperatorLost("explorer")),
        "wait: position too old": _until(_stale_ns, told=False),
        "wait: landed too old": _until(_landed_old_ns, landed=False),
        "wait: grace": _until(lambda _, memory: memory.grace_until_ns, told=False),
        "wait: deadline": _until(_deadline_ns),
        "wait: mode overdue": _until(_overdue_ns),
        "wait: control due": _until(lambda _, memory: memory.ask_control_ns),
        "wait: hold due": _until(lambda _, memory: memory.hold_again_ns),
        "wait: forced disarm too late": _until(_force_late_ns),
        "wait: vehicle lost": _lost,
    }
)
