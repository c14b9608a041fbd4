"""Stores what an input reports in the gate's memory, and makes events of what changed.

Nothing is decided here: what follows from an event is in the table.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final, NamedTuple, assert_never

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.airspace.questions.braking import Breach
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind, Level
from gcs.gate.inputs import (
    AccuracySeen,
    ClimbEndSeen,
    CommandEnded,
    ConditionChanged,
    HeartbeatSeen,
    HomeSeen,
    Input,
    LandedSeen,
    MessageSeen,
    MissionLoaded,
    MissionPathVerified,
    MissionSeen,
    OperatorLost,
    PhotoSeen,
    PositionSeen,
    Requested,
    ReturnHeightSeen,
    ReturnPlacesSeen,
    StreamSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.events import SAW, Event, event_of
from gcs.gate.machine.memory import HOME_MOVED_M, SECOND_NS, Memory
from gcs.gate.machine.progress import arrival_radius_h_m, within_arrival
from gcs.gate.machine.sentences import ASKED_FOR, result_word
from gcs.gate.machine.step_context import StepContext
from gcs.gate.machine.verifying import refusal_of_what_is_flown
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo
from gcs.gate.states import Control, FlightMode, LandedState, State

JUMP_LEAST_M = 0.5
"""A position that changes by less is no jump, however short the time between the samples."""

ACCEPTED = 0
"""MAV_RESULT_ACCEPTED"""

REFUSED_AS: Final = {
    CommandKind.HOLD: Event.HOLD_REFUSED,
    CommandKind.DISARM: Event.DISARM_REFUSED,
}
"""The commands whose refusal is an event of its own; of all others it is COMMAND_REFUSED."""

NOT_OURS: Final = "; nothing is done about it: the vehicle flies, and not under our control"

FLOOR_FREE = frozenset({State.GROUNDED, State.TAKING_OFF, State.LANDING, State.RETURNING})
"""States that begin or end on the ground: the fence's floor does not apply to their stop."""


class Occurrence(NamedTuple):
    """An event with its reason, where there is one, and its breach, where one is predicted."""

    event: Event
    why: Refusal | None = None
    breach: Breach | None = None


def events_from(step: StepContext, given: Input) -> Iterator[Occurrence]:
    """Store what `given` reports, and yield the events that follow from it.

    A generator because the caller handles each event before the next one is looked for.
    """
    memory = step.memory
    match given:
        case Requested():
            if isinstance(given.request, GoTo):
                step.say(Level.INFO, f"Requested Position: {place(given.request.goal_ned)}")
            yield Occurrence(event_of(given.request))
        case StreamSeen():
            yield Occurrence(Event.STREAM_SAMPLE)
        case HeartbeatSeen():
            yield from _heartbeat(step, given)
        case MessageSeen():
            if memory.heard_ns is not None:
                memory.heard_ns = step.now_ns
        case LandedSeen(landed):
            yield from _landed(step, landed)
        case PositionSeen():
            yield from _position(step, given)
        case CommandEnded():
            yield from _command_answer(step, given)
        case HomeSeen(pos_ned):
            yield from _home(step, pos_ned)
        case ReturnHeightSeen(up_m):
            memory.return_up_m = up_m
        case ReturnPlacesSeen(places, unknown):
            memory.return_places, memory.return_unknown = places, unknown
        case AccuracySeen():
            memory.arrival_h_m = arrival_radius_h_m(step.policy.arrival, given)
        case ClimbEndSeen(within_m):
            memory.climb_ends_within_m = within_m
        case VerifierChanged(verifier):
            yield from _verifier(step, verifier)
        case PhotoSeen():
            yield from _photo(step, given)
        case MissionLoaded():
            yield from _mission(step, given)
        case MissionPathVerified(within):
            memory.mission_within = within
        case MissionSeen(seq, total, finished):
            memory.mission_over = finished or 0 < total <= seq + 1
            yield Occurrence(Event.MISSION_FINISHED if finished else Event.MISSION_ITEM)
        case ConditionChanged():
            _condition(step, given)
        case OperatorLost(reason, for_good):
            step.say(Level.INFO, f"The operator leaves: {reason}")
            memory.operator_lost |= for_good
            yield Occurrence(Event.OPERATOR_LOST)
        case Tick():
            return
        case _:
            assert_never(given)


