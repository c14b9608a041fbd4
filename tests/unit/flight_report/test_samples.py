"""What is shown as it was told: sampled plots, the spectrum, parameters, the mission."""

from __future__ import annotations

from math import pi, sin
from pathlib import Path

import pytest

from gcs.flight_report.drift import drift_before
from gcs.flight_report.facts import Clock, Fact, Pose, Sample
from gcs.flight_report.findings.clock import ClockDetector
from gcs.flight_report.findings.finding import Finding, Level
from gcs.flight_report.findings.motors import MotorsDetector
from gcs.flight_report.findings.wind import WindDetector
from gcs.flight_report.flight import ParameterSeen, VehicleFlight
from gcs.flight_report.page.parameters_html import differing, parameters
from gcs.flight_report.readers.mavlink_samples import version_text, wind
from gcs.flight_report.render import page
from gcs.flight_report.sampled import Sampled
from gcs.flight_report.spectrum import SEGMENT, Spectrum
from gcs.report import GeodeticItem, PoseItem, RecordItem, StatusItem
from tests.unit.flight_report.facts_in_time import flying, found, levels
from tests.unit.flight_report.test_scan import (
    UPRIGHT,
    frame,
    heartbeat,
    scanned,
    status,
    vehicle_of,
)
from tests.unit.record.flights import MS

HOVER = Pose((0.0, 0.0, 5.0), 0.1, 0.0, 0.0, 0.0, 0.0)


def motors(values: tuple[float, ...], begin_s: float, end_s: float) -> list[tuple[float, Fact]]:
    """At 10 Hz."""
    times = (begin_s + n / 10 for n in range(round(10 * (end_s - begin_s))))
    return [(t_s, Sample("motors", values)) for t_s in times]


class TestSampled:
    def test_a_row_comes_with_its_leading_message_and_has_what_was_told_last(self) -> None:
        sampled = Sampled.of("rates")
        sampled.take(0.0, 3, (1.0, 2.0, 3.0), leads=False)
        sampled.take(0.1, 0, (4.0, 5.0, 6.0), leads=True)
        sampled.take(9.0, 0, (7.0, 8.0, 9.0), leads=True)
        rows = [values for _, values in sampled.series.rows() if any(values)]
        assert rows == [[4.0, 5.0, 6.0, 1.0, 2.0, 3.0], [7.0, 8.0, 9.0, None, None, None]]


class TestSpectrum:
    @staticmethod
    def shaken(rate_hz: float, at_hz: float) -> Spectrum:
        spectrum = Spectrum()
        for number in range(2 * SEGMENT):
            t_s = number / rate_hz
            spectrum.add(t_s, (0.0, 0.0, -9.8 + 2.0 * sin(2 * pi * at_hz * t_s)))
        return spectrum

    def test_a_sine_is_found_at_its_frequency_with_its_amplitude(self) -> None:
        spectrum = self.shaken(256.0, 50.0)
        hertz, (x, _, z) = max(spectrum.amplitudes(), key=lambda row: row[1][2])
        assert hertz == pytest.approx(50.0, abs=1.0)
        assert z == pytest.approx(2.0, rel=0.02)
        assert x == pytest.approx(0.0, abs=1e-9)
        assert spectrum.segments == 2

    def test_samples_that_come_too_slowly_show_no_rotor(self) -> None:
        spectrum = self.shaken(10.0, 3.0)
        assert spectrum.too_slow
        assert spectrum.amplitudes() == []

    def test_a_stretch_with_a_gap_is_dropped(self) -> None:
        spectrum = Spectrum()
        for number in range(SEGMENT):
            spectrum.add(number / 200.0 + (number > 100), (0.0, 0.0, 1.0))
        assert spectrum.segments == 0


