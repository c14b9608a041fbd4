"""What a program that watches the topics is told: all that is in the file, and nothing twice."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from mcap.records import Channel, Schema

from gcs import ipc
from gcs.mcap_file.format import Message
from gcs.mcap_file.reader import Reading
from gcs.record.writer import Recorder
from gcs.shell.recording import Recording
from gcs.shell.topic_stream import NO_RECORD, TopicStream
from tests.unit.record.flights import START_NS, a_flight

A, B = 2, 3
POSITION = "/mavlink/1/1/LOCAL_POSITION_NED"


class Watched:
    """A recorder with its stream, and what each client was told."""

    def __init__(self, folder: Path) -> None:
        self.recorder = Recorder.open(folder, "test", "20260101-000000", START_NS)
        self.recording = Recording(self.recorder)
        self.told: dict[int, list[tuple[ipc.Event, bool]]] = {A: [], B: []}
        self.stream = TopicStream(self.recording, self._tell)
        self.now_ns = START_NS

    def _tell(self, line: bytes, client: int, droppable: bool) -> None:
        self.told[client].append((ipc.decode_event(line), droppable))

    def fly(self) -> None:
        """A flight's worth of everything that can be recorded."""
        for item in a_flight():
            self.now_ns += 10_000_000
            self.recording.write(item, self.now_ns)

    def heard(self, client: int) -> list[tuple[str, int, bytes]]:
        """Topic, time and bytes of each message; every topic is told once and before them."""
        topics: dict[int, str] = {}
        found = []
        for event, _ in self.told[client]:
            if isinstance(event, ipc.Topic):
                assert event.number not in topics
                assert event.topic not in topics.values()
                topics[event.number] = event.topic
            else:
                assert isinstance(event, ipc.TopicMessage)
                found.append((topics[event.number], event.log_time_ns, event.data))
        return found

    def in_file(self) -> list[tuple[str, int, bytes]]:
        topics: dict[int, str] = {}
        found = []
        for record in Reading(self.recorder.path):
            if isinstance(record, Channel):
                topics[record.id] = record.topic
            if isinstance(record, Message):
                found.append((topics[record.channel_id], record.log_time_ns, record.data))
        return found


@pytest.fixture
def watched(tmp_path: Path) -> Iterator[Watched]:
    made = Watched(tmp_path)
    yield made
    made.recorder.close(made.now_ns)


def test_who_watches_from_the_beginning_is_told_all_that_is_in_the_file(watched: Watched) -> None:
    watched.stream.add(A)
    watched.fly()
    heard = watched.heard(A)
    watched.stream.remove(A)
    watched.recorder.close(watched.now_ns)
    in_file = watched.in_file()
    assert {"/gate/decision", "/link/0/garbage", POSITION} <= {topic for topic, _, _ in heard}
    assert heard == in_file[: len(heard)]


def test_a_topic_has_the_schema_of_the_file(watched: Watched) -> None:
    watched.stream.add(A)
    watched.fly()
    watched.recorder.close(watched.now_ns)
    schemas: dict[int, Schema] = {}
    in_file = {}
    for record in Reading(watched.recorder.path):
        if isinstance(record, Schema):
            schemas[record.id] = record
        if isinstance(record, Channel):
            schema = schemas[record.schema_id]
            in_file[record.topic] = (schema.name, schema.encoding, schema.data)
    told = {
        event.topic: (event.schema_name, event.schema_encoding, event.schema)
        for event, _ in watched.told[A]
        if isinstance(event, ipc.Topic)
    }
    assert told == in_file


def test_who_comes_late_is_told_the_topics_and_the_last_word_of_what_is_said_once(
    watched: Watched,
) -> None:
    watched.stream.add(A)
    watched.fly()
    before = len(watched.told[B])
    watched.stream.add(B)
    latest: dict[tuple[int, str], bytes] = {}
    for event, _ in watched.told[A]:
        if isinstance(event, ipc.TopicMessage) and event.latch:
            latest[event.number, event.latch] = event.data
    late = [event for event, _ in watched.told[B][before:]]
    assert [event for event in late if isinstance(event, ipc.Topic)] == [
        event for event, _ in watched.told[A] if isinstance(event, ipc.Topic)
    ]
    assert {
        (event.number, event.latch): event.data
        for event in late
        if isinstance(event, ipc.TopicMessage)
    } == latest
    assert len(latest) >= 4


def test_only_raw_frames_may_be_left_out(watched: Watched) -> None:
    watched.stream.add(A)
    watched.fly()
    topics = {e.number: e.topic for e, _ in watched.told[A] if isinstance(e, ipc.Topic)}
    for event, droppable in watched.told[A]:
        raw = isinstance(event, ipc.TopicMessage) and topics[event.number].startswith(
            ("/mavlink/", "/link/")
        )
        assert droppable == raw


def test_who_has_gone_is_told_nothing_and_the_other_one_still_is(watched: Watched) -> None:
    watched.stream.add(A)
    watched.stream.add(B)
    watched.stream.remove(A)
    before = len(watched.told[A]), len(watched.told[B])
    watched.fly()
    assert len(watched.told[A]) == before[0]
    assert len(watched.told[B]) > before[1]
    watched.stream.remove(B)
    after = len(watched.told[B])
    watched.fly()
    assert len(watched.told[B]) == after


def test_asking_twice_is_asking_once(watched: Watched) -> None:
    watched.stream.add(A)
    watched.stream.add(A)
    watched.fly()
    times_ns = [log_time_ns for _, log_time_ns, _ in watched.heard(A)]
    assert len(set(times_ns)) == len(times_ns) > 0


def test_a_station_that_does_not_record_says_so() -> None:
    told: list[bytes] = []
    stream = TopicStream(Recording(None), lambda line, client, droppable: told.append(line))
    stream.add(A)
    assert [ipc.decode_event(line) for line in told] == [ipc.Trouble(NO_RECORD)]
