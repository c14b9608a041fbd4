"""The Python library, over a scripted station: what a request returns, and what it raises."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable

import pytest

import gcs
from gcs import ipc
from gcs.operator.client import StationEnded, StationEvent
from tests.unit.operator.fake_station import FakeStation


class FakeWay:
    """Hands the fake station's answers to the listener at once; time passes with `tick`."""

    def __init__(self, scenario: str = "airborne") -> None:
        self.station = FakeStation(scenario)
        self.sent: list[ipc.Command] = []
        self.was_sent = threading.Event()
        self.closed = 0
        self.time_s = 0.0
        self._tell: Callable[[StationEvent], None] = lambda _: None
        self._order = threading.Lock()

    def listen(self, on_event: Callable[[StationEvent], None]) -> None:
        self._tell = on_event
        self.tell(*self.station.hello(), self.station.snapshot())

    def tell(self, *events: StationEvent) -> None:
        for event in events:
            self._tell(event)

    def send(self, command: ipc.Command) -> bool:
        if self.closed:
            return False
        with self._order:
            self.sent.append(command)
            self.tell(*self.station.handle(command, self.time_s))
        self.was_sent.set()
        return True

    def tick(self, count: int = 1) -> None:
        with self._order:
            for _ in range(count):
                self.time_s += 0.1
                self.tell(*self.station.tick(self.time_s))

    def close(self) -> StationEnded:
        self.closed += 1
        ended = StationEnded(ipc.Bye(0, "logs/x.mcap", "left"), 0, "")
        self.tell(ended)
        return ended


def flying() -> tuple[gcs.Station, FakeWay]:
    way = FakeWay()
    station = gcs.Station(way)
    station.control()
    return station, way


def message(name: str, **fields: float) -> ipc.MessageEvent:
    return ipc.MessageEvent(name, 0, 1, 1, dict(fields))


def test_nothing_of_it_is_loaded_by_the_import_alone() -> None:
    names = {
        "columns": "gcs.logfile.columns.read",
        "connect": "gcs.operator.connect",
        "Station": "gcs.operator.station",
    }
    for name in gcs.__all__:
        home = names.get(name, "gcs.operator." + ("station" if name == "Operation" else "failures"))
        assert getattr(gcs, name).__module__ == home
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        getattr(gcs, "nothing")  # noqa: B009
    assert "gcs.operator.failures" in sys.modules


def test_a_request_that_is_complete_returns_what_it_was() -> None:
    station, way = flying()
    done = station.resume()
    assert (done.state, str(done)) == ("complete", "<Operation 0 resume: complete>")
    assert way.sent[-1] == ipc.Ask(2, "resume")


def test_a_refusal_has_its_code_its_sentence_and_its_numbers() -> None:
    station, way = flying()
    with pytest.raises(gcs.Refused) as refused:
        station.goto(500.0, 0.0, 2.0)
    assert (refused.value.code, refused.value.sentence) == (
        "OUTSIDE_FENCE",
        "350 m outside the fence `circle`",
    )
    way.tell(ipc.VerdictEvent(3, "goto", "refused"))  # no request of that number is open
    assert str(refused.value) == "OUTSIDE_FENCE: 350 m outside the fence `circle`"


def test_what_is_no_number_goes_to_the_gate_as_null() -> None:
    station, way = flying()
    with pytest.raises(gcs.Refused, match="NON_FINITE"):
        station.goto(float("nan"), 0.0, 2.0)
    assert way.sent[-1] == ipc.Ask(2, "goto", goal_enu=(None, 0.0, 2.0))


def test_an_orbit_without_an_end_is_not_waited_for() -> None:
    station, way = flying()
    station.orbit(-10.0, 2.0, (0.0, 20.0, 5.0), nose="along", wait=False)
    circle = ipc.Circle((0.0, 20.0, 5.0), -10.0, 2.0, 0.0, "along")
    assert way.sent[-1] == ipc.Ask(2, "orbit", orbit=circle)
    with pytest.raises(ValueError, match="finite"):
        station.orbit(float("nan"), 2.0)


