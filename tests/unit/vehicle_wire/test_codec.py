"""The vehicle's codec against pymavlink's, which is the oracle."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v10 import all as upstream_1
from pymavlink.dialects.v20 import all as upstream

from tests.each import each
from vehicle_sim.wire import ids
from vehicle_sim.wire.codec import BY_TYPE, encode
from vehicle_sim.wire.dialect import LAYOUTS, NAMES
from vehicle_sim.wire.messages import IDS, TYPES, Heartbeat, LocalPositionNed, Message, Timesync
from vehicle_sim.wire.split import Counters, Reassembler, split
from vehicle_sim.wire.supplement import COMMANDS, GROWN, MessageField

RANGES = {
    "uint8_t": (0, 2**8 - 1),
    "int8_t": (-(2**7), 2**7 - 1),
    "uint16_t": (0, 2**16 - 1),
    "int16_t": (-(2**15), 2**15 - 1),
    "uint32_t": (0, 2**32 - 1),
    "int32_t": (-(2**31), 2**31 - 1),
    "uint64_t": (0, 2**64 - 1),
    "int64_t": (-(2**63), 2**63 - 1),
}


def value(field: MessageField, draw: random.Random) -> float | bytes | tuple[float, ...]:
    if field.length and field.kind in ("char", "uint8_t"):
        text = bytes(draw.randrange(1, 127) for _ in range(draw.randrange(field.length + 1)))
        return text.ljust(field.length, b"\0")
    if field.length:
        one = MessageField(field.name, field.kind, 0)
        return tuple(number(one, draw) for _ in range(field.length))
    return number(field, draw)


def number(field: MessageField, draw: random.Random) -> float:
    if field.kind == "float":
        return draw.randrange(-1000, 1000) / 8
    return draw.randint(*RANGES[field.kind])


def any_message(kind: type[Message], draw: random.Random) -> Message:
    fields = LAYOUTS[IDS[kind]].fields
    return kind._make(value(field, draw) for field in fields)


@each("kind", TYPES.values(), said=lambda kind: kind.__name__)
def test_every_message_comes_back_whole(kind: type[Message]) -> None:
    draw = random.Random(kind.__name__)
    for sequence in range(20):
        message = any_message(kind, draw)
        counters = Counters()
        (frame,) = split(encode(message, sequence, 7, 9), counters)
        assert (frame.version, frame.sequence, frame.system, frame.component) == (2, sequence, 7, 9)
        assert frame.message() == message
        assert counters == Counters(frames=1)


@each(
    "kind",
    [kind for kind in TYPES.values() if IDS[kind] in upstream.mavlink_map],
    said=lambda kind: kind.__name__,
)
def test_pymavlink_reads_what_we_write(kind: type[Message]) -> None:
    draw = random.Random(kind.__name__)
    message = any_message(kind, draw)
    layout = LAYOUTS[IDS[kind]]
    (read,) = upstream.MAVLink(None).parse_buffer(encode(message, 3, 7, 9))
    assert read.get_type() == layout.name
    known = {field.name for field in layout.fields} - {
        field.name for field in GROWN.get(layout.name, ())
    }
    for field, ours in zip(layout.fields, message, strict=True):
        if field.name not in known:
            continue
        theirs = getattr(read, field.name)
        if isinstance(ours, bytes):
            raw = theirs.encode() if isinstance(theirs, str) else bytes(theirs)
            assert raw.rstrip(b"\0") == ours.rstrip(b"\0"), field.name
        elif isinstance(ours, tuple):
            assert tuple(theirs) == ours, field.name
        else:
            assert theirs == ours, field.name


@each(
    "kind",
    [kind for kind in TYPES.values() if IDS[kind] in upstream_1.mavlink_map],
    said=lambda kind: kind.__name__,
)
def test_pymavlink_reads_what_we_write_in_mavlink_1(kind: type[Message]) -> None:
    """The base fields, and the CRC over exactly them."""
    draw = random.Random(kind.__name__)
    message = any_message(kind, draw)
    codec = BY_TYPE[kind]
    data = codec.frame1(codec.payload(message), 3, 7, 9)
    (read,) = upstream_1.MAVLink(None).parse_buffer(data)
    assert len(data) == 8 + codec.base_size
    assert (read.get_srcSystem(), read.get_srcComponent(), read.get_seq()) == (7, 9, 3)
    names = set(read.get_fieldnames())
    assert names
    for field, ours in zip(LAYOUTS[IDS[kind]].fields, message, strict=True):
        assert (field.name in names) is not field.extension, field.name
        if field.extension or isinstance(ours, bytes):
            continue
        theirs = getattr(read, field.name)
        assert (tuple(theirs) if isinstance(ours, tuple) else theirs) == ours, field.name


@pytest.mark.parametrize("version", [1, 2])
def test_we_read_what_pymavlink_writes(version: int) -> None:
    link = upstream.MAVLink(None, srcSystem=255, srcComponent=190)
    link.seq = 41
    told = upstream.MAVLink_command_long_message(1, 1, 400, 0, 1, 21196, 0, 0, 0, 0, 0.5)
    counters = Counters()
    (frame,) = split(told.pack(link, force_mavlink1=version == 1), counters)
    assert (frame.version, frame.sequence, frame.system, frame.component) == (version, 41, 255, 190)
    assert frame.message() == (1.0, 21196.0, 0, 0, 0, 0, 0.5, 400, 1, 1, 0)


def test_trailing_zeros_are_cut_but_for_one_byte() -> None:
    assert len(encode(Timesync(0, 0), 0, 1, 1)) == 12 + 1
    assert encode(Timesync(0, 0), 0, 1, 1)[10:11] == b"\0"
    assert len(encode(Heartbeat(0, 2, 12, 0, 0, 3), 0, 1, 1)) == 12 + 9


def test_the_extensions_that_pymavlink_lacks_are_there() -> None:
    (frame,) = split(encode(Timesync(1, 2, 255, 190), 0, 1, 1), Counters())
    assert frame.message() == (1, 2, 255, 190)


GOOD = encode(LocalPositionNed(1, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0), 5, 1, 1)


def test_a_stray_start_byte_does_not_swallow_the_frame_behind_it() -> None:
    for stray in (b"\xfd", b"\xfe", b"\xfd\x09\x00", b"\xfe\x00garbage"):
        counters = Counters()
        frames = split(stray + GOOD, counters)
        assert [frame.sequence for frame in frames] == [5], stray
        assert counters.frames == 1


@pytest.mark.parametrize("cut", range(1, len(GOOD)))
def test_a_truncated_frame_is_counted(cut: int) -> None:
    counters = Counters()
    assert split(GOOD[:cut], counters) == []
    assert counters.truncated >= 1


@pytest.mark.parametrize("at", range(len(GOOD)))
def test_a_frame_with_any_byte_changed_is_not_taken_and_the_next_one_is(at: int) -> None:
    damaged = bytearray(GOOD)
    damaged[at] ^= 0x55
    counters = Counters()
    assert split(bytes(damaged) + GOOD, counters) == split(GOOD, Counters())


def test_unknown_messages_and_flags_are_counted_apart() -> None:
    counters = Counters()
    split(GOOD[:7] + b"\xff\xff\xff" + GOOD[10:], counters)
    split(GOOD[:2] + b"\x80" + GOOD[3:], counters)
    assert (counters.unknown, counters.incompatible) == (1, 1)


@given(st.binary(max_size=300))
def test_no_bytes_at_all_raise(data: bytes) -> None:
    for frame in split(data, Counters()):
        frame.message()


@given(st.lists(st.integers(1, 60), max_size=30))
def test_a_stream_cut_anywhere_gives_the_same_frames(sizes: list[int]) -> None:
    stream = b"noise" + GOOD + b"\x00\x01" + GOOD * 3
    reassembler, counters = Reassembler(), Counters()
    frames = []
    at = 0
    for size in [*sizes, len(stream)]:
        frames += split(reassembler.feed(stream[at : at + size]), counters)
        at += size
    assert len(frames) == 4
    assert counters.truncated == counters.bad_crc == 0


@pytest.mark.parametrize(
    ("ours", "prefix"),
    [
        (ids.Cmd, "MAV_CMD_"),
        (ids.MavFrame, "MAV_FRAME_"),
        (ids.Sensor, "MAV_SYS_STATUS_"),
        (ids.Capability, "MAV_PROTOCOL_CAPABILITY_"),
        (ids.EstimatorFlag, "ESTIMATOR_"),
        (ids.EkfFlag, "EKF_"),
        (ids.MissionResult, "MAV_MISSION_"),
        (ids.MissionType, "MAV_MISSION_TYPE_"),
        (ids.ParamType, "MAV_PARAM_TYPE_"),
        (ids.DataStream, "MAV_DATA_STREAM_"),
    ],
    ids=lambda each: getattr(each, "__name__", each),
)
def test_the_numbers_are_the_dialects(ours: type[ids.Cmd], prefix: str) -> None:
    for member in ours:
        names = [prefix + _upstream_name(member.name)]
        found = [getattr(upstream, name) for name in names if hasattr(upstream, name)]
        found += [COMMANDS[name] for name in names if name in COMMANDS]
        assert found == [member.value], names


def _upstream_name(name: str) -> str:
    return {
        "GYRO_3D": "SENSOR_3D_GYRO",
        "ACCEL_3D": "SENSOR_3D_ACCEL",
        "MAG_3D": "SENSOR_3D_MAG",
        "ABSOLUTE_PRESSURE": "SENSOR_ABSOLUTE_PRESSURE",
        "DIFFERENTIAL_PRESSURE": "SENSOR_DIFFERENTIAL_PRESSURE",
        "GPS": "SENSOR_GPS",
        "ANGULAR_RATE_CONTROL": "SENSOR_ANGULAR_RATE_CONTROL",
        "ATTITUDE_STABILIZATION": "SENSOR_ATTITUDE_STABILIZATION",
        "YAW_POSITION": "SENSOR_YAW_POSITION",
        "Z_ALTITUDE_CONTROL": "SENSOR_Z_ALTITUDE_CONTROL",
        "XY_POSITION_CONTROL": "SENSOR_XY_POSITION_CONTROL",
        "MOTOR_OUTPUTS": "SENSOR_MOTOR_OUTPUTS",
        "RC_RECEIVER": "SENSOR_RC_RECEIVER",
        "BATTERY": "SENSOR_BATTERY",
        "SET_ACTUATOR_TARGET": "RESERVED3",  # the name until 2023; PX4 1.14 still says it
    }.get(name, name)


def test_every_message_has_the_dialects_name() -> None:
    for number, kind in TYPES.items():
        assert NAMES[number].replace("_", "").lower() == kind.__name__.lower()
