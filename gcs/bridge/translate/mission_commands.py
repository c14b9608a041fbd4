"""Commands about the mission, speeds, and where the vehicle looks; and those nobody may send."""

from __future__ import annotations

import math
from typing import Final

from gcs import ipc
from gcs.bridge.translate.command import Command
from gcs.bridge.translate.meaning import Meaning, Reject, Seen, Words
from gcs.bridge.translate.modes import mission_started
from gcs.bridge.translate.says import forward, hover_again, refuse, unsupported
from gcs.gate.refusal import Code
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import mode_named
from gcs.wire.messages import MissionSetCurrent

ON_GROUND: Final = "on the ground a mission begins with its first item"
LAST_SEQ: Final = 0xFFFF
STOPPED_FIRST: Final = "it is stopped first, and its way from there to that item verified"


def mission_start_px4(command: Command, seen: Seen) -> Meaning:
    """p1 is the first item; the last one is ignored.  On the ground it arms, too (Commander.cpp):
    here not before the mission on board has cleared.

    0 and -1: where it was set to begin, or the first one.
    """
    number = command.whole(command.p1)
    if number is None or number < -1 or (number > 0 and seen.on_ground):
        return unsupported(f"a start at item {command.p1:g}: {ON_GROUND}")
    start = mission_started(seen)
    if number > 0:
        return _set_current(number, seen, start)
    if isinstance(start, Words) and start.asks and seen.on_ground and not seen.armed:
        return Words((ipc.Ask(0, "mission_check"), ipc.Ask(0, "arm"), *start.asks))
    return start


def mission_start_ardupilot(command: Command, seen: Seen) -> Meaning:
    """With a first or last item it is denied (GCS_Mavlink.cpp)."""
    if (command.p1, command.p2) != (0.0, 0.0):
        return unsupported(f"ArduCopter takes no items in MISSION_START ({command.p1:g})")
    return mission_started(seen)


def do_set_mission_current(command: Command, seen: Seen) -> Meaning:
    """p1 is the item."""
    number = command.whole(command.p1)
    return _set_current(-1 if number is None else number, seen)


def mission_set_current(message: MissionSetCurrent, seen: Seen) -> Meaning:
    """The old message for it."""
    return _set_current(message.seq, seen)


def _set_current(number: int, seen: Seen, start: Meaning | None = None) -> Meaning:
    """While no mission is flown it moves nothing: the next start begins there.

    A mission that is flown is stopped, set to the item and started again: so the way from where the
    vehicle stands still to that item is verified, with all that follows.  `start`: it is to be
    started in any case.
    """
    if not 0 <= number <= LAST_SEQ:
        return unsupported(f"item {number} of a mission")
    if 0 < seen.mission_items <= number:
        last = seen.mission_items - 1
        return refuse(Code.BAD_MISSION, f"there is no item {number}: the last one is {last}")
    words = (ipc.Ask(0, "mission_set_current", item=number),)
    if seen.state is State.FLYING_MISSION and seen.in_control:
        return hover_again(seen, *words, ipc.Ask(0, "mission_start"), note=STOPPED_FIRST)
    if isinstance(start, Reject):
        return start
    if isinstance(start, Words):
        *before, last_word = start.asks or (ipc.Ask(0, "mission_start"),)
        return Words((*before, *words, last_word), start.note)
    return Words(words)


def do_land_start(command: Command, seen: Seen) -> Meaning:
    """Land by the mission: it is set to its DO_LAND_START item, and flown from there.

    MAVLink's command has no parameters.  An ArduCopter flies it in AUTO_RTL from the nearest
    marker, and a PX4 1.14 starts its mission there (both from memory of the sources: `ModeAuto`,
    `navigator_main.cpp`); neither is sent it here, as nobody verified the way to the marker.
    """
    if seen.mission_items == 0:
        return refuse(Code.NO_MISSION, "no verified mission is on board: upload one first")
    if seen.on_ground:
        return refuse(Code.NOT_FLYING, ON_GROUND)
    match seen.land_starts:
        case ():
            return refuse(Code.BAD_MISSION, "the mission on board has no DO_LAND_START item")
        case (only,):
            return _set_current(only, seen, mission_started(seen))
        case several:
            numbers = ", ".join(map(str, several))
            sentence = f"DO_LAND_START is at items {numbers}: name one, by DO_SET_MISSION_CURRENT"
            return unsupported(sentence)


def change_speed(command: Command, seen: Seen) -> Meaning:
    """Slower is let through, also "as before" (0, -1, -2); a mission is verified with its own.

    p2 is m/s.  NaN stops ArduCopter's simulation with a floating point exception (recorded).  p1 is
    the kind of speed: px4 ignores it (recorded), ardupilot has 0 and 1 for the horizontal one.
    """
    if not math.isfinite(command.p2):
        return refuse(Code.NON_FINITE, "a speed that is no number")
    flown = mode_named(seen.autopilot, seen.mode_name)
    if seen.state is State.FLYING_MISSION or (
        flown is not None and flown.meaning is FlightMode.MISSION
    ):
        return refuse(Code.POLICY, "a mission is verified with its own speeds, and flown with them")
    if not seen.autopilot.mode_in_two_parts and command.p1 not in (0.0, 1.0):
        return refuse(Code.POLICY, "speeds of climb and descent stay the vehicle's own")
    if command.p2 > seen.max_speed_m_s:
        return refuse(
            Code.POLICY,
            f"{command.p2:g} m/s is faster than the vehicle's own {seen.max_speed_m_s:g} m/s",
            ("asked_m_s", command.p2),
            ("max_m_s", seen.max_speed_m_s),
        )
    return forward(seen)


def region_of_interest(command: Command, seen: Seen) -> Meaning:
    """Turns the camera or the vehicle's nose, and moves it nowhere."""
    return forward(seen)


def go_around(command: Command, seen: Seen) -> Meaning:
    return unsupported("a landing is broken off with hold: mode AUTO.LOITER or BRAKE")


def of_no_use(command: Command, seen: Seen) -> Meaning:
    return unsupported(f"{seen.autopilot.name} multirotors do not take this command")


def not_to_be_judged(command: Command, seen: Seen) -> Meaning:
    return unsupported("where this command would take the vehicle cannot be verified")
