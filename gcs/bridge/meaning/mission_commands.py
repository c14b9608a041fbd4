"""Commands about the mission, speeds, and where the vehicle looks; and those nobody may send."""

from __future__ import annotations

import math
from typing import Final

from gcs import ipc
from gcs.bridge.meaning.command import Command
from gcs.bridge.meaning.meaning import Meaning, Seen, Words
from gcs.bridge.meaning.modes import meaning_named
from gcs.bridge.meaning.says import forward, refuse, unsupported
from gcs.gate.refusal import Code
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import mode_named
from gcs.wire.messages import MissionSetCurrent

FROM_THE_FIRST: Final = "a mission is verified from its first item, and flown from there"


def mission_start_px4(command: Command, seen: Seen) -> Meaning:
    """p1 is the first item; the last one is ignored.  On the ground it arms, too (Commander.cpp).

    -1 would fly on where it stopped, which the gate's own start decides.
    """
    if command.p1 not in (0.0, -1.0):
        return unsupported(f"a start at item {command.p1:g}: {FROM_THE_FIRST}")
    start = meaning_named(seen, FlightMode.MISSION)
    if isinstance(start, Words) and start.asks and seen.on_ground and not seen.armed:
        return Words((ipc.Ask(0, "arm"), *start.asks))
    return start


def mission_start_ardupilot(command: Command, seen: Seen) -> Meaning:
    """With a first or last item it is denied (GCS_Mavlink.cpp)."""
    if (command.p1, command.p2) != (0.0, 0.0):
        return unsupported(f"a start at item {command.p1:g}: {FROM_THE_FIRST}")
    return meaning_named(seen, FlightMode.MISSION)


def do_set_mission_current(command: Command, seen: Seen) -> Meaning:
    """p1 is the item."""
    number = command.whole(command.p1)
    return _set_current(-1 if number is None else number, seen)


def mission_set_current(message: MissionSetCurrent, seen: Seen) -> Meaning:
    """The old message for it."""
    return _set_current(message.seq, seen)


def _set_current(number: int, seen: Seen) -> Meaning:
    """Back to the first item, while no mission is flown, moves nothing and is where it is verified
    from.  Item 0 of ardupilot is home, so its first is 1."""
    first = 0 if seen.autopilot.mode_in_two_parts else 1
    flown = mode_named(seen.autopilot, seen.mode_name)
    in_mission = flown is not None and flown.meaning is FlightMode.MISSION
    if 0 <= number <= first and not in_mission and seen.state is not State.FLYING_MISSION:
        return forward(seen)
    return unsupported(f"a jump to item {number}: {FROM_THE_FIRST}")


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


def orbit(command: Command, seen: Seen) -> Meaning:
    return unsupported(
        "a circle that the vehicle flies by itself is not held inside the fence: "
        "send it as a mission with NAV_LOITER_TURNS, or as a stream of setpoints"
    )


def go_around(command: Command, seen: Seen) -> Meaning:
    return unsupported("a landing is broken off with hold: mode AUTO.LOITER or BRAKE")


def of_no_use(command: Command, seen: Seen) -> Meaning:
    return unsupported(f"{seen.autopilot.name} multirotors do not take this command")


def not_to_be_judged(command: Command, seen: Seen) -> Meaning:
    return unsupported("where this command would take the vehicle cannot be verified")
