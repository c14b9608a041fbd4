"""Attitudes that operators stream, as they reach the gate: NED, and as they are on the wire."""

from __future__ import annotations

import math
import struct

import msgspec
import pytest

from gcs import ipc
from gcs.station.streams import Streams

OPERATOR = 1


def on_the_wire(value: float) -> float:
    rounded: float = struct.unpack("<f", struct.pack("<f", value))[0]
    return rounded


def test_an_attitude_is_a_quaternion_as_the_wire_carries_it() -> None:
    """Heading 90 degrees, nose 10 degrees down: Rz(90) Ry(-10)."""
    asked = ipc.Stream(roll_deg=0.0, pitch_deg=-10.0, yaw_deg=90.0, thrust=0.45)
    seen = Streams().seen(OPERATOR, asked, 0)
    assert (seen.pos_ned, seen.v_ned, seen.a_ned, seen.yaw_rad) == (None,) * 4
    assert seen.attitude is not None
    half, turned = math.radians(-5.0), math.radians(45.0)
    q = (
        math.cos(half) * math.cos(turned),
        -math.sin(half) * math.sin(turned),
        math.sin(half) * math.cos(turned),
        math.cos(half) * math.sin(turned),
    )
    assert seen.attitude.q_ned_from_frd == pytest.approx(q, abs=1e-6)
    for number in (*seen.attitude.q_ned_from_frd, seen.attitude.thrust):
        assert number == on_the_wire(number)
    assert seen.attitude.thrust == pytest.approx(0.45)


def test_a_velocity_is_no_attitude() -> None:
    seen = Streams().seen(OPERATOR, ipc.Stream(v_enu=(1.0, 0.0, 0.0), yaw_deg=90.0), 0)
    assert seen.attitude is None
    assert seen.yaw_rad == pytest.approx(math.pi / 2)


@pytest.mark.parametrize("missing", ["roll_deg", "pitch_deg", "yaw_deg", "thrust"])
def test_a_part_that_is_missing_is_no_number(missing: str) -> None:
    whole = ipc.Stream(roll_deg=0.0, pitch_deg=0.0, yaw_deg=0.0, thrust=0.5)
    asked = msgspec.structs.replace(whole, **{missing: None})
    seen = Streams().seen(OPERATOR, asked, 0)
    assert seen.attitude is not None
    assert not all(map(math.isfinite, seen.attitude.numbers))


def test_of_an_attitude_too_one_sample_alone_takes_no_control() -> None:
    streams = Streams()
    whole = ipc.Stream(roll_deg=0.0, pitch_deg=0.0, yaw_deg=0.0, thrust=0.5)
    broken = ipc.Stream(roll_deg=0.0, pitch_deg=0.0, yaw_deg=0.0)
    assert not streams.goes_on(OPERATOR, whole, 0)
    assert not streams.goes_on(OPERATOR, broken, 100_000_000)
    assert streams.goes_on(OPERATOR, whole, 200_000_000)
