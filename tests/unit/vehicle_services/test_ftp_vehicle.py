"""MAVLink FTP as a part of the whole vehicle."""

from __future__ import annotations

from tests.unit.vehicle_services.fake_vehicle import Bench, S, acks, long, of
from tests.unit.vehicle_services.ftp_client import frame, refused, understood
from vehicle_sim.services.ftp.wire import Nak, Opcode
from vehicle_sim.wire import messages as m


def ftp_replies(heard: list[m.Message]) -> list[m.FileTransferProtocol]:
    return of(heard, m.FileTransferProtocol)


def test_a_vehicle_serves_files_and_says_that_it_does() -> None:
    bench = Bench("ardupilot")
    (version,) = of(bench.send(long(512, 148)), m.AutopilotVersion)
    assert version.capabilities & 0x20  # MAV_PROTOCOL_CAPABILITY_FTP
    (told,) = ftp_replies(bench.send(frame(Opcode.OPEN_FILE_RO, b"@PARAM/param.pck")))
    assert (told.target_system, told.target_component) == (255, 190)
    size = int.from_bytes(understood(told).data, "little")
    bench.send(frame(Opcode.BURST_READ_FILE, sequence=2, size=239))
    packets = [understood(each) for each in ftp_replies(bench.advance(1 * S))]
    assert sum(len(packet.data) for packet in packets[:-1]) == size
    assert refused(packets[-1]) is Nak.EOF


def test_files_for_another_vehicle_are_not_served() -> None:
    bench = Bench("px4")
    other = frame(Opcode.NONE)._replace(target_system=2)
    assert ftp_replies(bench.send(other)) == []
    for target in ((1, 1), (0, 0), (1, 0)):
        asked = frame(Opcode.NONE)._replace(target_system=target[0], target_component=target[1])
        assert len(ftp_replies(bench.send(asked))) == 1


def test_only_px4_knows_component_metadata() -> None:
    bench = Bench("px4")
    heard = bench.send(long(512, 397))
    (told,) = of(heard, m.ComponentMetadata)
    uri = told.uri.rstrip(b"\0")
    assert uri == b"mftp://etc/extras/component_general.json"
    (summed,) = ftp_replies(bench.send(frame(Opcode.CALC_FILE_CRC32, uri.removeprefix(b"mftp://"))))
    assert understood(summed).data == told.file_crc.to_bytes(4, "little")
    assert acks(Bench("ardupilot").send(long(512, 397))) == [(512, 4)]
