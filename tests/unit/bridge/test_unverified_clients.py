"""Peers that a port with a key took in: heartbeats are all that they are sent before they sign."""

from __future__ import annotations

from collections.abc import Iterable

from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.effects import ForwardToLink, LogLine, Reply
from gcs.bridge.peers.client import TOLD_NS
from gcs.bridge.peers.unverified_clients import TOLD_A_SECOND
from gcs.gate.effects import Level
from gcs.wire.frame import Frame
from gcs.wire.messages import Statustext
from tests.unit.bridge.test_bridge import HEARTBEAT, OWN, VEHICLE, S, Table, frame_of, of, texts

OF_VEHICLE = mavlink.MAVLink_heartbeat_message(2, 12, 0, 0, 4, 3)
POSITION = mavlink.MAVLink_local_position_ned_message(1, 0, 0, 0, 0, 0, 0)
STRANGER = 2
"""The link of the peer that is not verified; 1 is another client's."""


def met() -> Table:
    """A client that is verified, and a peer that is not."""
    table = Table(clients=1)
    table.says(HEARTBEAT, 1)
    table.bridge.came(STRANGER, "udp 2", verified=False)
    return table


def from_vehicle(table: Table, *frames: Frame) -> dict[int, list[bytes]]:
    sent: dict[int, list[bytes]] = {}
    for link, raws, _ in table.bridge.from_vehicle(frames, table.now_ns):
        sent.setdefault(link, []).extend(raws)
    return sent


def test_it_is_sent_the_autopilots_heartbeats_and_nothing_else() -> None:
    table = met()
    beat = frame_of(OF_VEHICLE, 1, 1)
    camera, station = frame_of(HEARTBEAT, 1, 100), frame_of(HEARTBEAT, 250, 190)
    position = frame_of(POSITION, 1, 1)
    sent = from_vehicle(table, position, beat, camera, station, position)
    assert sent[STRANGER] == [beat.raw]
    assert len(sent[1]) == 5
    assert STRANGER not in from_vehicle(table, position)


def test_no_text_and_no_frame_of_another_client_is_for_it() -> None:
    table = met()
    told = table.bridge.warn(Level.ERROR, "x", VEHICLE, table.now_ns)
    told += table.bridge.control_changed(1000, "udp 1", [VEHICLE], table.now_ns)
    told += table.says(HEARTBEAT, 1).effects
    told += table.says(mavlink.MAVLink_ping_message(1, 1, 246, 190), 1).effects
    assert {each.link for each in of(Reply, told)} == {1}
    assert not of(ForwardToLink, told)


def test_from_its_first_good_frame_on_it_is_a_client_like_others() -> None:
    table = met()
    (note,) = table.bridge.verify(STRANGER)
    assert note == LogLine(Level.INFO, "udp 2, on link 2, is verified: it has the clients' key")
    table.says(HEARTBEAT, STRANGER)
    position = frame_of(POSITION, 1, 1)
    assert from_vehicle(table, position) == {1: [position.raw], STRANGER: [position.raw]}
    assert [each.link for each in of(ForwardToLink, table.says(HEARTBEAT, 1).effects)] == [STRANGER]


def test_the_page_says_so_until_then() -> None:
    table = met()
    assert [each.verified for each in table.bridge.status(table.now_ns)] == [True, False]
    table.bridge.verify(STRANGER)
    assert [each.verified for each in table.bridge.status(table.now_ns)] == [True, True]


def notes(effects: Iterable[object]) -> list[str]:
    return [each.text for each in effects if isinstance(each, LogLine)]


def test_the_log_has_that_it_came_and_went() -> None:
    table = Table(clients=0)
    came = notes(table.bridge.came(STRANGER, "udp 2", verified=False))
    went = notes(table.bridge.gone(STRANGER, "silent for 10 s"))
    assert came == [
        "udp 2 has connected, on link 2, not verified: it is sent heartbeats alone until it signs "
        "with the clients' key"
    ]
    assert went == ["udp 2, not verified, has gone: silent for 10 s"]


def test_a_place_that_the_user_named_has_connected_once_it_is_heard() -> None:
    table = Table(clients=0)
    came = notes(table.bridge.came(STRANGER, "udp 2", named=True))
    assert came == ["udp 2 is sent to, and not heard yet, on link 2"]
    assert [each.client for each in table.bridge.status(table.now_ns)] == [0]
    assert notes(table.says(HEARTBEAT, STRANGER).effects) == ["udp 2 has connected"]
    assert [each.client for each in table.bridge.status(table.now_ns)] == [1000]


def test_a_crowd_that_comes_and_goes_does_not_fill_the_log() -> None:
    table = Table(clients=0)
    told: list[str] = []
    for number in range(100):
        told += notes(table.bridge.came(2, f"udp {number}", verified=False))
        told += notes(table.bridge.gone(2, "made room"))
    assert len(told) == 2 * TOLD_A_SECOND
    (rest,) = notes(table.bridge.second([VEHICLE], table.now_ns))
    assert rest == "95 more peers have connected within a second, not verified"
    assert notes(table.bridge.second([VEHICLE], table.now_ns + S)) == []
    assert len(notes(table.bridge.came(2, "udp 100", verified=False))) == 1


# ------------------------------------------------------------------- who sends more than he may


def test_who_sends_too_much_is_told_once_in_some_seconds_with_all_that_was_dropped() -> None:
    table = Table()
    told: list[tuple[int, str]] = []
    for second in range(12):
        if second < 7:
            table.bridge.flooded(1, 100)
        effects = table.bridge.second([VEHICLE], table.now_ns)
        for each in of(Reply, effects):
            assert (each.link, each.source) == (1, VEHICLE)
            assert isinstance(each.message, Statustext)
            assert each.message.severity == mavlink.MAV_SEVERITY_WARNING
        if said := texts(effects):
            told.append((second, said))
        table.now_ns += S
    assert told == [
        (0, "gate: 100 dropped: more than 500 messages/s"),
        (TOLD_NS // S, "gate: 500 dropped: more than 500 messages/s"),
        (2 * TOLD_NS // S, "gate: 100 dropped: more than 500 messages/s"),
    ]
    assert table.bridge.status(table.now_ns)[0].dropped == 700


def test_before_a_vehicle_is_heard_the_station_tells_it() -> None:
    table = Table()
    table.bridge.flooded(1, 3)
    (told,) = of(Reply, table.bridge.second([], table.now_ns))
    assert told.source == OWN


def test_who_is_not_verified_is_told_nothing_before_it_is() -> None:
    table = met()
    table.bridge.flooded(STRANGER, 3)
    assert not of(Reply, table.bridge.second([VEHICLE], table.now_ns))
    table.bridge.verify(STRANGER)
    (told,) = of(Reply, table.bridge.second([VEHICLE], table.now_ns + S))
    assert told.link == STRANGER
