"""The Python library, over a scripted station: what a request returns, and what it raises."""

from __future__ import annotations

import math
import sys
import threading
from collections.abc import Callable
from fractions import Fraction

import msgspec
import numpy as np
import pytest

import gcs
from gcs import ipc
from gcs.operator.client import StationEnded, StationEvent
from gcs.operator.stream import Stream
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
        "Operation": "gcs.operator.operation",
        "AsyncOperation": "gcs.operator.async_station",
        "AsyncStation": "gcs.operator.async_station",
        "aconnect": "gcs.operator.async_station",
        "Station": "gcs.operator.station",
    }
    for name in gcs.__all__:
        home = names.get(name, "gcs.operator.failures")
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
    station.orbit(-10.0, 2.0, (0.0, 20.0, 5.0), turns=0, nose="along")
    circle = ipc.Circle((0.0, 20.0, 5.0), -10.0, 2.0, 0.0, "along")
    assert way.sent[-1] == ipc.Ask(2, "orbit", orbit=circle)


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
    with pytest.raises(gcs.NotHeard, match=r"no ALTITUDE was heard within 0\.01 s") as late:
        station.telemetry("ALTITUDE", 0.01)
    assert isinstance(late.value, TimeoutError)
    assert (late.value.code, late.value.numbers) == ("NOT_HEARD", {"timeout_s": 0.01})
    assert way.sent == [ipc.Subscribe(["ALTITUDE"])]


def test_a_message_that_does_not_exist_is_a_wrong_value() -> None:
    station, way = flying()
    threading.Timer(0.05, way.tell, (ipc.Trouble("no such MAVLink message: BATTERY"),)).start()
    with pytest.raises(gcs.BadArgument, match="name of a MAVLink message, not 'BATTERY'"):
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


def test_every_way_to_go_is_one_request() -> None:
    station, way = flying()
    ways: list[tuple[Callable[[], object], ipc.Ask]] = [
        (lambda: station.move(2, 0, 1, 90), ipc.Ask(0, "goto", move_enu=(2, 0, 1), yaw_deg=90)),
        (lambda: station.move(up_m=1), ipc.Ask(0, "goto", move_enu=(0, 0, 1))),
        (lambda: station.forward(5), ipc.Ask(0, "goto", move_body=(5, 0, 0))),
        (
            lambda: station.goto_global(47.1, 8.5, 491, amsl=True),
            ipc.Ask(0, "goto", goal_global=(47.1, 8.5, 491), amsl=True),
        ),
        (lambda: station.speed(1.5), ipc.Ask(0, "speed", speed_m_s=1.5)),
        (lambda: station.heading(-90), ipc.Ask(0, "heading", yaw_deg=-90)),
    ]
    for ask, expected in ways:
        with pytest.raises(AssertionError):  # the fake station flies to local goals only
            ask()
        sent = way.sent[-1]
        assert isinstance(sent, ipc.Ask)
        assert msgspec.structs.replace(sent, id=0) == expected


def test_a_goal_is_checked_without_being_flown_to() -> None:
    station, way = flying()
    way.station.refusals[3.0, 0.0, 2.0] = ("OUTSIDE_FENCE", "outside")
    assert station.check_goto(3, 0, 2, 90).code == "OUTSIDE_FENCE"
    assert station.check_goto(1, 0, 2).outcome == "accepted"
    assert way.sent[-1] == ipc.Check(ipc.Ask(3, "goto", goal_enu=(1.0, 0.0, 2.0)))
    assert station.state == "HOVERING"


def test_a_photo_has_its_number() -> None:
    station, way = flying()
    photo = station.photo(wait=False)
    assert photo.picture is None
    way.tell(ipc.EndingEvent(2, "photo", "complete", numbers={"picture": 7.0}))
    assert photo.wait().picture == 7


