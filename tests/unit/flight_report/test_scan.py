"""One pass over a record: what a flight was, from the bytes that the recorder wrote."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.flight_report.facts import (
    Decision,
    Estimator,
    Fact,
    Gps,
    Identity,
    Text,
    Vibration,
)
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.readers.topics import source_of
from gcs.flight_report.render import page
from gcs.flight_report.scan import scan
from gcs.flight_report.summary import (
    consequences,
    main_trouble,
    what_happened,
    what_went_wrong,
)
from gcs.mcap_file.errors import BadRecordError
from gcs.record import ros1
from gcs.record.log_line import read_log_line
from gcs.report import (
    AttachmentItem,
    ConditionItem,
    DecisionItem,
    Direction,
    FenceItem,
    FenceShape,
    FrameItem,
    FsaItem,
    GeodeticItem,
    LogEvent,
    PointEnu,
    PoseItem,
    RecordItem,
    StatusItem,
)
from gcs.wire.dialect import MESSAGES
from gcs.wire.frame import msgid_in
from tests.unit.logfile import tlogs
from tests.unit.record.flights import MS, START_NS, a_flight, decided, frame_v2, record

UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def frame(name: str, layout: str, *values: object, compid: int = 1) -> FrameItem:
    """A frame of that message; `layout` is its payload in wire order."""
    msgid = next(d.msgid for d in MESSAGES.values() if d.name == name)
    raw = frame_v2(msgid, struct.pack(layout, *values), source=(1, compid))
    return FrameItem(0, Direction.RECEIVED, raw)


def heartbeat(autopilot: int = 12, kind: int = 2) -> FrameItem:
    return frame("HEARTBEAT", "<IBBBBB", 0, kind, autopilot, 81, 4, 3)


def gps(fix_type: int, satellites: int) -> FrameItem:
    layout = "<QiiiHHHHBB"
    return frame("GPS_RAW_INT", layout, 0, 0, 0, 0, 80, 100, 0, 0, fix_type, satellites)


def status(*, armed: bool, landed: str, mode: str = "OFFBOARD") -> StatusItem:
    return StatusItem(1, armed, mode, landed, 90.0, 16.0, 200.0, 0.0)


def a_flight_that_loses_gps() -> list[RecordItem]:
    """Half a second a step: 2 s on the ground, a climb to 10 m, GPS lost, a failsafe."""
    items: list[RecordItem] = [
        FenceItem([FenceShape("field", True, [], (0.0, 0.0), 50.0, 0.0, 20.0)], None),
        AttachmentItem("policy.toml", "application/toml", b"margin_h_m = 1.5\n"),
    ]
    for step in range(40):
        up_m = min(10.0, max(0.0, (step - 4) * 1.0))
        armed = step >= 3
        items.append(heartbeat())
        items.append(status(armed=armed, landed="IN_AIR" if step >= 5 else "ON_GROUND"))
        items.append(PoseItem(1, (step * 0.5, 0.0, -up_m), (1.0, 0.0, 0.0), UPRIGHT))
        items.append(gps(3, 10) if step < 25 else gps(1, 0))
        if step == 30:
            text = b"Failsafe activated".ljust(50, b"\0")
            items.append(frame("STATUSTEXT", "<B50sHB", 2, text, 0, 0))
    return items


def scanned(directory: Path, items: Iterable[RecordItem], step_ns: int = 125 * MS) -> Flight:
    return scan(record(directory, items, step_ns))


def vehicle_of(flight: Flight) -> VehicleFlight:
    found = flight.main_vehicle()
    assert found is not None
    return found


def reader_of(topic: str) -> Callable[[bytes], Iterable[Fact]]:
    source = source_of(topic)
    assert source is not None
    assert source.read is not None
    return source.read


class TestFlight:
    @pytest.fixture
    def flight(self, tmp_path: Path) -> Flight:
        return scanned(tmp_path, a_flight_that_loses_gps())

    def test_which_vehicle_it_was(self, flight: Flight) -> None:
        vehicle = vehicle_of(flight)
        assert (vehicle.sysid, vehicle.autopilot, vehicle.kind) == (1, "px4", "quadrotor")

    def test_its_totals(self, flight: Flight) -> None:
        vehicle = vehicle_of(flight)
        totals = vehicle.totals
        assert totals.take_offs == 1
        assert totals.max_up_m == pytest.approx(10.0)
        assert totals.flying_s == pytest.approx(34 * 0.5, abs=0.6)
        assert totals.armed_s == pytest.approx(36 * 0.5, abs=0.6)
        assert totals.max_distance_m == pytest.approx(18.0, abs=0.6)
        assert totals.landed_s is None

    def test_what_went_wrong_first_and_then(self, flight: Flight) -> None:
        vehicle = vehicle_of(flight)
        first = main_trouble(vehicle)
        assert first is not None
        assert first.title == "the GPS lost its fix"
        assert [then.title for then in consequences(vehicle, first)] == [
            "the vehicle's failsafe acted"
        ]
        assert "the GPS lost its fix" in what_went_wrong(flight, vehicle)
        assert "was in the air at the record's end" in what_happened(flight, vehicle)

    def test_its_fence_with_the_margin_of_its_policy(self, flight: Flight) -> None:
        (zone,) = flight.fence.zones
        assert (zone.name, zone.radius_m, zone.ceiling_up_m) == ("field", 50.0, 20.0)
        assert flight.fence.margin_h_m == 1.5

    def test_what_it_said(self, flight: Flight) -> None:
        vehicle = vehicle_of(flight)
        assert [said.text for said in vehicle.said] == ["Failsafe activated"]


class TestPartialRecords:
    def test_one_of_everything(self, tmp_path: Path) -> None:
        flight = scanned(tmp_path, a_flight())
        vehicle = vehicle_of(flight)
        (request,) = vehicle.requests
        assert (request.outcome, request.code) == ("refused", "OUTSIDE_FENCE")
        assert request.goal_enu == (500.0, 0.0, 2.0)

    def test_nothing_at_all(self, tmp_path: Path) -> None:
        flight = scanned(tmp_path, [])
        assert (flight.messages, flight.vehicles, flight.seconds) == (0, {}, 0.0)
        assert "empty" in what_happened(flight, None)

    def test_one_message(self, tmp_path: Path) -> None:
        flight = scanned(tmp_path, [heartbeat()])
        vehicle = vehicle_of(flight)
        assert flight.seconds == 0.0
        assert "never armed" in what_happened(flight, vehicle)

    def test_a_ground_station_alone_is_no_vehicle(self, tmp_path: Path) -> None:
        flight = scanned(tmp_path, [heartbeat(autopilot=8, kind=6)] * 3)
        assert flight.main_vehicle() is None
        assert "No vehicle was heard" in what_happened(flight, None)

    def test_a_flight_without_a_position(self, tmp_path: Path) -> None:
        items: list[RecordItem] = [heartbeat(), status(armed=True, landed="IN_AIR"), heartbeat()]
        vehicle = vehicle_of(scanned(tmp_path, items))
        assert vehicle.track.points == []
        assert vehicle.totals.max_up_m is None

    def test_a_position_that_is_not_finite_is_none(self, tmp_path: Path) -> None:
        nowhere = PoseItem(1, (float("nan"), 0.0, 0.0), (0.0, 0.0, 0.0), UPRIGHT)
        vehicle = vehicle_of(scanned(tmp_path, [status(armed=True, landed="IN_AIR"), nowhere]))
        assert vehicle.track.points == []

    def test_a_file_that_was_not_closed(self, tmp_path: Path) -> None:
        whole = record(tmp_path, a_flight_that_loses_gps(), 125 * MS)
        cut = tmp_path / "cut.mcap"
        cut.write_bytes(whole.read_bytes()[:-4000])
        flight = scan(cut)
        assert not flight.closed
        assert flight.main_vehicle() is not None

    @pytest.mark.parametrize("data", [b"", b"no log at all", b"\x89PNG\r\n\x1a\n" + bytes(100)])
    def test_what_is_no_record(self, tmp_path: Path, data: bytes) -> None:
        path = tmp_path / "what.mcap"
        path.write_bytes(data)
        with pytest.raises(BadRecordError):
            scan(path)

    @pytest.mark.parametrize("name", ["old.tlog", "old.BIN", "old.ulg"])
    def test_what_is_no_log_of_another_format_either(self, tmp_path: Path, name: str) -> None:
        (tmp_path / name).write_bytes(b"anything")
        with pytest.raises(BadRecordError, match=name):
            scan(tmp_path / name)

    def test_a_log_of_another_format_is_read_as_a_record(self, tmp_path: Path) -> None:
        path = tmp_path / "old.tlog"
        path.write_bytes(b"".join(tlogs.stamped(frame) for frame in tlogs.flight(60)))
        flight = scan(path)
        assert (flight.name, set(flight.vehicles)) == ("old.tlog", {1})


class TestRequests:
    @staticmethod
    def told(phase: str, outcome: str, request_id: int = 3) -> DecisionItem:
        verdict = phase == "verdict"
        return decided(
            request_id,
            outcome,
            phase=phase,
            code="" if outcome in ("accepted", "complete") else "TOO_FAR",
            goal=PointEnu(1.0, 2.0, 3.0) if verdict else None,
            numbers={"leg_m": 4.0} if verdict else {},
        )

    def test_verdict_and_ending_are_one_request(self, tmp_path: Path) -> None:
        items = [self.told("verdict", "accepted"), self.told("ending", "complete")]
        vehicle = vehicle_of(scanned(tmp_path, items, 500 * MS))
        (request,) = vehicle.requests
        assert (request.outcome, request.ending) == ("accepted", "complete")
        assert request.goal_enu == (1.0, 2.0, 3.0)
        assert request.ended_s == pytest.approx(request.t_s + 0.5)

    def test_an_ending_whose_verdict_is_missing_is_told_too(self, tmp_path: Path) -> None:
        vehicle = vehicle_of(scanned(tmp_path, [self.told("ending", "timed out")]))
        assert [(r.outcome, r.ending) for r in vehicle.requests] == [("", "timed out")]

    def test_there_is_a_limit(self, tmp_path: Path) -> None:
        items = [self.told("verdict", "refused", number) for number in range(600)]
        vehicle = vehicle_of(scanned(tmp_path, items, MS))
        assert len(vehicle.requests) + vehicle.requests_left_out == 600
        assert vehicle.requests_left_out == 100


class TestReaders:
    """What a message says, as MAVLink's common.xml has its fields and units."""

    @staticmethod
    def read(topic: str, item: FrameItem) -> list[object]:
        length = ros1.full_length(msgid_in(item.raw))
        return list(reader_of(topic)(ros1.codec(length).encode(item.raw, 0, 0)))

    def test_gps_raw_int(self) -> None:
        assert self.read("/mavlink/1/1/GPS_RAW_INT", gps(3, 10)) == [Gps(3, 10, 0.8, None)]

    def test_values_that_are_unknown(self) -> None:
        unknown = frame(
            "GPS_RAW_INT", "<QiiiHHHHBB", 0, 0, 0, 0, 65535, 65535, 65535, 65535, 0, 255
        )
        assert self.read("/mavlink/1/1/GPS_RAW_INT", unknown) == [Gps(0, None, None, None)]

    def test_vibration(self) -> None:
        shaken = frame("VIBRATION", "<Q3f3I", 0, 1.5, 2.5, 3.5, 1, 2, 3)
        assert self.read("/mavlink/1/1/VIBRATION", shaken) == [Vibration(1.5, 2.5, 3.5, 6)]

    def test_estimator_ratios_in_the_order_of_each_message(self) -> None:
        px4 = frame("ESTIMATOR_STATUS", "<Q8fH", 0, 0.5, 0.25, 0.125, 2.0, 9, 9, 9, 9, 0)
        assert self.read("/mavlink/1/1/ESTIMATOR_STATUS", px4) == [
            Estimator("px4", 0.5, 0.25, 0.125, 2.0)
        ]
        copter = frame("EKF_STATUS_REPORT", "<5fH", 0.5, 0.25, 0.125, 2.0, 9.0, 0)
        assert self.read("/mavlink/1/1/EKF_STATUS_REPORT", copter) == [
            Estimator("ardupilot", 0.5, 0.25, 0.125, 2.0)
        ]

    def test_a_heartbeat_of_another_kind(self) -> None:
        assert self.read("/mavlink/1/1/HEARTBEAT", heartbeat(3, 13)) == [
            Identity("ardupilot", "hexarotor")
        ]
        assert self.read("/mavlink/1/1/HEARTBEAT", heartbeat(8, 6)) == []

    def test_a_long_text_is_joined(self) -> None:
        read = reader_of("/mavlink/1/1/STATUSTEXT")
        first, second = (
            frame("STATUSTEXT", "<B50sHB", 3, part.ljust(50, b"\0"), 9, number)
            for number, part in enumerate((b"x" * 50, b"the end"))
        )
        encode = ros1.codec(ros1.full_length(253)).encode
        assert read(encode(first.raw, 0, 0)) == []
        assert read(encode(second.raw, 0, 0)) == [Text(3, "x" * 50 + "the end")]

    def test_other_components_and_topics_are_passed_over(self) -> None:
        assert source_of("/mavlink/1/100/HEARTBEAT") is None
        assert source_of("/tf_static") is None
        assert source_of("/vehicle/x/state") is None

    def test_a_message_that_is_too_short_is_counted(self, tmp_path: Path) -> None:
        read = reader_of("/mavlink/1/1/VIBRATION")
        with pytest.raises(struct.error):
            read(b"\0" * 14)

    def test_a_decision_that_is_none(self) -> None:
        read = reader_of("/gate/decision")
        assert read(b"{}") == []
        assert read(b"\xff") == []
        (fact,) = read(
            b'{"vehicle":1,"request_id":2,"word":"arm","phase":"verdict","outcome":"accepted"}'
        )
        assert isinstance(fact, Decision)


