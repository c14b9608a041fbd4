"""MAVLink FTP by its specification, and by the habits of MAVSDK, mavftp and QGroundControl."""

from __future__ import annotations

import pytest

from tests.unit.vehicle_services.ftp_client import (
    GROUND,
    MS,
    FtpBench,
    S,
    frame,
    refused,
)
from vehicle_sim.effects import Client
from vehicle_sim.services.ftp.wire import Nak, Opcode
from vehicle_sim.storage.store import StoreError, StoreFault, put
from vehicle_sim.storage.virtual_files import Virtual

BIG = bytes(range(251)) * 400  # 100,400 bytes


def listing(bench: FtpBench, path: bytes) -> list[bytes]:
    """All pages of it."""
    lines: list[bytes] = []
    while True:
        reply = bench.ask(Opcode.LIST_DIRECTORY, path, offset=len(lines))
        if reply.opcode is Opcode.NAK:
            assert refused(reply) is Nak.EOF
            return lines
        assert reply.data.endswith(b"\0")
        lines += reply.data[:-1].split(b"\0")


# ------------------------------------------------------------------------------ directories


def test_a_directory_is_listed_in_pages() -> None:
    bench = FtpBench()
    bench.store.make_directory("sub")
    for number in range(40):
        bench.store.create(f"file{number:02}.bin")
    bench.store.write("file07.bin", 0, bytes(1234))
    lines = listing(bench, b"/")
    assert lines[7] == b"Ffile07.bin\t1234"
    assert lines[40:] == [b"Dsub"]


def test_an_empty_directory_ends_at_once_and_a_missing_one_is_not_found() -> None:
    """An empty ACK would send mavftp into a loop."""
    bench = FtpBench()
    bench.store.make_directory("empty")
    assert listing(bench, b"empty") == []
    assert refused(bench.ask(Opcode.LIST_DIRECTORY, b"none")) is Nak.FILE_NOT_FOUND


def test_directories_are_made_and_removed() -> None:
    bench = FtpBench()
    assert bench.ask(Opcode.CREATE_DIRECTORY, b"a").opcode is Opcode.ACK
    assert refused(bench.ask(Opcode.CREATE_DIRECTORY, b"a")) is Nak.FILE_EXISTS
    put(bench.store, "a/f", b"x")
    full = bench.ask(Opcode.REMOVE_DIRECTORY, b"a")
    assert full.data == bytes((Nak.FAIL_ERRNO, 39))
    bench.store.remove("a/f")
    assert bench.ask(Opcode.REMOVE_DIRECTORY, b"a").opcode is Opcode.ACK
    assert refused(bench.ask(Opcode.REMOVE_DIRECTORY, b"a")) is Nak.FILE_NOT_FOUND


# ---------------------------------------------------------------------------------- reading


def test_a_file_is_opened_read_and_closed() -> None:
    bench = FtpBench()
    put(bench.store, "log/f", BIG)
    opened = bench.ask(Opcode.OPEN_FILE_RO, b"/log/f")
    assert int.from_bytes(opened.data, "little") == len(BIG)
    assert len(opened.data) == 4
    part = bench.ask(Opcode.READ_FILE, offset=1000, size=80, session=opened.session)
    assert (part.data, part.offset) == (BIG[1000:1080], 1000)
    end = bench.ask(Opcode.READ_FILE, offset=len(BIG) - 10, size=239)
    assert end.data == BIG[-10:]
    assert refused(bench.ask(Opcode.READ_FILE, offset=len(BIG), size=239)) is Nak.EOF
    assert refused(bench.ask(Opcode.READ_FILE, offset=0xFFFFFFFF, size=239)) is Nak.EOF
    assert bench.ask(Opcode.TERMINATE_SESSION).opcode is Opcode.ACK
    assert refused(bench.ask(Opcode.READ_FILE, size=80)) is Nak.INVALID_SESSION
    assert refused(bench.ask(Opcode.TERMINATE_SESSION)) is Nak.INVALID_SESSION


