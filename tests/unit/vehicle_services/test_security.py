"""A world with a signing key: who is obeyed, what is counted, how the key comes and goes."""

from __future__ import annotations

from itertools import count, pairwise

from pymavlink.dialects.v20 import all as upstream

from tests.unit.vehicle_services.fake_vehicle import MS, FakeVehicle, S
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import (
    Datagram,
    Input,
    Left,
    LinkSpec,
    Log,
    SigningKey,
    Transmit,
    Wake,
    World,
)
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode
from vehicle_sim.wire.signing import EPOCH_UNIX_NS
from vehicle_sim.wire.split import Counters, split

KEY = SigningKey(b"k" * 32)
OTHER = SigningKey(b"o" * 32)
UNIX_NS = EPOCH_UNIX_NS + 50_000_000 * S
TICKS = 50_000_000 * 100_000
START_NS = 7 * S
SEQUENCES = count()


class Field:
    """One vehicle, two links, ground stations of pymavlink's."""

    def __init__(self, key: SigningKey | None = KEY) -> None:
        self.vehicle = FakeVehicle()
        self.vehicle.armed = False
        server = VehicleServer(self.vehicle, PROFILES["px4"], Parameters("px4"), 1)
        self.world = World(
            [server],
            [LinkSpec(), LinkSpec()],
            start_ns=START_NS,
            signing=key,
            unix_start_ns=UNIX_NS,
        )
        self.now_ns = START_NS
        self.logs: list[Log] = []

    def give(self, given: Input, at_ns: int | None = None) -> list[bytes]:
        if at_ns is not None:
            self.now_ns = at_ns
        sent = []
        for output in self.world.handle(given, self.now_ns):
            if isinstance(output, Transmit):
                sent.append(output.data)
            else:
                self.logs.append(output)
        return sent

    def hear(self, data: bytes, link: int = 0, peer: str = "ground") -> list[bytes]:
        return self.give(Datagram(link, peer, data))

    @property
    def landings(self) -> int:
        return len(self.vehicle.named("land"))

    def counters(self, link: int = 0, peer: str = "ground") -> Counters:
        counters = self.world.counters(link, peer)
        assert counters is not None
        return counters


def station(key: SigningKey | None, timestamp: int = TICKS, link_id: int = 0) -> upstream.MAVLink:
    mav = upstream.MAVLink(None, srcSystem=255, srcComponent=190)
    mav.robust_parsing = True
    if key is not None:
        mav.signing.secret_key = key.secret
        mav.signing.timestamp = timestamp
        mav.signing.link_id = link_id
        mav.signing.sign_outgoing = True
    return mav


def land(mav: upstream.MAVLink, mavlink1: bool = False) -> bytes:
    """A new one each time: an equal sequence number would make it a duplicate on the way."""
    told = upstream.MAVLink_command_long_message(1, 1, 21, 0, 0, 0, 0, 0, 0, 0, 0)
    mav.seq = next(SEQUENCES) & 0xFF
    return bytes(told.pack(mav, force_mavlink1=mavlink1))


def setup(key: SigningKey | bytes, timestamp: int = TICKS, system: int = 1) -> bytes:
    """SETUP_SIGNING, unsigned."""
    secret = key.secret if isinstance(key, SigningKey) else key
    return encode(m.SetupSigning(timestamp, system, 1, secret), 0, 255, 190)


def signed_setup(mav: upstream.MAVLink, key: bytes, timestamp: int) -> bytes:
    told = upstream.MAVLink_setup_signing_message(1, 1, list(key), timestamp)
    return bytes(told.pack(mav))


def test_a_signed_command_is_obeyed_and_its_answer_is_signed() -> None:
    field, mav = Field(), station(KEY)
    answer = field.hear(land(mav))
    assert field.landings == 1
    heard = [each for data in answer for each in mav.parse_buffer(data)]
    assert "COMMAND_ACK" in [each.get_type() for each in heard]
    assert all(each.get_signed() for each in heard)
    assert field.counters().bad == 0


def test_unsigned_wrong_and_replayed_commands_are_counted_and_ignored() -> None:
    field = Field()
    good = land(station(KEY))
    field.hear(good)
    field.hear(good)
    field.hear(land(station(OTHER)))
    field.hear(land(station(None)))
    field.hear(land(station(None), mavlink1=True))
    assert field.landings == 1
    assert field.counters() == Counters(frames=5, unsigned=2, bad_signature=1, replayed=1)