class TestMotors:
    @pytest.mark.parametrize(
        ("values", "title"),
        [
            ((50.0, 52.0, 55.0, 50.0), ""),
            ((50.0, 50.0, 60.0, 50.0), "motor 3 had to give more than the rest"),
            ((60.0, 50.0, 60.0, 50.0), "motors 1 and 3 had to give more than the rest"),
            ((90.0, 10.0, 90.0, 90.0), "motors 1 and 3 and 4 had to give far more than the rest"),
        ],
    )
    def test_one_that_gives_more_than_the_others(
        self, values: tuple[float, ...], title: str
    ) -> None:
        facts: list[tuple[float, Fact]] = [(0.0, HOVER), *motors(values, 0.0, 14.0)]
        findings = found(MotorsDetector(), facts).findings
        assert (findings[0].title if findings else "") == title

    @pytest.mark.parametrize(("after", "way"), [(60.0, "more"), (40.0, "less"), (55.0, "")])
    def test_hovering_that_takes_more_or_less_at_once(self, after: float, way: str) -> None:
        facts: list[tuple[float, Fact]] = [
            (0.0, HOVER),
            *motors((50.0,) * 4, 0.0, 6.0),
            *motors((after,) * 4, 6.0, 16.0),
        ]
        titles = [f.title for f in found(MotorsDetector(), facts).findings]
        assert titles == ([f"hovering took {way} thrust at once"] if way else [])

    def test_what_a_touch_down_follows_is_no_hover(self) -> None:
        """As in the logs of a real PX4: the motors idle before it knows that it stands."""
        detector, now = MotorsDetector(), flying()
        idle = motors((5.0, 30.0, 30.0, 5.0), 10.0, 13.0)
        for t_s, fact in [(0.0, HOVER), *motors((50.0,) * 4, 0.0, 10.0), *idle]:
            now.t_s = t_s
            detector.handle(fact, now)
        now.t_s, now.in_air = 13.0, False
        detector.handle(Sample("motors", (5.0,) * 4), now)
        assert detector.result(now).findings == []

    def test_a_battery_that_empties_takes_more_slowly(self) -> None:
        facts: list[tuple[float, Fact]] = [(0.0, HOVER)]
        for minute in range(10):
            facts += motors((50.0 + 2.0 * minute,) * 4, 60.0 * minute, 60.0 * minute + 60.0)
        assert found(MotorsDetector(), facts).findings == []


class TestClock:
    @pytest.mark.parametrize(
        ("facts", "expected"),
        [
            ([(0.0, 10.0), (1.0, 11.0), (2.0, 11.9), (2.1, 11.8)], []),
            ([(0.0, 10.0), (1.0, 0.5)], [(1.0, Level.CRITICAL)]),
            ([(0.0, 10.0), (600.0, 0.5)], [(600.0, Level.NOTE)]),
            ([(0.0, 10.0), (1.0, 111.0)], [(1.0, Level.WARNING)]),
        ],
    )
    def test_restarts_and_jumps(
        self, facts: list[tuple[float, float]], expected: list[tuple[float, Level]]
    ) -> None:
        told = [(t_s, Clock(boot_s)) for t_s, boot_s in facts]
        assert levels(found(ClockDetector(), told)) == expected


def test_the_wind_comes_from_where_it_does_not_go() -> None:
    blows_east = wind(9.0, 0.0)
    assert blows_east.values == pytest.approx((9.0, 270.0))
    # 8 m/s is mission_wind_m_s of default.toml.
    assert levels(found(WindDetector(), [(1.0, blows_east)])) == [(1.0, Level.WARNING)]
    on_the_ground = flying()
    on_the_ground.in_air = False
    assert found(WindDetector(), [(1.0, blows_east)], on_the_ground).findings == []


@pytest.mark.parametrize(
    ("packed", "told"),
    [(0x010E03FF, "1.14.3"), (0x04070000, "4.7.0 dev"), (0x010F0080, "1.15.0 beta")],
)
def test_versions(packed: int, told: str) -> None:
    # FIRMWARE_VERSION_TYPE: 0 dev, 64 alpha, 128 beta, 192 rc, 255 official.
    assert version_text(packed) == told


class TestParameters:
    def test_those_that_differ_and_those_that_changed(self) -> None:
        vehicle = VehicleFlight(1)
        for name, values, default in (
            ("KEPT", (1.0,), 1.0),
            ("ROUNDED", (0.1,), 0.10000000149),
            ("OTHER", (2.0,), 1.0),
            ("CAL_MAG0_ID", (7.0,), 0.0),
            ("CHANGED", (3.0, 4.0), 4.0),
        ):
            seen = vehicle.parameters.setdefault(name, ParameterSeen())
            for number, value in enumerate(values):
                seen.told(60.0 * number, value, default)
        assert [name for name, _ in differing(vehicle)] == ["CAL_MAG0_ID", "OTHER"]
        html = parameters(vehicle)
        assert "Of 5 parameters 1 differ from their default, and 1 that calibration" in html
        assert "CHANGED from 3 to 4 at 1:00.0" in html

    def test_a_record_that_does_not_know_the_defaults_says_so(self) -> None:
        vehicle = VehicleFlight(1)
        vehicle.parameters["A"] = ParameterSeen(1.0, 1.0)
        assert "does not say what their defaults are" in parameters(vehicle)


