"""From an input to facts, and from what changed to events; nothing is decided here."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final, TypeAlias, assert_never

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Breach, Verifier
from gcs.gate.effects import CommandKind, Level
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
    ReturnHeightSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.events import SAW, Event, event_of
from gcs.gate.machine.guards import cleared_no_more, within
from gcs.gate.machine.memory import SECOND_NS
from gcs.gate.machine.sentences import ASKED_FOR, where
from gcs.gate.machine.turn import Turn
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo
from gcs.gate.states import Control, LandedState, State

HOME_MOVED_M = 1.0
"""Arming moves home by centimetres; further, it is another place."""

JUMP_LEAST_M = 0.5
"""Noise between two samples that arrive in one instant is no jump."""

ACCEPTED = 0
"""MAV_RESULT_ACCEPTED"""

REFUSED_AS: Final = {
    CommandKind.HOLD: Event.HOLD_REFUSED,
    CommandKind.DISARM: Event.DISARM_REFUSED,
}
"""What a refusal of these means is not what any other command's means."""

Told: TypeAlias = tuple[Event, Refusal | None, Breach | None]
"""An event, why it happened where that has words, and the breach where it is one."""

FLOOR_FREE = frozenset({State.GROUNDED, State.TAKING_OFF, State.LANDING, State.RETURNING})
"""States that begin or end on the ground: the fence's floor does not apply to their stop."""


def _plain(*events: Event) -> Iterator[Told]:
    for event in events:
        yield event, None, None


def events_from(turn: Turn, given: Input) -> Iterator[Told]:
    """Store what `given` says, and tell what that means.

    Lazy on purpose: each event is handled before the next is looked for.
    """
    memory = turn.memory
    match given:
        case Requested():
            if isinstance(given.request, GoTo):
                turn.say(Level.INFO, f"Requested Position: {where(given.request.goal_ned)}")
            yield from _plain(event_of(given.request))
        case HeartbeatSeen():
            yield from _heartbeat(turn, given)
        case LandedSeen(landed):
            yield from _landed(turn, landed)
        case PositionSeen():
            yield from _position(turn, given)
        case CommandEnded():
            yield from _answer(turn, given)
        case HomeSeen(pos_ned):
            yield from _home(turn, pos_ned)
        case ReturnHeightSeen(up_m):
            memory.return_up_m = up_m
        case VerifierChanged(verifier):
            yield from _verifier(turn, verifier)
        case PhotoSeen():
            yield from _photo(turn, given)
        case MissionLoaded(name, items):
            memory.mission_name, memory.mission_items = name, items
            memory.mission_over = False
        case MissionSeen(seq, total, finished):
            memory.mission_over = finished or 0 < total <= seq + 1
            yield from _plain(Event.MISSION_FINISHED if finished else Event.MISSION_ITEM)
        case ConditionChanged():
            _condition(turn, given)
        case OperatorLost(reason):
            turn.say(Level.INFO, f"The operator leaves: {reason}")
            memory.deserted = True
            yield from _plain(Event.OPERATOR_LOST)
        case Tick():
            return
        case _:
            assert_never(given)


def _heartbeat(turn: Turn, seen: HeartbeatSeen) -> Iterator[Told]:
    memory = turn.memory
    was_armed, was_mode = memory.armed, memory.mode
    memory.heard_ns, memory.heard_before = turn.now_ns, True
    memory.armed, memory.mode, memory.mode_name = seen.armed, seen.mode, seen.mode_name
    if memory.state is State.NO_VEHICLE:
        yield from _plain(Event.HEARD)
        return
    if seen.armed and not was_armed:
        yield from _plain(Event.ARMED)
    elif not seen.armed and (was_armed or _disarm_answered(turn)):
        yield from _plain(Event.DISARMED)
    if seen.mode is memory.asked_mode:
        yield from _plain(Event.MODE_CONFIRMED)
    elif seen.mode is not was_mode:
        yield from _plain(SAW[seen.mode])


def _disarm_answered(turn: Turn) -> bool:
    """A disarm of a vehicle that was never seen armed: its answer and a heartbeat end it."""
    memory = turn.memory
    return (
        memory.state is State.GROUNDED
        and memory.task is not None
        and memory.task.kind in (Event.DISARM, Event.FORCE_DISARM, Event.ABORT)
        and not memory.outstanding
    )


def _landed(turn: Turn, landed: LandedState) -> Iterator[Told]:
    memory = turn.memory
    was, flew = memory.landed, memory.airborne
    memory.landed, memory.landed_ns = landed, turn.now_ns
    climbs = memory.flies is State.TAKING_OFF or turn.now_ns < memory.takeoff_until_ns
    if landed is LandedState.ON_GROUND and memory.pos_ned is not None and not climbs:
        memory.stood_down_m = memory.pos_ned[2]
    if landed is LandedState.ON_GROUND and was is not landed:
        yield from _plain(Event.LANDED)
    elif memory.airborne and not flew:
        yield from _plain(Event.AIRBORNE)


def _home(turn: Turn, pos_ned: Vec3) -> Iterator[Told]:
    memory = turn.memory
    was_ned, memory.home_ned = memory.home_ned, pos_ned
    if was_ned is None or memory.on_ground or math.dist(was_ned, pos_ned) <= HOME_MOVED_M:
        return
    moved_m = math.dist(was_ned, pos_ned)
    turn.say(Level.WARNING, f"Home moved by {moved_m:.1f} m while the vehicle flies")
    yield from _plain(Event.HOME_MOVED)