def test_an_operation_can_be_waited_for_later() -> None:
    station, way = flying()
    flight = station.goto(3.0, 0.0, 2.0, wait=False)
    assert flight.state == "running"
    way.tick(30)
    assert flight.wait().state == "complete"
    assert station.position_enu == (3.0, 0.0, 2.0)


def test_the_time_to_wait_is_not_the_operation_s_own() -> None:
    station, way = flying()
    with pytest.raises(gcs.NotCompleted) as late:
        station.goto(3.0, 0.0, 2.0, timeout_s=0.01)
    assert late.value.state == "running"
    assert "goto 3 0 2 is still under way after" in str(late.value)
    way.tick(30)
    assert station.state == "HOVERING"


def test_an_abort_in_another_thread_ends_the_goto_that_is_waited_for() -> None:
    station, way = flying()
    raised: list[gcs.NotCompleted] = []

    def fly() -> None:
        with pytest.raises(gcs.NotCompleted) as ended:
            station.goto(100.0, 0.0, 2.0)
        raised.append(ended.value)

    way.was_sent.clear()
    flight = threading.Thread(target=fly)
    flight.start()
    assert way.was_sent.wait(60.0)
    assert station.abort().state == "complete"
    flight.join(60.0)
    assert [(each.state, each.code) for each in raised] == [("aborted", "OPERATOR")]


def test_the_state_is_the_one_that_a_request_led_to_before_any_snapshot() -> None:
    station, _ = flying()
    assert station.state == "HOVERING"
    station.hold()
    assert station.state == "HOLDING"


def test_one_operation_is_stopped_by_its_number() -> None:
    station, way = flying()
    flight = station.goto(3.0, 0.0, 2.0, wait=False)
    way.tell(ipc.VerdictEvent(2, "goto", "accepted", operation=17))
    assert flight.id == 17
    flight.stop()
    assert way.sent[-1] == ipc.Ask(3, "abort", operation=17)


def test_telemetry_is_subscribed_to_once_and_then_the_latest() -> None:
    station, way = flying()
    way.tell(message("BATTERY_STATUS", battery_remaining=90.0))
    station.telemetry("BATTERY_STATUS")
    way.sent.clear()
    way.tell(message("BATTERY_STATUS", battery_remaining=80.0))
    assert station.telemetry("BATTERY_STATUS") == {"battery_remaining": 80.0}
    assert way.sent == []
    with pytest.raises(TimeoutError, match=r"no ALTITUDE was heard within 0\.01 s"):
        station.telemetry("ALTITUDE", 0.01)
    assert way.sent == [ipc.Subscribe(["ALTITUDE"])]


def test_a_message_that_does_not_exist_is_a_wrong_value() -> None:
    station, way = flying()
    threading.Timer(0.05, way.tell, (ipc.Trouble("no such MAVLink message: BATTERY"),)).start()
    with pytest.raises(ValueError, match="no such MAVLink message: BATTERY"):
        station.telemetry("BATTERY", 5.0)


def test_events_are_those_from_now_on_until_it_is_left() -> None:
    station, way = flying()
    events = station.events()
    station.resume()
    station.close()
    kinds = [type(event) for event in events]
    assert kinds == [ipc.VerdictEvent, ipc.EndingEvent, ipc.Bye]
    assert way.closed == 1


def test_a_with_block_leaves_at_its_end_and_once() -> None:
    way = FakeWay()
    with gcs.Station(way) as station:
        station.close()
    assert way.closed == 1
    assert way.sent == [ipc.Leave("the program ends")]
    with pytest.raises(gcs.Disconnected, match="this program has left the station"):
        station.land()


def test_a_station_that_ends_is_told_to_whoever_waits() -> None:
    station, way = flying()
    flight = station.goto(3.0, 0.0, 2.0, wait=False)
    way.tell(StationEnded(None, 1, "Traceback"))
    with pytest.raises(
        gcs.Disconnected, match=r"the link process died .* is not known: it was not read"
    ):
        flight.wait()


def test_who_is_in_control_is_known() -> None:
    station, way = flying()
    assert station.in_control
    way.tell(ipc.Operators([ipc.OperatorInfo(1, "me"), ipc.OperatorInfo(2, "you")], 2))
    assert not station.in_control
