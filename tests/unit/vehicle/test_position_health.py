"""GPS and estimator: conditions of what real autopilots were recorded to tell."""

from __future__ import annotations

import math

import pytest

from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged
from gcs.protocol.autopilot import ARDUPILOT, PX4
from gcs.session.work import GateInput
from gcs.vehicle.message_to_telemetry import updates
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.messages import EkfStatusReport, EstimatorStatus, GpsRawInt, Message, SysStatus
from tests.unit.station.vehicles import SECOND_NS, vehicle

GOOD, STARTING = 831, 164
"""Flags of px4_1_14_flight.tlog, flying and 2 s after its start; ArduCopter 4.7's good is 831 too.
(arducopter_4_7_flight.tlog)."""
CONST_POS_MODE, GPS_GLITCH, EKF_GPS_GLITCHING = 0x80, 0x400, 0x8000
GPS_BIT, AHRS_BIT = 0x20, 0x20_0000


def gps(fix_type: int, satellites: int = 10, h_acc_mm: int = 900) -> GpsRawInt:
    """PX4 1.14.3's, but for the fix."""
    return GpsRawInt(
        time_usec=1_032_000,
        lat=473977408,
        lon=85455920,
        alt=31914,
        eph=70,
        epv=110,
        vel=3,
        cog=35618,
        fix_type=fix_type,
        satellites_visible=satellites,
        h_acc=h_acc_mm,
    )


def px4(flags: int, ratio: float = 0.03, accuracy_m: float = 0.32) -> EstimatorStatus:
    return EstimatorStatus(
        time_usec=0,
        vel_ratio=ratio,
        pos_horiz_ratio=0.03,
        pos_vert_ratio=0.05,
        mag_ratio=0.13,
        hagl_ratio=0.0,
        tas_ratio=0.0,
        pos_horiz_accuracy=accuracy_m,
        pos_vert_accuracy=0.33,
        flags=flags,
    )


def arducopter(flags: int, variance: float = 0.015) -> EkfStatusReport:
    return EkfStatusReport(
        velocity_variance=variance,
        pos_horiz_variance=0.004,
        pos_vert_variance=0.00001,
        compass_variance=0.008,
        terrain_alt_variance=0.0,
        flags=flags,
    )


def sensors(enabled: int, health: int) -> SysStatus:
    return SysStatus(
        onboard_control_sensors_present=enabled,
        onboard_control_sensors_enabled=enabled,
        onboard_control_sensors_health=health,
        load=0,
        voltage_battery=16_000,
        current_battery=-1,
        drop_rate_comm=0,
        errors_comm=0,
        errors_count1=0,
        errors_count2=0,
        errors_count3=0,
        errors_count4=0,
        battery_remaining=-1,
    )


class Script:
    """A vehicle, and which conditions are active of what it told."""

    def __init__(self, telemetry: Telemetry | None = None, *, armed: bool = True) -> None:
        self.telemetry = telemetry or vehicle()
        self.telemetry.armed = armed
        self.now_ns = SECOND_NS
        self.active: dict[Condition, str] = {}

    def hear(self, *messages: Message) -> Script:
        for message in messages:
            self.now_ns += SECOND_NS // 2
            self._take(updates(message, self.telemetry, self.now_ns))
        return self

    def wait(self, seconds: float, *, positions: bool = True) -> Script:
        self.now_ns += round(seconds * SECOND_NS)
        silent = self.telemetry.health.gps_silent
        self._take(silent(3 * SECOND_NS, self.now_ns, positions=positions))
        return self

    def _take(self, found: object) -> None:
        for item in found:  # type: ignore[attr-defined]
            if isinstance(item, GateInput) and isinstance(item.given, ConditionChanged):
                self.active.pop(item.given.condition, None)
                if item.given.active:
                    self.active[item.given.condition] = item.given.text


# ------------------------------------------------------------------------------------ gps


@pytest.mark.parametrize("fix_type", [3, 4, 5, 6, 8])
def test_a_fix_is_nothing_to_tell(fix_type: int) -> None:
    """3 is PX4's, 6 ArduCopter's, as recorded."""
    assert Script().hear(gps(fix_type)).active == {}


@pytest.mark.parametrize("fix_type", [0, 1, 2])
def test_a_fix_that_is_lost_is_a_condition_until_it_is_back(fix_type: int) -> None:
    script = Script().hear(gps(3), gps(fix_type, 4))
    assert set(script.active) == {Condition.GPS_LOST}
    assert "4 satellites" in script.active[Condition.GPS_LOST]
    assert script.hear(gps(3)).active == {}


def test_a_vehicle_that_starts_up_has_lost_nothing() -> None:
    assert Script(armed=False).hear(gps(0), gps(1), gps(1)).active == {}


def test_a_vehicle_without_a_receiver_may_fly_indoors() -> None:
    assert Script().hear(sensors(0, 0), gps(0), gps(0)).active == {}


def test_a_vehicle_that_is_met_in_the_air_without_its_fix_has_lost_it() -> None:
    script = Script().hear(sensors(GPS_BIT, 0), gps(1))
    assert set(script.active) == {Condition.GPS_LOST}


