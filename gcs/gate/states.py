"""The states of the gate's machine, and of the vehicle as it reports them."""

from __future__ import annotations

from enum import IntEnum, StrEnum


class State(IntEnum):
    """The state of the gate's machine.  HOVERING, VERIFYING and MOVING have the lab's names and
    numbers.

    STALE: the vehicle is heard, but its position is too old.  HOLDING: stopped by a request or by
    the gate, left by `resume` only.  EXTERNAL: it flies, and not under our control.
    """

    HOVERING = 1
    VERIFYING = 2
    MOVING = 3
    NO_VEHICLE = 4
    STALE = 5
    GROUNDED = 6
    TAKING_OFF = 7
    STREAMING = 8
    TAKING_PICTURE = 9
    FLYING_MISSION = 10
    RETURNING = 11
    LANDING = 12
    HOLDING = 13
    EXTERNAL = 14


class Control(IntEnum):
    """Who controls the vehicle.  TAKING: we send the hold goal as setpoint and wait for the
    heartbeat to show guided mode."""

    NONE = 0
    TAKING = 1
    OURS = 2


class FlightMode(StrEnum):
    """What a mode means to the gate; the autopilots have different names for the same meaning."""

    GUIDED = "guided"  # px4 OFFBOARD, ardupilot GUIDED
    HOLD = "hold"  # px4 AUTO.LOITER, ardupilot BRAKE or LOITER
    TAKEOFF = "takeoff"  # px4 AUTO.TAKEOFF
    MISSION = "mission"  # px4 AUTO.MISSION, ardupilot AUTO
    RETURN = "return"  # px4 AUTO.RTL, ardupilot RTL or SMART_RTL
    LAND = "land"  # px4 AUTO.LAND or AUTO.PRECLAND, ardupilot LAND
    OTHER = "other"  # any other mode: somebody else flies


class LandedState(IntEnum):
    """MAV_LANDED_STATE, with its numbers."""

    UNDEFINED = 0
    ON_GROUND = 1
    IN_AIR = 2
    TAKEOFF = 3
    LANDING = 4
