"""A pilot's sticks from a client: MANUAL_CONTROL, RC_CHANNELS_OVERRIDE.

Sticks are never forwarded.  They are read as a velocity, forward and beside the vehicle's nose, up
and down, and a yaw rate, which the gate verifies as it does any sample of a stream; what the pilot
feels is the autopilot's own position mode.  Where a raw stick leads has no bound, and both
autopilots act on the loss of sticks that they have seen once (recorded: ArduCopter returns home
0.96 s after the last override).
"""

from __future__ import annotations

import math
from typing import Final

from gcs.bridge.translate.meaning import Meaning, Reject, Sample, Seen, Sticks
from gcs.bridge.translate.places import rotated
from gcs.bridge.translate.says import DONE, refuse, unsupported
from gcs.frames import as_on_the_wire
from gcs.gate.policy.policy import StreamRules
from gcs.gate.refusal import Code
from gcs.wire.messages import ManualControl, RcChannelsOverride

NOT_GIVEN: Final = 0x7FFF
"""MANUAL_CONTROL: this axis does not exist."""
END: Final = 1000
"""MANUAL_CONTROL: x forward, y to the right and r clockwise are -1000 to 1000; z, the throttle, is
0 to 1000 for a vehicle without reverse thrust, and 500 its middle (both autopilots)."""
MIDDLE_THROTTLE: Final = 500
BUTTONS: Final = "buttons of a joystick are ignored: give modes and commands by name"

MIDDLE_US, FULL_US = 1500, 500
"""RC1_TRIM to RC4_TRIM of ArduCopter 4.7, and RCx_MAX - RCx_TRIM (arducopter_4_7_params.json)."""
SHORTEST_US, LONGEST_US = 800, 2200
"""ArduPilot takes no other pulse for a stick's (RC_Channel; from memory)."""
STICKS: Final = 4
"""Channels 1 to 4 are roll, pitch, throttle and yaw (RCMAP_* as recorded)."""
_UNCHANGED: Final = 65535
_RELEASED_FROM_9: Final = 65534

_BELOW: Final = 1.0 - 1e-6
"""Rounding to the wire's float32 must not take full stick beyond the policy's most."""


def manual_control(message: ManualControl, seen: Seen) -> Meaning:
    """Axes that are not given are in the middle; buttons and the extended axes are ignored."""
    for name, value, least in (
        ("x", message.x, -END),
        ("y", message.y, -END),
        ("z", message.z, 0),
        ("r", message.r, -END),
    ):
        if value != NOT_GIVEN and not least <= value <= END:
            return unsupported(f"{name} of {value} is no stick: {least} to {END}")
    note = BUTTONS if message.buttons or message.buttons2 else ""
    forward, right, clockwise = (
        0.0 if axis == NOT_GIVEN else axis / END for axis in (message.x, message.y, message.r)
    )
    throttle = MIDDLE_THROTTLE if message.z == NOT_GIVEN else message.z
    up = (throttle - MIDDLE_THROTTLE) / MIDDLE_THROTTLE
    return _sticks(forward, right, up, clockwise, seen, note)


def rc_override(message: RcChannelsOverride, seen: Seen) -> Meaning:
    """Channels 1 to 4 of an ArduPilot, in us; released or unchanged ones are in the middle.

    Channels 1 to 8: 0 is released, 65535 unchanged; 9 to 18: 65534 released, 0 unchanged, too.
    """
    sticks = [getattr(message, f"chan{number}_raw") for number in range(1, STICKS + 1)]
    others = [getattr(message, f"chan{number}_raw") for number in range(STICKS + 1, 9)]
    late = [getattr(message, f"chan{number}_raw") for number in range(9, 19)]
    free = (0, _UNCHANGED)
    if not (
        all(raw in free for raw in others) and all(raw in (*free, _RELEASED_FROM_9) for raw in late)
    ):
        return unsupported(
            "radio channels from 5 on, from a client: they switch modes and devices; leave them 0"
        )
    if seen.autopilot.mode_in_two_parts:
        if all(raw in free for raw in sticks):
            return DONE
        return unsupported(
            "radio channels from a client: a px4 has no stick for them but what its calibration "
            "says (RC_MAP_*); send MANUAL_CONTROL"
        )
    for number, raw in enumerate(sticks, 1):
        if raw not in free and not SHORTEST_US <= raw <= LONGEST_US:
            return unsupported(
                f"channel {number} of {raw} us is no stick: {SHORTEST_US} to {LONGEST_US}"
            )
    roll, pitch, throttle, yaw = (
        0.0 if raw in free else max(-1.0, min(1.0, (raw - MIDDLE_US) / FULL_US)) for raw in sticks
    )
    return _sticks(-pitch, roll, throttle, yaw, seen, "")


def _sticks(
    forward: float, right: float, up: float, clockwise: float, seen: Seen, note: str
) -> Sticks | Reject:
    """Of sticks from -1 to 1, 0 in the middle."""
    rules = seen.stream
    if rules is None:
        return unsupported("sticks from a client: there is no policy to fly them by")
    forward, right, up, clockwise = (
        _beyond_dead_band(axis, rules.stick_dead_band) for axis in (forward, right, up, clockwise)
    )
    beside = forward != 0.0 or right != 0.0 or clockwise != 0.0
    centred, resting = not beside and up == 0.0, not beside and up <= 0.0
    if seen.yaw_rad is None:
        if centred or (resting and seen.on_ground):
            return Sticks(Sample(v_ned=(0.0, 0.0, 0.0)), centred, resting, note)
        return refuse(Code.NO_POSITION, "where the vehicle's nose points is not known")
    v_frd = _velocity_frd(forward, right, up, rules)
    north, east, down = rotated(v_frd, seen.yaw_rad)
    yaw_rate_deg_s = clockwise * _full(rules.stick_yaw_rate_deg_s, rules.max_yaw_rate_deg_s)
    sample = Sample(
        v_ned=(as_on_the_wire(north), as_on_the_wire(east), as_on_the_wire(down)),
        yaw_rate_rad_s=math.radians(yaw_rate_deg_s),
    )
    return Sticks(sample, centred, resting, note)


def _beyond_dead_band(axis: float, band: float) -> float:
    """0 in the dead band; from its end to the stick's, 0 to 1."""
    beyond = max(0.0, abs(axis) - band) / (1.0 - band)
    return math.copysign(beyond, axis) if beyond else 0.0


def _velocity_frd(
    forward: float, right: float, up: float, rules: StreamRules
) -> tuple[float, float, float]:
    """A stick in a corner asks for no more speed than one at a side."""
    speed_h = _full(rules.stick_speed_h_m_s, rules.max_speed_h_m_s) / max(
        1.0, math.hypot(forward, right)
    )
    if up > 0.0:
        down = -up * _full(rules.stick_speed_up_m_s, rules.max_speed_up_m_s)
    else:
        down = -up * _full(rules.stick_speed_down_m_s, rules.max_speed_down_m_s)
    return (forward * speed_h, right * speed_h, down)


def _full(stick: float, most: float) -> float:
    """What full stick asks for."""
    return min(stick, most) * _BELOW
