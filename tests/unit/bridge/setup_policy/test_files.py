"""FILE_TRANSFER_PROTOCOL of a client: reading and writing are by policy."""

from __future__ import annotations

import struct

import pytest

from gcs.gate.refusal import Code
from gcs.wire.ids import FtpError, FtpOpcode
from gcs.wire.messages import FileTransferProtocol
from tests.unit.bridge.setup_policy.wire import FLYING, PARKED, allowed, guard, refused, sent

FORWARD = 'ftp_writes = "forward"'
WRITES = (
    FtpOpcode.CREATEFILE,
    FtpOpcode.WRITEFILE,
    FtpOpcode.REMOVEFILE,
    FtpOpcode.CREATEDIRECTORY,
    FtpOpcode.REMOVEDIRECTORY,
    FtpOpcode.OPENFILEWO,
    FtpOpcode.TRUNCATEFILE,
    FtpOpcode.RENAME,
)
CONTENT = {
    FtpOpcode.OPENFILERO,
    FtpOpcode.READFILE,
    FtpOpcode.CALCFILECRC,
    FtpOpcode.BURSTREADFILE,
}
READS = (
    FtpOpcode.NONE,
    FtpOpcode.TERMINATESESSION,
    FtpOpcode.RESETSESSION,
    FtpOpcode.LISTDIRECTORY,
    FtpOpcode.OPENFILERO,
    FtpOpcode.READFILE,
    FtpOpcode.CALCFILECRC,
    FtpOpcode.BURSTREADFILE,
    16,  # ListDirectoryWithTime (pymavlink 2.4.50, `mavftp_op.py`)
)


def ftp(
    opcode: int, data: bytes = b"", seq: int = 7, session: int = 3, size: int | None = None
) -> FileTransferProtocol:
    """As https://mavlink.io/en/services/ftp.html lays the payload out."""
    size = len(data) if size is None else size
    head = struct.pack("<HBBBBBxI", seq, session, opcode, size, 0, 0, 0x01020304)
    message = sent("file_transfer_protocol", 0, 1, 1, list((head + data).ljust(251, b"\0")))
    assert isinstance(message, FileTransferProtocol)
    return message


def negative(answers: tuple[object, ...]) -> tuple[int, int, int, int, int, int]:
    """seq, session, opcode, size, opcode that was asked for, error; addressed to the client."""
    (answer,) = answers
    assert isinstance(answer, FileTransferProtocol)
    assert (answer.target_system, answer.target_component) == (245, 190)
    seq, session, opcode, size, asked, _, offset = struct.unpack_from(
        "<HBBBBBxI", bytes(answer.payload)
    )
    assert offset == 0x01020304
    return seq, session, opcode, size, asked, answer.payload[12]


@pytest.mark.parametrize("opcode", READS)
def test_reading_is_forwarded(opcode: int) -> None:
    allowed(guard().judge(ftp(opcode, b"@PARAM/param.pck"), PARKED))
    allowed(guard('downloads = "forward"').judge(ftp(opcode, b"@PARAM/param.pck"), FLYING))


@pytest.mark.parametrize("opcode", READS)
def test_in_the_air_files_are_listed_and_not_read(opcode: int) -> None:
    judged = guard().judge(ftp(opcode, b"/fs/microsd/log/1.ulg"), FLYING)
    if opcode in CONTENT:
        found = refused(judged)
        assert found.refusal.code is Code.IN_AIR
        assert "bridge.downloads" in found.refusal.sentence
        assert negative(found.answers)[-1] == FtpError.FILEPROTECTED
    else:
        allowed(judged)


@pytest.mark.parametrize("opcode", WRITES)
def test_writing_is_refused_as_the_protocol_says_it(opcode: int) -> None:
    found = refused(guard().judge(ftp(opcode, b"/fs/microsd/x"), PARKED))
    assert found.refusal.code is Code.POLICY
    assert "bridge.ftp_writes" in found.refusal.sentence
    assert negative(found.answers) == (8, 3, FtpOpcode.NAK, 1, opcode, FtpError.FILEPROTECTED)


def test_the_number_of_an_answer_starts_again_at_zero() -> None:
    found = refused(guard().judge(ftp(FtpOpcode.REMOVEFILE, b"/x", seq=65535), PARKED))
    assert negative(found.answers)[0] == 0


@pytest.mark.parametrize("opcode", WRITES)
def test_the_policy_may_forward_writing(opcode: int) -> None:
    note = allowed(guard(FORWARD).judge(ftp(opcode, b"/APM/x.txt"), PARKED)).note
    assert ("/APM/x.txt" in note) == (opcode != FtpOpcode.WRITEFILE)


@pytest.mark.parametrize(
    "path",
    [
        b"@PARAM/param.pck",
        b"/@PARAM/param.pck",
        b"@MISSION/mission.dat",
        b"@MISSION/fence.dat",
        b"x\0@SYS/y",
        b"/a/../@PARAM/param.pck",
    ],
)
def test_set_up_that_is_written_as_a_file_is_refused_whatever_the_policy(path: bytes) -> None:
    for opcode in (FtpOpcode.CREATEFILE, FtpOpcode.OPENFILEWO, FtpOpcode.RENAME):
        found = refused(guard(FORWARD).judge(ftp(opcode, path), PARKED))
        assert negative(found.answers)[-1] == FtpError.FILEPROTECTED
        assert "set-up" in found.refusal.sentence


def test_a_path_behind_the_size_that_is_told_is_found_too() -> None:
    refused(guard(FORWARD).judge(ftp(FtpOpcode.CREATEFILE, b"@PARAM/param.pck", size=0), PARKED))


def test_data_that_looks_like_a_path_may_be_written() -> None:
    allowed(guard(FORWARD).judge(ftp(FtpOpcode.WRITEFILE, b"@PARAM/param.pck"), PARKED))


@pytest.mark.parametrize("opcode", [17, 64, 127, 130, 255])
def test_an_opcode_that_is_not_known_is_answered(opcode: int) -> None:
    found = refused(guard(FORWARD).judge(ftp(opcode), PARKED))
    assert negative(found.answers)[-1] == FtpError.UNKNOWNCOMMAND


def test_more_data_than_there_is_room_for_is_answered() -> None:
    found = refused(guard(FORWARD).judge(ftp(FtpOpcode.CREATEFILE, size=240), PARKED))
    assert negative(found.answers)[-1] == FtpError.INVALIDDATASIZE


@pytest.mark.parametrize("opcode", [FtpOpcode.ACK, FtpOpcode.NAK])
def test_an_answer_of_a_client_is_answered_by_nothing(opcode: int) -> None:
    assert refused(guard(FORWARD).judge(ftp(opcode), PARKED)).answers == ()
