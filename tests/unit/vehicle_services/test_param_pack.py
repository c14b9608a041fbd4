"""`param.pck`, read by pymavlink's own reader."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.mavftp import MAVFTP

from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.param_pack import param_pack, unpack
from vehicle_sim.storage.store import StoreError


def read(parameters: Parameters, query: str = "") -> dict[str, tuple[float, int]]:
    """Names, values and AP_Param types, as pymavlink finds them."""
    decoded = MAVFTP.ftp_param_decode(param_pack(parameters).read(query))
    assert decoded is not None
    return {name.decode(): (value, kind) for name, value, kind in decoded.params}


def test_every_parameter_is_there_in_the_order_of_the_list() -> None:
    parameters = Parameters("ardupilot")
    packed = read(parameters)
    assert [*packed] == [spec.name for spec in parameters.specs]
    apart = sum(6 + len(spec.name) for spec in parameters.specs)
    assert len(param_pack(parameters).read("")) < 0.8 * apart, "names share their prefixes"
    for spec in parameters.specs:
        kind = {2: 1, 4: 2, 6: 3, 9: 4}[spec.stored_as]  # MAV_PARAM_TYPE to AP_Param's
        assert packed[spec.name] == (parameters.value(spec.name), kind)


def test_defaults_come_where_they_differ() -> None:
    parameters = Parameters("ardupilot")
    parameters.set("SYSID_THISMAV", 7.0)
    parameters.set("GUID_TIMEOUT", 2.5)
    data = param_pack(parameters).read("withdefaults=1")
    decoded = MAVFTP.ftp_param_decode(data)
    assert decoded is not None
    assert decoded.defaults is not None
    values = {name: value for name, value, _ in decoded.params}
    defaults = {name: value for name, value, _ in decoded.defaults}
    assert (values[b"SYSID_THISMAV"], defaults[b"SYSID_THISMAV"]) == (7, 1)
    changed = [name for name, value in values.items() if defaults[name] != value]
    assert sorted(changed) == [b"GUID_TIMEOUT", b"SYSID_THISMAV"]
    assert len(data) == len(param_pack(parameters).read("")) + 2 + 4


def test_a_part_is_to_be_had() -> None:
    parameters = Parameters("ardupilot")
    names = [spec.name for spec in parameters.specs]
    data = param_pack(parameters).read("start=3&count=4")
    assert struct.unpack("<HHH", data[:6]) == (0x671B, 4, len(names))
    assert [*read(parameters, "start=3&count=4")] == names[3:7]
    assert [*read(parameters, f"start={len(names) - 1}")] == names[-1:]
    assert [*read(parameters, "count=9999&other=x")] == names


@pytest.mark.parametrize(
    "query", ["start=65535", "start=x", "start=-1", "count=", "withdefaults=2", "start=700"]
)
def test_a_part_that_there_is_not(query: str) -> None:
    with pytest.raises(StoreError):
        param_pack(Parameters("ardupilot")).read(query)


def upload(*entries: tuple[int, int, bytes, bytes]) -> bytes:
    """Type, shared prefix, rest of the name, value; the header has the file's length."""
    body = b"".join(
        bytes((kind, shared | (len(rest) - 1) << 4)) + rest + value
        for kind, shared, rest, value in entries
    )
    return struct.pack("<HHH", 0x671B, len(entries), 6 + len(body)) + body


def write(parameters: Parameters, data: bytes) -> None:
    file = param_pack(parameters)
    assert file.write is not None
    file.write(data)


def test_an_upload_sets_what_is_known() -> None:
    parameters = Parameters("ardupilot")
    write(
        parameters,
        upload(
            (1, 0, b"SYSID_THISMAV", b"\x09"),
            (2, 0, b"NO_SUCH", b"\x01\x00"),
            (4, 0, b"GUID_TIMEOUT", struct.pack("<f", math.nan)),
            (3, 0, b"WP_YAW_BEHAVIOR", struct.pack("<i", 1)),
            (4, 2, b"NAV_SPEED", struct.pack("<f", 700.0)),
        ),
    )
    assert parameters.get("SYSID_THISMAV") == 9
    assert parameters.get("WP_YAW_BEHAVIOR") == 1
    assert parameters.get("WPNAV_SPEED") == 700
    assert parameters.get("GUID_TIMEOUT") == 3.0


@given(st.binary(max_size=60), st.integers(0, 70))
def test_an_upload_that_is_none_changes_nothing(noise: bytes, cut: int) -> None:
    parameters = Parameters("ardupilot")
    good = upload((1, 0, b"SYSID_THISMAV", b"\x09"), (1, 5, b"_NEXT", b"\x01"))
    for data in (noise, good[: min(cut, len(good) - 1)], good + noise[:1] + b"\0"):
        with pytest.raises(StoreError):
            write(parameters, data)
    assert parameters.version == 0


@given(st.binary(max_size=300))
def test_no_bytes_break_the_reader(noise: bytes) -> None:
    header = struct.pack("<HHH", 0x671B, 5, 6 + len(noise))
    try:
        unpack(header + noise)
    except ValueError:
        return