def test_paths_end_at_a_nul_as_mavsdk_sends_them_or_without_one() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"x")
    assert bench.ask(Opcode.OPEN_FILE_RO, b"f\0").opcode is Opcode.ACK
    assert bench.ask(Opcode.CALC_FILE_CRC32, b"f").opcode is Opcode.ACK
    assert refused(bench.ask(Opcode.OPEN_FILE_RO, b"\xff", session=1)) is Nak.FAIL_ERRNO


def test_a_burst_counts_on_from_the_request_and_comes_paced() -> None:
    bench = FtpBench()
    put(bench.store, "f", BIG)
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    bench.burst(size=80)
    first = bench.sequence + 1
    packets = bench.advance(20 * MS)
    assert 20 < sum(len(packet.data) for packet in packets) / 80 < 160, "half a megabyte a second"
    packets += bench.advance(2 * S)
    assert [packet.sequence for packet in packets] == [*range(first, first + 150)]
    assert b"".join(packet.data for packet in packets) == BIG[: 150 * 80]
    assert [packet.offset for packet in packets] == [number * 80 for number in range(150)]
    assert [packet.burst_complete for packet in packets] == [False] * 149 + [True]


def test_bursts_that_are_asked_for_again_bring_the_whole_file_and_its_end() -> None:
    bench = FtpBench()
    put(bench.store, "f", BIG)
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    got = b""
    for _ in range(20):
        bench.burst(offset=len(got))
        packets = bench.advance(500 * MS)
        got += b"".join(packet.data for packet in packets if packet.opcode is Opcode.ACK)
        if packets[-1].opcode is Opcode.NAK:
            break
    assert got == BIG
    assert (refused(packets[-1]), packets[-1].offset) == (Nak.EOF, len(BIG))
    assert packets[-1].sequence == packets[-2].sequence + 1
    assert bench.advance(1 * S) == []


def test_a_client_that_ends_the_session_on_the_last_byte_hears_of_no_end() -> None:
    """MAVSDK would warn about it."""
    bench = FtpBench()
    put(bench.store, "f", bytes(239 * 3))
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    bench.burst()
    packets = bench.advance(8 * MS)
    assert [len(packet.data) for packet in packets] == [239, 239, 239]
    bench.ask(Opcode.TERMINATE_SESSION)
    assert bench.advance(1 * S) == []


def test_a_burst_starts_anew_where_the_client_stalled() -> None:
    """mavftp repeats the same sequence number with another offset."""
    bench = FtpBench()
    put(bench.store, "f", BIG)
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    bench.burst()
    bench.advance(8 * MS)
    asked = frame(Opcode.BURST_READ_FILE, sequence=bench.sequence, offset=5000, size=239)
    bench.server.handle(GROUND, asked, bench.now_ns)
    (packet, *_) = bench.advance(4 * MS)
    assert (packet.offset, packet.sequence) == (5000, bench.sequence + 1)


def test_a_file_that_goes_away_ends_its_burst() -> None:
    bench = FtpBench()
    put(bench.store, "f", BIG)
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    bench.burst()
    bench.advance(8 * MS)
    bench.ask(Opcode.REMOVE_FILE, b"f")
    (last,) = bench.advance(1 * S)
    assert refused(last) is Nak.FILE_NOT_FOUND
    assert last.burst_complete


# ---------------------------------------------------------------------------------- writing


def test_a_file_is_created_and_written_in_any_order() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"longer than what comes")
    assert bench.ask(Opcode.CREATE_FILE, b"f").data == b""
    for offset in (80, 0, 160, 80):
        told = bench.ask(Opcode.WRITE_FILE, BIG[offset : offset + 80], offset=offset)
        assert (told.opcode, told.offset, told.data) == (Opcode.ACK, offset, b"")
    assert bench.store.read("f", 0, 999) == BIG[:240]
    assert refused(bench.ask(Opcode.READ_FILE, size=80)) is Nak.FAIL


def test_open_for_writing_keeps_what_is_there() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"0123456789")
    assert bench.ask(Opcode.OPEN_FILE_WO, b"f").data == (10).to_bytes(4, "little")
    bench.ask(Opcode.WRITE_FILE, b"xy", offset=4)
    assert bench.store.read("f", 0, 99) == b"0123xy6789"
    assert bench.ask(Opcode.OPEN_FILE_WO, b"new", session=1).data == bytes(4)
    assert bench.store.size("new") == 0


