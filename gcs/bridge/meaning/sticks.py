"""A pilot's sticks and attitudes from a client: MANUAL_CONTROL, RC_CHANNELS_OVERRIDE,
SET_ATTITUDE_TARGET.

Where they take the vehicle cannot be verified by its position, so they are refused.  Sticks in the
middle, and channels that are released or left as they are, ask for nothing; they are not forwarded
either, because both autopilots act on the loss of sticks that they have seen once (recorded:
ArduCopter returns home 0.96 s after the last override), and a release would take away the override
of a pilot on another link.
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.meaning.meaning import Meaning, Seen
from gcs.bridge.meaning.says import DONE, unsupported
from gcs.wire.messages import ManualControl, RcChannelsOverride, SetAttitudeTarget

MIDDLE_THROTTLE: Final = 500
"""MANUAL_CONTROL.z: 0 to 1000 for vehicles that have no reverse thrust."""
NOT_GIVEN: Final = 0x7FFF
"""MANUAL_CONTROL: this axis does not exist."""
_UNCHANGED: Final = 65535
_RELEASED_FROM_9: Final = 65534
_HINT: Final = "its effect on the position cannot be verified; send positions or velocities"


def manual_control(message: ManualControl, seen: Seen) -> Meaning:
    """-1000 to 1000; 0 is the middle, and 500 that of the throttle."""
    sides = (message.x, message.y, message.r)
    middle = all(axis in (0, NOT_GIVEN) for axis in sides)
    level = message.z in (MIDDLE_THROTTLE, NOT_GIVEN)
    if middle and level and not message.buttons and not message.buttons2:
        return DONE
    return unsupported(f"sticks from a client: {_HINT}")


def rc_override(message: RcChannelsOverride, seen: Seen) -> Meaning:
    """Channels 1 to 8: 0 released, 65535 unchanged; 9 to 18: 65534 released, 0 unchanged, too."""
    first = [getattr(message, f"chan{number}_raw") for number in range(1, 9)]
    rest = [getattr(message, f"chan{number}_raw") for number in range(9, 19)]
    if all(raw in (0, _UNCHANGED) for raw in first) and all(
        raw in (0, _UNCHANGED, _RELEASED_FROM_9) for raw in rest
    ):
        return DONE
    return unsupported(f"radio channels from a client: {_HINT}")


def attitude_target(message: SetAttitudeTarget, seen: Seen) -> Meaning:
    """Attitudes, body rates and thrust, in whatever mask."""
    return unsupported(f"attitudes and thrust from a client: {_HINT}")