class TestLogLine:
    def test_as_the_sdk_writes_it(self) -> None:
        from foxglove.messages import Log, LogLevel, Timestamp

        line = Log(
            timestamp=Timestamp(1_767_225_600, 5),
            level=LogLevel.Warning,
            message="Grüße <b>",
            name="gate",
            file="x.py",
            line=3,
        )
        assert read_log_line(line.encode()) == (3, "gate", "Grüße <b>")

    @pytest.mark.parametrize("data", [b"\x12", b"\x12\xff\x01", b"\xff" * 12, b"\x17\x01"])
    def test_what_is_none(self, data: bytes) -> None:
        assert read_log_line(data) is None


def test_a_gate_condition_reaches_the_findings(tmp_path: Path) -> None:
    lost = ConditionItem("gps_lost", "HOLD", "no fix, 0 satellites")
    items: list[RecordItem] = [
        heartbeat(),
        status(armed=True, landed="IN_AIR"),
        FsaItem(1, "MOVING", 3, "HOVERING", "goto", "OURS", "NOMINAL", None),
        LogEvent(START_NS, 3, "state_and_safety", "vehicle 1: HOLD: gps_lost: no fix"),
        FsaItem(1, "HOLDING", 13, "MOVING", "must hold", "OURS", "HOLD", None, (lost,)),
        FsaItem(1, "HOLDING", 13, "HOLDING", "reminder", "OURS", "HOLD", None, (lost,)),
    ]
    vehicle = vehicle_of(scanned(tmp_path, items))
    assert [f.title for f in vehicle.went_wrong] == ["the gate called HOLD: the GPS was lost"]
    assert [value for _, value in vehicle.lanes.severity.changes] == ["NOMINAL", "HOLD"]


