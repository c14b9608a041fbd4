"""Parameters, files and logs, byte for byte as a client sees them."""

from __future__ import annotations

import math
import struct

import pytest
from pymavlink.dialects.v20 import all as mavlink

from tests.contract.client import ACCEPTED, BOTH, Client, Message, connected
from vehicle_sim.autopilot.modes import Personality

either = pytest.mark.parametrize("personality", BOTH)
WHOLE = {"px4": "MAV_SYS_ID", "ardupilot": "SYSID_THISMAV"}
REAL = {"px4": "MPC_XY_CRUISE", "ardupilot": "WPNAV_SPEED"}
INT32, REAL32 = 6, 9

OPEN_RO, READ, TERMINATE, CREATE, WRITE, REMOVE, LIST = 4, 5, 1, 6, 7, 8, 3
ACK, NAK = 128, 129
EOF, FILE_NOT_FOUND = 6, 10


def set_parameter(client: Client, name: str, value: float, kind: int) -> list[Message]:
    asked = mavlink.MAVLink_param_set_message(1, 1, name.encode(), value, kind)
    return client.send(asked)


def bytewise(value: int) -> float:
    (told,) = struct.unpack("<f", struct.pack("<i", value))
    assert isinstance(told, float)
    return told


def valued(message: Message, personality: Personality) -> float:
    if personality == "px4" and message.param_type == INT32:
        return float(struct.unpack("<i", struct.pack("<f", message.param_value))[0])
    return float(message.param_value)


@either
def test_parameters_are_listed_read_and_set(personality: Personality) -> None:
    """PARAM_REQUEST_LIST / READ / SET."""
    client = connected(personality)
    client.forget()
    client.send(mavlink.MAVLink_param_request_list_message(1, 1))
    client.sky.run(5.0)
    listed = [each for each in client.all("PARAM_VALUE") if each.param_id != "_HASH_CHECK"]
    count = listed[0].param_count
    assert len(listed) == count >= 60
    assert sorted(each.param_index for each in listed) == list(range(count))
    assert bool([e for e in client.all("PARAM_VALUE") if e.param_id == "_HASH_CHECK"]) == (
        personality == "px4"
    )
    by_name = {each.param_id: each for each in listed}
    whole = by_name[WHOLE[personality]]
    assert valued(whole, personality) == 1.0

    read = mavlink.MAVLink_param_request_read_message(1, 1, b"", whole.param_index)
    (one,) = client.send(read)
    assert (one.param_id, one.param_index) == (whole.param_id, whole.param_index)
    read = mavlink.MAVLink_param_request_read_message(1, 1, REAL[personality].encode(), -1)
    (one,) = client.send(read)
    assert one.param_id == REAL[personality]

    (back,) = set_parameter(client, REAL[personality], one.param_value * 0.5, REAL32)
    assert back.param_value == pytest.approx(one.param_value * 0.5)
    (back,) = set_parameter(client, REAL[personality], math.nan, REAL32)
    assert back.param_value == pytest.approx(one.param_value * 0.5), "the old value"
    assert set_parameter(client, "NO_SUCH_THING", 1.0, REAL32) == [], "4.7 has PARAM_ERROR"


@either
def test_whole_numbers_travel_the_way_the_capability_bit_says(personality: Personality) -> None:
    client = connected(personality)
    name = "NAV_DLL_ACT" if personality == "px4" else "FS_GCS_ENABLE"
    value = bytewise(3) if personality == "px4" else 3.0
    (back,) = set_parameter(client, name, value, INT32)
    assert valued(back, personality) == 3.0
    _, (version,) = client.request_message(148)
    # ArduPilot is recorded with neither bit (0xfbef); C_CAST is what none of them means.
    told = version.capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE
    assert bool(told) is (personality == "px4")


# ------------------------------------------------------------------------------------ files


