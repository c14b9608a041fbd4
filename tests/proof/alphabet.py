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

from gcs.frames import Vec3
from gcs.gate.airspace.return_place import ReturnPlace
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind
from gcs.gate.inputs import (
    CommandEnded,
    ConditionChanged,
    HeartbeatSeen,
    HomeSeen,
    Input,
    LandedSeen,
    MessageSeen,
    MissionLoaded,
    MissionSeen,
    OperatorLost,
    PhotoSeen,
    PositionSeen,
    Requested,
    ReturnPlacesSeen,
    StreamSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.requests import (
    Abort,
    Arm,
    BeginStream,
    Disarm,
    EndStream,
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
from gcs.gate.states import FlightMode, LandedState, State
from tests.proof.invariants_command import FORCE_WINDOW_NS
from tests.proof.world import (
    ABOVE,
    AWAY_YAW_RAD,
    CONDITIONS,
    DASH,
    EDGE,
    ELSEWHERE,
    GOAL,
    GOAL_YAW_RAD,
    HOME,
    LOW,
    NOWHERE,
    OUTSIDE,
    RUSH,
    SPOT,
    STILL,
    STROLL,
    TOP,
    World,
)

TICK_NS: Final = SECOND_NS // 20
TASK_ID: Final = 1
PENDING_ID: Final = 2
NEW_ID: Final = 3
LATE_ID: Final = -1
"""The id of the request under way, of the one that waits, of a new one, and of one that the gate
does not know any more."""

OWNER: Final = "owner"
OTHER: Final = "other"
"""Who asks: whoever asked for what is under way, or somebody else.  `taking.py` keeps ids and
sources so between letters."""

Step: TypeAlias = tuple[int, Input]
"""Nanoseconds that pass, then the input."""

Letter: TypeAlias = Callable[[World, Memory, int], Iterator[Step]]
"""From the world, what the gate remembers, and now; no steps where it makes no sense."""

REQUESTS: Final[Mapping[str, Request]] = MappingProxyType(
    {
        "goto inside": GoTo(GOAL, GOAL_YAW_RAD),
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
        "stream begin": BeginStream(),
        "stream end": EndStream(),
        "other mode": SetMode("POSCTL", FlightMode.OTHER),
        "fence on": SwitchFence(on=True),
    }
)


RETURN: Final = Requested(NEW_ID, OWNER, ReturnHome())
CRITICAL: Final = ConditionChanged(Condition.BATTERY_CRITICAL, True)
CLEAR_PLACE: Final = ReturnPlace("a clear place", (GOAL[0], GOAL[1], HOME[2]))
PLACE_OUTSIDE: Final = ReturnPlace("a place outside", (OUTSIDE[0], OUTSIDE[1], HOME[2]))


def _request(request: Request) -> Letter:
    def letter(_world: World, _memory: Memory, now_ns: int) -> Iterator[Step]:
        yield 1, Requested(NEW_ID, OWNER, request)

    return letter


def _other_request(request: Request) -> Letter:
    """From another source, while there is a request that it can collide with."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        if memory.task is not None or memory.pending is not None:
            yield 1, Requested(NEW_ID, OTHER, request)

    return letter


def _input(given: Input) -> Letter:
    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        yield 1, given

    return letter


def _mode(mode: FlightMode) -> Letter:
    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        yield 1, HeartbeatSeen(memory.armed, mode, mode.value)

    return letter


def _toggle_armed(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.mode is not None:
        yield 1, HeartbeatSeen(not memory.armed, memory.mode, memory.mode.value)


def _answer(result: int | None) -> Letter:
    """To the last command that is not answered yet."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        for request_id, kind in memory.outstanding[-1:]:
            yield 1, CommandEnded(request_id, kind, result)

    return letter


def _first_answer(result: int | None) -> Letter:
    """To the first of several."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        for request_id, kind in memory.outstanding[:-1][:1]:
            yield 1, CommandEnded(request_id, kind, result)

    return letter


def _late_answer(result: int | None) -> Letter:
    """To a command like the last one, but of a request that has ended or was displaced."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        kinds = [kind for _, kind in memory.outstanding]
        yield 1, CommandEnded(LATE_ID, (kinds or [CommandKind.ARM])[-1], result)

    return letter


def _odd_answer(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    """To a command that the request under way never sent."""
    for request_id, _ in memory.outstanding[-1:]:
        yield 1, CommandEnded(request_id, CommandKind.SET_MODE, 2)


def _condition(condition: Condition) -> Letter:
    """On where nothing is wrong, off where this is."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        active = [name for name, _ in memory.conditions]
        if active in ([], [condition]):
            yield 1, ConditionChanged(condition, not active)

    return letter


def _caution(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    """Comes and goes: it makes no other situation, so it would never be seen to go."""
    if not memory.conditions:
        yield 1, ConditionChanged(Condition.TICK_LATE, True)
        yield 1, ConditionChanged(Condition.TICK_LATE, False)


def _tick(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    yield TICK_NS, Tick(0)


def _picture(*, new: bool, ok: bool) -> Letter:
    """The last picture told again, or another one: indices alternate."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        if new:
            yield 1, PhotoSeen(1 - (memory.photo_index or 0), ok)
        elif memory.photo_index is not None:
            yield 1, PhotoSeen(memory.photo_index, ok)

    return letter


def _sample(source: str, pos_ned: Vec3 | None = None, v_ned: Vec3 | None = None) -> Letter:
    """A sample of a stream; of another source, while there is something it can collide with."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        collides = memory.flown_state is State.STREAMING or memory.task is not None
        if source == OWNER or collides:
            yield 1, StreamSeen(source, pos_ned, v_ned, None, None, None)

    return letter


def _samples_stay_good(world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    """Until those of a stream that was refused were good for long enough, with fresh positions."""
    if memory.flown_state is not State.STREAMING or memory.good_since_ns is None:
        return
    rules = world.policy.stream
    passes_ns = max(1, memory.good_since_ns + round(rules.good_again_s * SECOND_NS) - now_ns)
    for part_ns in (1, passes_ns):
        yield part_ns, PositionSeen(SPOT, STILL, 0)
        yield 0, StreamSeen(memory.streamer, None, STROLL, None, None, None)


def _home_moves(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.home_ned is not None:
        yield 1, HomeSeen(OUTSIDE)
        yield 1, HomeSeen(memory.home_ned)


def _fence_moves(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.verifier is not None:
        yield 1, VerifierChanged(replace(memory.verifier, zones=(ELSEWHERE,)))
        yield 1, VerifierChanged(memory.verifier)


def _until(
    due: Callable[[World, Memory], int | None], *, told: bool = True, landed: bool = True
) -> Letter:
    """Just until something is due; a vehicle that is heard goes on reporting its position
    (`told`) and whether it has `landed` meanwhile."""

    def letter(world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        due_ns = due(world, memory)
        if due_ns is None:
            return
        passes_ns = max(1, due_ns - now_ns)
        if memory.state is State.NO_VEHICLE or memory.mode is None:
            yield passes_ns, Tick(0)
            return
        if landed and memory.landed_ns is not None:
            yield passes_ns, LandedSeen(memory.landed)
            passes_ns = 0
        yield passes_ns, HeartbeatSeen(memory.armed, memory.mode, memory.mode.value)
        age_ns = memory.position_age_ns(now_ns)
        if told and age_ns is not None and age_ns <= world.policy.position_age_s * SECOND_NS:
            assert memory.pos_ned is not None
            assert memory.v_ned is not None
            yield 1, PositionSeen(memory.pos_ned, memory.v_ned, 0, yaw_rad=memory.yaw_rad)
        yield 1, Tick(0)

    return letter


def becomes_known(world: World) -> tuple[Input, ...]:
    """Home and the fence about it are known, and a mission is on board."""
    return HomeSeen(HOME), VerifierChanged(world.verifier), MissionLoaded("square", 4)


def _become_known(world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.verifier is None:
        for given in becomes_known(world):
            yield 1, given


def _mission_without_one(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.mission_items > 0:
        yield 1, MissionLoaded("", 0)
        yield 1, Requested(NEW_ID, OWNER, StartMission())
        yield 1, MissionLoaded("square", 4)


def _mission_without_fence(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.verifier is None:
        yield 1, MissionLoaded("square", 4)
        yield 1, Requested(NEW_ID, OWNER, StartMission())
        yield 1, MissionLoaded("", 0)


def _with_return_places(places: tuple[ReturnPlace, ...] | None, given: Input) -> Letter:
    """While a return may end there, too, or it is not known where (None)."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        if memory.return_places == ():
            yield 1, ReturnPlacesSeen(places)
            yield 1, given
            yield 1, ReturnPlacesSeen(())

    return letter


def _force_disarm_too_late(world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    yield from _until(_window_over_ns)(world, memory, now_ns)
    if memory.force_asked_ns is not None:
        yield 1, Requested(NEW_ID, OWNER, Disarm(force=True))


def _lost(world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.heard_ns is not None:
        yield round(world.policy.heartbeat_age_s * SECOND_NS) + 1, Tick(0)


def _stale_ns(world: World, memory: Memory) -> int | None:
    if memory.pos_ns is None:
        return None
    return memory.pos_ns + round(world.policy.position_age_s * SECOND_NS) + 1


def _landed_old_ns(world: World, memory: Memory) -> int | None:
    if memory.landed_ns is None:
        return None
    return memory.landed_ns + round(world.policy.heartbeat_age_s * SECOND_NS)


def _overdue_ns(world: World, memory: Memory) -> int | None:
    return None if memory.asked_mode is None else memory.asked_until_ns


def _sample_old_ns(world: World, memory: Memory) -> int | None:
    if memory.state is not State.STREAMING or memory.flown is None:
        return None
    return memory.sample_ns + round(world.policy.stream.deadman_s * SECOND_NS)


def _stream_over_ns(world: World, memory: Memory) -> int | None:
    if memory.state is not State.STREAMING:
        return None
    return memory.streamed_ns + round(world.policy.stream.ends_after_s * SECOND_NS)


def _position_old_ns(world: World, memory: Memory) -> int | None:
    if memory.state is not State.STREAMING or memory.pos_ns is None:
        return None
    return memory.pos_ns + round(world.policy.stream.position_age_s * SECOND_NS) + 1


def _deadline_ns(world: World, memory: Memory) -> int | None:
    return None if memory.task is None else memory.task.deadline_ns


def _window_over_ns(_world: World, memory: Memory) -> int | None:
    return None if memory.force_asked_ns is None else memory.force_asked_ns + FORCE_WINDOW_NS + 1


ALPHABET: Final[Mapping[str, Letter]] = MappingProxyType(
    {
        "tick": _tick,
        "position": _input(PositionSeen(SPOT, STILL, 0)),
        "position at the goal": _input(PositionSeen(GOAL, STILL, 0)),
        "position at the goal, turned away": _input(
            PositionSeen(GOAL, STILL, 0, yaw_rad=AWAY_YAW_RAD)
        ),
        "position at the top": _input(PositionSeen(TOP, STILL, 0)),
        "position short of the top": _input(PositionSeen(LOW, STILL, 0)),
        "position above the top": _input(PositionSeen(ABOVE, STILL, 0)),
        "position dashing for the fence": _input(PositionSeen(EDGE, DASH, 0)),
        "position after a reset": _input(PositionSeen(SPOT, STILL, 0, reset=True)),
        **{f"{mode.value} mode": _mode(mode) for mode in FlightMode},
        "another message": _input(MessageSeen()),
        "armed or disarmed": _toggle_armed,
        "on the ground": _input(LandedSeen(LandedState.ON_GROUND)),
        "in the air": _input(LandedSeen(LandedState.IN_AIR)),
        **{f"ask: {name}": _request(request) for name, request in REQUESTS.items()},
        **{f"another asks: {name}": _other_request(wish) for name, wish in REQUESTS.items()},
        "ask: guided mode by its name": _request(SetMode("guided", FlightMode.GUIDED)),
        "ask: mission with none on board": _mission_without_one,
        "ask: mission without a fence": _mission_without_fence,
        "ask: return to an unknown place": _with_return_places(None, RETURN),
        "ask: return to a clear place": _with_return_places((CLEAR_PLACE,), RETURN),
        "ask: return to a place outside": _with_return_places((PLACE_OUTSIDE,), RETURN),
        "condition: RETURN to a place outside": _with_return_places((PLACE_OUTSIDE,), CRITICAL),
        "ask: force disarm too late": _force_disarm_too_late,
        "sample: velocity": _sample(OWNER, v_ned=STROLL),
        "sample: position": _sample(OWNER, GOAL),
        "sample: too fast": _sample(OWNER, v_ned=RUSH),
        "another's sample": _sample(OTHER, v_ned=STROLL),
        "samples stay good": _samples_stay_good,
        "answer: accepted": _answer(0),
        "answer: refused": _answer(2),
        "answer: none": _answer(None),
        "first answer: accepted": _first_answer(0),
        "first answer: refused": _first_answer(2),
        "first answer: none": _first_answer(None),
        "late answer: accepted": _late_answer(0),
        "late answer: refused": _late_answer(2),
        "late answer: none": _late_answer(None),
        "answer: to another command": _odd_answer,
        "picture": _picture(new=True, ok=True),
        "no picture": _picture(new=True, ok=False),
        "a picture told again": _picture(new=False, ok=True),
        "mission loaded": _input(MissionLoaded("square", 4)),
        "mission at its last item": _input(MissionSeen(3, 4, finished=False)),
        "mission finished": _input(MissionSeen(3, 4, finished=True)),
        **{f"condition: {severity.name}": _condition(c) for c, severity in CONDITIONS.items()},
        "condition: CAUTION, and it is over": _caution,
        "home and fence become known": _become_known,
        "home moves, and back": _home_moves,
        "fence moves, and back": _fence_moves,
        "operator lost": _input(OperatorLost("explorer")),
        "operator leaves": _input(OperatorLost("explorer", for_good=False)),
        "wait: position too old": _until(_stale_ns, told=False),
        "wait: landed too old": _until(_landed_old_ns, landed=False),
        "wait: sample too old": _until(_sample_old_ns),
        "wait: stream over": _until(_stream_over_ns),
        "wait: position too old for a sample": _until(_position_old_ns, told=False),
        "wait: grace": _until(lambda _, memory: memory.grace_until_ns, told=False),
        "wait: deadline": _until(_deadline_ns),
        "wait: mode overdue": _until(_overdue_ns),
        "wait: control due": _until(lambda _, memory: memory.ask_control_ns),
        "wait: hold due": _until(lambda _, memory: memory.hold_again_ns),
        "wait: vehicle lost": _lost,
    }
)