def test_files_are_truncated_renamed_summed_and_removed() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"123456789")
    assert bench.ask(Opcode.TRUNCATE_FILE, b"f", offset=4).opcode is Opcode.ACK
    assert bench.store.read("f", 0, 99) == b"1234"
    assert bench.ask(Opcode.RENAME, b"f\0g").opcode is Opcode.ACK
    assert bench.ask(Opcode.RENAME, b"g\0h\0").opcode is Opcode.ACK
    assert refused(bench.ask(Opcode.RENAME, b"h")) is Nak.INVALID_DATA_SIZE
    put(bench.store, "h", b"123456789")
    crc = bench.ask(Opcode.CALC_FILE_CRC32, b"h").data
    assert int.from_bytes(crc, "little") == 0x2DFD2D88  # CRC-32 from 0, not inverted
    assert bench.ask(Opcode.REMOVE_FILE, b"h").opcode is Opcode.ACK
    assert refused(bench.ask(Opcode.REMOVE_FILE, b"h")) is Nak.FILE_NOT_FOUND
    assert refused(bench.ask(Opcode.CALC_FILE_CRC32, b"h")) is Nak.FILE_NOT_FOUND


def test_a_full_store_says_so() -> None:
    bench = FtpBench()
    bench.ask(Opcode.CREATE_FILE, b"f")
    told = bench.ask(Opcode.WRITE_FILE, b"x", offset=4_000_000_000)
    assert told.data == bytes((Nak.FAIL_ERRNO, 28))
    assert bench.store.used_bytes == 0


# -------------------------------------------------------------------------------- refusals


def test_what_is_no_request_is_named() -> None:
    bench = FtpBench()
    assert bench.ask(Opcode.NONE).opcode is Opcode.ACK
    assert refused(bench.ask(16, b"/")) is Nak.UNKNOWN_COMMAND
    assert refused(bench.ask(77)) is Nak.UNKNOWN_COMMAND
    assert refused(bench.ask(Opcode.LIST_DIRECTORY, b"/", size=240)) is Nak.INVALID_DATA_SIZE


@pytest.mark.parametrize("opcode", [Opcode.ACK, Opcode.NAK])
def test_answers_are_not_answered(opcode: Opcode) -> None:
    assert FtpBench().server.handle(GROUND, frame(opcode), 0) == []


@pytest.mark.parametrize("path", [b"../x", b"/a/../../x", b"..\\x", b"a\tb", b"\xff\xfe"])
def test_no_path_leads_out(path: bytes) -> None:
    bench = FtpBench()
    for opcode in (
        Opcode.LIST_DIRECTORY,
        Opcode.OPEN_FILE_RO,
        Opcode.CREATE_FILE,
        Opcode.OPEN_FILE_WO,
        Opcode.REMOVE_FILE,
        Opcode.CREATE_DIRECTORY,
        Opcode.REMOVE_DIRECTORY,
        Opcode.TRUNCATE_FILE,
        Opcode.CALC_FILE_CRC32,
    ):
        assert bench.ask(opcode, path).data == bytes((Nak.FAIL_ERRNO, 22))


# --------------------------------------------------------------------------------- retries


def test_a_request_that_comes_again_has_the_same_reply_and_no_second_effect() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"x")
    for opcode, data in (
        (Opcode.CREATE_DIRECTORY, b"d"),
        (Opcode.RENAME, b"f\0g"),
        (Opcode.REMOVE_FILE, b"g"),
        (Opcode.REMOVE_DIRECTORY, b"d"),
        (Opcode.CREATE_FILE, b"h"),
        (Opcode.TERMINATE_SESSION, b""),
    ):
        first = bench.ask(opcode, data)
        assert first.opcode is Opcode.ACK
        for _ in range(3):
            bench.now_ns += 1 * S
            assert bench.ask(opcode, data, sequence=bench.sequence) == first
            bench.sequence -= 2
        bench.sequence += 2


def test_an_open_that_comes_again_opens_no_second_session() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"x")
    first = bench.ask(Opcode.OPEN_FILE_RO, b"f", sequence=9)
    assert bench.ask(Opcode.OPEN_FILE_RO, b"f", sequence=9) == first
    bench.ask(Opcode.READ_FILE, size=9)
    assert bench.ask(Opcode.OPEN_FILE_RO, b"f", sequence=9) == first


