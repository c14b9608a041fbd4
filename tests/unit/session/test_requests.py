"""From the operator's words to what the gate is asked."""

from __future__ import annotations

import math

import msgspec
import pytest

from gcs import ipc
from gcs.frames import as_on_the_wire, heading_rad
from gcs.gate.requests import Abort, GoTo, SetMode, TakeOff
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import ARDUPILOT, PX4
from gcs.request_words import REQUESTS, BadAskError, Doer
from gcs.session.requests import Requests, request_of


def test_a_goal_is_turned_into_ned_once() -> None:
    request = request_of(ipc.Ask(1, "goto", goal_enu=(1.0, 2.0, 3.0), yaw_deg=90.0), PX4)
    assert request == GoTo((2.0, 1.0, -3.0), as_on_the_wire(math.pi / 2))


@pytest.mark.parametrize(("turned_deg", "same_deg"), [(450.0, 90.0), (-90.0, 270.0), (1e300, None)])
def test_a_heading_of_many_turns_is_a_heading(turned_deg: float, same_deg: float | None) -> None:
    assert abs(heading_rad(turned_deg)) <= math.pi + 1e-6
    if same_deg is not None:
        assert heading_rad(turned_deg) == pytest.approx(heading_rad(same_deg), abs=1e-6)


def test_null_is_no_number_and_is_for_the_gate_to_refuse() -> None:
    request = request_of(ipc.Ask(1, "goto", goal_enu=(None, 0.0, 1.0)), PX4)
    assert isinstance(request, GoTo)
    assert math.isnan(request.goal_ned[1])


def test_a_take_off_without_a_height_is_no_number_either() -> None:
    request = request_of(ipc.Ask(1, "takeoff"), PX4)
    assert isinstance(request, TakeOff)
    assert math.isnan(request.up_m)


@pytest.mark.parametrize("value", [5.01, 0.1, -3.3333])
def test_what_is_verified_is_what_the_wire_can_carry(value: float) -> None:
    assert as_on_the_wire(as_on_the_wire(value)) == as_on_the_wire(value)
    assert as_on_the_wire(value) == pytest.approx(value, rel=1e-7)


def test_what_the_wire_cannot_carry_is_infinite() -> None:
    assert as_on_the_wire(1e300) == math.inf


@pytest.mark.parametrize("word", ["fly", "", "mission_upload"])
def test_an_unknown_word_is_no_request(word: str) -> None:
    with pytest.raises(BadAskError):
        request_of(ipc.Ask(1, word), PX4)


def test_a_mode_is_named_as_its_autopilot_names_it() -> None:
    assert request_of(ipc.Ask(1, "mode", mode="brake"), ARDUPILOT) == SetMode(
        "BRAKE", FlightMode.HOLD
    )
    with pytest.raises(BadAskError):
        request_of(ipc.Ask(1, "mode", mode="brake"), PX4)


def test_a_request_is_known_until_it_is_over() -> None:
    requests = Requests()
    first, second = requests.open(ipc.Ask(10, "arm"), 1), requests.open(ipc.Ask(10, "land"), 2)
    assert first != second
    assert requests.close(first).ask.id == 10
    assert requests.get(second).source == "operator 2"
    assert requests.open_count == 1
    assert request_of(ipc.Ask(1, "abort"), PX4) == Abort()


def test_the_protocol_names_the_words_of_the_table_and_no_other() -> None:
    text = ipc.Ask.__doc__ or ""
    named = text[text.index("one of: ") + len("one of: ") :].split(".")[0].split()
    assert sorted(named) == sorted(REQUESTS)


def test_what_the_gate_does_is_asked_of_the_gate_and_nothing_else_is() -> None:
    """But a mode, which needs to know the autopilot, and a start, which is prepared first."""
    of_gate = {name for name, word in REQUESTS.items() if word.doer is Doer.GATE}
    with_request = {name for name, word in REQUESTS.items() if word.gate is not None}
    assert of_gate - with_request == {"mode"}
    assert with_request - of_gate == {"mission_start"}


def test_the_arguments_of_a_word_are_fields_of_a_request() -> None:
    fields = {field.name for field in msgspec.structs.fields(ipc.Ask)}
    for word in REQUESTS.values():
        assert word.build is not None or fields >= {each.field for each in word.arguments}
