"""The words for what the gate and the vehicle are doing."""

from __future__ import annotations

from enum import IntEnum, StrEnum


class State(IntEnum):
    """Where the machine is.  The lab's three keep the lab's names and numbers."""

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
    """Who flies.  TAKING: we stream the hold goal and wait for the heartbeat to confirm."""

    NONE = 0
    TAKING = 1
    OURS = 2


class FlightMode(StrEnum):
    """What the vehicle's mode means to the gate, whatever the autopilot calls it."""

    GUIDED = "guided"  # px4 OFFBOARD, ardupilot GUIDED
    HOLD = "hold"  # px4 AUTO.LOITER, ardupilot BRAKE or LOITER
    TAKEOFF = "takeoff"  # px4 AUTO.TAKEOFF
    MISSION = "mission"  # px4 AUTO.MISSION, ardupilot AUTO
    RETURN = "return"  # px4 AUTO.RTL, ardupilot RTL or SMART_RTL
    LAND = "land"  # px4 AUTO.LAND or AUTO.PRECLAND, ardupilot LAND
    OTHER = "other"  # flown by somebody else


class LandedState(IntEnum):
    """MAV_LANDED_STATE, with the same numbers."""

    UNDEFINED = 0
    ON_GROUND = 1
    IN_AIR = 2
    TAKEOFF = 3
    LANDING = 4