def test_at_one_time_the_cause_stands_before_what_follows(tmp_path: Path) -> None:
    sentence = "it would come to rest 0.96 m from the edge"
    ending = decided(4, "aborted", phase="ending", code="FENCE_BREACH", sentence=sentence)
    brake = FsaItem(1, "HOLDING", 13, "MOVING", "breach predicted", "OURS", "NOMINAL", None)
    items: list[RecordItem] = [heartbeat(), status(armed=True, landed="IN_AIR"), ending, brake]
    vehicle = vehicle_of(scanned(tmp_path, items, MS))
    assert [finding.title for finding in vehicle.went_wrong] == [
        "the gate braked: it would have come out of the fence",
        "goto #4 was aborted",
    ]
    first = main_trouble(vehicle)
    assert first is not None
    assert [later.title for later in consequences(vehicle, first)] == ["goto #4 was aborted"]


class TestFlightsByHeight:
    """Of a vehicle that does not say whether it is in the air, as that of quad_2015.tlog."""

    @staticmethod
    def flown(tmp_path: Path, heights_m: Iterable[float]) -> VehicleFlight:
        """Half a second a height; armed but for the first and the last."""
        heights = list(heights_m)
        items: list[RecordItem] = [heartbeat(3)]
        for number, up_m in enumerate(heights):
            armed = 0 < number < len(heights) - 1
            items.append(PoseItem(1, (0.0, 0.0, -up_m), (0.0, 0.0, 0.0), UPRIGHT))
            items.append(status(armed=armed, landed="UNDEFINED"))
        return vehicle_of(scanned(tmp_path, items, 250 * MS))

    def test_one_that_never_rises_has_not_flown(self, tmp_path: Path) -> None:
        totals = self.flown(tmp_path, [0.0, 0.0, 0.2, 0.4, 0.2, 0.0, 0.0]).totals
        assert (totals.take_offs, totals.flying_s) == (0, 0.0)
        assert totals.armed_s > 0.0

    def test_a_hop_before_it_is_disarmed_is_no_flight_of_its_own(self, tmp_path: Path) -> None:
        up_m = [0.0, 0.0, 0.7, 5.0, 5.0, 0.4, 0.1, 0.1, 0.6, 0.1, 0.0]
        totals = self.flown(tmp_path, up_m).totals
        assert totals.take_offs == 1
        assert totals.landed_s is not None

    def test_each_arming_may_be_a_flight(self, tmp_path: Path) -> None:
        items: list[RecordItem] = [heartbeat(3)]
        for up_m in (0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 3.0, 0.0):
            items.append(PoseItem(1, (0.0, 0.0, -up_m), (0.0, 0.0, 0.0), UPRIGHT))
            items.append(status(armed=len(items) % 8 != 2, landed="UNDEFINED"))
        assert vehicle_of(scanned(tmp_path, items, 500 * MS)).totals.take_offs == 2


