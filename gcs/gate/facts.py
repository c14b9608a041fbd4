"""From an input to facts, and from what changed to events; nothing is decided here."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TypeAlias, assert_never

from gcs.gate.core import Core
from gcs.gate.events import SAW, Event, event_of
from gcs.gate.guards import within
from gcs.gate.memory import SECOND_NS
from gcs.gate.types import (
    Code,
    CommandEnded,
    CommandKind,
    ConditionChanged,
    Control,
    GeodeticSeen,
    GoTo,
    HeartbeatSeen,
    HomeSeen,
    Input,
    LandedSeen,
    LandedState,
    Level,
    MissionLoaded,
    MissionSeen,
    OperatorLost,
    PhotoSeen,
    PositionSeen,
    Refusal,
    Request,
    ReturnHeightSeen,
    State,
    Tick,
    VerifierChanged,
)
from gcs.gate.verifier import Breach
from gcs.gate.words import where

JUMP_LEAST_M = 0.5
"""Noise between two samples that arrive in one instant is no jump."""

ACCEPTED = 0
"""MAV_RESULT_ACCEPTED"""

Told: TypeAlias = tuple[Event, Refusal | None, Breach | None]
"""An event, why it happened where that has words, and the breach where it is one."""

FLOOR_FREE = frozenset({State.GROUNDED, State.TAKING_OFF, State.LANDING, State.RETURNING})
"""States that begin or end on the ground: the fence's floor does not apply to their stop."""


def _plain(*events: Event) -> Iterator[Told]:
    for event in events:
        yield event, None, None


def absorb(core: Core, given: Input) -> Iterator[Told]:
    """Store what `given` says, and tell what that means.

    Lazy on purpose: each event is handled before the next is looked for.
    """
    memory = core.memory
    match given:
        case Request():
            if isinstance(given.wish, GoTo):
                core.say(Level.INFO, f"Requested Position: {where(given.wish.goal_ned)}")
            yield from _plain(event_of(given.wish))
        case HeartbeatSeen():
            yield from _heartbeat(core, given)
        case LandedSeen(landed):
            yield from _landed(core, landed)
        case PositionSeen():
            yield from _position(core, given)
        case CommandEnded():
            yield from _answer(core, given)
        case HomeSeen(pos_ned):
            memory.home_ned = pos_ned
        case ReturnHeightSeen(up_m):
            memory.return_up_m = up_m
        case VerifierChanged(verifier):
            memory.verifier = verifier
            memory.personality = verifier.personality
        case PhotoSeen(_, ok):
            memory.photo_ok = ok
            core.why = Refusal(Code.VEHICLE_REFUSED, "the camera took no picture")
            yield Event.PHOTO_SEEN, core.why, None
        case MissionLoaded(name, items):
            memory.mission_name, memory.mission_items = name, items
            memory.mission_over = False
        case MissionSeen(seq, total, finished):
            memory.mission_over = finished or 0 < total <= seq + 1
            yield from _plain(Event.MISSION_FINISHED if finished else Event.MISSION_ITEM)
        case ConditionChanged():
            _condition(core, given)
        case OperatorLost(reason):
            core.say(Level.INFO, f"The operator leaves: {reason}")
            yield from _plain(Event.OPERATOR_LOST)
        case GeodeticSeen() | Tick():
            return
        case _:
            assert_never(given)


def _heartbeat(core: Core, seen: HeartbeatSeen) -> Iterator[Told]:
    memory = core.memory
    was_armed, was_mode = memory.armed, memory.mode
    memory.heard_ns, memory.heard_before = core.now_ns, True
    memory.armed, memory.mode, memory.mode_name = seen.armed, seen.mode, seen.mode_name
    if memory.state is State.NO_VEHICLE:
        yield from _plain(Event.HEARD)
        return
    if seen.armed and not was_armed:
        yield from _plain(Event.ARMED)
    elif not seen.armed and (was_armed or _disarm_answered(core)):
        yield from _plain(Event.DISARMED)
    if seen.mode is memory.asked_mode:
        yield from _plain(Event.MODE_CONFIRMED)
    elif seen.mode is not was_mode:
        yield from _plain(SAW[seen.mode])


