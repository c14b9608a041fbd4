"""All parameters of a vehicle: by messages on a link that loses some, and from a packed file."""

from __future__ import annotations

import random
import struct

import pytest

from gcs.float32 import float32, value_text
from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.parameters import Parameter, why_not
from gcs.protocol.transfers.parameter_list import ListDone, ListEffect, ListFailed, ParameterList
from gcs.protocol.transfers.parameter_pack import PackError, unpack
from gcs.wire.ids import ParamType
from gcs.wire.messages import ParamRequestList, ParamRequestRead, ParamValue

VEHICLE = Address(1, 1)
REAL32, UINT32 = 9, 5


class Vehicle:
    """Tells `count` parameters, P0 = 0 and so on; `grows`: one more once the list was asked for."""

    def __init__(self, count: int, loss: float = 0.0, *, grows: bool = False) -> None:
        self.count = count
        self.loss = loss
        self.grows = grows
        self.dice = random.Random(3)

    def value(self, index: int) -> ParamValue:
        return ParamValue(float(index), self.count, index, f"P{index}", REAL32)

    def answer(self, asked: object) -> list[ParamValue]:
        if self.dice.random() < self.loss:
            return []
        told: list[ParamValue] = []
        if isinstance(asked, ParamRequestList):
            told = [ParamValue(1.5, self.count, 0xFFFF, "_HASH_CHECK", UINT32)]
            for index in range(self.count):
                self.count += self.grows and index == 50
                told.append(self.value(index))
        elif isinstance(asked, ParamRequestRead):
            told = [self.value(asked.param_index)]
        return [each for each in told if self.dice.random() >= self.loss]


def listed(vehicle: Vehicle) -> tuple[ListEffect, float]:
    """How it ended, and after how many seconds."""
    machine = ParameterList(VEHICLE, ParamEncoding.CAST)
    now_ns = 0
    effects = machine.start(now_ns)
    for _ in range(100_000):
        answers = []
        for effect in effects:
            if isinstance(effect, ListDone | ListFailed):
                assert machine.deadline_ns is None
                return effect, now_ns / 1e9
            if isinstance(effect, Send):
                answers += vehicle.answer(effect.message)
        now_ns += 1_000_000
        effects = [e for a in answers for e in machine.handle(Heard(1, 1, a), now_ns)]
        if not answers:
            assert machine.deadline_ns is not None
            now_ns = max(now_ns, machine.deadline_ns)
            effects = machine.handle(Wake(), now_ns)
    raise AssertionError("it does not end")


@pytest.mark.parametrize("loss", [0.0, 0.2, 0.5])
def test_all_of_them_come_whatever_is_lost(loss: float) -> None:
    ended, seconds = listed(Vehicle(1000, loss))
    expected = tuple(Parameter(f"P{n}", float(n), ParamType.REAL32) for n in range(1000))
    assert ended == ListDone(expected)
    assert seconds < 0.1 or loss


def test_one_more_while_the_list_is_on_its_way() -> None:
    """As a PX4 does (recorded: 872, then 873)."""
    ended, _ = listed(Vehicle(100, grows=True))
    assert isinstance(ended, ListDone)
    assert len(ended.parameters) == 101


def test_a_vehicle_that_tells_nothing_is_given_up() -> None:
    ended, seconds = listed(Vehicle(10, loss=1.0))
    assert ended == ListFailed("the vehicle tells no parameters")
    assert seconds < 5.0


PACKED = (
    struct.pack("<HHH", 0x671B, 3, 3)
    + bytes((0x04, 0x70 | 0)) + b"AHRS_YAW" + struct.pack("<f", 0.5)
    + bytes(3)  # that a value does not lie across two blocks
    + bytes((0x01, 0x20 | 5)) + b"RPM" + struct.pack("<b", -2)
    + bytes((0x03, 0x00 | 8)) + b"A" + struct.pack("<i", 70_000)
)  # fmt: skip
"""By https://mavlink.io/en/services/parameter_ftp.html."""


def test_a_packed_file() -> None:
    assert unpack(PACKED) == (
        Parameter("AHRS_YAW", 0.5, ParamType.REAL32),
        Parameter("AHRS_RPM", -2, ParamType.INT8),
        Parameter("AHRS_RPMA", 70_000, ParamType.INT32),
    )
    for cut in range(len(PACKED)):
        with pytest.raises(PackError):
            unpack(PACKED[:cut])
    with pytest.raises(PackError, match="0x6720"):
        unpack(b"\x20" + PACKED[1:])


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.1, "0.1"),
        (0.30000001192092896, "0.3"),
        (202.5, "202.5"),
        (1e6, "1000000"),
        (16_777_216.0, "16777216"),
        (3.4028234663852886e38, "3.4028235e+38"),
        (1e-5, "0.00001"),
        (-0.0, "-0"),
    ],
)
def test_a_value_is_written_in_the_fewest_digits_that_mean_it(value: float, text: str) -> None:
    assert value_text(float32(value)) == text


def test_any_float_is_read_back_as_it_was() -> None:
    dice = random.Random(1)
    for _ in range(2_000):
        (value,) = struct.unpack("<f", dice.randbytes(4))
        if value == value and abs(value) != float("inf"):
            assert float32(float(value_text(value))) == value


@pytest.mark.parametrize(
    ("value", "kind", "encoding", "wrong"),
    [
        (2.0, ParamType.INT8, ParamEncoding.CAST, ""),
        (2.5, ParamType.INT32, ParamEncoding.BYTEWISE, "whole number"),
        (128.0, ParamType.INT8, ParamEncoding.CAST, "-128 to 127"),
        (16_777_217.0, ParamType.INT32, ParamEncoding.CAST, "cannot travel"),
        (16_777_217.0, ParamType.INT32, ParamEncoding.BYTEWISE, ""),
        (float("nan"), ParamType.REAL32, ParamEncoding.CAST, "not a finite"),
        (1e39, ParamType.REAL32, ParamEncoding.CAST, "32-bit"),
    ],
)
def test_what_a_parameter_can_be_set_to(
    value: float, kind: ParamType, encoding: ParamEncoding, wrong: str
) -> None:
    said = why_not("P", value, kind, encoding)
    assert wrong in said if wrong else said == ""
