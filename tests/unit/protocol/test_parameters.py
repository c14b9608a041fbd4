"""What a value of the parameter protocol means."""

from __future__ import annotations

import struct

from hypothesis import given
from hypothesis import strategies as st

from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.parameters import decode_value
from gcs.wire.ids import ParamType

BYTEWISE, CAST = ParamEncoding.BYTEWISE, ParamEncoding.CAST


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
