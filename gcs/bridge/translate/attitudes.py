"""SET_ATTITUDE_TARGET: which bits of its mask leave something that can be verified.

ATTITUDE_TARGET_TYPEMASK, as PX4 1.14 (`mavlink_receiver.cpp`) and ArduCopter 4.5 to 4.7
(`GCS_Mavlink.cpp`) read it (both from memory):

- Without the attitude body rates are flown: where they turn the vehicle to has no bound.
- Without the thrust PX4 stops its motors, and ArduCopter stops in the air.
- PX4 takes rates of roll and pitch beside an attitude for a second setpoint, of rates; a yaw rate
  alone only turns the nose.  ArduCopter takes all three rates or none, and turns the attitude on by
  them: about the body's down alone, which leaves its tilt as it is.
- Thrust along three axes is no collective thrust, and only other kinds of vehicle have it.
- Bits that the standard does not have mean nothing that could be verified.
"""

from __future__ import annotations

import math
from typing import Final

from gcs.bridge.translate.meaning import Meaning, Sample, Seen
from gcs.bridge.translate.says import refuse, unsupported
from gcs.frames import as_on_the_wire
from gcs.gate.airspace.attitude_samples import NOT_FLOWN, UNIT_WITHIN
from gcs.gate.attitude import Attitude
from gcs.gate.refusal import Code
from gcs.wire.ids import AttitudeMask as Mask
from gcs.wire.messages import SetAttitudeTarget

THRUST_BODY_SET: Final = 32
"""ATTITUDE_TARGET_TYPEMASK_THRUST_BODY_SET of the standard; the dialect here does not have it."""
_KNOWN: Final = (
    Mask.BODY_ROLL_RATE_IGNORE
    | Mask.BODY_PITCH_RATE_IGNORE
    | Mask.BODY_YAW_RATE_IGNORE
    | THRUST_BODY_SET
    | Mask.THROTTLE_IGNORE
    | Mask.ATTITUDE_IGNORE
)
_TILTING: Final = Mask.BODY_ROLL_RATE_IGNORE | Mask.BODY_PITCH_RATE_IGNORE
_RATES: Final = _TILTING | Mask.BODY_YAW_RATE_IGNORE


def attitude_target(message: SetAttitudeTarget, seen: Seen) -> Meaning:
    """An attitude with a thrust, and a yaw rate where the mask leaves one."""
    if seen.stream is None or seen.stream.tilt_deg <= 0.0:
        return refuse(Code.POLICY, NOT_FLOWN)
    mask, rates = message.type_mask, message.type_mask & _RATES
    why = _refused_bits(mask)
    if not why:
        why = _refused_rates(message, rates, px4=seen.autopilot.mode_in_two_parts)
    if why:
        return unsupported(f"type_mask {mask} {why}")
    rate_rad_s = None if rates & Mask.BODY_YAW_RATE_IGNORE else message.body_yaw_rate
    if not all(map(math.isfinite, (*message.q, message.thrust, rate_rad_s or 0.0))):
        return refuse(Code.NON_FINITE, "an attitude with a number that is not finite")
    size = math.hypot(*message.q)
    if abs(size - 1.0) > UNIT_WITHIN:
        return unsupported(f"a quaternion of length {size:.3f} is no attitude: 1 is asked")
    w, x, y, z = (part / size for part in message.q)
    thrust = as_on_the_wire(message.thrust)
    return Sample(yaw_rate_rad_s=rate_rad_s, attitude=Attitude((w, x, y, z), thrust))


def _refused_bits(mask: int) -> str:
    """What is wrong with the bits that are no rates; empty: nothing."""
    if mask & ~_KNOWN:
        return "has bits that the standard does not know"
    if mask & Mask.ATTITUDE_IGNORE:
        return "leaves out the attitude: where body rates alone turn the vehicle cannot be verified"
    if mask & Mask.THROTTLE_IGNORE:
        return "leaves out the thrust: neither autopilot flies an attitude without"
    if mask & THRUST_BODY_SET:
        return "gives a thrust along three axes, which a multirotor does not have"
    return ""


def _refused_rates(message: SetAttitudeTarget, ignored: int, *, px4: bool) -> str:
    """What is wrong with the rates beside an attitude; empty: nothing."""
    if ignored == _RATES:
        return ""
    if px4:
        if ignored == _TILTING:
            return ""
        return "gives a rate of roll or pitch beside an attitude, which px4 takes for a setpoint"
    if ignored:
        return "gives some body rates only: ArduCopter takes all three or none, and stops"
    if (message.body_roll_rate, message.body_pitch_rate) != (0.0, 0.0):
        return "turns the attitude on by a rate of roll or pitch: where to cannot be verified"
    return ""
