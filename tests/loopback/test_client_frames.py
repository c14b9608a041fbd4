"""What a client reads on its own link: no frames that seem lost, and its own version of MAVLink.

Both are judged by pymavlink: its loss counter, and a parser that knows MAVLink 1 alone.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v10 import all as v10
from pymavlink.dialects.v20 import all as v20

from gcs.bridge.routing import target_of
from gcs.report import Direction, FrameItem, FramesItem
from gcs.session import inputs
from gcs.station.client_frames import UPGRADES_NS
from gcs.wire.frame import Frame, split
from tests.loopback.bridged import STATION, BridgedFlight, Client, joined
from tests.loopback.flight import PERSONALITIES, Personality

ARM, TAKE_OFF, ORBIT = 400, 22, 34
KEY = bytes(range(32))


def loss_of(client: Client) -> Any:
    """pymavlink's connection after all that the client heard: `mav_loss`, `mav_count`."""
    counter = mavutil.mavfile(None, "here")
    for heard in client.heard:
        heard.message._timestamp = heard.time_ns / 1e9
        counter.post_message(heard.message)
    return counter


def frames(flight: BridgedFlight, direction: Direction, link: int) -> list[Frame]:
    """Of the record."""
    raws = [
        raw
        for _, item in flight.records
        if isinstance(item, FrameItem | FramesItem)
        and (item.direction, item.link) == (direction, link)
        for raw in (item.raws if isinstance(item, FramesItem) else (item.raw,))
    ]
    return [item for raw in raws for item in split(raw) if isinstance(item, Frame)]


def answers(flight: BridgedFlight) -> list[Frame]:
    """What the bridge said in the vehicle's name to its first client."""
    sent = frames(flight, Direction.SENT, 1)
    return [frame for frame in sent if (frame.sysid, frame.compid) == (1, 1)]


def for_the_bridge_alone(flight: BridgedFlight) -> int:
    heard = frames(flight, Direction.RECEIVED, 0)
    return sum(target_of(frame)[0] == STATION[0] for frame in heard)


def fly(flight: BridgedFlight, client: Client) -> None:
    """Arming, a take-off, refusals and texts: some answers in the vehicle's name."""
    flight.connected()
    assert client.ask(ARM, 1, within_s=10) == 0
    for _ in range(5):
        client.ask(ORBIT, 7)
        flight.beating(1.0)


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("key", [None, KEY], ids=["plain", "vehicle signs"])
def test_answers_of_the_bridge_do_not_look_like_lost_frames(
    personality: Personality, key: bytes | None
) -> None:
    """But for the vehicle's frames for the bridge alone, and those of messages that pymavlink does
    not know (EVENT), which it does not count, nothing is missing."""
    flight = BridgedFlight(personality, vehicle_key=key, station_key=key)
    client = flight.join()
    fly(flight, client)
    assert len(answers(flight)) > 6
    counted = loss_of(client)
    unknown = sum(heard.message.get_msgId() < 0 for heard in client.heard)
    assert counted.mav_loss <= for_the_bridge_alone(flight) + unknown
    assert counted.mav_loss < 0.07 * counted.mav_count


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("key", [None, KEY], ids=["plain", "vehicle signs"])
def test_what_a_client_asked_less_of_does_not_look_like_lost_frames(
    personality: Personality, key: bytes | None
) -> None:
    flight, client = joined(BridgedFlight(personality, vehicle_key=key, station_key=key))
    assert client.ask(511, 30, 500_000) == client.ask(511, 32, 500_000) == 0
    flight.beating(5)
    client.heard.clear()
    before = for_the_bridge_alone(flight)
    flight.beating(10)
    counted = loss_of(client)
    unknown = sum(heard.message.get_msgId() < 0 for heard in client.heard)
    assert counted.mav_loss <= for_the_bridge_alone(flight) - before + unknown


class OldClient(Client):
    """It speaks MAVLink 1 and reads nothing else."""

    def __init__(self, flight: BridgedFlight, link: int, sysid: int, compid: int) -> None:
        super().__init__(flight, link, sysid, compid)
        self.mav = v10.MAVLink(None, srcSystem=sysid, srcComponent=compid)
        self.mav.robust_parsing = True

    def command(self, command: int, *params: float, target: tuple[int, int] = (1, 1)) -> None:
        filled = params + (0.0,) * (7 - len(params))
        self.send(v10.MAVLink_command_long_message(*target, command, 0, *filled))

    def beat(self) -> None:
        self.send(v10.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))


def join_old(flight: BridgedFlight) -> OldClient:
    link = 1 + len(flight.clients)
    client = OldClient(flight, link, 245, 190)
    flight.clients[link] = client
    flight.feed(inputs.ClientCame(link, "udp 127.0.0.1:40001", stream=False))
    client.beat()
    return client


def read(client: Client) -> list[Any]:
    return [heard.message for heard in client.heard if heard.message.get_type() != "BAD_DATA"]


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_client_of_mavlink_1_flies_the_vehicle_and_reads_it(personality: Personality) -> None:
    flight = BridgedFlight(personality)
    client = join_old(flight)
    flight.connected()
    flight.beating(UPGRADES_NS / 1e9 + 1)
    assert {"HEARTBEAT", "ATTITUDE", "GLOBAL_POSITION_INT"} <= {m.get_type() for m in read(client)}
    assert client.ask(ARM, 1, within_s=10) == 0
    assert flight.vehicle.armed
    assert client.ask(TAKE_OFF, 0, 0, 0, 0, 0, 0, 5) == 0
    client.send(v10.MAVLink_param_request_read_message(1, 1, b"NO_SUCH_NAME", -1))
    name = b"MPC_XY_CRUISE" if personality == "px4" else b"WPNAV_SPEED"
    client.send(v10.MAVLink_param_request_read_message(1, 1, name, -1))
    flight.until(lambda: name.decode() in {p.param_id for p in client.messages("PARAM_VALUE")})
    flight.run(5.0)
    told = [m for m in read(client) if m.get_type() == "GLOBAL_POSITION_INT"][-1]
    assert told.relative_alt / 1000 == pytest.approx(flight.truth_enu()[2], abs=1.0)


def test_what_mavlink_1_leaves_out_does_not_look_like_loss() -> None:
    flight = BridgedFlight()
    client = join_old(flight)
    flight.connected()
    flight.beating(UPGRADES_NS / 1e9 + 1)
    client.heard.clear()
    flight.beating(10.0)
    heard = read(client)
    assert not [m for m in client.heard if m.message.get_type() == "BAD_DATA"]
    numbers = [m.get_seq() for m in heard if (m.get_srcSystem(), m.get_srcComponent()) == (1, 1)]
    assert len(numbers) > 500
    missing = sum((b - a) % 256 - 1 for a, b in pairwise(numbers))
    assert missing <= for_the_bridge_alone(flight)
    assert missing < 0.02 * len(numbers)


def test_a_client_that_begins_with_mavlink_1_and_knows_2_is_sent_2_at_once() -> None:
    """As QGroundControl does, from memory: it goes over when it hears version 2."""
    flight = BridgedFlight()
    flight.connected()
    client = join_old(flight)
    client.command(ORBIT)
    client.mav = v20.MAVLink(None, srcSystem=245, srcComponent=190)
    flight.run(2.0)
    assert {m.get_msgbuf()[0] for m in read(client)} == {0xFD}
    Client.beat(client)
    client.heard.clear()
    flight.beating(UPGRADES_NS / 1e9 + 2)
    assert Client.ask(client, ARM, 1, within_s=10) == 0
    assert {m.get_msgbuf()[0] for m in read(client)} == {0xFD}
