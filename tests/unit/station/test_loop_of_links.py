"""Two bridges that are one another's vehicle links and clients: the loop ends, and is told.

Whatever leaves is there 2 ms later.  The first bridge's vehicle link has two peers, the vehicle and
the second bridge; the second one hears the first one alone.
"""

from __future__ import annotations

import heapq
from itertools import count

import msgspec
import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.peers.link_loops import ASK_AGAIN_NS, LEFT_OUT_NS
from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.report import LogEvent
from gcs.session.effects import LeaveOutPeer, Record, Transmit
from gcs.session.inputs import ClientCame, Datagram, Wake
from gcs.session.setup import Setup
from gcs.station.session import Session

S = 1_000_000_000
START_NS = 1_000 * S
WAY_NS = 2_000_000
FRONT, BEHIND = 0, 1
VEHICLE_LINK = 0
CONFIG = StationConfig(
    endpoints=["test"], name="loop", bridge=True, clients=["test"], sysid=255, compid=191
)


class Circle:
    """A vehicle, and two bridges that send to one another."""

    def __init__(
        self, sysids: tuple[int, int], *, one_peer: bool = False, two_links: bool = False
    ) -> None:
        """`one_peer`: the vehicle and the second bridge are behind one router of the first.
        `two_links`: the first bridge hears the second one on a vehicle's link of its own."""
        configs = [msgspec.structs.replace(CONFIG, sysid=sysid) for sysid in sysids]
        links = [("a link", "another link") if two_links else ("a link",), ("a link",)]
        self.bridges = [
            Session(Setup(config, "test", DEFAULT, "", own, ""), START_NS)
            for config, own in zip(configs, links, strict=True)
        ]
        self.clients = [len(own) for own in links]
        """The link of each one's only client."""
        self.leads_back = len(links[FRONT]) - 1
        """The link on which the first one hears the second one."""
        self.now_ns = START_NS
        self.vehicle = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
        self.one_peer = one_peer
        self.left_out = False
        """The second bridge, by the first one."""
        self.told: list[str] = []
        self.heard = [0, 0]
        """Datagrams that came on each bridge's vehicle link."""
        self.sent_back: list[bytes] = []
        """What the first bridge sent on its second vehicle's link."""
        self._order = count()
        self._under_way: list[tuple[int, int, int, int, bytes, bool]] = []
        for bridge in (FRONT, BEHIND):
            self._feed(bridge, ClientCame(self.clients[bridge], f"udp {bridge}", stream=False))

    def run(self, seconds: int) -> None:
        """The vehicle sends 21 messages a second."""
        for _ in range(seconds * 20):
            until_ns = self.now_ns + S // 20
            at_ms = (self.now_ns - START_NS) // 1_000_000
            if at_ms % 1000 == 0:
                beat = mavlink.MAVLink_heartbeat_message(2, 12, 81, 0x03040000, 3, 3)
                self._send(FRONT, VEHICLE_LINK, beat.pack(self.vehicle))
            attitude = mavlink.MAVLink_attitude_message(at_ms, 0, 0, 0, 0, 0, 0)
            self._send(FRONT, VEHICLE_LINK, attitude.pack(self.vehicle))
            while self._under_way and self._under_way[0][0] <= until_ns:
                self.now_ns, _, bridge, link, data, by_bridge = heapq.heappop(self._under_way)
                if by_bridge and self.left_out:
                    continue
                self.heard[bridge] += link < self.clients[bridge]
                self._wake()
                self._feed(bridge, Datagram(link, data))
            self.now_ns = until_ns
            self._wake()

    def _wake(self) -> None:
        for number, bridge in enumerate(self.bridges):
            if bridge.deadline_ns <= self.now_ns:
                self._feed(number, Wake())

    def _send(self, bridge: int, link: int, data: bytes, *, by_bridge: bool = False) -> None:
        arrives_ns = self.now_ns + WAY_NS
        item = arrives_ns, next(self._order), bridge, link, data, by_bridge
        heapq.heappush(self._under_way, item)

    def _feed(self, bridge: int, given: ClientCame | Datagram | Wake) -> None:
        for effect in self.bridges[bridge].handle(given, self.now_ns):
            match effect:
                case Transmit(link, data) if bridge == FRONT and link == self.clients[FRONT]:
                    self._send(BEHIND, VEHICLE_LINK, data)
                case Transmit(link, data) if bridge == FRONT:
                    self.sent_back += [data] if link == 1 else []
                    if link == self.leads_back and not self.left_out:
                        self._send(BEHIND, self.clients[BEHIND], data)
                case Transmit(link, data) if link == VEHICLE_LINK:
                    self._send(FRONT, self.clients[FRONT], data)
                case Transmit(_, data):
                    self._send(FRONT, self.leads_back, data, by_bridge=True)
                case LeaveOutPeer(link, data, _):
                    assert link == VEHICLE_LINK
                    assert b"\x08\x00\x00" in data, "the LINK_NODE_STATUS itself"
                    self.left_out |= bridge == FRONT and not self.one_peer
                case Record(LogEvent() as line):
                    self.told.append(f"{bridge}: {line.text}")
                case _:
                    pass

    def heard_in(self, seconds: int) -> list[int]:
        """Datagrams on each vehicle link from now on."""
        self.heard = [0, 0]
        self.run(seconds)
        return self.heard


@pytest.mark.parametrize("sysids", [(255, 250), (255, 255)], ids=["two-names", "one-name"])
def test_the_first_bridge_leaves_the_second_one_out_and_the_second_goes_on_as_a_client(
    sysids: tuple[int, int],
) -> None:
    circle = Circle(sysids)
    circle.run(2)
    assert circle.left_out
    front, behind = circle.heard_in(5)
    assert front == 5 * 21
    assert 5 * 21 <= behind <= 5 * 25, "the vehicle's, and what the first one says to its client"
    loops = [line for line in circle.told if "a loop of links" in line]
    assert loops[0] == (
        "0: a loop of links: what is sent to udp 0, a client on link 1, comes in again on link 0 "
        "(a link): two bridges or routers send to one another; take the --client that leads back "
        "out of one of them"
    )
    assert len(loops) <= 2, "once each"
    assert not [line for line in circle.told if "goes on" in line]


def test_where_no_peer_can_be_left_out_the_client_is_sent_no_more() -> None:
    circle = Circle((255, 250), one_peer=True)
    circle.run(2 + ASK_AGAIN_NS // S)
    assert [line for line in circle.told if "the loop of links goes on: nothing that" in line]
    front, behind = circle.heard_in(5)
    assert front <= 5 * 25
    assert behind <= 5 * 25


def test_a_link_of_its_own_that_leads_back_is_left_out_whole_until_it_is_silent() -> None:
    circle = Circle((255, 250), two_links=True)
    circle.run(3)
    assert [line for line in circle.told if line.startswith("0: link 1 is left out, until it has")]
    before = len(circle.sent_back)
    _, behind = circle.heard_in(5)
    assert 5 * 21 <= behind <= 5 * 25, "the second bridge hears the vehicle, each frame once"
    assert len(circle.sent_back) == before, "nothing leaves on the link that leads back"
    assert not [line for line in circle.told if "goes on" in line]
    circle.now_ns += LEFT_OUT_NS + S
    circle.run(1)
    assert len([line for line in circle.told if "link 1 is left out" in line]) == 2, "once more"


def test_the_station_that_comes_back_is_no_other_one() -> None:
    circle = Circle((255, 250))
    circle.run(3)
    assert not [line for line in circle.told if "another station" in line]
