"""Clients of MAVLink 1: they are spoken to in it until they speak MAVLink 2 (MAV_PROTO_VER 0)."""

from __future__ import annotations

from pymavlink.dialects.v10 import all as old
from pymavlink.dialects.v20 import all as new

from tests.unit.vehicle_services.fake_vehicle import MS, Bench, S
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram, LinkSpec, Log, SigningKey, Transmit, Wake, World
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.split import Counters, split

OLD = old.MAVLink(None, srcSystem=255, srcComponent=190)
NEW = new.MAVLink(None, srcSystem=255, srcComponent=190)
BEAT_1 = bytes(old.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(OLD))
BEAT_2 = bytes(new.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(NEW))
RADIO_1 = bytes(old.MAVLink_radio_status_message(200, 190, 90, 40, 40, 0, 0).pack(OLD))


def ask(message: int) -> bytes:
    """MAV_CMD_REQUEST_MESSAGE, in MAVLink 1."""
    told = old.MAVLink_command_long_message(1, 1, 512, 0, message, 0, 0, 0, 0, 0, 0)
    OLD.seq = (OLD.seq + 1) & 0xFF
    return bytes(told.pack(OLD))


def sent(outputs: list[Transmit | Log], peer: object = "ground") -> bytes:
    return b"".join(
        each.data for each in outputs if isinstance(each, Transmit) and each.peer == peer
    )


def versions(data: bytes) -> set[int]:
    counters = Counters()
    found = {frame.version for frame in split(data, counters)}
    assert counters.bad == 0
    return found


def test_a_peer_of_mavlink_1_is_greeted_and_served_in_it() -> None:
    world = Bench().world
    data = sent(world.handle(Datagram(0, "ground", BEAT_1), 0))
    assert versions(data) == {1}
    for at_ns in range(20 * MS, 2 * S, 20 * MS):
        data += sent(world.handle(Wake(), at_ns))
    assert versions(data) == {1}
    parser = old.MAVLink(None)
    heard = parser.parse_buffer(data)
    assert parser.total_receive_errors == 0
    assert len(heard) == len(split(data, Counters()))
    assert {"HEARTBEAT", "ATTITUDE", "SYS_STATUS"} <= {each.get_type() for each in heard}
    sequences = [each.get_seq() for each in heard]
    assert sequences == [number & 0xFF for number in range(len(sequences))], "no gap"


def test_base_fields_come_whole_and_extensions_not_at_all() -> None:
    bench = Bench()
    world = bench.world
    world.handle(Datagram(0, "ground", BEAT_1), 0)
    (position,) = (
        each
        for each in old.MAVLink(None).parse_buffer(
            sent(world.handle(Datagram(0, "ground", ask(m.IDS[m.GpsRawInt])), 0))
        )
        if each.get_type() == "GPS_RAW_INT"
    )
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3), peer="modern")
    (reference,) = (
        each
        for each in bench.send(
            m.CommandLong(m.IDS[m.GpsRawInt], 0, 0, 0, 0, 0, 0, 512, 1, 1, 0), peer="modern"
        )
        if isinstance(each, m.GpsRawInt)
    )
    for name in position.get_fieldnames():
        assert getattr(position, name) == getattr(reference, name), name


def test_what_mavlink_1_has_no_number_for_is_acked_and_not_sent() -> None:
    world = Bench().world
    world.handle(Datagram(0, "ground", BEAT_1), 0)
    data = sent(world.handle(Datagram(0, "ground", ask(m.IDS[m.AvailableModes])), 0))
    heard = old.MAVLink(None).parse_buffer(data)
    assert {each.get_type() for each in heard} == {"COMMAND_ACK"}


def test_protocol_version_comes_as_mavlink_2_and_the_first_answer_in_it_switches_for_ever() -> None:
    world = Bench().world
    world.handle(Datagram(0, "ground", BEAT_1), 0)
    data = sent(world.handle(Datagram(0, "ground", ask(m.IDS[m.ProtocolVersion])), 0))
    frames = split(data, Counters())
    assert {(frame.number, frame.version) for frame in frames} == {(77, 1), (300, 2)}
    world.handle(Datagram(0, "ground", BEAT_2), 1 * MS)
    world.handle(Datagram(0, "ground", BEAT_1), 2 * MS)
    assert versions(sent(world.handle(Wake(), 500 * MS))) == {2}


def test_a_peer_that_was_not_heard_gets_mavlink_2_until_it_speaks_1() -> None:
    bench = Bench()
    server = VehicleServer(bench.vehicle, PROFILES["px4"], bench.parameters, 1)
    world = World([server], [LinkSpec(peers=("station",))])
    assert versions(sent(world.handle(Wake(), 100 * MS), "station")) == {2}
    world.handle(Datagram(0, "station", RADIO_1), 200 * MS)
    assert versions(sent(world.handle(Wake(), 300 * MS), "station")) == {2}, "the radio's own"
    world.handle(Datagram(0, "station", BEAT_1), 400 * MS)
    assert versions(sent(world.handle(Wake(), 600 * MS), "station")) == {1}


def test_each_peer_has_its_own_version() -> None:
    world = Bench().world
    world.handle(Datagram(0, "old", BEAT_1), 0)
    world.handle(Datagram(0, "new", BEAT_2), 0)
    outputs = world.handle(Wake(), 1 * S)
    assert versions(sent(outputs, "old")) == {1}
    assert versions(sent(outputs, "new")) == {2}
    assert [(each.peer, each.version) for each in world.links] == [("old", 1), ("new", 2)]


def test_under_a_key_nobody_is_sent_mavlink_1_which_cannot_be_signed() -> None:
    bench = Bench()
    server = VehicleServer(bench.vehicle, PROFILES["px4"], bench.parameters, 1)
    world = World([server], [LinkSpec()], signing=SigningKey(b"k" * 32))
    world.handle(Datagram(0, "ground", BEAT_1), 0)
    frames = split(sent(world.handle(Wake(), 1 * S)), Counters())
    assert {(frame.version, frame.signed) for frame in frames} == {(2, True)}


def test_rc_channels_raw_is_for_peers_of_mavlink_1_alone() -> None:
    """As ArduPilot's `send_rc_channels_raw`; DroneKit's `channels` live on it."""
    bench = Bench("ardupilot")
    bench.vehicle.channels_us = (1500, 1600, 1100, *[0] * 15)
    world = bench.world
    bench.send(m.RequestDataStream(4, 1, 1, 3, 1), peer="modern")
    world.handle(Datagram(0, "ground", BEAT_1), 0)
    asked = old.MAVLink_request_data_stream_message(1, 1, 3, 4, 1)
    outputs = world.handle(Datagram(0, "ground", bytes(asked.pack(OLD))), 0)
    for at_ns in range(20 * MS, 1 * S, 20 * MS):
        outputs += world.handle(Wake(), at_ns)
    heard = old.MAVLink(None).parse_buffer(sent(outputs))
    raw = [each for each in heard if each.get_type() == "RC_CHANNELS_RAW"]
    assert (raw[0].chan1_raw, raw[0].chan2_raw, raw[0].chan3_raw) == (1500, 1600, 1100)
    numbers = {frame.number for frame in split(sent(outputs, "modern"), Counters())}
    assert m.IDS[m.RcChannels] in numbers
    assert m.IDS[m.RcChannelsRaw] not in numbers
