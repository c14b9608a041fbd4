"""A hostile vehicle and a hostile link: the gate is told anything, in any state, for a while.

A state is reached as a flight reaches it; then the letters of the explorer follow, which are all
that can be told to a gate (`tests/proof/alphabet.py`), in any order.  Nothing of it is true, so
no promise about the truth holds meanwhile; verdicts, endings and permits are judged as ever.  What
is rare in a flight is met here often enough to say something about it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from gcs.frames import Vec3
from gcs.gate.condition import Condition
from gcs.gate.inputs import (
    CommandEnded,
    ConditionChanged,
    HomeSeen,
    Input,
    MissionLoaded,
    PositionSeen,
    Requested,
    ReturnHeightSeen,
    ReturnPlacesSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.memory import Memory
from gcs.gate.states import State
from tests.proof.alphabet import ALPHABET, Letter, Step
from tests.proof.world import SPOT, STILL, World
from tests.soak.hostile_counts import Seen
from tests.soak.hostile_run import MS_NS, SECOND_NS, HostileRun
from tests.soak.point_mass import TO_RETURN_UP_M

DASH_M_S: Final = 40.0
A_WHILE_S: Final = 0.4
"""Between two letters of a word so much time passes at the most, now and then."""


def _moves_to(goal_ned: Callable[[Memory], Vec3 | None], v_ned: Vec3 = STILL) -> Letter:
    """A position there, after as long as it takes to fly to it at 20 m/s.  The first that is told
    is where the vehicle is."""

    def letter(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
        there_ned = goal_ned(memory)
        if there_ned is not None:
            away_m = math.dist(memory.pos_ned or there_ned, there_ned)
            yield 1 + round(away_m / 20.0 * SECOND_NS), PositionSeen(there_ned, v_ned, 0)

    return letter


def _here(memory: Memory) -> Vec3 | None:
    return memory.pos_ned or SPOT


def _goal(memory: Memory) -> Vec3 | None:
    goal = memory.goal or memory.hold
    return None if goal is None else goal.pos_ned


def _top(memory: Memory) -> Vec3 | None:
    return memory.top_ned if memory.state is State.TAKING_OFF else _goal(memory)


def _above_top(up_m: float) -> Callable[[Memory], Vec3 | None]:
    def place(memory: Memory) -> Vec3 | None:
        top_ned = _top(memory)
        return None if top_ned is None else (*top_ned[:2], top_ned[2] - up_m)

    return place


def _dashes(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    """Faster than any hold could stop it, out of any fence."""
    if memory.pos_ned is not None:
        north, east, _ = memory.pos_ned
        away_m = math.hypot(north, east)
        out = (north / away_m, east / away_m) if away_m > 0.0 else (0.0, 1.0)
        v_ned = (DASH_M_S * out[0], DASH_M_S * out[1], 0.0)
        yield 1, PositionSeen(memory.pos_ned, v_ned, 0)


def _reset(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.pos_ned is not None:
        yield 1, PositionSeen(memory.pos_ned, STILL, 0, reset=True)


def _recorder_fails(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    yield 1, ConditionChanged(Condition.RECORDER_FAILED, True, "hostile")


LETTERS: Final[Mapping[str, Letter]] = MappingProxyType(
    {
        **ALPHABET,
        "recorder fails": _recorder_fails,
        "position": _moves_to(_here),
        "position at the goal": _moves_to(_goal),
        "position at the top": _moves_to(_top),
        "position short of the top": _moves_to(_above_top(-0.75)),
        "position above the top": _moves_to(_above_top(4.0)),
        "position dashing for the fence": _dashes,
        "position after a reset": _reset,
    }
)
"""The explorer's; its places are told from where this vehicle is."""

NAMES: Final = tuple(LETTERS)