def test_mavsdk_begins_every_operation_with_sequence_0() -> None:
    """The same file twice in a row, and a removal that cannot succeed twice."""
    bench = FtpBench()
    put(bench.store, "f", b"x")
    for _ in range(2):
        assert bench.ask(Opcode.OPEN_FILE_RO, b"f\0", sequence=0).opcode is Opcode.ACK
        assert bench.ask(Opcode.READ_FILE, size=9, sequence=1).data == b"x"
        assert bench.ask(Opcode.TERMINATE_SESSION, sequence=2).opcode is Opcode.ACK
    assert bench.ask(Opcode.REMOVE_FILE, b"f\0", sequence=0).opcode is Opcode.ACK
    bench.now_ns += 2 * S
    again = bench.ask(Opcode.REMOVE_FILE, b"f\0", sequence=0)
    assert refused(again) is Nak.FILE_NOT_FOUND


def test_another_client_with_the_same_sequence_is_another_one() -> None:
    bench = FtpBench()
    bench.ask(Opcode.CREATE_DIRECTORY, b"d", sequence=4)
    other = bench.ask(Opcode.CREATE_DIRECTORY, b"d", sequence=4, client=Client(1, 255, 190))
    assert refused(other) is Nak.FILE_EXISTS


# -------------------------------------------------------------------------------- sessions


def test_clients_do_not_share_sessions() -> None:
    bench = FtpBench()
    put(bench.store, "mine", b"mine")
    put(bench.store, "yours", b"yours")
    you = Client(0, 254, 190)
    bench.ask(Opcode.OPEN_FILE_RO, b"mine")
    bench.ask(Opcode.OPEN_FILE_RO, b"yours", client=you)
    assert bench.ask(Opcode.READ_FILE, size=9).data == b"mine"
    assert bench.ask(Opcode.READ_FILE, size=9, client=you).data == b"yours"
    bench.ask(Opcode.RESET_SESSIONS)
    assert refused(bench.ask(Opcode.READ_FILE, size=9)) is Nak.INVALID_SESSION
    assert bench.ask(Opcode.READ_FILE, size=9, client=you).data == b"yours"


def test_one_client_may_have_several_numbers_but_not_any_number() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"x")
    told = [bench.ask(Opcode.OPEN_FILE_RO, b"f", session=number) for number in range(9)]
    assert [reply.session for reply in told] == [*range(9)]
    assert [reply.opcode for reply in told[:8]] == [Opcode.ACK] * 8
    assert refused(told[8]) is Nak.NO_SESSIONS_AVAILABLE


def test_all_clients_together_are_bounded() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"x")
    told = [
        bench.ask(Opcode.OPEN_FILE_RO, b"f", client=Client(0, system, 190))
        for system in range(1, 41)
    ]
    assert [reply.opcode for reply in told].count(Opcode.ACK) == 32
    assert refused(told[-1]) is Nak.NO_SESSIONS_AVAILABLE


def test_a_number_in_use_is_busy_until_it_idles() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"x")
    put(bench.store, "g", b"y")
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    bench.ask(Opcode.READ_FILE, size=9)
    busy = bench.ask(Opcode.OPEN_FILE_RO, b"g")
    assert refused(busy) is Nak.NO_SESSIONS_AVAILABLE
    bench.now_ns += 3 * S
    assert bench.ask(Opcode.OPEN_FILE_RO, b"g").opcode is Opcode.ACK
    assert bench.ask(Opcode.READ_FILE, size=9).data == b"y"


def test_a_client_that_never_heard_that_its_file_is_open_may_ask_anew() -> None:
    """QGroundControl does not repeat an open, but begins again with a new sequence number."""
    bench = FtpBench()
    put(bench.store, "f", b"x")
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    assert bench.ask(Opcode.OPEN_FILE_RO, b"f").opcode is Opcode.ACK


