"""Facts of imported DataFlash and ULog messages, read by the fields that their schemas list."""

from __future__ import annotations

import struct

import pytest

from gcs.flight_report.facts import Battery, Estimator, Fact, Gps, Text, Vibration
from gcs.flight_report.findings.failsafes import FailsafeDetector
from gcs.flight_report.readers.onboard_logs import ERRORS
from gcs.flight_report.readers.packed_fields import PackedFields
from gcs.flight_report.readers.topics import source_of
from tests.unit.flight_report.facts_in_time import found


def read(topic: str, schema: str, layout: str, *values: object) -> list[Fact]:
    source = source_of(topic, schema.encode())
    assert source is not None
    assert source.read is not None
    return source.read(struct.pack("<" + layout, *values))


class TestDataFlash:
    def test_gps(self) -> None:
        # As GPS is in test.BIN.
        schema = (
            "uint64 TimeUS\nuint8 Status\nuint32 GMS\nuint16 GWk\nuint8 NSats\nfloat64 HDop\n"
            "float64 Lat\n"
        )
        facts = read("/dataflash/GPS", schema, "QBIHBdd", 5, 3, 0, 0, 10, 1.21, -35.3)
        assert facts == [Gps(3, 10, 1.21, None)]

    def test_a_second_receiver_is_passed_over(self) -> None:
        schema = "uint8 I\nuint8 Status\nuint8 NSats\nfloat32 HDop\n"
        assert read("/dataflash/GPS", schema, "BBBf", 1, 3, 10, 1.0) == []

    def test_vibration_of_old_and_new_logs(self) -> None:
        axes = "float32 VibeX\nfloat32 VibeY\nfloat32 VibeZ\n"
        old = axes + "uint32 Clip0\nuint32 Clip1\nuint32 Clip2\n"
        assert read("/dataflash/VIBE", old, "3f3I", 1.0, 2.0, 3.0, 4, 5, 6) == [
            Vibration(1.0, 2.0, 3.0, 15)
        ]
        new = "uint8 IMU\n" + axes + "uint32 Clip\n"
        assert read("/dataflash/VIBE", new, "B3fI", 0, 1.0, 2.0, 3.0, 7) == [
            Vibration(1.0, 2.0, 3.0, 7)
        ]
        assert read("/dataflash/VIBE", new, "B3fI", 1, 1.0, 2.0, 3.0, 7) == []

    def test_estimator_of_the_first_core(self) -> None:
        schema = "uint8 C\nfloat64 SV\nfloat64 SP\nfloat64 SH\nfloat64 SM\n"
        assert read("/dataflash/XKF4", schema, "B4d", 0, 0.1, 0.2, 0.3, 0.4) == [
            Estimator("ardupilot", 0.1, 0.2, 0.3, 0.4)
        ]
        assert read("/dataflash/XKF4", schema, "B4d", 1, 0.1, 0.2, 0.3, 0.4) == []

    def test_battery(self) -> None:
        schema = "uint8 Inst\nfloat32 Volt\nfloat32 Curr\n"
        assert read("/dataflash/BAT", schema, "Bff", 0, 12.5, 8.0) == [Battery(12.5, 8.0, None)]

    @pytest.mark.parametrize("error", ERRORS)
    def test_an_error_is_said_in_the_words_that_findings_know(self, error: tuple[int, int]) -> None:
        facts = read("/dataflash/ERR", "uint8 Subsys\nuint8 ECode\n", "BB", *error)
        (fact,) = facts
        assert isinstance(fact, Text)
        assert len(found(FailsafeDetector(), [(1.0, fact)]).findings) == 1

    def test_an_error_that_is_resolved_is_none(self) -> None:
        assert read("/dataflash/ERR", "uint8 Subsys\nuint8 ECode\n", "BB", 5, 0) == []


class TestULog:
    def test_vibration_is_where_px4s_mavlink_has_it(self) -> None:
        schema = (
            "uint64 timestamp\nuint32 accel_clipping_0\nuint32 accel_clipping_1\n"
            "uint32 accel_clipping_2\nfloat32 accel_vibration_metric\n"
        )
        facts = read("/ulog/vehicle_imu_status_0", schema, "Q3If", 9, 1, 0, 1, 1.5)
        assert facts == [Vibration(0.0, 0.0, 1.5, 2)]

    def test_gps_without_a_dilution(self) -> None:
        schema = "float32 eph\nuint8 fix_type\nuint8 satellites_used\n"
        facts = read("/ulog/vehicle_gps_position_0", schema, "fBB", 0.5, 3, 12)
        assert facts == [Gps(3, 12, None, 0.5)]

    def test_estimator(self) -> None:
        schema = "".join(f"float32 {name}_test_ratio\n" for name in ("mag", "vel", "pos", "hgt"))
        nan = float("nan")
        facts = read("/ulog/estimator_status_0", schema, "4f", 0.5, 0.25, 0.125, nan)
        assert facts == [Estimator("px4", 0.25, 0.125, None, 0.5)]

    def test_battery_share_is_a_percentage(self) -> None:
        schema = "float32 voltage_v\nfloat32 current_a\nfloat32 remaining\n"
        facts = read("/ulog/battery_status_0", schema, "3f", 15.5, 4.0, 0.5)
        assert facts == [Battery(15.5, 4.0, 50.0)]


class TestPackedFields:
    def test_texts_and_arrays_take_their_room(self) -> None:
        schema = b"string name # text of 5 bytes\nint16[3] raw\nuint8 last\n"
        data = struct.pack("<I5s3hB", 5, b"ab", 1, 2, 3, 42)
        assert PackedFields(schema).value("last")(data) == 42.0
        assert PackedFields(schema).value("raw")(data) == 1.0

    def test_a_field_that_is_not_there(self) -> None:
        assert PackedFields(b"uint8 a\n").value("b")(b"\1") is None
        assert PackedFields(b"uint8 a\n").value("b", "a")(b"\1") == 1.0

    @pytest.mark.parametrize("schema", [b"Header header\n", b"string name\n", b"time stamp\n"])
    def test_another_schema_has_no_reader(self, schema: bytes) -> None:
        assert source_of("/dataflash/GPS", schema) is None

    def test_topics_that_are_not_used(self) -> None:
        assert source_of("/dataflash/UNIT", b"uint8 a\n") is None
        assert source_of("/ulog/cpuload_0", b"uint8 a\n") is None
