"""Ports with a key: who has not shown that he has it takes no place from those who have."""

from __future__ import annotations

from gcs.session.inputs import ClientCame, ClientGone, Datagram, LinkEvent
from gcs.shell.client_table import (
    LAST_LINK,
    UNVERIFIED_HZ,
    UNVERIFIED_PLACES,
    Arrival,
    ClientLimits,
    ClientTable,
)

S = 1_000_000_000
FIRST_LINK = 1
BEAT = b"\xfd\x00\x00\x00\x00\xff\xbe\x00\x00\x00\x00\x00"


class PaperPeer:
    """The way to a client: keeps what it is sent."""

    stream = False
    expires = True

    def __init__(self, name: str, *, named: bool = False) -> None:
        self.name = name
        self.stays = named
        self.sent: list[bytes] = []
        self.forgotten = False

    def send(self, data: bytes) -> str:
        self.sent.append(data)
        return ""

    def forget(self) -> None:
        self.forgotten = True


class Door:
    """A table, a clock, and whoever comes."""

    def __init__(self, max_clients: int = 2, *, key: bool = True, first: int = FIRST_LINK) -> None:
        self.now_ns = 1_000 * S
        limits = ClientLimits(max_clients, 500.0, 10.0, verifies=key)
        self.table = ClientTable(first, limits)
        self.peers: dict[int, PaperPeer] = {}
        self._names = 0

    def comes(self, *, named: bool = False) -> int | None:
        """A new peer, which says something."""
        self._names += 1
        peer = PaperPeer(f"peer {self._names}", named=named)
        link = self.table.come(peer, self.now_ns)
        if link is not None:
            self.peers[link] = peer
            self.table.heard(link, BEAT, self.now_ns)
        return link

    def turn(self, seconds: float = 0.1) -> list[Arrival]:
        """The session has looked at all that came; time passes."""
        came = self.table.take()
        self.now_ns += round(seconds * S)
        return came

    def verified(self) -> int:
        """One with the key comes, and the session says that it has it."""
        link = self.comes()
        assert link is not None
        self.turn()
        self.table.verify(link, self.now_ns)
        return link

    def beats(self, *links: int) -> None:
        for link in links:
            self.table.heard(link, BEAT, self.now_ns)


def gone(arrivals: list[Arrival]) -> list[tuple[int, str]]:
    return [(each.link, each.reason) for each in arrivals if isinstance(each, ClientGone)]


def test_without_a_key_everybody_is_verified_as_he_comes() -> None:
    door = Door(key=False)
    assert [door.comes() for _ in range(3)] == [1, 2, None]
    came = [each for each in door.turn() if isinstance(each, ClientCame)]
    assert came == [ClientCame(1, "peer 1", False, True), ClientCame(2, "peer 2", False, True)]
    door.table.verify(1, door.now_ns)
    assert door.turn() == []


def test_a_crowd_without_the_key_takes_no_place_of_those_who_have_it() -> None:
    door = Door(max_clients=2)
    crowd = [door.comes() for _ in range(10)]
    assert None not in crowd
    came = [each for each in door.turn() if isinstance(each, ClientCame)]
    assert [each.verified for each in came] == [False] * 10
    one, other = door.verified(), door.verified()
    assert one in door.table
    assert other in door.table
    assert gone(door.turn()) == []


def test_where_all_places_are_taken_a_verified_one_goes_and_is_told() -> None:
    door = Door(max_clients=2)
    one, other = door.verified(), door.verified()
    door.beats(one, other)
    door.turn()
    third = door.verified()
    assert door.turn() == [
        LinkEvent(
            FIRST_LINK, "no room for client peer 3: 2 are there, none of them silent", trouble=True
        ),
        ClientGone(third, "no room for it"),
    ]
    assert door.peers[third].forgotten
    assert one in door.table
    assert other in door.table


def test_one_without_the_key_that_is_silent_is_no_place_for_one_who_has_it() -> None:
    door = Door(max_clients=1)
    one = door.verified()
    silent = door.comes()
    assert silent is not None
    door.turn(4.0)
    door.beats(one)
    third = door.verified()
    assert [link for link, _ in gone(door.turn())] == [third]
    assert silent in door.table