def _disarm_answered(core: Core) -> bool:
    """A disarm of a vehicle that was never seen armed: its answer and a heartbeat end it."""
    memory = core.memory
    return (
        memory.state is State.GROUNDED
        and memory.task is not None
        and memory.task.kind in (Event.DISARM, Event.FORCE_DISARM, Event.ABORT)
        and not memory.outstanding
    )


def _landed(core: Core, landed: LandedState) -> Iterator[Told]:
    memory = core.memory
    was, flew = memory.landed, memory.airborne
    memory.landed = landed
    if landed is LandedState.ON_GROUND and was is not landed:
        yield from _plain(Event.LANDED)
    elif memory.airborne and not flew:
        yield from _plain(Event.AIRBORNE)


def _position(core: Core, seen: PositionSeen) -> Iterator[Told]:
    """A sample that is no number, or older than one that came before it, is not a position."""
    memory = core.memory
    if not all(map(math.isfinite, (*seen.pos_ned, *seen.v_ned))):
        return
    if seen.time_boot_ms < memory.boot_ms and not seen.reset:
        return
    jumped = seen.reset or _faster_than_allowed(core, seen)
    memory.pos_ned, memory.v_ned = seen.pos_ned, seen.v_ned
    memory.pos_ns, memory.boot_ms = core.now_ns, seen.time_boot_ms
    if memory.goal is None or not within(core, memory.goal.pos_ned):
        memory.within_since_ns = None
    elif memory.within_since_ns is None:
        memory.within_since_ns = core.now_ns
    if jumped:
        yield from _plain(Event.JUMPED)
    if memory.verifier is not None and memory.control is not Control.NONE:
        breach = memory.verifier.predicted_stop(
            seen.pos_ned, seen.v_ned, floor_applies=_floor_applies(core)
        )
        if breach is not None:
            why = Refusal(Code.FENCE_BREACH, breach.sentence, breach.numbers, breach.zone)
            yield Event.BREACH, why, breach
    yield from _plain(Event.POSITION)


def _floor_applies(core: Core) -> bool:
    memory = core.memory
    return memory.state not in FLOOR_FREE and memory.landed is LandedState.IN_AIR


def _faster_than_allowed(core: Core, seen: PositionSeen) -> bool:
    memory = core.memory
    if memory.pos_ned is None or memory.pos_ns is None:
        return False
    elapsed_ns = max(core.now_ns - memory.pos_ns, (seen.time_boot_ms - memory.boot_ms) * 1_000_000)
    allowed_m = core.policy.jump_speed_m_s * elapsed_ns / SECOND_NS + JUMP_LEAST_M
    return math.dist(seen.pos_ned, memory.pos_ned) > allowed_m


def _answer(core: Core, ended: CommandEnded) -> Iterator[Told]:
    """An answer ends a command and nothing else; one that nobody waits for is reported."""
    memory, key = core.memory, (ended.request_id, ended.kind)
    name = ended.kind.value.replace("_", " ")
    said = f": {ended.text}" if ended.text else ""
    if key not in memory.outstanding:
        core.say(Level.INFO, f"A late answer to {name}, not acted on{said}")
        yield from _plain(Event.COMMAND_LATE)
        return
    memory.outstanding = tuple(other for other in memory.outstanding if other != key)
    if ended.result == ACCEPTED:
        yield from _plain(Event.COMMAND_DONE)
    elif ended.result is None:
        core.say(Level.WARNING, f"No answer to {name}")
        silent = ended.kind is CommandKind.HOLD
        yield from _plain(Event.HOLD_SILENT if silent else Event.COMMAND_SILENT)
    else:
        sentence = f"the vehicle refused to {name} (result {ended.result}){said}"
        refused = ended.kind is CommandKind.HOLD
        why = Refusal(Code.VEHICLE_REFUSED, sentence, (("result", float(ended.result)),))
        yield (Event.HOLD_REFUSED if refused else Event.COMMAND_REFUSED), why, None


def _condition(core: Core, changed: ConditionChanged) -> None:
    memory = core.memory
    others = tuple(pair for pair in memory.conditions if pair[0] is not changed.condition)
    if changed.active:
        memory.conditions = tuple(sorted((*others, (changed.condition, changed.text))))
    else:
        memory.conditions = others
    severity = core.policy.severities[changed.condition]
    if changed.active:
        core.say(Level.WARNING, f"{severity.name}: {changed.condition.value}: {changed.text}")
    else:
        core.say(Level.INFO, f"No longer {severity.name}: {changed.condition.value}")