_STANDS: Final = ("guided mode", "position")
_FLIES: Final = (*_STANDS, "in the air")
_ARMED: Final = (*_STANDS, "armed or disarmed")
_HOVERS: Final = (*_FLIES, "ask: control")
_CONTROLS: Final = (*_HOVERS, "wait: control due", "answer: accepted", "guided mode")
_FORCED: Final = ("guided mode", "armed or disarmed", "ask: force disarm", "ask: force disarm")
_LANDS_UNHEARD: Final = ("guided mode", "wait: vehicle lost", "ask: land", "guided mode")
_RETURNS_HELD: Final = (
    "position",
    "return mode",
    "ask: hold",
    "ask: disarm",
    "armed or disarmed",
)
_ARMED_IN_AIR: Final = (*_STANDS, "ask: arm", "in the air", "hold mode")
"""It arms and flies before it has answered."""
_HOLD_UNANSWERED: Final = (
    "position",
    "ask: hold",
    *["armed or disarmed"] * 3,
    "wait: position too old",
    "position",
)
"""In a mode that the vehicle chose, its state comes back with a hold that nobody answered yet."""
_CLIMBED: Final = (
    *_ARMED,
    "on the ground",
    "ask: take off",
    "position at the top",
    "in the air",
    "tick",
    "wait: control due",
    "tick",
    "guided mode",
)
"""It flies to its top before it is known how the command for guided mode was answered."""
_MISSION_AGAIN: Final = (
    *_ARMED,
    "on the ground",
    "ask: mission",
    "mission mode",
    "wait: position too old",
    "return mode",
    "position",
    "mission mode",
)

WORDS: Final[tuple[tuple[str, ...], ...]] = (
    (),
    ("in the air",),
    ("guided mode", "ask: hold", "wait: vehicle lost"),
    ("guided mode", "wait: vehicle lost", "ask: land"),
    ("guided mode",),
    ("guided mode", "ask: hold"),
    ("guided mode", "armed or disarmed"),
    ("guided mode", "ask: arm"),
    ("guided mode", "ask: arm", "ask: disarm"),
    _LANDS_UNHEARD,
    ("guided mode", "armed or disarmed", "ask: return"),
    ("return mode",),
    _STANDS,
    ("guided mode", "ask: force disarm"),
    (*_STANDS, "ask: arm"),
    _ARMED,
    ("return mode", "position"),
    (*_STANDS, "ask: force disarm"),
    (*_STANDS, "ask: hold"),
    (*_STANDS, "ask: arm", "hold mode"),
    _FLIES,
    (*_HOVERS, "wait: deadline"),
    _FORCED,
    (*_ARMED, "ask: force disarm", "ask: force disarm"),
    ("guided mode", "armed or disarmed", "ask: land"),
    (*_ARMED, "ask: land"),
    ("guided mode", "in the air", "land mode"),
    (*_ARMED, "ask: hold"),
    (*_ARMED, "ask: return"),
    _ARMED_IN_AIR,
    (*_FLIES, "ask: hold"),
    ("guided mode", "in the air", "return mode", "ask: return"),
    ("guided mode", "in the air", "return mode"),
    ("return mode", "armed or disarmed", "position"),
    _RETURNS_HELD,
    _HOVERS,
    (*_HOVERS, "wait: landed too old"),
    (*_ARMED, "in the air", "ask: control"),
    (*_HOVERS, "hold mode"),
    (*_ARMED, "on the ground", "ask: take off"),
    (*_ARMED, "on the ground", "ask: mission"),
    _CONTROLS,
    (*_CONTROLS, "ask: goto inside", "tick"),
    (*_CONTROLS, "ask: stream begin", "sample: velocity"),
    (*_CONTROLS, "ask: photo"),
    (*_CONTROLS, "ask: mission"),
    (*_CONTROLS, "ask: return"),
    (*_CONTROLS, "ask: land"),
    (*_CONTROLS, "ask: land", "wait: deadline"),
    (*_CONTROLS, "ask: photo", "ask: arm", "armed or disarmed"),
    (*_CONTROLS, "ask: stream begin", "sample: velocity", "wait: sample too old"),
    (*_CONTROLS, "ask: stream begin", "sample: position", "wait: landed too old"),
    (*_CONTROLS, "wait: position too old"),
    (*_HOVERS, "wait: landed too old", "wait: position too old"),
    (*_FLIES, "ask: hold", "wait: position too old"),
    (*_ARMED, "on the ground", "ask: take off", "in the air"),
    (*_ARMED, "on the ground", "ask: take off", "takeoff mode"),
    (*_ARMED, "on the ground", "ask: mission", "tick", "takeoff mode"),
    (*_ARMED, "ask: hold", "answer: refused"),
    (*_FORCED, "position"),
    ("guided mode", "ask: hold", "wait: vehicle lost", "position"),
    (*_LANDS_UNHEARD, "position", "wait: sample too old"),
    (*_RETURNS_HELD, "first answer: accepted", "hold mode", "position"),
    (*_RETURNS_HELD, "first answer: accepted", "hold mode", "return mode", "position"),
    (*_RETURNS_HELD, "first answer: accepted", "hold mode", "land mode", "position"),
    (*_HOVERS, "wait: control due", "wait: landed too old", "ask: photo"),
    (*_CONTROLS, "ask: goto inside", "tick", "armed or disarmed"),
    (*_CONTROLS, "ask: goto inside", "tick", "wait: landed too old"),
    (*_LANDS_UNHEARD, "armed or disarmed", "position"),
    (*_CONTROLS, "ask: mission", "ask: goto inside"),
    (*_ARMED, "on the ground", "ask: mission", "return mode", "guided mode"),
    (*_STANDS, "recorder fails", "ask: arm"),
    (*_ARMED_IN_AIR, "answer: refused"),
    (*_ARMED_IN_AIR, "answer: none"),
    _CLIMBED,
    (*_CLIMBED, "answer: refused"),
    (*_CLIMBED, "answer: none"),
    *[
        (mode, *_HOLD_UNANSWERED, answer)
        for mode in ("return mode", "land mode")
        for answer in ("tick", "answer: refused", "answer: none")
    ],
    _MISSION_AGAIN,
)
"""Into states that a flight seldom is in, mostly the shortest ones that the explorer finds."""


