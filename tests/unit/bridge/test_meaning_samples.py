"""A sample of a setpoint stream in the operators' frame, by MAVLink's north, east, down."""

from __future__ import annotations

import math

import pytest

from gcs import ipc
from gcs.bridge.judge.motion import stream_of
from gcs.bridge.translate.meaning import Sample
from gcs.gate.attitude import Attitude

HALF = math.sqrt(0.5)


def test_north_east_down_becomes_east_north_up() -> None:
    sample = Sample(pos_ned=(1.0, 2.0, -3.0), v_ned=(4.0, 5.0, 6.0), a_ned=(-7.0, 8.0, -9.0))
    assert stream_of(sample) == ipc.Stream(
        pos_enu=(2.0, 1.0, 3.0), v_enu=(5.0, 4.0, -6.0), a_enu=(8.0, -7.0, 9.0)
    )


def test_angles_become_degrees() -> None:
    told = stream_of(Sample(yaw_rad=math.pi / 2, yaw_rate_rad_s=-math.pi / 4))
    assert told.yaw_deg == pytest.approx(90.0)
    assert told.yaw_rate_deg_s == pytest.approx(-45.0)


def test_what_is_not_given_and_axes_left_out_are_none() -> None:
    sample = Sample(v_ned=(1.0, math.nan, math.nan))
    assert stream_of(sample) == ipc.Stream(v_enu=(None, 1.0, None))


def test_an_attitude_is_roll_pitch_and_yaw_in_degrees() -> None:
    nose_east = Attitude((HALF, 0.0, 0.0, HALF), 0.4)
    told = stream_of(Sample(attitude=nose_east, yaw_rate_rad_s=math.pi))
    assert (told.roll_deg, told.pitch_deg) == pytest.approx((0.0, 0.0))
    assert (told.yaw_deg, told.yaw_rate_deg_s) == pytest.approx((90.0, 180.0))
    assert told.thrust == 0.4