def test_a_session_left_alone_is_closed() -> None:
    bench = FtpBench()
    put(bench.store, "f", b"x")
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    bench.advance(6 * S)
    bench.ask(Opcode.READ_FILE, size=9)
    bench.advance(9 * S)
    assert bench.ask(Opcode.READ_FILE, size=9).opcode is Opcode.ACK
    bench.advance(11 * S)
    assert refused(bench.ask(Opcode.READ_FILE, size=9)) is Nak.INVALID_SESSION
    assert bench.server.deadline_ns > bench.now_ns + 1000 * S


def test_a_channel_that_goes_takes_its_sessions_and_bursts_along() -> None:
    bench = FtpBench()
    put(bench.store, "f", BIG)
    bench.ask(Opcode.OPEN_FILE_RO, b"f")
    bench.burst()
    bench.server.forget(GROUND.channel)
    assert bench.advance(1 * S) == []
    assert refused(bench.ask(Opcode.READ_FILE, size=9)) is Nak.INVALID_SESSION


# --------------------------------------------------------------------------- virtual files


def test_a_virtual_file_stays_what_it_was_when_it_was_opened() -> None:
    contents = [b"first"]
    bench = FtpBench({"@X/y": Virtual(lambda query: contents[0] + query.encode())})
    put(bench.store, "@X/z", b"stored")
    assert listing(bench, b"/") == [b"D@X"]
    assert listing(bench, b"@X") == [b"Fy\t5", b"Fz\t6"]
    assert bench.ask(Opcode.OPEN_FILE_RO, b"@X/y?a=1").data == (8).to_bytes(4, "little")
    contents[0] = b"second"
    assert bench.ask(Opcode.READ_FILE, size=80).data == b"firsta=1"


def test_a_virtual_file_cannot_be_changed_like_a_file() -> None:
    bench = FtpBench({"etc/extras/y": Virtual(lambda query: b"y")})
    for path in (b"etc", b"/etc/extras", b"etc/extras/y"):
        for opcode in (
            Opcode.CREATE_FILE,
            Opcode.OPEN_FILE_WO,
            Opcode.REMOVE_FILE,
            Opcode.REMOVE_DIRECTORY,
            Opcode.CREATE_DIRECTORY,
            Opcode.TRUNCATE_FILE,
        ):
            assert refused(bench.ask(opcode, path)) is Nak.FILE_PROTECTED
        assert refused(bench.ask(Opcode.RENAME, path + b"\0new")) is Nak.FILE_PROTECTED
    assert bench.ask(Opcode.CALC_FILE_CRC32, b"etc/extras/y").opcode is Opcode.ACK


def test_an_upload_to_a_virtual_file_takes_effect_as_a_whole() -> None:
    taken: list[bytes] = []
    bench = FtpBench({"v": Virtual(lambda query: b"", taken.append)})
    bench.ask(Opcode.CREATE_FILE, b"v")
    bench.ask(Opcode.WRITE_FILE, b"two", offset=3)
    bench.ask(Opcode.WRITE_FILE, b"one", offset=0)
    assert taken == []
    bench.ask(Opcode.TERMINATE_SESSION)
    assert taken == [b"onetwo"]
    bench.ask(Opcode.CREATE_FILE, b"v")
    bench.ask(Opcode.WRITE_FILE, b"three")
    bench.ask(Opcode.RESET_SESSIONS)  # as QGroundControl ends it
    assert taken == [b"onetwo", b"three"]
    bench.ask(Opcode.CREATE_FILE, b"v")
    assert bench.ask(Opcode.WRITE_FILE, b"x", offset=70_000).data == bytes((Nak.FAIL_ERRNO, 28))
    bench.advance(11 * S)
    assert taken == [b"onetwo", b"three"], "an upload that was left alone is dropped"


def test_an_upload_that_is_no_good_is_refused_at_its_end() -> None:
    def refuse(data: bytes) -> None:
        raise StoreError(StoreFault.BAD_PATH)

    bench = FtpBench({"v": Virtual(lambda query: b"", refuse)})
    bench.ask(Opcode.CREATE_FILE, b"v")
    assert refused(bench.ask(Opcode.TERMINATE_SESSION)) is Nak.FAIL_ERRNO
    assert refused(bench.ask(Opcode.TERMINATE_SESSION)) is Nak.INVALID_SESSION
