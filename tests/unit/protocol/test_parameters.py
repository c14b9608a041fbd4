"""The parameter protocol, asking side: what values mean, and how a read ends."""

from __future__ import annotations

import struct

from hypothesis import given
from hypothesis import strategies as st

from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.effects import (
    Address,
    Heard,
    ParamAbsent,
    ParamRead,
    ParamsDone,
    Send,
    Wake,
)
from gcs.protocol.parameters import (
    READ_TRIES,
    READ_WAIT_NS,
    ParamReader,
    decode_value,
)
from gcs.wire.ids import ParamError, ParamType
from gcs.wire.messages import Message, ParamRequestRead, ParamValue
from gcs.wire.messages import ParamError as ParamErrorMessage

OWN = Address(255, 190)
VEHICLE = Address(1, 1)
BYTEWISE, CAST = ParamEncoding.BYTEWISE, ParamEncoding.CAST


def value(name: str, wire: float, type_: ParamType, index: int = 0) -> ParamValue:
    return ParamValue(
        param_value=wire, param_count=872, param_index=index, param_id=name, param_type=type_
    )


def error(name: str, why: ParamError, to: Address = OWN) -> ParamErrorMessage:
    return ParamErrorMessage(
        param_index=-1,
        target_system=to.sysid,
        target_component=to.compid,
        param_id=name,
        error=why,
    )


def from_vehicle(message: Message) -> Heard:
    return Heard(1, 1, message)


def ask(name: str) -> Send:
    return Send(
        ParamRequestRead(param_index=-1, target_system=1, target_component=1, param_id=name)
    )


# ------------------------------------------------------------------------------- values


def test_px4_puts_an_integers_bytes_into_the_float() -> None:
    (wire,) = struct.unpack("<f", struct.pack("<i", 2))
    assert decode_value(wire, ParamType.INT32, BYTEWISE) == 2
    assert decode_value(wire, ParamType.INT32, CAST) == 0


def test_ardupilot_casts() -> None:
    assert decode_value(1500.0, ParamType.INT16, CAST) == 1500
    assert isinstance(decode_value(1500.0, ParamType.INT16, CAST), int)
    assert decode_value(0.25, ParamType.REAL32, CAST) == 0.25


SIZES = {
    ParamType.UINT8: (0, 2**8 - 1),
    ParamType.INT8: (-(2**7), 2**7 - 1),
    ParamType.UINT16: (0, 2**16 - 1),
    ParamType.INT16: (-(2**15), 2**15 - 1),
    ParamType.UINT32: (0, 2**31 - 2**23),
    ParamType.INT32: (-(2**22), 2**31 - 2**23 - 1),
}


@given(st.data(), st.sampled_from(sorted(SIZES)))
def test_integers_survive_bytewise(data: st.DataObject, type_: ParamType) -> None:
    number = data.draw(st.integers(*SIZES[type_]))
    raw = number.to_bytes(4, "little", signed=number < 0)
    wire: float = struct.unpack("<f", raw)[0]
    assert decode_value(wire, type_, BYTEWISE) == number


# -------------------------------------------------------------------------------- reads


def test_names_are_read_one_by_one() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, (("RTL_ALT",), ("FS_GCS_ENABLE",)))
    assert reader.start(0) == [ask("RTL_ALT")]
    first = reader.handle(from_vehicle(value("RTL_ALT", 1500.0, ParamType.INT32)), 5)
    assert first == [ParamRead("RTL_ALT", 1500, ParamType.INT32), ask("FS_GCS_ENABLE")]
    second = reader.handle(from_vehicle(value("FS_GCS_ENABLE", 1.0, ParamType.INT8)), 9)
    assert second == [ParamRead("FS_GCS_ENABLE", 1, ParamType.INT8), ParamsDone()]
    assert reader.ended
    assert reader.deadline_ns is None


def test_no_names_are_read_at_once() -> None:
    assert ParamReader(OWN, VEHICLE, CAST, ()).start(0) == [ParamsDone()]