Wrong = Callable[[gcs.Station], object]
WRONG: list[tuple[Wrong, str]] = [
    (lambda s: s.goto(1, "x", 2), "goto: north_m must be a number, not 'x'"),  # type: ignore[arg-type]
    (lambda s: s.goto(1, None, 2), "goto: north_m must be a number, not None"),  # type: ignore[arg-type]
    (lambda s: s.goto(1, 0, 2, 999), "goto: yaw_deg must be from -360 to 360 degrees, not 999"),
    (lambda s: s.goto(1, 0, 2, math.nan), "goto: yaw_deg must be a finite number, not nan"),
    (lambda s: s.check_goto(1, 0, 2, 361), "check_goto: yaw_deg must be from -360 to 360 degrees"),
    (lambda s: s.move(1, 0, 2, "n"), "move: yaw_deg must be a number, not 'n'"),  # type: ignore[arg-type]
    (lambda s: s.forward([1]), "forward: forward_m must be a number, not [1]"),  # type: ignore[arg-type]
    (lambda s: s.goto_global(1, 1j, 0), "goto_global: lon_deg must be a number, not 1j"),  # type: ignore[arg-type]
    (lambda s: s.heading(400), "heading: yaw_deg must be from -360 to 360 degrees, not 400"),
    (lambda s: s.heading(None), "heading: yaw_deg must be a number, not None"),  # type: ignore[arg-type]
    (lambda s: s.takeoff("2"), "takeoff: up_m must be a number, not '2'"),  # type: ignore[arg-type]
    (lambda s: s.takeoff(10**400), "takeoff: up_m must be a number, not 1000"),
    (lambda s: s.orbit(math.nan, 2), "orbit: radius_m must be a finite number, not nan"),
    (lambda s: s.orbit(5, 2, (1, 2)), "orbit: centre must be three numbers: east, north, up"),  # type: ignore[arg-type]
    (lambda s: s.orbit(5, 2, 3), "orbit: centre must be three numbers: east, north, up"),  # type: ignore[arg-type]
    (lambda s: s.orbit(5, 2, (1, 2, "x")), "orbit: centre[2] must be a number, not 'x'"),  # type: ignore[arg-type]
    (lambda s: s.velocity(1, 0, 0, seconds=0), "velocity: seconds must be greater than 0, not 0"),
    (lambda s: s.velocity(1, 0, 0, seconds=-1), "velocity: seconds must be greater than 0"),
    (lambda s: s.velocity("1", 0, 0, seconds=1), "velocity: east_m_s must be a number, not '1'"),  # type: ignore[arg-type]
    (lambda s: s.mode(5), "mode: mode_name must be a text, not 5"),  # type: ignore[arg-type]
    (lambda s: s.upload(5), "upload: path must be a path, not 5"),  # type: ignore[arg-type]
    (lambda s: s.land(timeout_s="1"), "land: timeout_s must be a number, not '1'"),  # type: ignore[arg-type]
    (lambda s: s.land(timeout_s=-1), "land: timeout_s must be a number of seconds, not negative"),
    (lambda s: s.goto(1, 0), "goto: missing a required argument: 'up_m'"),  # type: ignore[call-arg]
    (lambda s: s.goto(1, 0, 2, alt=5), "goto: got an unexpected keyword argument 'alt'"),  # type: ignore[call-arg]
    (lambda s: s.velocity(1, 0, 0), "velocity: missing a required"),  # type: ignore[call-arg]
    (lambda s: s.land(5), "land: too many positional arguments"),  # type: ignore[call-arg,arg-type]
    (lambda s: s.upload(), "upload: missing a required argument: 'path'"),  # type: ignore[call-arg]
    (lambda s: s.telemetry(5), "telemetry: message must be a text, not 5"),  # type: ignore[arg-type]
]


@pytest.mark.parametrize(("call", "sentence"), WRONG, ids=[sentence for _, sentence in WRONG])
def test_a_wrong_argument_is_named_and_nothing_is_asked_for(call: Wrong, sentence: str) -> None:
    station, way = flying()
    before = len(way.sent)
    with pytest.raises(gcs.BadArgument) as wrong:
        call(station)
    assert str(wrong.value).startswith(sentence)
    assert wrong.value.code == "BAD_ARGUMENT"
    assert isinstance(wrong.value, gcs.GcsError)
    assert isinstance(wrong.value, ValueError)
    assert isinstance(wrong.value, TypeError)
    assert len(way.sent) == before


def test_numbers_of_others_are_numbers() -> None:
    station, way = flying()
    station.goto(np.float32(1.5), Fraction(1, 2), True, wait=False)  # type: ignore[arg-type]
    assert way.sent[-1] == ipc.Ask(2, "goto", goal_enu=(1.5, 0.5, 1.0))


def test_the_module_shows_its_library_and_nothing_else() -> None:
    assert [name for name in dir(gcs) if not name.startswith("__")] == sorted(gcs.__all__)
    with pytest.raises(gcs.BadArgument, match="connect: too many positional arguments"):
        gcs.connect("udpin://127.0.0.1:1", "lab")  # type: ignore[call-arg,arg-type]


def test_every_public_method_says_what_it_does() -> None:
    for kind in (gcs.Station, gcs.Operation, Stream):
        for name, member in vars(kind).items():
            if not name.startswith("_") and (callable(member) or isinstance(member, property)):
                assert member.__doc__, f"{kind.__name__}.{name}"
    for name in gcs.__all__:
        error = getattr(gcs, name)
        if isinstance(error, type) and issubclass(error, Exception):
            assert issubclass(error, gcs.GcsError)


class OfParameters(FakeStation):
    """A vehicle with two parameters."""

    def _asked(self, ask: ipc.Ask, now_s: float) -> list[ipc.Event]:
        held = [ipc.Parameter("RTL_ALT", 15.5, "real32"), ipc.Parameter("RTL_TYPE", 1, "int32")]
        told = [each for each in held if ask.name in ("", each.name)]
        if not told:
            return self._refuse(ask, "BAD_PARAMETER", "no such parameter; near: RTL_ALT")
        return self._quick(ask, self.state, ipc.ParametersEvent(ask.id, told))


def test_parameters_are_read_by_name_and_set() -> None:
    way = FakeWay()
    way.station = OfParameters()
    with gcs.Station(way) as station:
        assert station.parameters() == {"RTL_ALT": 15.5, "RTL_TYPE": 1}
        assert station.parameter("RTL_TYPE") == 1
        assert station.set_parameter("RTL_ALT", 20).state == "complete"
        with pytest.raises(gcs.Refused, match="near: RTL_ALT") as refused:
            station.parameter("RTL_ALTT")
    assert refused.value.code == "BAD_PARAMETER"
    words = [(ask.word, ask.name, ask.value) for ask in way.sent if isinstance(ask, ipc.Ask)]
    assert words[2] == ("param_set", "RTL_ALT", 20.0)


def test_what_matters_before_a_take_off_is_told_row_by_row() -> None:
    station, way = flying()
    report = station.preflight()
    assert [(row.name, row.verdict) for row in report.rows] == [
        ("gps", "pass"),
        ("failsafes", "caution"),
    ]
    assert not report.fails
    way.station.preflight_rows.append(ipc.PreflightRow("battery", "fail", "12 %"))
    assert station.preflight().fails
