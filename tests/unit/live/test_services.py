"""Requests of services and parameters of viewers: what they ask the station for."""

from __future__ import annotations

import json

import pytest

from gcs import ipc
from gcs.live.parameters import Parameters
from gcs.live.services import (
    MAX_REQUEST_BYTES,
    SERVICES,
    Answer,
    BadCallError,
    GoTo,
    ask_of,
    request_of,
    schema_of,
)
from gcs.request_words import ALWAYS_HEARD, REQUESTS, Doer
from gcs.session.requests import request_of as gate_request_of

AT = ipc.Snapshot(
    0, "HOVERING", "OURS", "NOMINAL", [], 0.0, "", True, 0.0, pos_enu=(1.0, 2.0, 3.456)
)
MOVING = ipc.Snapshot(
    0, "MOVING", "OURS", "NOMINAL", [], 0.0, "", True, 0.0, (5.0, 5.0, 5.0), pos_enu=(1.0, 2.0, 3.0)
)
DEFAULT = Parameters()


def asked(
    service: str,
    text: str,
    parameters: Parameters = DEFAULT,
    snapshot: ipc.Snapshot | None = AT,
) -> ipc.Ask:
    return ask_of(service, request_of(service, text.encode()), parameters, snapshot)


@pytest.mark.parametrize(
    ("service", "text", "ask"),
    [
        ("arm", "", ipc.Ask(0, "arm")),
        ("land", "{}", ipc.Ask(0, "land")),
        ("hold", " \n", ipc.Ask(0, "hold")),
        ("take_control", '{"code": "x"}', ipc.Ask(0, "station_take")),
        ("takeoff", '{"up_m": 2.5}', ipc.Ask(0, "takeoff", up_m=2.5)),
        (
            "goto",
            '{"east_m": 4, "north_m": -1, "up_m": 2, "yaw_deg": 90}',
            ipc.Ask(0, "goto", goal_enu=(4.0, -1.0, 2.0), yaw_deg=90.0),
        ),
        ("goto", '{"east_m": 4, "north_m": -1}', ipc.Ask(0, "goto", goal_enu=(4.0, -1.0, 3.46))),
        ("step", '{"direction": "west"}', ipc.Ask(0, "goto", goal_enu=(0.0, 2.0, 3.46))),
        ("step", '{"direction": "up"}', ipc.Ask(0, "goto", goal_enu=(1.0, 2.0, 4.46))),
    ],
)
def test_a_service_is_a_request_of_the_station(service: str, text: str, ask: ipc.Ask) -> None:
    assert asked(service, text) == ask


def test_every_service_asks_for_what_the_station_knows() -> None:
    texts = {
        "takeoff": '{"up_m": 2}',
        "goto": '{"east_m": 1, "north_m": 1}',
        "step": '{"direction": "up"}',
        "take_control": '{"code": ""}',
    }
    for service in SERVICES:
        ask = asked(service, texts.get(service, ""))
        if ask.word != "station_take":
            gate_request_of(ask, None)


def test_a_viewer_that_looks_may_ask_for_what_the_station_hears_of_anyone() -> None:
    """And for nothing more: a word that needs control would be given control where nobody has it.
    `disarm` is no service, giving control back neither, and taking it, landing and returning, which
    move the vehicle, need the code.  What reads a vehicle's parameters, files and logs is no
    service either."""
    anyone = {service.word for service in SERVICES.values() if service.anyone}
    readers = {name for name, word in REQUESTS.items() if word.doer is Doer.READER}
    assert anyone == ALWAYS_HEARD - readers - {"disarm", "station_release", "land", "rtl"}


def test_the_height_is_the_parameter_s_where_it_is_set() -> None:
    high, _ = DEFAULT.changed({"goal_height_m": 7.5})
    assert asked("goto", '{"east_m": 0, "north_m": 0}', high).goal_enu == (0.0, 0.0, 7.5)
    assert asked("goto", '{"east_m": 0, "north_m": 0, "up_m": 1}', high).goal_enu == (0.0, 0.0, 1.0)


def test_without_a_known_height_the_goal_has_none_which_the_gate_refuses() -> None:
    assert asked("goto", '{"east_m": 0, "north_m": 0}', snapshot=None).goal_enu == (0.0, 0.0, None)


def test_a_step_goes_on_from_the_goal_that_is_flown_to() -> None:
    far, _ = DEFAULT.changed({"step_m": 2.5})
    assert asked("step", '{"direction": "north"}', far, MOVING).goal_enu == (5.0, 7.5, 5.0)
    with pytest.raises(BadCallError, match="position"):
        asked("step", '{"direction": "north"}', far, None)


@pytest.mark.parametrize(
    ("service", "payload"),
    [
        ("goto", b""),
        ("goto", b'{"east_m": 1}'),
        ("goto", b'{"east_m": "1", "north_m": 2}'),
        ("goto", b"[1, 2]"),
        ("goto", b"\xff"),
        ("takeoff", b'{"up_m": null}'),
        ("takeoff", b'{"up_m": NaN}'),
        ("step", b'{"direction": "forward"}'),
        ("take_control", b"{}"),
        ("arm", b"[" * 4_000),
        ("arm", b" " * (MAX_REQUEST_BYTES + 1)),
    ],
)
def test_what_cannot_be_meant_is_told_in_a_sentence(service: str, payload: bytes) -> None:
    with pytest.raises(BadCallError, match=r"request"):
        request_of(service, payload)


@pytest.mark.parametrize(
    "asked_for",
    [
        {"step_m": 0.0},
        {"step_m": -1.0},
        {"step_m": 101.0},
        {"step_m": float("nan")},
        {"step_m": "1"},
        {"step_m": True},
        {"goal_height_m": -0.1},
        {"goal_height_m": float("inf")},
        {"goal_height_m": None},
        {"nothing": 1.0},
        {"changed": 1.0},
    ],
)
def test_a_parameter_that_makes_no_sense_changes_nothing(asked_for: dict[str, object]) -> None:
    same, mistakes = DEFAULT.changed(asked_for)
    assert same == DEFAULT
    assert len(mistakes) == 1


def test_a_form_is_made_of_plain_types() -> None:
    assert json.loads(schema_of(GoTo)) == {
        "title": "GoTo",
        "type": "object",
        "properties": {
            "east_m": {"type": "number"},
            "north_m": {"type": "number"},
            "up_m": {"type": "number"},
            "yaw_deg": {"type": "number"},
        },
        "required": ["east_m", "north_m"],
    }
    answer = json.loads(schema_of(Answer))
    assert answer["properties"]["accepted"] == {"type": "boolean"}
    assert answer["properties"]["sentence"] == {"type": "string"}
    assert answer["properties"]["operation"] == {"type": "integer"}
    assert answer["properties"]["numbers"] == {"type": "object"}
