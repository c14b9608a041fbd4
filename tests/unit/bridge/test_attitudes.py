"""SET_ATTITUDE_TARGET: what each of the 256 masks means to each autopilot.

The bits are ATTITUDE_TARGET_TYPEMASK's of the MAVLink standard (1, 2, 4: body rates of roll, pitch
and yaw are ignored; 32: thrust_body is given; 64: thrust is ignored; 128: the attitude is ignored),
written as numbers here.  What each autopilot makes of them is from memory of its source.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest
from msgspec import structs
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.translate.meaning import Meaning, Sample, Seen
from gcs.bridge.translate.translate import meaning_of
from gcs.gate.policy.parse import DEFAULT
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from tests.unit.bridge.vehicles import NAN, flying, refusal, sent

BOTH = pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)
RULES = structs.replace(DEFAULT.stream, tilt_deg=10.0)
LEVEL = (1.0, 0.0, 0.0, 0.0)
FORWARD = (math.cos(math.radians(-2.5)), 0.0, math.sin(math.radians(-2.5)), 0.0)
"""Nose 5 degrees down."""
NO_RATES = 7
FLOWN = {"px4": {7: False, 3: True}, "ardupilot": {7: False, 0: True}}
"""By autopilot, the masks that leave something to fly, and whether there is a yaw rate in it."""


def hovering(autopilot: Autopilot) -> Seen:
    return flying(autopilot, stream=RULES)


def asked(
    mask: int,
    seen: Seen,
    q: Sequence[float] = FORWARD,
    rates: Sequence[float] = (0.0, 0.0, 0.25),
    thrust: float = 0.5,
) -> Meaning:
    message = mavlink.MAVLink_set_attitude_target_message(0, 1, 1, mask, q, *rates, thrust)
    return meaning_of(sent(message), seen)


def flown(meaning: Meaning) -> Sample:
    assert isinstance(meaning, Sample), meaning
    assert meaning.attitude is not None
    assert (meaning.pos_ned, meaning.v_ned, meaning.a_ned, meaning.yaw_rad) == (None,) * 4
    return meaning


@BOTH
def test_every_mask(autopilot: Autopilot) -> None:
    seen, with_rate = hovering(autopilot), FLOWN[autopilot.name]
    for mask in range(256):
        meaning = asked(mask, seen)
        if mask not in with_rate:
            text = refusal(meaning)
            assert text.startswith("UNSUPPORTED"), mask
            assert f"type_mask {mask} " in text
            continue
        sample = flown(meaning)
        assert sample.attitude is not None
        assert sample.attitude.q_ned_from_frd == pytest.approx(FORWARD, abs=1e-6)
        assert sample.attitude.thrust == 0.5
        assert sample.yaw_rate_rad_s == (0.25 if with_rate[mask] else None)


@BOTH
@pytest.mark.parametrize(
    ("mask", "why"),
    [
        (0x87, "leaves out the attitude"),
        (0x80, "leaves out the attitude"),
        (0x47, "leaves out the thrust"),
        (0x27, "three axes"),
        (0x0F, "bits that the standard does not know"),
        (0x17, "bits that the standard does not know"),
    ],
)
def test_a_reason_for_each_bit(autopilot: Autopilot, mask: int, why: str) -> None:
    assert why in refusal(asked(mask, hovering(autopilot)))


def test_rates_beside_an_attitude() -> None:
    """DroneKit's example sends mask 0, or 4, with rates of roll and pitch of 0."""
    assert "takes for a setpoint" in refusal(asked(0, hovering(PX4)))
    assert "takes for a setpoint" in refusal(asked(4, hovering(PX4)))
    assert "all three or none" in refusal(asked(4, hovering(ARDUPILOT)))
    for rates in ((0.1, 0.0, 0.0), (0.0, -0.1, 0.0), (NAN, 0.0, 0.0)):
        turned = asked(0, hovering(ARDUPILOT), rates=rates)
        assert "turns the attitude on" in refusal(turned)
    flown(asked(NO_RATES, hovering(ARDUPILOT), rates=(9.0, NAN, math.inf)))


@BOTH
def test_numbers_that_are_none(autopilot: Autopilot) -> None:
    for q in ((NAN, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, math.inf)):
        assert refusal(asked(NO_RATES, hovering(autopilot), q=q)).startswith("NON_FINITE")
    assert refusal(asked(NO_RATES, hovering(autopilot), thrust=NAN)).startswith("NON_FINITE")
    with_rate = 3 if autopilot is PX4 else 0
    bad = asked(with_rate, hovering(autopilot), rates=(0.0, 0.0, NAN))
    assert refusal(bad).startswith("NON_FINITE")


@BOTH
def test_a_quaternion_has_a_length_of_one(autopilot: Autopilot) -> None:
    """ArduCopter takes it within 1e-3 (from memory)."""
    seen = hovering(autopilot)
    assert "length 0.900" in refusal(asked(NO_RATES, seen, q=(0.9, 0.0, 0.0, 0.0)))
    assert "length 0.000" in refusal(asked(NO_RATES, seen, q=(0.0, 0.0, 0.0, 0.0)))
    nearly = flown(asked(NO_RATES, seen, q=(1.0005, 0.0, 0.0, 0.0)))
    assert nearly.attitude is not None
    assert nearly.attitude.q_ned_from_frd == LEVEL


@BOTH
def test_none_is_flown_unless_the_policy_says_so(autopilot: Autopilot) -> None:
    """Then it takes no control either, as a sample would."""
    for rules in (DEFAULT.stream, None):
        text = refusal(asked(NO_RATES, flying(autopilot, stream=rules)))
        assert text.startswith("POLICY")
        assert "stream.tilt_deg is 0" in text
