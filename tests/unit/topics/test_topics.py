"""What a text names, what the bytes of a topic become, also in records that are not ours, and
rates, against Python's own statistics of the times between messages."""

from __future__ import annotations

import itertools
import statistics
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.topics.rates import Intervals
from gcs.topics.selector import Selector, SelectorError, value_at
from gcs.topics.topic import DecodeError, recorded_topic

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


@pytest.mark.parametrize(
    ("encoding", "schema", "metadata", "data"),
    [
        ("json", "gate.Fsa", {}, b"[1]"),
        ("json", "gate.Fsa", {}, b"{"),
        ("json", "gate.Fsa", {}, b'{"a":' * 400 + b"1" + b"}" * 400),
        ("json", "gate.Fsa", {}, b'{"a":' + b"[" * 100_000 + b"]" * 100_000 + b"}"),
        ("ros1", "mavlink/ATTITUDE", {"payload_length": "28"}, b""),
        ("ros1", "mavlink/ATTITUDE", {"payload_length": "28"}, bytes(60)),
        ("ros1", "mavlink/ATTITUDE", {"payload_length": "9" * 5000}, bytes(60)),
        ("ros1", "mavlink/ATTITUDE", {"payload_length": "999"}, bytes(60)),
        ("ros1", "mavlink/ATTITUDE", {}, bytes(60)),
        ("protobuf", "foxglove.Log", {}, bytes(60)),
    ],
)
def test_what_is_no_message_of_its_topic_is_told(
    encoding: str, schema: str, metadata: dict[str, str], data: bytes
) -> None:
    with pytest.raises(DecodeError):
        recorded_topic("/x", schema, encoding, metadata, b"").decode(data)


def test_a_line_of_the_log_has_level_node_and_text() -> None:
    line = bytes.fromhex("1003 1a02 6869 2204 67617465")  # level 3, message "hi", name "gate"
    fields = recorded_topic("/log", "foxglove.Log", "protobuf", {}, b"").decode(line)
    assert fields == {"level": 3, "node": "gate", "text": "hi"}


def test_garbage_is_told_with_its_reason() -> None:
    data = (3).to_bytes(4, "little") + b"crc" + (2).to_bytes(4, "little") + b"\xfd\x00"
    topic = recorded_topic("/link/0/garbage", "mavlink/Garbage", "ros1", {}, b"")
    assert topic.decode(data) == {"reason": "crc", "data": "fd 00"}


@given(st.lists(st.integers(1, 10**9), min_size=1, max_size=50))
def test_a_rate_is_the_mean_and_the_spread_of_the_times_between(gaps_ns: list[int]) -> None:
    times = Intervals.over(None)
    for at_ns in itertools.accumulate(gaps_ns, initial=1_767_225_600_000_000_000):
        times.add(at_ns)
    rate = times.rate()
    gaps_s = [gap / 1e9 for gap in gaps_ns]
    assert rate is not None
    assert rate.hz == pytest.approx(1.0 / statistics.fmean(gaps_s))
    assert (rate.min_s, rate.max_s, rate.window) == (min(gaps_s), max(gaps_s), len(gaps_s) + 1)
    assert rate.std_dev_s == pytest.approx(statistics.pstdev(gaps_s), abs=1e-12)


def test_a_window_is_of_the_newest() -> None:
    times = Intervals.over(3)
    for at_ns in (0, 100, 1_000_000_000, 2_000_000_000, 3_000_000_000):
        times.add(at_ns)
    rate = times.rate()
    assert rate is not None
    assert (rate.hz, rate.window, times.total) == (1.0, 3, 5)


def test_one_message_has_no_rate_and_a_burst_none_in_a_list() -> None:
    times = Intervals.over(None)
    times.add(5)
    assert times.rate() is None
    times.add(5_000_000)
    assert times.rate() is not None
    assert times.rate(least_span_s=1.0) is None