def test_one_refusal_of_a_kind_is_said_and_all_are_counted_when_the_peer_goes() -> None:
    field = Field()
    for _ in range(20):
        field.hear(land(station(None)))
    warned = [log.text for log in field.logs if log.level == "warning"]
    assert len(warned) == 1
    assert "255/190" in warned[0]
    field.give(Left(0, "ground"))
    assert field.logs[-1].text == "link 0: 20 bad frames (frames 20, unsigned 20)"


def test_a_stranger_sees_the_vehicle_but_is_not_heard() -> None:
    """What is sent is signed, not secret: a station without the key shows the vehicle."""
    field, mav = Field(), station(None)
    sent = field.hear(encode(m.Heartbeat(0, 6, 8, 0, 4, 3), 0, 255, 190))
    heard = [each.get_type() for data in sent for each in mav.parse_buffer(data)]
    assert "HEARTBEAT" in heard
    field.hear(land(station(None)))
    assert field.landings == 0


def test_each_link_has_its_id_and_time_rises_over_all_of_them() -> None:
    field = Field()
    beat = upstream.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    field.hear(bytes(beat.pack(station(KEY))), 0, "one")
    field.hear(bytes(beat.pack(station(KEY, link_id=1))), 1, "two")
    stamps: dict[int, list[int]] = {0: [], 1: []}
    for at_ns in range(START_NS + 20 * MS, START_NS + 2 * S, 20 * MS):
        for data in field.give(Wake(), at_ns):
            for frame in split(data, Counters()):
                stamps[frame.raw[-13]].append(int.from_bytes(frame.raw[-12:-6], "little"))
    for times in stamps.values():
        assert len(times) > 50
        assert all(a < b for a, b in pairwise(times))
        assert abs(times[-1] - TICKS - 2 * 100_000) < 10_000, "unix time goes with the wall clock"


def test_pymavlink_takes_every_frame_of_twenty_seconds() -> None:
    field = Field()
    mav = station(KEY)
    beat = upstream.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    field.hear(bytes(beat.pack(mav)))
    heard: list[str] = []
    for at_ns in range(START_NS, START_NS + 20 * S, 100 * MS):
        for data in field.give(Wake(), at_ns):
            heard += [each.get_type() for each in mav.parse_buffer(data)]
    assert len(heard) > 200
    assert "BAD_DATA" not in heard


def test_setup_signing_turns_it_on_at_once_for_all_that_follows() -> None:
    field = Field(None)
    unsigned = land(station(None))
    field.hear(unsigned)
    field.hear(setup(KEY) + land(station(None)))
    assert field.landings == 1, "the same datagram's next frame is not signed"
    field.hear(land(station(KEY)))
    assert field.landings == 2
    assert "signing is on, set up by client 255/190" in [log.text for log in field.logs]


def test_setup_signing_for_another_vehicle_is_not_ours() -> None:
    field = Field(None)
    field.hear(setup(KEY, system=2))
    field.hear(land(station(None)))
    assert field.landings == 1


def test_a_key_is_changed_and_removed_only_by_who_has_it() -> None:
    field = Field()
    field.hear(setup(OTHER))
    field.hear(setup(bytes(32), 0))
    field.hear(signed_setup(station(OTHER), bytes(32), 0))
    assert field.counters() == Counters(frames=3, unsigned=2, bad_signature=1)
    field.hear(land(station(None)))
    assert field.landings == 0
    mav = station(KEY)
    off = signed_setup(mav, bytes(32), 0)
    field.hear(off)
    field.hear(land(station(None)))
    assert field.landings == 1
    field.hear(setup(KEY))
    field.hear(off)
    field.hear(land(station(None)))
    assert field.landings == 1, "what turned it off once does not do so again"


def test_signing_is_not_set_up_while_armed() -> None:
    field = Field(None)
    field.vehicle.armed = True
    field.hear(encode(m.Heartbeat(0, 6, 8, 0, 4, 3), 0, 255, 190))
    answer = field.hear(setup(KEY))
    texts = [frame.message() for data in answer for frame in split(data, Counters())]
    assert m.Statustext(4, b"ERROR: Won't setup signing when armed".ljust(50, b"\0")) in texts
    field.hear(land(station(None)))
    assert field.landings == 1