def _heartbeat(step: StepContext, seen: HeartbeatSeen) -> Iterator[Occurrence]:
    memory = step.memory
    was_armed, was_mode = memory.armed, memory.mode
    memory.heard_ns, memory.heard_before = step.now_ns, True
    memory.armed, memory.mode, memory.mode_name = seen.armed, seen.mode, seen.mode_name
    used = memory.guided_used or seen.armed or was_mode is None
    memory.guided_used = used and seen.mode is FlightMode.GUIDED
    memory.failsafe = seen.failsafe
    if memory.state is State.NO_VEHICLE:
        memory.lost_in_flight = False
        yield Occurrence(Event.VEHICLE_HEARD)
        return
    if seen.armed and not was_armed:
        yield Occurrence(Event.ARMED)
    elif not seen.armed and (was_armed or _disarm_answered(step)):
        yield Occurrence(Event.DISARMED)
    if seen.mode is memory.asked_mode:
        yield Occurrence(Event.MODE_CONFIRMED)
    elif seen.mode is not was_mode:
        yield Occurrence(SAW[seen.mode])


def _disarm_answered(step: StepContext) -> bool:
    """A vehicle that was never seen armed was told to disarm, and has answered: the heartbeat
    that follows counts as the report that it is disarmed."""
    memory = step.memory
    return (
        memory.state is State.GROUNDED
        and memory.task is not None
        and memory.task.kind in (Event.DISARM, Event.FORCE_DISARM, Event.ABORT)
        and not memory.outstanding
    )


def _landed(step: StepContext, landed: LandedState) -> Iterator[Occurrence]:
    memory = step.memory
    was, flew = memory.landed, memory.airborne
    memory.landed, memory.landed_ns = landed, step.now_ns
    climbs = memory.flown_state is State.TAKING_OFF or step.now_ns < memory.takeoff_until_ns
    if landed is LandedState.ON_GROUND and memory.pos_ned is not None and not climbs:
        memory.ground_down_m = memory.pos_ned[2]
    if landed is LandedState.ON_GROUND and was is not landed:
        yield Occurrence(Event.LANDED)
    elif memory.airborne and not flew:
        yield Occurrence(Event.AIRBORNE)


def _home(step: StepContext, pos_ned: Vec3) -> Iterator[Occurrence]:
    memory = step.memory
    was_ned, memory.home_ned = memory.home_ned, pos_ned
    if was_ned is None or memory.on_ground or math.dist(was_ned, pos_ned) <= HOME_MOVED_M:
        return
    moved_m = math.dist(was_ned, pos_ned)
    step.say(Level.WARNING, f"Home moved by {moved_m:.1f} m while the vehicle flies")
    yield Occurrence(Event.HOME_MOVED)


def _verifier(step: StepContext, verifier: Verifier) -> Iterator[Occurrence]:
    """What is flown under our control is judged again by a verifier that changed."""
    memory = step.memory
    was, memory.verifier = memory.verifier, verifier
    memory.autopilot = verifier.autopilot
    if verifier == was or memory.control is Control.NONE:
        return
    why = refusal_of_what_is_flown(memory, verifier, was)
    if why is not None:
        yield Occurrence(Event.CLEARS_NO_MORE, why)


def _mission(step: StepContext, loaded: MissionLoaded) -> Iterator[Occurrence]:
    """What is flown as a mission is refused once it is known that another one may be on board."""
    memory = step.memory
    memory.mission_items = loaded.items
    memory.mission_over, memory.mission_within = False, None
    if not loaded.items and memory.flown_state is State.FLYING_MISSION:
        text = "the mission on board is not the one that was verified"
        yield Occurrence(Event.CLEARS_NO_MORE, Refusal(Code.BAD_MISSION, text))


def _photo(step: StepContext, seen: PhotoSeen) -> Iterator[Occurrence]:
    """A picture with the same index as the last one is that picture, reported again."""
    memory = step.memory
    was_index, memory.photo_index = memory.photo_index, seen.index
    if seen.index == was_index:
        return
    memory.photo_ok = seen.ok
    why = Refusal(Code.VEHICLE_REFUSED, "the camera took no picture")
    yield Occurrence(Event.PHOTO_SEEN, why)


def _position(step: StepContext, seen: PositionSeen) -> Iterator[Occurrence]:
    """Drops a sample that is not finite or older than the last one.  From every other the stop is
    predicted, where we have or take control."""
    memory = step.memory
    if not all(map(math.isfinite, (*seen.pos_ned, *seen.v_ned))):
        return
    if seen.time_boot_ms < memory.boot_ms and not seen.reset:
        return
    jumped = seen.reset or _faster_than_allowed(step, seen)
    if jumped:
        memory.ground_down_m = None
    memory.pos_ned, memory.v_ned = seen.pos_ned, seen.v_ned
    memory.pos_ns, memory.boot_ms = step.now_ns, seen.time_boot_ms
    memory.late_s, memory.yaw_rad = seen.late_s, seen.yaw_rad
    if not within_arrival(step):
        memory.within_since_ns = None
    elif memory.within_since_ns is None:
        memory.within_since_ns = step.now_ns
    if jumped:
        yield Occurrence(Event.POSITION_JUMPED)
    if memory.comes_back and _is_inside(memory):
        memory.hold = None if memory.hold is None else replace(memory.hold, way_back=False)
    if memory.verifier is not None and memory.control is not Control.NONE:
        breach = memory.verifier.predicted_stop(
            seen.pos_ned,
            seen.v_ned,
            memory.path,
            seen.late_s,
            floor_applies=_floor_applies(step),
        )
        if breach is not None:
            why = Refusal(Code.FENCE_BREACH, breach.sentence, breach.numbers, breach.zone)
            yield Occurrence(Event.BREACH, why, breach)
    yield Occurrence(Event.POSITION)