def lettered(run: HostileRun) -> Seen:
    """A new gate, into some state by a word, and then a few letters.  Raises Broken."""
    dice = run.dice
    run.feed(ReturnHeightSeen(TO_RETURN_UP_M))
    run.feed(ReturnPlacesSeen(()))
    if dice.random() < 0.9:
        run.feed(HomeSeen(run.home_ned))
        run.feed(VerifierChanged(run.verifier()))
        run.feed(MissionLoaded("square", 4))
    run.vehicle.pos = [dice.uniform(-5.0, 5.0), dice.uniform(-5.0, 5.0), dice.uniform(-8.0, -2.0)]
    for name in dice.choice(WORDS):
        if dice.random() < 0.1:
            run.passes(round(dice.random() * A_WHILE_S * SECOND_NS))
        _tell_word(run, (name,))
    is_told_anything(run, dice.choice((1, 2, 3, 5)))
    run.all_answered()
    run.seen.runs, run.seen.cells = 0, run.gate.met
    return run.seen


def is_told_anything(run: HostileRun, letters: int) -> None:
    """So many letters, now and then one of them twice."""
    dice = run.dice
    letter = dice.choice(NAMES)
    for _ in range(letters):
        letter = letter if dice.random() < 0.2 else dice.choice(NAMES)
        _tell_word(run, (letter,))
    if run.gate.memory.verifier is not None:
        run.feed(HomeSeen(run.home_ned))
        run.feed(VerifierChanged(run.verifier()))
    run.feed(Tick(0))
    run.taken_away()


def _tell_word(run: HostileRun, word: tuple[str, ...]) -> None:
    world = World(run.policy, run.verifier(), TO_RETURN_UP_M, 0.0)
    for name in word:
        for passes_ns, given in LETTERS[name](world, run.gate.memory, run.now_ns):
            run.passes(passes_ns)
            _tell(run, given)


def _tell(run: HostileRun, given: Input) -> None:
    match given:
        case Requested(_, source, request):
            run.ask(request, source)
        case CommandEnded(request_id, kind):
            run.never_hears((request_id, kind))
            run.feed(given)
        case MissionLoaded():
            run.vehicle.has_no_mission()
            run.feed(given)
        case PositionSeen(pos_ned):
            first = run.gate.pos_ned is None
            at_ned = run.vehicle.at if first else pos_ned
            run.feed(replace(given, pos_ned=at_ned, time_boot_ms=run.now_ns // MS_NS))
        case _:
            run.feed(given)