class TestARecordThatBeginsInTheAir:
    @staticmethod
    def flown(tmp_path: Path, alt_rel_m: float | None, *, lands: bool) -> VehicleFlight:
        """At 30, then 35 m above the local origin; the ground is at 20 m."""
        items: list[RecordItem] = [heartbeat(), status(armed=True, landed="IN_AIR")]
        ups_m = (30.0, 30.0, 35.0, 35.0, *((25.0, 20.0, 20.0) if lands else ()))
        for up_m in ups_m:
            if alt_rel_m is not None:
                items.append(GeodeticItem(1, 47.0, 8.0, 500.0, alt_rel_m + up_m - 30.0))
            items.append(PoseItem(1, (0.0, 0.0, -up_m), (0.0, 0.0, 0.0), UPRIGHT))
            items.append(status(armed=True, landed="IN_AIR" if up_m > 20.0 else "ON_GROUND"))
        return vehicle_of(scanned(tmp_path, items, 250 * MS))

    @pytest.mark.parametrize(
        ("alt_rel_m", "lands", "highest_m", "counted_from"),
        [
            (10.0, False, 15.0, "home"),
            (None, True, 15.0, "where it landed"),
            (None, False, 5.0, "where the record begins"),
        ],
    )
    def test_what_its_height_counts_from(
        self,
        tmp_path: Path,
        alt_rel_m: float | None,
        lands: bool,
        highest_m: float,
        counted_from: str,
    ) -> None:
        totals = self.flown(tmp_path, alt_rel_m, lands=lands).totals
        assert totals.began_in_air
        assert totals.max_up_m == pytest.approx(highest_m)
        assert totals.up_from == counted_from


