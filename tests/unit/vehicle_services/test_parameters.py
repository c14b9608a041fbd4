"""The parameter protocol: every SET is answered with the value that holds."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.unit.vehicle_services.fake_vehicle import MS, Bench, S, of
from vehicle_sim.services.parameters import decode, encode
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import ParamType


def values(heard: list[m.Message]) -> list[m.ParamValue]:
    return of(heard, m.ParamValue)


def name(value: m.ParamValue) -> str:
    return value.param_id.rstrip(b"\0").decode()


def read(text: str, index: int = -1) -> m.ParamRequestRead:
    return m.ParamRequestRead(index, 1, 1, text.encode())


def as_float(whole: int) -> float:
    return float(struct.unpack("<f", struct.pack("<i", whole))[0])


def test_a_list_comes_paced_complete_and_in_order() -> None:
    bench = Bench("ardupilot")
    first = values(bench.send(m.ParamRequestList(1, 1)))
    rest = values(bench.advance(10 * MS))
    assert len(first) + len(rest) <= 20, "not in one burst"
    rest += values(bench.advance(2 * S))
    total = len(bench.parameters)
    assert [value.param_index for value in first + rest] == list(range(total))
    assert {value.param_count for value in rest} == {total}


def test_px4_begins_its_list_with_the_hash_and_a_client_that_knows_it_stops_the_list() -> None:
    bench = Bench("px4")
    (first,) = values(bench.send(m.ParamRequestList(1, 1)))
    assert name(first) == "_HASH_CHECK"
    bench.send(m.ParamSet(first.param_value, 1, 1, first.param_id, first.param_type))
    assert values(bench.advance(1 * S)) == []


def test_the_hash_changes_with_a_value() -> None:
    bench = Bench("px4")
    (before,) = values(bench.send(read("_HASH_CHECK")))
    bench.parameters.set("MIS_TAKEOFF_ALT", 7.0)
    (after,) = values(bench.send(read("_HASH_CHECK")))
    assert before.param_value != after.param_value


def crc32(data: bytes, crc: int) -> int:
    """Bit by bit: the reflected polynomial, from 0, not inverted."""
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xEDB88320 if crc & 1 else 0)
    return crc


def test_the_hash_is_what_qgroundcontrol_reckons_from_what_it_was_sent() -> None:
    """CRC-32 over names and four bytes of value, sorted by name: ParamHashCheckStateMachine."""
    bench = Bench("px4")
    for altitude in (2.5, 3.0, 7.25):
        bench.parameters.set("MIS_TAKEOFF_ALT", altitude)
        (told,) = values(bench.send(m.ParamRequestList(1, 1)))
        cache = {
            name(each): struct.pack("<f", each.param_value) for each in values(bench.advance(S))
        }
        assert len(cache) == len(bench.parameters)
        expected = 0
        for each in sorted(cache):
            expected = crc32(cache[each], crc32(each.encode(), expected))
        assert struct.pack("<f", told.param_value) == expected.to_bytes(4, "little")
        assert (told.param_type, told.param_index) == (ParamType.UINT32, 65535)


def test_px4_leaves_the_hash_out_of_a_list_that_is_asked_for_again() -> None:
    bench = Bench("px4")
    assert name(values(bench.send(m.ParamRequestList(1, 1)))[0]) == "_HASH_CHECK"
    assert values(bench.send(m.ParamRequestList(1, 1))) == []
    again = values(bench.advance(1 * S))
    assert [each.param_index for each in again] == [*range(len(bench.parameters))]


def test_a_parameter_is_read_by_name_and_by_index() -> None:
    bench = Bench("px4")
    (by_name,) = values(bench.send(read("MIS_TAKEOFF_ALT")))
    (by_index,) = values(bench.send(read("", by_name.param_index)))
    assert by_name == by_index
    assert by_name.param_value == bench.parameters.get("MIS_TAKEOFF_ALT")


def test_integers_travel_as_bytes_on_px4_and_as_numbers_on_ardupilot() -> None:
    (px4,) = values(Bench("px4").send(read("MAV_SYS_ID")))
    assert (px4.param_value, px4.param_type) == (as_float(1), ParamType.INT32)
    (ardupilot,) = values(Bench("ardupilot").send(read("SYSID_THISMAV")))
    assert ardupilot.param_value == 1.0


def test_set_is_answered_with_the_new_value() -> None:
    bench = Bench("px4")
    asked = m.ParamSet(4.0, 1, 1, b"MIS_TAKEOFF_ALT", ParamType.REAL32)
    (told,) = values(bench.send(asked))
    assert told.param_value == 4.0
    assert bench.parameters.get("MIS_TAKEOFF_ALT") == 4.0


def test_ardupilot_leaves_the_index_out_of_the_echo() -> None:
    bench = Bench("ardupilot")
    (told,) = values(bench.send(m.ParamSet(2.0, 1, 1, b"SYSID_THISMAV", 4)))
    assert (told.param_index, told.param_value) == (65535, 2.0)


def answers(heard: list[m.Message]) -> list[m.ParamValue | m.ParamError]:
    return [each for each in heard if isinstance(each, m.ParamValue | m.ParamError)]


def set_to(bench: Bench, text: str, value: float, kind: int) -> list[float | int]:
    """What PARAM_SET is answered with in a second: values, or numbers of errors."""
    heard = bench.send(m.ParamSet(value, 1, 1, text.encode(), kind)) + bench.advance(S)
    return [
        each.param_value if isinstance(each, m.ParamValue) else each.error
        for each in answers(heard)
    ]


# Rows of the recorded scenario E1_param_set_answers of PX4 1.14.3.
@pytest.mark.parametrize(
    ("text", "value", "kind", "told"),
    [
        pytest.param("MPC_XY_VEL_MAX", 500.0, 9, [500.0, 500.0], id="over the maximum"),
        pytest.param("MPC_Z_VEL_MAX_UP", -5.0, 9, [-5.0, -5.0], id="under the minimum"),
        pytest.param("GF_ACTION", as_float(99), 6, [as_float(99)] * 2, id="no such choice"),
        pytest.param("MPC_XY_VEL_MAX", 12.0, 9, [12.0], id="the same value"),
        pytest.param("MPC_XY_VEL_MAX", math.nan, 9, [12.0], id="NaN"),
        pytest.param("MPC_XY_VEL_MAX", math.inf, 9, [math.inf] * 2, id="infinity"),
        pytest.param("GF_ACTION", 3.0, 6, [3.0, 3.0], id="an integer that is not bytes"),
        pytest.param("GF_ACTION", 3.0, 9, [], id="an integer declared a float"),
        pytest.param("MPC_XY_VEL_MAX", as_float(9), 6, [], id="a float declared an integer"),
        pytest.param("GF_ACTION", as_float(3), 5, [], id="a signed one declared unsigned"),
        pytest.param("GF_ACTION", as_float(3), 2, [], id="32 bits declared 8"),
        pytest.param("NO_SUCH_PARAM", 1.0, 9, [], id="unknown"),
        pytest.param("mpc_xy_vel_max", 5.0, 9, [], id="lower case"),
    ],
)
def test_px4_answers_param_set_as_recorded(
    text: str, value: float, kind: int, told: list[float]
) -> None:
    assert set_to(Bench("px4"), text, value, kind) == told


# Rows of the recorded scenarios E1, E3 and E4 of ArduCopter 4.7.0-dev; whole numbers are errors.
@pytest.mark.parametrize(
    ("text", "value", "kind", "told"),
    [
        pytest.param("WP_SPD", 500.0, 9, [500.0], id="over the maximum"),
        pytest.param("WP_SPD", -5.0, 9, [-5.0], id="under the minimum"),
        pytest.param("FENCE_ACTION", 99.0, 2, [99.0], id="no such choice"),
        pytest.param("FENCE_ACTION", 300.0, 2, [127.0], id="too much for 8 bits"),
        pytest.param("FENCE_ACTION", -300.0, 2, [-128.0], id="too little for 8 bits"),
        pytest.param("PILOT_ACCEL_Z", 70000.0, 4, [32767.0], id="too much for 16 bits"),
        pytest.param("FENCE_ACTION", 2.7, 2, [2.0], id="a fraction"),
        pytest.param("WP_SPD", 8.0, 6, [8.0], id="a float declared an integer"),
        pytest.param("FENCE_ACTION", 2.0, 9, [2.0], id="an integer declared a float"),
        pytest.param("WP_SPD", 10.0, 9, [10.0], id="the same value"),
        pytest.param("STAT_BOOTCNT", 1000.0, 6, [1000.0], id="a counter"),
        pytest.param("WP_SPD", math.nan, 9, [2], id="NaN"),
        pytest.param("WP_SPD", math.inf, 9, [2], id="infinity"),
        pytest.param("NO_SUCH_PARAM", 1.0, 9, [1], id="unknown"),
        pytest.param("WPNAV_SPEED", 500.0, 9, [1], id="a name of 4.5"),
        pytest.param("wp_spd", 5.0, 9, [1], id="lower case"),
    ],
)
def test_arducopter_4_7_answers_param_set_as_recorded(
    text: str, value: float, kind: int, told: list[float]
) -> None:
    assert set_to(Bench("ardupilot", firmware="4.7"), text, value, kind) == told


def test_arducopter_4_7_tells_the_types_and_no_index() -> None:
    bench = Bench("ardupilot", firmware="4.7")
    for text, kind in (("FENCE_ACTION", 2), ("PILOT_ACCEL_Z", 4), ("AUTO_OPTIONS", 6)):
        (told,) = values(bench.send(m.ParamSet(1.0, 1, 1, text.encode(), 9)))
        assert (told.param_type, told.param_index) == (kind, 65535)


def test_px4_tells_a_change_again_after_10_to_20_ms() -> None:
    bench = Bench("px4")
    bench.send(m.ParamSet(4.0, 1, 1, b"MIS_TAKEOFF_ALT", ParamType.REAL32))
    assert values(bench.advance(9 * MS)) == []
    assert len(values(bench.advance(12 * MS))) == 1


@pytest.mark.parametrize(("text", "index"), [("NO_SUCH_PARAM", -1), ("", -1), ("", 30000)])
def test_a_parameter_that_there_is_not(text: str, index: int) -> None:
    """ArduCopter 4.7 answers with PARAM_ERROR, PX4 and ArduCopter 4.5 do not."""
    (told,) = answers(Bench("ardupilot", firmware="4.7").send(read(text, index)))
    assert isinstance(told, m.ParamError)
    assert (told.error, told.param_index) == (1, index)
    assert answers(Bench("ardupilot").send(read(text, index))) == []
    assert answers(Bench("px4").send(read(text, index))) == []


def test_a_change_is_told_to_every_client() -> None:
    bench = Bench("px4")
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3), peer="one")
    asked = m.ParamSet(4.0, 1, 1, b"MIS_TAKEOFF_ALT", ParamType.REAL32)
    bench.send(asked, peer="two")
    assert bench.world.counters(0, "one") is not None
    assert bench.raw.count(b"MIS_TAKEOFF_ALT") == 2


@given(st.integers(-(2**31), 2**31 - 1).filter(lambda whole: whole & 0x7F800000 != 0x7F800000))
def test_bytes_of_an_integer_come_back_whole(whole: int) -> None:
    """Without those that are NaNs as floats, which processors may change on the way."""
    assert decode(encode(whole, ParamType.INT32, True), ParamType.INT32, True) == whole