def test_a_receiver_that_is_told_of_no_more_is_lost() -> None:
    script = Script().hear(gps(3))
    assert script.wait(2.9).active == {}
    assert set(script.wait(0.2).active) == {Condition.GPS_LOST}
    assert script.hear(gps(3)).active == {}


def test_where_gps_raw_int_does_not_come_the_health_bit_counts() -> None:
    script = Script().hear(sensors(GPS_BIT, GPS_BIT), sensors(GPS_BIT, 0))
    assert set(script.active) == {Condition.GPS_LOST}
    assert Script().hear(gps(3), sensors(GPS_BIT, 0)).active == {}


# ------------------------------------------------------------------------------ estimator


def test_a_good_estimator_is_nothing_to_tell() -> None:
    assert Script().hear(px4(GOOD), px4(GOOD)).active == {}
    assert Script(vehicle(ARDUPILOT)).hear(arducopter(GOOD), arducopter(GOOD)).active == {}


BAD: list[tuple[Message, str]] = [
    (px4(GOOD & ~1), "no attitude"),
    (px4(GOOD & ~2), "no horizontal velocity"),
    (px4(GOOD & ~0x18), "no horizontal position"),
    (px4(GOOD | CONST_POS_MODE), "held constant"),
    (px4(GOOD | GPS_GLITCH), "GPS glitch"),
    (px4(GOOD, ratio=1.2), "velocity disagrees"),
    (px4(GOOD, accuracy_m=7.0), "known to 7 m"),
    (arducopter(GOOD & ~0x18), "no horizontal position"),
    (arducopter(GOOD | EKF_GPS_GLITCHING), "GPS glitch"),
    (arducopter(GOOD | CONST_POS_MODE), "held constant"),
    (arducopter(GOOD, variance=1.1), "velocity disagrees"),
]


@pytest.mark.parametrize(("message", "word"), BAD)
def test_an_estimator_in_trouble_is_a_condition_in_its_words(message: Message, word: str) -> None:
    good = px4(GOOD) if isinstance(message, EstimatorStatus) else arducopter(GOOD)
    script = Script().hear(good, message)
    assert script.active == {}, "one report alone may be a spike"
    script.hear(message)
    assert word in script.active[Condition.ESTIMATOR_UNRELIABLE]
    assert word in script.telemetry.health.estimator.words
    assert script.hear(good).active == {}
    assert script.telemetry.health.estimator.words == "ok"


def test_dead_reckoning_that_is_still_good_is_none_of_the_estimator_s_troubles() -> None:
    """The absolute position is lost, the relative one is not; the lost fix is a condition."""
    relative_only = GOOD & ~0x10
    assert Script().hear(px4(GOOD), px4(relative_only), px4(relative_only)).active == {}


def test_an_estimator_that_starts_up_is_not_in_trouble() -> None:
    starting = px4(STARTING, ratio=math.nan)
    assert Script(armed=False).hear(starting, starting, starting).active == {}
    assert set(Script(armed=True).hear(starting, starting).active) == {
        Condition.ESTIMATOR_UNRELIABLE
    }


def test_where_neither_report_comes_the_health_bit_counts() -> None:
    script = Script().hear(sensors(AHRS_BIT, AHRS_BIT), sensors(AHRS_BIT, 0))
    assert set(script.active) == {Condition.ESTIMATOR_UNRELIABLE}
    assert Script().hear(px4(GOOD), sensors(AHRS_BIT, 0)).active == {}


def test_real_health_bits_of_flying_vehicles_are_no_trouble() -> None:
    """SYS_STATUS of both tlogs, in flight."""
    px4_bits = sensors(0x220_002D, 0x3220_803F)
    assert Script(vehicle(PX4)).hear(px4_bits, px4_bits).active == {}
    ardu_bits = sensors(0x5361_FC2F, 0x5771_FC2F)
    assert Script(vehicle(ARDUPILOT)).hear(ardu_bits, ardu_bits).active == {}


def test_what_sys_status_calls_healthy_is_not_an_estimator_that_was_good() -> None:
    """ArduCopter 4.7, recorded from 17 to 38 s after its start: AHRS is healthy, and
    EKF_STATUS_REPORT says 0xa7, with the position held constant."""
    starting = Script(vehicle(ARDUPILOT), armed=False)
    held = arducopter(0xA7)
    assert starting.hear(sensors(0x20_0000, 0x20_0000), held, held, held).active == {}
    starting.hear(arducopter(0x33F), held, held)
    assert set(starting.active) == {Condition.ESTIMATOR_UNRELIABLE}


def test_a_receiver_is_not_silent_where_the_link_was() -> None:
    script = Script().hear(gps(3))
    script.wait(1.5, positions=False).wait(1.5, positions=False).wait(0.1).wait(1.0).wait(1.0)
    assert script.active == {}
    assert set(script.wait(1.0).active) == {Condition.GPS_LOST}


# ---------------------------------------------------------------------------------- words


@pytest.mark.parametrize(
    ("fix_type", "satellites", "words"),
    [
        (3, 10, "3D fix, 10 satellites"),
        (1, 0, "no fix, 0 satellites"),
        (6, 255, "RTK fix"),
        (9, 7, "fix 9, 7 satellites"),
    ],
)
def test_the_receiver_in_words(fix_type: int, satellites: int, words: str) -> None:
    assert Script().hear(gps(fix_type, satellites)).telemetry.health.gps.words == words
