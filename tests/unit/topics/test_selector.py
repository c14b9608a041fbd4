"""Which topics and fields a text means."""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.topics.selector import Selector, SelectorError, value_at

POSITION = "/mavlink/1/1/LOCAL_POSITION_NED"


@pytest.mark.parametrize(
    ("text", "name", "path"),
    [
        ("LOCAL_POSITION_NED", POSITION, ()),
        ("local_position_ned.z", POSITION, ("z",)),
        ("1/1/LOCAL_POSITION_NED.z", POSITION, ("z",)),
        (POSITION, POSITION, ()),
        (f"{POSITION}.z", POSITION, ("z",)),
        (f"{POSITION}/z", POSITION, ("z",)),
        ("/mavlink/*/LOCAL_*", POSITION, ()),
        ("GPS_STATUS.satellite_snr[3]", "/mavlink/1/1/GPS_STATUS", ("satellite_snr", 3)),
        ("/gate/decision.goal.up_m", "/gate/decision", ("goal", "up_m")),
        ("state.up_m", "/vehicle/1/state", ("up_m",)),
        ("LOCAL_POSITION", POSITION, None),
        ("2/1/LOCAL_POSITION_NED", POSITION, None),
        ("/LOCAL_POSITION_NED", POSITION, None),
    ],
)
def test_a_text_means_a_topic_and_a_path(
    text: str, name: str, path: tuple[str | int, ...] | None
) -> None:
    assert Selector.parse(text).path_in(name) == path


@pytest.mark.parametrize("text", ["", "/", ".z", "A..z", "A.z[", "A[x]", "/vehicle/", "A" * 400])
def test_what_names_nothing_is_told(text: str) -> None:
    with pytest.raises(SelectorError):
        Selector.parse(text)


@given(st.text(max_size=40))
def test_any_text_is_taken_or_told(text: str) -> None:
    with suppress(SelectorError):
        Selector.parse(text).path_in(POSITION)


def test_a_field_that_is_not_there_is_told_with_what_is_near() -> None:
    with pytest.raises(SelectorError) as told:
        value_at({"roll": 1.0, "pitch": 2.0}, ("rol",), "ATTITUDE")
    assert "ATTITUDE: has no field 'rol'" in str(told.value)
    assert told.value.hint == "did you mean 'roll'?"


def test_an_element_that_is_not_there_is_none() -> None:
    assert value_at({"volts": [1, 2]}, ("volts", 5), "X") is None
    assert value_at({"volts": [1, 2]}, ("volts", -1), "X") == 2
