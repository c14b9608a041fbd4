"""Requests for a flight mode: DO_SET_MODE, SET_MODE, and commands that stand for a mode."""

from __future__ import annotations

from gcs import ipc
from gcs.bridge.translate.command import Command
from gcs.bridge.translate.meaning import Meaning, Reject, Seen, Words
from gcs.bridge.translate.says import (
    DONE,
    NOT_FLOWN_BY_US,
    ask,
    comes_back,
    forward,
    hover_again,
    mode,
    refuse,
    unsupported,
)
from gcs.gate.refusal import Code
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import Autopilot, Mode, mode_named, mode_of
from gcs.wire.ids import ModeFlag
from gcs.wire.messages import SetMode

FLIES_ITSELF = frozenset({State.FLYING_MISSION, State.RETURNING, State.LANDING})
"""States in which the vehicle flies by a mode of its own that the gate allowed."""


def do_set_mode(command: Command, seen: Seen) -> Meaning:
    """px4: main mode in p2, sub mode in p3; ardupilot: the mode's number in p2."""
    flags, main, sub = (command.whole(value) for value in (command.p1, command.p2, command.p3))
    if flags is None or main is None or not 0 <= main <= 0xFFFFFF:
        return unsupported("DO_SET_MODE without the number of a mode")
    if seen.autopilot.mode_in_two_parts:
        # An autopilot without such a part ignores it; px4 itself cuts both to eight bits.
        return _by_number(flags, (main & 0xFF) << 16 | ((sub or 0) & 0xFF) << 24, seen)
    return _by_number(flags, main, seen)


def set_mode(message: SetMode, seen: Seen) -> Meaning:
    """The old message: custom_mode as HEARTBEAT has it."""
    return _by_number(message.base_mode, message.custom_mode, seen)


def _by_number(flags: int, custom_mode: int, seen: Seen) -> Meaning:
    if not flags & ModeFlag.CUSTOM_MODE_ENABLED:
        return unsupported(
            f"base mode {flags} names no mode of {seen.autopilot.name}; "
            "set MAV_MODE_FLAG_CUSTOM_MODE_ENABLED and the custom mode"
        )
    wanted = mode_of(seen.autopilot, ModeFlag.CUSTOM_MODE_ENABLED, custom_mode)
    if wanted not in seen.autopilot.modes:
        return unsupported(f"{seen.autopilot.name} has no mode {custom_mode:#x} that is known here")
    return for_mode(wanted, seen)


def for_mode(wanted: Mode, seen: Seen) -> Meaning:
    """What a client that asks for this mode wants the vehicle to do."""
    if _is_let_through(wanted, seen):
        return forward(seen)
    match wanted.meaning:
        case FlightMode.HOLD:
            obeys_sticks = wanted.name != _sent(seen.autopilot, FlightMode.HOLD)
            by_sticks = obeys_sticks and seen.has_sticks and seen.in_control
            if by_sticks and not seen.on_ground:
                again = hover_again(seen, note=_by_sticks(wanted, seen))
                # A client that stops it is never refused.
                return again if isinstance(again, Words) else hold(seen, wanted.name)
            return hold(seen, wanted.name)
        case FlightMode.GUIDED:
            return guided(wanted, seen)
        case FlightMode.TAKEOFF:
            return Words((ipc.Ask(0, "takeoff", up_m=seen.takeoff_up_m),))
        case FlightMode.MISSION | FlightMode.RETURN | FlightMode.LAND:
            return _flown_by_itself(wanted, seen)
        case FlightMode.OTHER if seen.on_ground and not seen.armed:
            return _waits_for_take_off(wanted, seen) or mode(wanted.name)
        case FlightMode.OTHER if wanted.name in _POSITION_MODES and not seen.on_ground:
            return _position_mode(wanted, seen)
        case FlightMode.OTHER:
            sentence = f"{wanted.name} is flown with sticks: the gate could hold nothing in it"
            return refuse(Code.POLICY, f"{sentence} (policy: bridge.manual_modes)")


_POSITION_MODES = frozenset({"POSCTL", "POSHOLD"})
"""Modes in which the vehicle stays where it is until a stick is moved, and again after that."""


def _waits_for_take_off(wanted: Mode, seen: Seen) -> Words | None:
    """PX4 does not arm in POSCTL while it hears no sticks (recorded), and it hears none here."""
    if not (wanted.name == "POSCTL" and seen.has_sticks and seen.in_control):
        return None
    held = _sent(seen.autopilot, FlightMode.HOLD)
    return ask("hold", f"{wanted.name}: {held} on the ground; take off, then the sticks fly")