def test_who_found_no_place_comes_again_after_a_while() -> None:
    door = Door(max_clients=1)
    one = door.verified()
    again = PaperPeer("again")
    link = door.table.come(again, door.now_ns)
    assert link is not None
    door.table.verify(link, door.now_ns)
    came = 0
    for _ in range(40):
        door.turn(0.1)
        door.beats(one)
        door.table.sweep(door.now_ns)
        came += door.table.come(again, door.now_ns) is not None
        if came:
            break
    assert came
    assert door.now_ns == 1_000 * S + 3_100_000_000, "the first turn, and 3 s"


def test_a_silent_one_with_the_key_makes_room_for_another_one() -> None:
    door = Door(max_clients=2)
    silent, lively = door.verified(), door.verified()
    door.turn(4.0)
    door.beats(lively)
    third = door.verified()
    assert gone(door.turn()) == [(silent, "made room for peer 3")]
    assert third in door.table


def test_nobody_without_the_key_drives_out_a_silent_one_who_has_it() -> None:
    door = Door(max_clients=1)
    silent = door.verified()
    door.turn(9.0)
    for _ in range(2 * UNVERIFIED_PLACES):
        door.comes()
        assert (silent, "made room") not in [(link, why[:9]) for link, why in gone(door.turn(0.01))]
    assert silent in door.table


def test_of_those_without_it_the_first_goes_and_never_before_it_was_looked_at() -> None:
    door = Door()
    links = [door.comes() for _ in range(UNVERIFIED_PLACES)]
    assert door.comes() is None, "all of them have come in this turn"
    door.turn()
    assert door.comes() is not None
    assert gone(door.turn()) == [(links[0], f"made room for peer {UNVERIFIED_PLACES + 2}")]
    newer = [door.comes() for _ in range(UNVERIFIED_PLACES)]
    assert None not in newer, "each makes the next old one go"
    assert door.comes() is None
    assert [link for link, _ in gone(door.turn())][:-1] == links[1:]


def test_what_is_meant_for_one_that_has_gone_is_not_its_successors() -> None:
    """One with the key signs, and in the same turn makes room: the session hears of the signature
    first, and answers on a link that has gone."""
    door = Door()
    links = [door.comes() for _ in range(UNVERIFIED_PLACES)]
    door.turn()
    first = links[0]
    assert first is not None
    door.beats(first)
    successor = door.comes()
    assert successor is not None
    assert successor != first
    arrivals = door.turn()
    assert [type(each) for each in arrivals] == [Datagram, ClientGone, ClientCame, Datagram]
    door.table.verify(first, door.now_ns)
    door.table.send(first, b"for the first")
    assert door.peers[successor].sent == []
    for _ in range(UNVERIFIED_PLACES):
        door.turn()
        assert door.comes() is not None
    assert successor not in door.table, "it was never verified"


def test_its_number_is_given_again_once_the_session_knows() -> None:
    door = Door()
    first = door.comes()
    door.turn(11.0)
    door.table.sweep(door.now_ns)
    assert door.comes() != first
    door.turn()
    assert door.comes() == first


def test_whom_the_user_named_is_verified_as_it_comes_and_has_a_place() -> None:
    door = Door(max_clients=2)
    named = door.comes(named=True)
    assert named is not None
    assert door.turn()[0] == ClientCame(FIRST_LINK, "peer 1", False, True, named=True)
    one = door.verified()
    third = door.verified()
    assert [link for link, _ in gone(door.turn())] == [third]
    assert named in door.table
    assert one in door.table


def test_so_many_come_in_a_second_however_many_try() -> None:
    door = Door()
    came = 0
    for _ in range(2_000):
        for _ in range(5):
            came += door.comes() is not None
        door.turn(0.001)
    assert 2 * UNVERIFIED_HZ <= came <= 3 * UNVERIFIED_HZ


def test_there_is_a_link_for_each_place() -> None:
    door = Door(max_clients=32, first=LAST_LINK - 2 * UNVERIFIED_PLACES - 1)
    one, other = door.verified(), door.verified()
    crowd = [door.comes() for _ in range(UNVERIFIED_PLACES)]
    assert None not in crowd
    assert len({one, other, *crowd}) == UNVERIFIED_PLACES + 2
    door.turn()
    third = door.verified()
    assert third not in door.table, "no more links than two are left for those who have the key"