def _is_inside(memory: Memory) -> bool:
    """It has come back: it may stay where it is, and nothing says that it is outside."""
    if memory.verifier is None or memory.pos_ned is None or memory.v_ned is None:
        return False
    told = any(name is Condition.FENCE_BREACHED for name, _ in memory.conditions)
    judged = memory.verifier.hold_point(memory.pos_ned, memory.v_ned, (), floor_applies=True)
    return not told and not isinstance(judged, Refusal)


def _floor_applies(step: StepContext) -> bool:
    """A mission begins on the ground, and PX4 may end its climb below half a metre already."""
    memory = step.memory
    low = memory.ground_down_m is not None and not memory.climbed
    if memory.flown_state is State.FLYING_MISSION and low:
        return False
    return memory.flown_state not in FLOOR_FREE and memory.landed is LandedState.IN_AIR


def _faster_than_allowed(step: StepContext, seen: PositionSeen) -> bool:
    """Did the position move faster than the policy allows: is it a jump?

    The time between two samples is taken from the vehicle's own stamps, because samples may wait
    in queues on their way.  A stamp that advanced by more than the time between the arrivals plus
    the age at which a position is too old cannot be explained by that: it counts as a jump.
    """
    memory = step.memory
    late_ns = round(step.policy.position_age_s * SECOND_NS)
    if memory.pos_ned is None or memory.pos_ns is None:
        return False
    arrived_ns = step.now_ns - memory.pos_ns
    stamped_ns = (seen.time_boot_ms - memory.boot_ms) * 1_000_000
    if stamped_ns > arrived_ns + late_ns:
        return True  # its clock stepped forward: a restart, or no clock
    elapsed_ns = stamped_ns or arrived_ns
    allowed_m = step.policy.jump_speed_m_s * elapsed_ns / SECOND_NS + JUMP_LEAST_M
    return math.dist(seen.pos_ned, memory.pos_ned) > allowed_m


def _command_answer(step: StepContext, ended: CommandEnded) -> Iterator[Occurrence]:
    """An answer, or its absence, ends a command and nothing else.  What the vehicle does follows
    from its own reports.  An answer to a command that is not outstanding is only reported."""
    memory, key = step.memory, (ended.request_id, ended.kind)
    name = ended.kind.value.replace("_", " ")
    asked_for = ASKED_FOR[ended.kind]
    said = f": {ended.text}" if ended.text else ""
    if key not in memory.outstanding:
        if ended.result is None and memory.silence_reported is not ended.kind:
            step.say(Level.INFO, f"No answer to {name}, which is waited for no longer{said}")
        elif ended.result is not None:
            step.say(Level.INFO, f"A late answer to {name}, not acted on{said}")
        yield Occurrence(Event.LATE_ANSWER)
        return
    memory.outstanding = tuple(other for other in memory.outstanding if other != key)
    if ended.result is not None:
        memory.silence_reported = None
    if ended.result == ACCEPTED:
        yield Occurrence(Event.COMMAND_ACCEPTED)
    elif ended.result is None:
        if memory.silence_reported is not ended.kind:
            step.say(Level.WARNING, f"No answer to the request for {asked_for}")
        memory.silence_reported = ended.kind
        silent = ended.kind is CommandKind.HOLD
        yield Occurrence(Event.HOLD_UNANSWERED if silent else Event.COMMAND_UNANSWERED)
    else:
        sentence = f"the vehicle refused {asked_for} ({result_word(ended.result)}){said}"
        why = Refusal(Code.VEHICLE_REFUSED, sentence, (("result", float(ended.result)),))
        yield Occurrence(REFUSED_AS.get(ended.kind, Event.COMMAND_REFUSED), why)


def _condition(step: StepContext, changed: ConditionChanged) -> None:
    memory = step.memory
    others = tuple(pair for pair in memory.conditions if pair[0] is not changed.condition)
    if changed.active:
        memory.conditions = tuple(sorted((*others, (changed.condition, changed.text))))
    else:
        memory.conditions = others
    severity = step.policy.severities[changed.condition]
    if changed.active:
        idle = memory.state is State.EXTERNAL and severity > Severity.CAUTION
        text = f"{severity.name}: {changed.condition.value}: {changed.text}"
        step.say(Level.WARNING, f"{text}{NOT_OURS}" if idle else text)
    else:
        step.say(Level.INFO, f"No longer {severity.name}: {changed.condition.value}")
