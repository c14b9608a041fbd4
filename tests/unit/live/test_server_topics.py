"""What viewers are sent: an MCAP writer listens to the server's channels in place of a viewer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import foxglove
import pytest

from gcs import ipc
from gcs.live.inbox import Inbox
from gcs.live.server import FIRST_NS, MAX_FIRST, LiveServer
from tests.unit.record.flights import SECOND, START_NS, Logged, messages_of

pytestmark = pytest.mark.slow  # a socket

CLIENT: Any = SimpleNamespace(id=3)
JSON, RAW = 1, 2


class Bench:
    def __init__(self, path: Path) -> None:
        self._path = path
        self._inbox = Inbox()
        self.server = LiveServer(self._inbox)
        self._writer = foxglove.open_mcap(path, context=self.server._context)
        self.server.topic(ipc.Topic(JSON, "/json", "json", "A", "jsonschema", b"{}"))
        self.server.topic(ipc.Topic(RAW, "/raw", "ros1", "B", "ros1msg", b""))

    def say(self, number: int, data: bytes, after_ns: int = 0, latch: str = "") -> None:
        self.server.message(ipc.TopicMessage(number, START_NS + after_ns, data, latch))

    def subscribe(self, topic: str) -> None:
        channel: Any = SimpleNamespace(id=1, topic=topic)
        self.server._callbacks.on_subscribe(CLIENT, channel)
        self.server.repeat()

    def sent(self) -> list[Logged]:
        self._writer.close()
        return messages_of(self._path)

    def close(self) -> None:
        self._writer.close()
        self._inbox.close()


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    made = Bench(tmp_path / "sent.mcap")
    yield made
    made.close()


def test_a_message_is_sent_as_it_is(bench: Bench) -> None:
    bench.say(RAW, b"\x01\x02", 5)
    bench.say(JSON, b"{}", 7)
    assert bench.sent() == [
        Logged("/raw", START_NS + 5, b"\x01\x02"),
        Logged("/json", START_NS + 7, b"{}"),
    ]


def test_what_is_said_once_is_repeated_for_who_subscribes_the_last_word_on_each_thing(
    bench: Bench,
) -> None:
    bench.say(JSON, b"1", 1, latch="fence")
    bench.say(JSON, b"2", 2, latch="model")
    bench.say(JSON, b"3", 3, latch="fence")
    bench.say(JSON, b"4", FIRST_NS * 2)
    bench.subscribe("/json")
    assert [message.data for message in bench.sent()[4:]] == [b"3", b"2"]


def test_nothing_is_repeated_for_nobody_and_once_for_one(bench: Bench) -> None:
    bench.say(JSON, b"1", latch="fence")
    bench.server.repeat()
    bench.subscribe("/json")
    bench.server.repeat()
    bench.subscribe("/raw")
    bench.subscribe("/unknown")
    assert [message.data for message in bench.sent()] == [b"1", b"1"]


def test_what_came_as_a_topic_appeared_is_repeated_for_who_subscribes_to_it_at_once(
    bench: Bench,
) -> None:
    bench.say(JSON, b"first", 10)
    bench.say(RAW, b"raw", 10)
    bench.subscribe("/json")
    bench.subscribe("/raw")
    assert bench.sent()[2:] == [Logged("/json", START_NS + 10, b"first")]


def test_later_it_is_not(bench: Bench) -> None:
    bench.say(JSON, b"first")
    bench.say(RAW, b"raw", FIRST_NS + SECOND)
    bench.subscribe("/json")
    assert len(bench.sent()) == 2


def test_of_a_quick_topic_nothing_is_kept(bench: Bench) -> None:
    for number in range(MAX_FIRST + 1):
        bench.say(JSON, b"%d" % number, number)
    bench.subscribe("/json")
    assert len(bench.sent()) == MAX_FIRST + 1


def test_a_topic_that_is_told_again_after_a_new_connection_goes_on(bench: Bench) -> None:
    bench.say(JSON, b"1", 1)
    bench.server.topic(ipc.Topic(JSON, "/json", "json", "A", "jsonschema", b"{}"))
    bench.say(JSON, b"2", 2)
    assert [(m.topic, m.data) for m in bench.sent()] == [("/json", b"1"), ("/json", b"2")]
