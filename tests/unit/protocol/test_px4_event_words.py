"""PX4's events in words: as recorded beside them (scenarios_px4.json, its `event_catalogue`)."""

from __future__ import annotations

import pytest

from gcs.protocol.px4_event_words import WordedEvent, is_known, worded
from gcs.wire.messages import Event
from tests.unit.vehicle_services.test_events import TEXTS

CATALOGUE = [
    ("Mission rejected: starts with landing", 22901736, 0x63, ""),
    ("Mission rejected: takeoff is not the first waypoint item", 33440290, 0x63, ""),
    ("Mission rejected: item 2: unsupported command: 112", 25552931, 0x43, "020070"),
    ("Waypoint 2 below home", 31368072, 0x64, "02"),
    ("logging: opening log file 2026-11-22/02_11_18.ulg", 17980399, 0x66, "ea070b16020b12"),
]
"""Example arguments and messages of events of which no text was recorded."""


def event(number: int, log_levels: int, hexes: str) -> Event:
    data = bytes.fromhex(hexes).ljust(40, b"\0")
    return Event(number, 0, 0, 0, 0, log_levels, tuple(data))


@pytest.mark.parametrize(
    ("text", "number", "levels", "arguments"),
    [row for row in TEXTS if row[0] != "Failsafe activated"] + CATALOGUE,
)
def test_an_event_says_what_the_text_beside_it_says(
    text: str, number: int, levels: int, arguments: str
) -> None:
    told = worded(event(number, levels, arguments))
    assert told is not None
    assert (told.text, told.severity) == (text, levels & 0xF)
    assert text.startswith(told.begins) or told.begins == "[logger]"


def test_a_failsafe_s_event_names_the_action_where_the_text_does_not() -> None:
    """Its text was "Failsafe activated" alone, and the vehicle went to POSCTL."""
    told = worded(event(31382480, 0x42, "0000060002"))
    assert told == WordedEvent(
        2, "Failsafe activated, triggering Position mode", "Failsafe activated"
    )


def test_a_number_that_has_no_name_here_is_told_as_it_is() -> None:
    told = worded(event(26266355, 0x66, "63"))
    assert told is not None
    assert told.text == "Armed by 99 (not known here)"


@pytest.mark.parametrize("number", [27825120, 18691879, 17231145])
def test_the_report_is_known_and_not_told_event_by_event(number: int) -> None:
    summary = event(number, 0x88, "")
    assert is_known(summary)
    assert worded(summary) is None


def test_others_are_not_known() -> None:
    assert not is_known(event(12345, 0x66, ""))
    assert worded(event(12345, 0x66, "")) is None
