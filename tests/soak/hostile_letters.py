"""A hostile vehicle and a hostile link: the gate is told anything, in any state, for a while.

A state is reached as a flight reaches it; then the letters of the explorer follow, which are all
that can be told to a gate (`gcs/gate/proof/alphabet.py`), in any order.  Nothing of it is true, so
no promise about the truth holds meanwhile; verdicts, endings and permits are judged as ever.  What
is rare in a flight is met here often enough to say something about it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from gcs.frames import Vec3
from gcs.gate.inputs import (
    CommandEnded,
    HomeSeen,
    Input,
    MissionLoaded,
    PositionSeen,
    Requested,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.memory import Memory
from gcs.gate.proof.alphabet import ALPHABET, Letter, Step
from gcs.gate.proof.world import World
from tests.soak.hostile_run import MS_NS, HostileRun
from tests.soak.point_mass import TO_RETURN_UP_M

STILL: Final[Vec3] = (0.0, 0.0, 0.0)
DASH_M_S: Final = 40.0
"""From wherever it is, no hold stops it inside."""


def _here(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.pos_ned is not None:
        yield 1, PositionSeen(memory.pos_ned, STILL, 0)


def _at_the_goal(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    goal = memory.goal or memory.hold
    if goal is not None:
        yield 1, PositionSeen(goal.pos_ned, STILL, 0)


def _dashing(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.pos_ned is not None:
        north, east, _ = memory.pos_ned
        away_m = math.hypot(north, east) or 1.0
        v_ned = (DASH_M_S * north / away_m, DASH_M_S * east / away_m, 0.0)
        yield 1, PositionSeen(memory.pos_ned, v_ned, 0)


def _reset(_world: World, memory: Memory, now_ns: int) -> Iterator[Step]:
    if memory.pos_ned is not None:
        yield 1, PositionSeen(memory.pos_ned, STILL, 0, reset=True)


LETTERS: Final[tuple[Letter, ...]] = (
    *(letter for name, letter in ALPHABET.items() if not name.startswith("position")),
    _here,
    _at_the_goal,
    _dashing,
    _reset,
)
"""The explorer's, but for its places: a position is told where this vehicle is."""


def is_told_anything(run: HostileRun, letters: int) -> None:
    """So many letters, now and then one of them twice."""
    dice = run.dice
    world = World(run.policy, run.verifier(), TO_RETURN_UP_M, 0.0)
    letter = dice.choice(LETTERS)
    for _ in range(letters):
        letter = letter if dice.random() < 0.2 else dice.choice(LETTERS)
        for passes_ns, given in letter(world, run.gate.memory, run.now_ns):
            run.passes(passes_ns)
            _tell(run, given)
    if run.gate.memory.verifier is not None:
        run.feed(HomeSeen(run.home_ned))
        run.feed(VerifierChanged(run.verifier()))
    run.feed(Tick(0))
    run.taken_away()


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
        case PositionSeen():
            run.feed(replace(given, time_boot_ms=run.now_ns // MS_NS))
        case _:
            run.feed(given)