class Files:
    """FTP by hand."""

    def __init__(self, client: Client) -> None:
        self.client = client
        self.sequence = 0

    def ask(
        self,
        opcode: int,
        data: bytes = b"",
        session: int = 0,
        offset: int = 0,
        size: int | None = None,
        again: bool = False,
    ) -> tuple[int, int, bytes]:
        """Opcode, session and data of the reply."""
        self.sequence += 0 if again else 1
        length = len(data) if size is None else size
        head = struct.pack("<HBBBBBBI", self.sequence, session, opcode, length, 0, 0, 0, offset)
        payload = (head + data).ljust(251, b"\0")
        asked = mavlink.MAVLink_file_transfer_protocol_message(0, 1, 1, payload)
        (reply,) = self.client.send(asked)
        raw = bytes(reply.payload).ljust(251, b"\0")
        sequence, used, code, told, of, _, _, _ = struct.unpack("<HBBBBBBI", raw[:12])
        assert (sequence, of) == (self.sequence + 1, opcode)
        return code, used, raw[12 : 12 + told]


@either
def test_files_are_written_listed_read_and_removed(personality: Personality) -> None:
    """FTP."""
    client = connected(personality)
    files = Files(client)
    root = "" if personality == "ardupilot" else "/fs/microsd"
    name = f"{root}/note.txt".encode()
    code, session, _ = files.ask(CREATE, name)
    assert code == ACK
    for again in (False, True):
        assert files.ask(WRITE, b"hello", session, again=again)[0] == ACK, "a retry is answered"
    assert files.ask(TERMINATE, session=session)[0] == ACK
    code, _, listed = files.ask(LIST, f"{root}/".encode())
    assert code == ACK
    assert b"Fnote.txt\t5" in listed
    code, session, size = files.ask(OPEN_RO, name)
    assert (code, int.from_bytes(size, "little")) == (ACK, 5)
    assert files.ask(READ, session=session, size=100)[2] == b"hello"
    code, _, why = files.ask(READ, session=session, offset=5, size=100)
    assert (code, why[0]) == (NAK, EOF)
    files.ask(TERMINATE, session=session)
    assert files.ask(REMOVE, name)[0] == ACK
    code, _, why = files.ask(OPEN_RO, name)
    assert (code, why[0]) == (NAK, FILE_NOT_FOUND)
    for path in (b"/../../etc/passwd", b"../../../../etc/passwd", b"/etc/passwd"):
        assert files.ask(OPEN_RO, path)[0] == NAK


def test_ardupilot_packs_its_parameters_in_a_file() -> None:
    client = connected("ardupilot")
    files = Files(client)
    code, session, size = files.ask(OPEN_RO, b"@PARAM/param.pck")
    assert code == ACK
    assert int.from_bytes(size, "little") > 500
    head = files.ask(READ, session=session, size=6)[2]
    assert struct.unpack("<H", head[:2])[0] == 0x671B


def test_px4_has_the_metadata_that_it_promises() -> None:
    client = connected("px4")
    client.forget()
    assert client.request_message(397)[0] == ACCEPTED
    assert b"mftp" in bytes(client.raw)


# ------------------------------------------------------------------------------------- logs


@either
def test_flights_are_logged_and_the_logs_are_read_over_the_link(personality: Personality) -> None:
    """LOG_REQUEST_LIST / DATA / END / ERASE."""
    client = connected(personality)
    client.take_off(4.0)
    client.long(400, 0, 21196)
    client.sky.run(4.0)
    client.forget()
    client.send(mavlink.MAVLink_log_request_list_message(1, 1, 0, 0xFFFF))
    client.sky.run(2.0)
    entry = client.last("LOG_ENTRY")
    assert entry.size > 1000
    assert entry.num_logs >= 1
    client.forget()
    client.send(mavlink.MAVLink_log_request_data_message(1, 1, entry.id, 0, 200))
    client.sky.run(2.0)
    parts = client.all("LOG_DATA")
    assert [(part.ofs, part.count) for part in parts[:3]] == [(0, 90), (90, 90), (180, 20)]
    head = bytes(parts[0].data[:7])
    assert head.startswith(b"\xa3\x95\x80" if personality == "ardupilot" else b"ULog\x01\x12\x35")
    client.forget()
    beyond = mavlink.MAVLink_log_request_data_message(1, 1, entry.id, entry.size + 500, 90)
    client.send(beyond)
    client.sky.run(1.0)
    assert [part.count for part in client.all("LOG_DATA")] == [0]
    client.send(mavlink.MAVLink_log_request_end_message(1, 1))
    client.send(mavlink.MAVLink_log_erase_message(1, 1))
    client.forget()
    client.send(mavlink.MAVLink_log_request_list_message(1, 1, 0, 0xFFFF))
    client.sky.run(2.0)
    assert client.last("LOG_ENTRY").num_logs == 0