def _position_mode(wanted: Mode, seen: Seen) -> Meaning:
    """The same is had from the gate: it hovers, and flies sticks as a stream that it verifies.

    PX4 refuses POSCTL, too, where no sticks are heard (recorded: TEMPORARILY_REJECTED).
    """
    if not seen.has_sticks:
        sentence = f"{wanted.name}: no MANUAL_CONTROL comes from this client, so nothing flies it"
        return refuse(Code.POLICY, f"{sentence} (policy: bridge.manual_modes)")
    note = _by_sticks(wanted, seen)
    if not seen.in_control:
        return ask("control")
    if seen.state in NOT_FLOWN_BY_US:
        return ask("resume", note)
    if seen.state in (State.STREAMING, State.HOVERING):
        return Words((), note)  # in a hover the mode is shown, or the gate has asked for it
    return hover_again(seen, note=note)


def _by_sticks(wanted: Mode, seen: Seen) -> str:
    flown = _sent(seen.autopilot, FlightMode.GUIDED)
    return f"{wanted.name}: flown in {flown}, where the gate verifies what the sticks ask for"


def _is_let_through(wanted: Mode, seen: Seen) -> bool:
    """A mode of the sticks that the policy names, as `mode_named` takes names."""
    by_sticks = wanted.meaning in (FlightMode.OTHER, FlightMode.HOLD)
    if not by_sticks or wanted.name == _sent(seen.autopilot, wanted.meaning):
        return False
    return any(mode_named(seen.autopilot, name) == wanted for name in seen.manual_modes)


def hold(seen: Seen, asked_for: str = "") -> Words:
    """Stop: never refused, from no client, in no state (invariant 10)."""
    sent = _sent(seen.autopilot, FlightMode.HOLD)
    if asked_for in ("", sent):
        return ask("hold")
    return ask("hold", f"{asked_for}: held in {sent} instead, as {asked_for} obeys the sticks")


def guided(wanted: Mode, seen: Seen) -> Meaning:
    """OFFBOARD or GUIDED: let a station fly it.  The gate hovers until it is told where to.

    A mode that the vehicle flies by itself is stopped first, by a client who may go on from there:
    `hold` alone is heard from everybody.  On the ground GUIDED waits for a take-off, and clients of
    ArduPilot set it before they arm; OFFBOARD would fly to whatever setpoint comes.
    """
    if seen.on_ground:
        waits = not seen.autopilot.mode_in_two_parts
        return forward(seen) if waits else mode(wanted.name)
    if seen.state in NOT_FLOWN_BY_US:
        return ask("resume")
    if seen.state in FLIES_ITSELF:
        # The heartbeat may still show the mode before: `mode_name` counts for nothing here.
        return hover_again(seen) if seen.in_control else ask("control")
    if seen.in_control and (seen.mode_name == wanted.name or seen.state is State.HOVERING):
        return DONE  # in a hover the mode is shown, or the gate has asked for it
    return ask("control")


UNDER_WAY = frozenset({State.TAKING_OFF, State.MOVING, State.STREAMING, State.RETURNING})
"""States out of which a mission is started by stopping first."""

_WORD_OF = {
    FlightMode.MISSION: "mission_start",
    FlightMode.RETURN: "rtl",
    FlightMode.LAND: "land",
}


def _flown_by_itself(wanted: Mode, seen: Seen) -> Words | Reject:
    """By its name where it is not the mode that the gate sends: the gate says which one that is.

    A mission may be started, or gone on with, from a hold: its client has no word for `resume`.
    Out of a go-to that is not there yet an autopilot starts it at once, and clients rely on that;
    the gate starts one from a hover, so the client in control stops first.  Of a mission that is
    flown already the client in control alone is told so: any other is refused by the station.
    """
    if wanted.name != _sent(seen.autopilot, wanted.meaning):
        return mode(wanted.name)
    word = ask(_WORD_OF[wanted.meaning])
    if wanted.meaning is not FlightMode.MISSION:
        return word
    if seen.state is State.FLYING_MISSION:
        return DONE if seen.in_control else word
    if seen.state in NOT_FLOWN_BY_US and not seen.on_ground:
        return Words((ipc.Ask(0, "resume"), *word.asks))
    if seen.state in UNDER_WAY and seen.in_control:
        return hover_again(seen, *word.asks)
    return word


def _sent(autopilot: Autopilot, meaning: FlightMode) -> str:
    return autopilot.mode_of_meaning.get(meaning, "")


def meaning_named(seen: Seen, meaning: FlightMode) -> Meaning:
    """The mode of this meaning that the gate sends."""
    name = _sent(seen.autopilot, meaning)
    for known in seen.autopilot.modes:
        if known.name == name or (not name and known.meaning is meaning):
            return for_mode(known, seen)
    return unsupported(f"{seen.autopilot.name} has no such mode")


def mission_started(seen: Seen) -> Meaning:
    """What a command that starts a mission asks for: as its mode does, but that it takes no vehicle
    from a pilot who flies it with sticks.  Then the gate refuses it."""
    if seen.state is State.EXTERNAL and not seen.on_ground and not comes_back(seen):
        return ask("mission_start")
    return meaning_named(seen, FlightMode.MISSION)
