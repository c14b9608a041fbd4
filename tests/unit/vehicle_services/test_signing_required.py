"""A vehicle with a signing key: what is taken on every link, and what is not.

PX4's rule is that of 1.17 ("MAVLink Message Signing", docs.px4.io): a key makes signatures required
on all links, USB too, but for four messages.  ArduPilot's exceptions are RADIO and RADIO_STATUS
(from memory).  Off as delivered: without `--signing-key` and SETUP_SIGNING nothing is asked for.
"""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as upstream

from tests.unit.vehicle_services.fake_vehicle import S
from tests.unit.vehicle_services.flown_vehicle import HOME
from tests.unit.vehicle_services.test_security import KEY, OTHER, TICKS, UNIX_NS, station
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Landed
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram, LinkSpec, SigningKey, Transmit, Wake, World
from vehicle_sim.wire.codec import encode
from vehicle_sim.wire.messages import SetupSigning

LINKS = (0, 1)
both = pytest.mark.parametrize("personality", ["px4", "ardupilot"])


class Air:
    """One vehicle, two links, and whatever is said to it; two seconds after power-up."""

    def __init__(self, personality: Personality, key: SigningKey | None = KEY) -> None:
        parameters = Parameters(personality)
        self.vehicle = Autopilot(personality, HOME, 1, 0, parameters)
        server = VehicleServer(
            self.vehicle, PROFILES[personality], parameters, system=1, logging=False
        )
        links = [LinkSpec() for _ in LINKS]
        self.world = World([server], links, signing=key, unix_start_ns=UNIX_NS)
        self.now_ns = 0
        self.wait(2.0)

    def wait(self, seconds: float) -> None:
        self.now_ns += int(seconds * S)
        self.world.handle(Wake(), self.now_ns)

    def answers(self, data: bytes, link: int = 0) -> list[bytes]:
        """What comes back at once."""
        outputs = self.world.handle(Datagram(link, "station", data), self.now_ns)
        return [each.data for each in outputs if isinstance(each, Transmit)]

    def bad(self, link: int = 0) -> int:
        counters = self.world.counters(link, "station")
        assert counters is not None
        return counters.bad


def command(mav: upstream.MAVLink, number: int, *params: float) -> bytes:
    values = (*params, *(0.0,) * (7 - len(params)))
    told = upstream.MAVLink_command_long_message(1, 1, number, 0, *values)
    mav.seq = (mav.seq + 1) & 0xFF
    return bytes(told.pack(mav))


def heartbeat(mav: upstream.MAVLink) -> bytes:
    return bytes(upstream.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(mav))


def acks(data: list[bytes], mav: upstream.MAVLink) -> list[tuple[int, int]]:
    heard = [each for row in data for each in mav.parse_buffer(row) or []]
    return [(e.command, e.result) for e in heard if e.get_type() == "COMMAND_ACK"]


@both
@pytest.mark.parametrize("link", LINKS)
@pytest.mark.parametrize("key", [None, OTHER], ids=["unsigned", "another key"])
def test_a_command_without_the_key_gets_nothing_on_any_link(
    personality: Personality, link: int, key: SigningKey | None
) -> None:
    air, mav = Air(personality), station(key, link_id=link)
    air.answers(heartbeat(mav), link)  # so that it is a peer
    reader = station(KEY)
    assert acks(air.answers(command(mav, 400, 1), link), reader) == []
    air.wait(1.0)
    assert not air.vehicle.armed
    assert air.bad(link) > 0


@both
@pytest.mark.parametrize("link", LINKS)
def test_with_the_key_it_flies(personality: Personality, link: int) -> None:
    air, mav = Air(personality), station(KEY, link_id=link)
    px4 = personality == "px4"
    air.answers(heartbeat(mav), link)
    for number, *params in (
        (176, 1, 4, 3) if px4 else (176, 1, 4),
        (400, 1),
        (22, 0, 0, 0, 0, 0, 0, HOME.alt_amsl_m + 3.0 if px4 else 3.0),
    ):
        assert acks(air.answers(command(mav, number, *params), link), mav) == [(number, 0)]
    air.wait(12.0)
    assert air.vehicle.landed is Landed.IN_AIR


ALWAYS = (
    upstream.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3),
    upstream.MAVLink_radio_status_message(1, 1, 100, 1, 1, 0, 0),
    upstream.MAVLink_adsb_vehicle_message(1, 0, 0, 0, 0, 0, 0, 0, b"", 1, 0, 0, 0),
    upstream.MAVLink_collision_message(0, 1, 0, 0, 0.0, 0.0, 0.0),
)
COPTERS = {"RADIO_STATUS"}


@both
@pytest.mark.parametrize("key", [None, OTHER], ids=["unsigned", "another key"])
@pytest.mark.parametrize("message", ALWAYS, ids=lambda each: each.get_type())
def test_a_few_messages_are_taken_without_the_key(
    personality: Personality, key: SigningKey | None, message: upstream.MAVLink_message
) -> None:
    air, mav = Air(personality), station(key)
    air.answers(bytes(message.pack(mav)))
    taken = personality == "px4" or message.get_type() in COPTERS
    assert (air.bad() == 0) is taken


def test_an_unsigned_heartbeat_keeps_px4s_station_failsafe_away() -> None:
    """The price of the exception, as PX4's page says: a heartbeat can be forged."""

    def lost(unsigned_beats: bool) -> bool:
        air, mav, stranger = Air("px4"), station(KEY), station(None)
        air.vehicle.parameters.set("NAV_DLL_ACT", 2)
        air.answers(heartbeat(mav))
        for number, *params in ((400, 1), (22, 0, 0, 0, 0, 0, 0, HOME.alt_amsl_m + 3.0)):
            air.answers(command(mav, number, *params))
        for _ in range(40):
            air.wait(0.5)
            if unsigned_beats:
                air.answers(heartbeat(stranger))
        return air.vehicle.mode_name == "AUTO.RTL" or not air.vehicle.armed

    assert lost(unsigned_beats=False)
    assert not lost(unsigned_beats=True)


@both
def test_without_a_key_everything_is_taken(personality: Personality) -> None:
    air, mav = Air(personality, key=None), station(None)
    air.answers(heartbeat(mav))
    assert acks(air.answers(command(mav, 512, 148)), mav) == [(512, 0)]


@both
@pytest.mark.parametrize("link", LINKS)
def test_the_first_key_may_come_unsigned_on_any_link_and_holds_on_all(
    personality: Personality, link: int
) -> None:
    air = Air(personality, key=None)
    air.answers(encode(SetupSigning(TICKS, 1, 1, KEY.secret), 0, 255, 190), link)
    for each in LINKS:
        stranger, owner = station(None), station(KEY, TICKS + 10 * (each + 1), each)
        assert acks(air.answers(command(stranger, 512, 148), each), station(KEY)) == []
        assert acks(air.answers(command(owner, 512, 148), each), owner) == [(512, 0)]


@both
def test_the_key_stays_through_a_reboot(personality: Personality) -> None:
    """PX4 keeps it on its card."""
    air, mav = Air(personality), station(KEY)
    air.answers(heartbeat(mav))
    assert acks(air.answers(command(mav, 246, 1)), mav) == [(246, 0)]
    air.wait(3.0)
    assert acks(air.answers(command(station(None), 512, 148)), station(KEY)) == []
    assert acks(air.answers(command(mav, 512, 148)), mav) == [(512, 0)]