def _verifier(turn: Turn, verifier: Verifier) -> Iterator[Told]:
    """What was cleared by another fence is judged anew by this one."""
    memory = turn.memory
    was, memory.verifier = memory.verifier, verifier
    memory.autopilot = verifier.autopilot
    if verifier == was or memory.control is Control.NONE:
        return
    why = cleared_no_more(memory, verifier, was)
    if why is not None:
        yield Event.UNVERIFIED, why, None


def _photo(turn: Turn, seen: PhotoSeen) -> Iterator[Told]:
    """One told before the picture was asked for is another picture, told again."""
    memory = turn.memory
    told, memory.photo_index = memory.photo_index, seen.index
    if seen.index == told:
        return
    memory.photo_ok = seen.ok
    why = Refusal(Code.VEHICLE_REFUSED, "the camera took no picture")
    yield Event.PHOTO_SEEN, why, None


def _position(turn: Turn, seen: PositionSeen) -> Iterator[Told]:
    """A sample that is no number, or older than one that came before it, is not a position."""
    memory = turn.memory
    if not all(map(math.isfinite, (*seen.pos_ned, *seen.v_ned))):
        return
    if seen.time_boot_ms < memory.boot_ms and not seen.reset:
        return
    jumped = seen.reset or _faster_than_allowed(turn, seen)
    if jumped:
        memory.stood_down_m = None
    memory.pos_ned, memory.v_ned = seen.pos_ned, seen.v_ned
    memory.pos_ns, memory.boot_ms = turn.now_ns, seen.time_boot_ms
    if memory.goal is None or not within(turn, memory.goal.pos_ned):
        memory.within_since_ns = None
    elif memory.within_since_ns is None:
        memory.within_since_ns = turn.now_ns
    if jumped:
        yield from _plain(Event.JUMPED)
    if memory.verifier is not None and memory.control is not Control.NONE:
        breach = memory.verifier.predicted_stop(
            seen.pos_ned, seen.v_ned, floor_applies=_floor_applies(turn)
        )
        if breach is not None:
            why = Refusal(Code.FENCE_BREACH, breach.sentence, breach.numbers, breach.zone)
            yield Event.BREACH, why, breach
    yield from _plain(Event.POSITION)


def _floor_applies(turn: Turn) -> bool:
    memory = turn.memory
    return memory.flies not in FLOOR_FREE and memory.landed is LandedState.IN_AIR


def _faster_than_allowed(turn: Turn, seen: PositionSeen) -> bool:
    """By the vehicle's own clock, as samples may queue on their way; but one that comes in time
    cannot have been queued for longer than a position stays fresh."""
    memory = turn.memory
    late_ns = round(turn.policy.position_age_s * SECOND_NS)
    if memory.pos_ned is None or memory.pos_ns is None:
        return False
    arrived_ns = turn.now_ns - memory.pos_ns
    stamped_ns = (seen.time_boot_ms - memory.boot_ms) * 1_000_000
    if stamped_ns > arrived_ns + late_ns:
        return True  # its clock stepped forward: a restart, or no clock
    elapsed_ns = stamped_ns or arrived_ns
    allowed_m = turn.policy.jump_speed_m_s * elapsed_ns / SECOND_NS + JUMP_LEAST_M
    return math.dist(seen.pos_ned, memory.pos_ned) > allowed_m


def _answer(turn: Turn, ended: CommandEnded) -> Iterator[Told]:
    """An answer ends a command and nothing else; one that nobody waits for is reported."""
    memory, key = turn.memory, (ended.request_id, ended.kind)
    name = ended.kind.value.replace("_", " ")
    asked_for = ASKED_FOR[ended.kind]
    said = f": {ended.text}" if ended.text else ""
    if key not in memory.outstanding:
        turn.say(Level.INFO, f"A late answer to {name}, not acted on{said}")
        yield from _plain(Event.COMMAND_LATE)
        return
    memory.outstanding = tuple(other for other in memory.outstanding if other != key)
    if ended.result is not None:
        memory.silence_told = None
    if ended.result == ACCEPTED:
        yield from _plain(Event.COMMAND_DONE)
    elif ended.result is None:
        if memory.silence_told is not ended.kind:
            turn.say(Level.WARNING, f"No answer to the request for {asked_for}")
        memory.silence_told = ended.kind
        silent = ended.kind is CommandKind.HOLD
        yield from _plain(Event.HOLD_SILENT if silent else Event.COMMAND_SILENT)
    else:
        sentence = f"the vehicle refused {asked_for} (result {ended.result}){said}"
        why = Refusal(Code.VEHICLE_REFUSED, sentence, (("result", float(ended.result)),))
        yield REFUSED_AS.get(ended.kind, Event.COMMAND_REFUSED), why, None


def _condition(turn: Turn, changed: ConditionChanged) -> None:
    memory = turn.memory
    others = tuple(pair for pair in memory.conditions if pair[0] is not changed.condition)
    if changed.active:
        memory.conditions = tuple(sorted((*others, (changed.condition, changed.text))))
    else:
        memory.conditions = others
    severity = turn.policy.severities[changed.condition]
    if changed.active:
        turn.say(Level.WARNING, f"{severity.name}: {changed.condition.value}: {changed.text}")
    else:
        turn.say(Level.INFO, f"No longer {severity.name}: {changed.condition.value}")