def test_a_lost_request_is_sent_again_and_silence_means_absent() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, (("NO_SUCH",), ("RTL_ALT",)))
    effects = reader.start(0)
    for n in range(1, READ_TRIES + 1):
        assert reader.handle(Wake(), n * READ_WAIT_NS - 1) == []
        effects += reader.handle(Wake(), n * READ_WAIT_NS)
    asked = [ask("NO_SUCH")] * READ_TRIES
    assert effects == [*asked, ParamAbsent("NO_SUCH", None), ask("RTL_ALT")]


def test_an_error_means_absent_at_once() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, (("NO_SUCH",),))
    reader.start(0)
    to_others = error("NO_SUCH", ParamError.DOES_NOT_EXIST, Address(254, 1))
    assert reader.handle(from_vehicle(to_others), 1) == []
    assert reader.handle(from_vehicle(error("NO_SUCH", ParamError.DOES_NOT_EXIST)), 1) == [
        ParamAbsent("NO_SUCH", ParamError.DOES_NOT_EXIST),
        ParamsDone(),
    ]


def test_values_of_other_names_and_other_vehicles_are_not_the_answer() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, (("RTL_ALT",),))
    reader.start(0)
    other = value("WPNAV_SPEED", 500.0, ParamType.REAL32)
    assert reader.handle(from_vehicle(other), 1) == []
    assert reader.handle(Heard(2, 1, value("RTL_ALT", 1.0, ParamType.INT32)), 1) == []


def test_after_the_end_nothing_is_heard() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, (("A",),))
    reader.start(0)
    reader.handle(from_vehicle(value("A", 1.0, ParamType.INT8)), 1)
    assert reader.handle(from_vehicle(value("A", 1.0, ParamType.INT8)), 2) == []
    assert reader.handle(Wake(), 10**12) == []


def test_a_type_that_does_not_exist_is_a_float() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, (("A",),))
    reader.start(0)
    odd = ParamValue(param_value=2.5, param_count=1, param_index=0, param_id="A", param_type=99)
    assert reader.handle(from_vehicle(odd), 1)[0] == ParamRead("A", 2.5, ParamType.REAL32)


# -------------------------------------------------------------------- parameters of two names

TWO = (("RTL_ALT_M", "RTL_ALT"),)


def test_a_name_that_does_not_exist_is_followed_by_the_other_one_at_once() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, TWO)
    assert reader.start(0) == [ask("RTL_ALT_M")]
    refused = from_vehicle(error("RTL_ALT_M", ParamError.DOES_NOT_EXIST))
    assert reader.handle(refused, 5) == [ask("RTL_ALT")]
    told = reader.handle(from_vehicle(value("RTL_ALT", 1500.0, ParamType.INT32)), 9)
    assert told == [ParamRead("RTL_ALT", 1500, ParamType.INT32), ParamsDone()]


def test_after_silence_the_names_are_asked_in_turn() -> None:
    """An ArduCopter 4.5 says nothing of a name that it does not have; so does a lossy link."""
    reader = ParamReader(OWN, VEHICLE, CAST, TWO)
    effects = reader.start(0)
    for n in range(1, 2 * READ_TRIES + 1):
        effects += reader.handle(Wake(), n * READ_WAIT_NS)
    asked = [ask("RTL_ALT_M"), ask("RTL_ALT")] * READ_TRIES
    assert effects == [*asked, ParamAbsent("RTL_ALT_M", None), ParamsDone()]


def test_neither_name_exists() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, TWO)
    reader.start(0)
    reader.handle(from_vehicle(error("RTL_ALT_M", ParamError.DOES_NOT_EXIST)), 1)
    ended = reader.handle(from_vehicle(error("RTL_ALT", ParamError.DOES_NOT_EXIST)), 2)
    assert ended == [ParamAbsent("RTL_ALT_M", ParamError.DOES_NOT_EXIST), ParamsDone()]


def test_an_answer_that_comes_late_is_an_answer() -> None:
    reader = ParamReader(OWN, VEHICLE, CAST, (("A",), *TWO))
    reader.start(0)
    late = value("RTL_ALT_M", 15.0, ParamType.REAL32)
    assert reader.handle(from_vehicle(late), 1) == [ParamRead("RTL_ALT_M", 15.0, ParamType.REAL32)]
    known = reader.handle(from_vehicle(value("A", 1.0, ParamType.INT8)), 2)
    assert known == [ParamRead("A", 1, ParamType.INT8), ParamsDone()]
