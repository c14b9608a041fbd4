"""The operator's end of the pipe, against a link process of its own (a fake one)."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from queue import Queue

import pytest

from gcs import ipc
from gcs.config import LinkConfig
from gcs.shell.client import Heard, LinkClient, LinkDown
from gcs.shell.interrupts import Interrupts

FAKE = (sys.executable, "-m", "tests.unit.cli.fake_link")
PATIENCE = 200


@pytest.fixture(autouse=True)
def _at_the_root(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(Path(__file__).parents[3])


def heard(client: LinkClient) -> Iterator[Heard]:
    """Everything said, in order; gives up where nothing more comes."""
    for _ in range(PATIENCE):
        yield from client.poll(0.5).heard


def start(scenario: str) -> LinkClient:
    return LinkClient.start(LinkConfig(name=scenario, speedup=20.0), FAKE)


def test_it_says_hello_answers_and_says_good_bye() -> None:
    client = start("flight")
    said: list[Heard] = []
    for one in heard(client):
        said.append(one)
        if isinstance(one, ipc.Hello):
            assert client.send(ipc.Ask(7, "arm"))
        if isinstance(one, ipc.EndingEvent):
            assert one.id == 7
            client.send(ipc.Leave("done"))
        if isinstance(one, LinkDown):
            break
    assert said[-1] == LinkDown(ipc.Bye(0, "logs/x.mcap", "done"), 0, "")
    assert not client.send(ipc.Ask(8, "arm"))
    assert client.poll(0.0).heard == [said[-1]]
    assert client.close().exit_code == 0


def test_a_link_that_dies_leaves_its_exit_code_and_last_words() -> None:
    client = start("crash")
    down = next(one for one in heard(client) if isinstance(one, LinkDown))
    assert down.bye is None
    assert down.exit_code == 1
    assert down.stderr_tail == "fake link: planted failure"
    client.close()


def test_closing_tells_the_link_that_the_operator_is_lost() -> None:
    client = start("flight")
    next(heard(client))
    down = client.close()
    assert down.exit_code == 0
    assert down.bye is None


def test_a_listener_is_told_everything_up_to_the_end() -> None:
    client = start("flight")
    told: Queue[Heard] = Queue()
    client.listen(told.put)
    assert isinstance(told.get(timeout=20), ipc.Hello)
    client.send(ipc.Leave("done"))
    while not isinstance(last := told.get(timeout=20), LinkDown):
        pass
    assert last.bye is not None
    client.close()


def test_what_is_no_event_is_told_and_not_fatal() -> None:
    client = LinkClient.start(LinkConfig(), (sys.executable, "-c", "print('Traceback?')"))
    first, *_, last = [one for one, _ in zip(heard(client), range(2), strict=False)]
    assert isinstance(first, ipc.Trouble)
    assert "no event" in first.text
    assert isinstance(last, LinkDown)
    client.close()


def test_a_wait_ends_when_something_else_is_readable() -> None:
    client = start("silent")
    reader, writer = os.pipe()
    os.write(writer, b"x")
    with os.fdopen(reader, "rb") as file, os.fdopen(writer, "wb"):
        assert client.poll(60.0, (file,)).ready == [file]
    client.close()


def test_an_interrupt_is_noted_wakes_the_wait_and_is_given_back() -> None:
    before = signal.getsignal(signal.SIGINT)
    client = start("silent")
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGINT)
        assert client.poll(60.0, (interrupts,)).ready == [interrupts]
        assert interrupts.name == "SIGINT"
        interrupts.forget()
        assert interrupts.name == ""
        signal.raise_signal(signal.SIGTERM)
        assert interrupts.name == "SIGTERM"
    assert signal.getsignal(signal.SIGINT) is before
    client.close()
