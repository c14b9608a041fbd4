"""Links: each frames its own bytes, numbers its own frames, and is silent until somebody spoke."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from gcs.session.effects import Record, Transmit
from gcs.station.links import Links
from gcs.wire.frame import Frame, Garbage, Item
from gcs.wire.messages import MissionItemReached
from tests.unit.station import told, wire
from tests.unit.station.wire import Sender

REACHED = MissionItemReached(seq=7)
NOW_NS = 1_700_000_000_000_000_000


def raws(items: Sequence[Item]) -> list[bytes]:
    return [item.raw for item in items if isinstance(item, Frame)]


def is_garbage(items: Sequence[Item]) -> bool:
    return bool(items) and all(isinstance(item, Garbage) for item in items)


# ----------------------------------------------------------------------------------- out


def test_every_link_numbers_its_own_frames_from_nought_and_round_after_255() -> None:
    links = Links(255, 190, count=2)
    numbers = [wire.sent(links.send(0, REACHED, NOW_NS))[0].get_seq() for _ in range(258)]
    assert numbers == [*range(256), 0, 1]
    assert wire.sent(links.send(1, REACHED, NOW_NS))[0].get_seq() == 0


def test_a_frame_leaves_in_the_station_s_name_and_is_recorded_as_it_left() -> None:
    transmit, record = Links(200, 191, count=3).send(2, REACHED, NOW_NS)
    assert isinstance(transmit, Transmit)
    assert isinstance(record, Record)
    message = wire.read(transmit.data)
    assert (message.get_srcSystem(), message.get_srcComponent(), message.seq) == (200, 191, 7)
    assert told.frames([record]) == [(2, 1, transmit.data)]


def test_a_link_whose_peer_is_not_known_sends_and_records_nothing_and_keeps_its_count() -> None:
    links = Links(255, 190, count=2, waiting=[1])
    assert links.send(1, REACHED, NOW_NS) == []
    links.peer_known(0)
    assert links.send(1, REACHED, NOW_NS) == []
    links.peer_known(1)
    assert wire.sent(links.send(1, REACHED, NOW_NS))[0].get_seq() == 0


def test_the_heartbeat_is_a_ground_station_s_and_leaves_on_every_link_with_a_peer() -> None:
    links = Links(255, 190, count=3, waiting=[1])
    effects = links.heartbeat(NOW_NS)
    assert [e.link for e in effects if isinstance(e, Transmit)] == [0, 2]
    for beat in wire.sent(effects):
        assert beat.type == 6  # MAV_TYPE_GCS
        assert beat.autopilot == 8  # MAV_AUTOPILOT_INVALID: no flight controller
        assert (beat.base_mode, beat.custom_mode, beat.mavlink_version) == (0, 0, 3)
        assert beat.system_status == 4  # MAV_STATE_ACTIVE


# ------------------------------------------------------------------------------------ in


@pytest.mark.parametrize("mavlink1", [False, True])
def test_a_datagram_holds_whole_frames(mavlink1: bool) -> None:
    vehicle = Sender()
    sent = [
        vehicle.frame(wire.position(n, (1.0, 2.0, 3.0)), mavlink1=mavlink1) for n in range(1, 4)
    ]
    items = Links(255, 190, count=1).split(0, b"".join(sent))
    assert raws(items) == sent


def test_half_a_frame_in_a_datagram_is_no_beginning_of_the_next() -> None:
    links = Links(255, 190, count=1)
    frame = Sender().frame(wire.heartbeat())
    assert is_garbage(links.split(0, frame[:9]))
    assert is_garbage(links.split(0, frame[9:]))


def test_a_stray_beginning_of_a_frame_does_not_swallow_the_good_one_behind_it() -> None:
    frame = Sender().frame(wire.heartbeat())
    assert raws(Links(255, 190, count=1).split(0, b"\xfd\xfe" + frame)) == [frame]


@pytest.mark.parametrize("mavlink1", [False, True])
def test_a_stream_gives_the_same_frames_wherever_it_is_cut(mavlink1: bool) -> None:
    vehicle = Sender()
    frames = [
        vehicle.frame(message, mavlink1=mavlink1)
        for message in (wire.heartbeat(), wire.position(1, (1.0, 2.0, 3.0)), wire.landed(1))
    ]
    data = b"".join(frames)
    for cut in range(len(data) + 1):
        links = Links(255, 190, count=1, streams=[0])
        assert raws([*links.split(0, data[:cut]), *links.split(0, data[cut:])]) == frames


def test_two_streams_do_not_run_into_each_other() -> None:
    links = Links(255, 190, count=2, streams=[0, 1])
    frame = Sender().frame(wire.heartbeat())
    assert raws([*links.split(0, frame[:9]), *links.split(1, frame[:9])]) == []
    assert raws(links.split(1, frame[9:])) == [frame]
    assert raws(links.split(0, frame[9:])) == [frame]