class TestWhatTheVehicleSaid:
    LINE = LogEvent(START_NS, 4, "vehicle", "Failsafe activated")
    """As the import of a log without STATUSTEXT writes it."""

    def test_a_line_of_the_log_where_there_is_no_statustext(self, tmp_path: Path) -> None:
        items: list[RecordItem] = [heartbeat(), status(armed=True, landed="IN_AIR"), self.LINE]
        vehicle = vehicle_of(scanned(tmp_path, items))
        assert [(said.severity, said.text) for said in vehicle.said] == [(3, "Failsafe activated")]
        assert [f.title for f in vehicle.went_wrong] == ["the vehicle's failsafe acted"]

    def test_it_is_not_told_twice(self, tmp_path: Path) -> None:
        text = b"Failsafe activated".ljust(50, b"\0")
        items: list[RecordItem] = [
            heartbeat(),
            status(armed=True, landed="IN_AIR"),
            frame("STATUSTEXT", "<B50sHB", 2, text, 0, 0),
            self.LINE,
        ]
        vehicle = vehicle_of(scanned(tmp_path, items))
        assert len(vehicle.said) == len(vehicle.went_wrong) == 1

    def test_only_what_was_received_is_the_vehicle_s(self, tmp_path: Path) -> None:
        """A bridge answers a client in the vehicle's name, and refuses one that calls itself so."""
        text = b"goto: refused".ljust(50, b"\0")
        answer = frame("STATUSTEXT", "<B50sHB", 4, text, 0, 0)
        items: list[RecordItem] = [
            heartbeat(),
            status(armed=True, landed="IN_AIR"),
            gps(3, 10),
            FrameItem(1, Direction.SENT, answer.raw),
            FrameItem(1, Direction.REFUSED, gps(0, 0).raw),
            FrameItem(1, Direction.REFUSED, heartbeat(3, 1).raw),
        ]
        vehicle = vehicle_of(scanned(tmp_path, items))
        assert (vehicle.autopilot, vehicle.kind) == ("px4", "quadrotor")
        assert vehicle.messages == 2
        assert vehicle.said == []
        assert vehicle.went_wrong == []


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    items = [*a_flight_that_loses_gps(), *a_flight()]
    return record(tmp_path_factory.mktemp("whole"), items, 125 * MS).read_bytes()


@given(st.data())
def test_damage_is_counted_or_told_and_never_a_crash(
    whole: bytes, tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    places = data.draw(st.lists(st.integers(0, len(whole) - 1), max_size=20))
    values = data.draw(st.binary(min_size=len(places), max_size=len(places)))
    damaged = bytearray(whole[: data.draw(st.integers(0, len(whole)))])
    for place, value in zip(places, values, strict=True):
        if place < len(damaged):
            damaged[place] = value
    path = tmp_path_factory.mktemp("damaged") / "damaged.mcap"
    path.write_bytes(damaged)
    try:
        flight = scan(path)
    except BadRecordError:
        return
    assert page(flight).startswith("<!doctype html>")