def test_the_mission_is_placed_by_a_position_that_is_known_in_both_frames(tmp_path: Path) -> None:
    """A thousandth of a degree of latitude is 111.2 m; a height is above home, or the sea."""
    layout = "<4fiifHHBBBBB"

    def item(seq: int, lat: int, alt_m: float, frame_: int, command: int = 16) -> RecordItem:
        place = (lat, 80_000_000, alt_m)
        return frame(
            "MISSION_ITEM_INT", layout, *(0.0,) * 4, *place, seq, command, 1, 1, frame_, 0, 1
        )

    position = (0, 470_000_000, 80_000_000, 510_000, 10_000, 0, 0, 0, 0)
    items: list[RecordItem] = [
        heartbeat(),
        GeodeticItem(1, 47.0, 8.0, 510.0, 10.0),
        PoseItem(1, (5.0, 3.0, -12.0), (0.0, 0.0, 0.0), UPRIGHT),
        status(armed=True, landed="IN_AIR"),
        frame("GLOBAL_POSITION_INT", "<IiiiihhhH", *position),
        item(0, 470_010_000, 20.0, 3),
        item(1, 470_000_000, 520.0, 0),
        item(2, 470_000_000, 0.0, 3, command=178),
    ]
    plan = vehicle_of(scanned(tmp_path, items, 250 * MS)).plan
    assert plan == [
        pytest.approx((3.0, 5.0 + 111.2, 22.0), abs=0.05),
        pytest.approx((3.0, 5.0, 22.0), abs=0.05),
    ]


class TestDrift:
    @staticmethod
    def told(east_m: list[float], goals_m: list[float]) -> str:
        """A second a place; the trouble comes with the last."""
        vehicle = VehicleFlight(1)
        place = vehicle.plots.sampled["place"]
        vehicle.plots.sampled["wind"].take(0.0, 0, wind(6.0, 0.0).values, leads=True)
        for number, (east, goal) in enumerate(zip(east_m, goals_m, strict=True)):
            place.take(float(number), 3, (goal, 0.0, 5.0), leads=False)
            place.take(float(number), 0, (east, 0.0, 5.0), leads=True)
        trouble = Finding("gps", Level.WARNING, len(east_m) - 1.0, "the GPS lost its fix")
        return drift_before(vehicle, trouble)

    def test_who_is_blown_off_its_place(self) -> None:
        told = self.told([0.0, 0.5, 1.5, 2.5], [0.0] * 4)
        assert "drifted 2.5 m to the east" in told
        assert "a wind of 6 m/s from the west" in told

    def test_who_stays_or_is_on_its_way_does_not_drift(self) -> None:
        assert self.told([0.0, 0.5, 0.2], [0.0] * 3) == ""
        assert self.told([0.0, 3.0, 6.0], [12.0] * 3) == ""
        assert self.told([0.0, 3.0, 6.0], [0.0, 12.0, 12.0]) == ""


class TestSeveralVehicles:
    def test_all_that_flew_are_on_one_page_unless_one_is_chosen(self, tmp_path: Path) -> None:
        items: list[RecordItem] = []
        for number in range(12):
            for sysid in (1, 2):
                landed = "IN_AIR" if number > 1 else "ON_GROUND"
                at = (float(number), 10.0 * sysid, -5.0)
                items.append(PoseItem(sysid, at, (1.0, 0.0, 0.0), UPRIGHT))
                items.append(StatusItem(sysid, True, "OFFBOARD", landed, 90.0, 16.0, 200.0, 0.0))
        flight = scanned(tmp_path, items, 250 * MS)
        html = page(flight)
        assert html.count("WHAT WENT WRONG".capitalize()) == html.count('class="lead"') == 2
        assert 'id="path-1"' in html
        assert 'id="path-2"' in html
        assert html.count("<canvas") == 1
        flight.chosen = 2
        chosen = page(flight)
        assert 'id="path"' in chosen
        assert "Also in the record: Vehicle 1" in chosen
