"""An operator's end of the pipe, with a station process of its own (a fake one)."""

from __future__ import annotations

import signal
import socket
import sys
from collections.abc import Iterator
from pathlib import Path
from queue import Queue

import pytest

from gcs import ipc
from gcs.config import StationConfig
from gcs.operator.client import StationClient, StationEnded, StationEvent, command_line

pytestmark = pytest.mark.slow  # a station's process

FAKE = (sys.executable, "-m", "tests.unit.operator.fake_station")
PATIENCE = 200
PATIENT_S = 60.0


@pytest.fixture(autouse=True)
def _at_the_root(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(Path(__file__).parents[3])


def events_of(client: StationClient) -> Iterator[StationEvent]:
    """Every event, in order; gives up when nothing more comes."""
    for _ in range(PATIENCE):
        yield from client.poll(0.5).events


def start(scenario: str) -> StationClient:
    return StationClient.start(StationConfig(name=scenario, speedup=20.0), FAKE)


def test_it_says_hello_answers_and_says_good_bye() -> None:
    client = start("flight")
    events: list[StationEvent] = []
    for event in events_of(client):
        events.append(event)
        if isinstance(event, ipc.Hello):
            assert client.send(ipc.Ask(7, "arm"))
        if isinstance(event, ipc.EndingEvent):
            assert event.id == 7
            client.send(ipc.Leave("done"))
        if isinstance(event, StationEnded):
            break
    assert events[-1] == StationEnded(ipc.Bye(0, "logs/x.mcap", "done"), 0, "")
    assert not client.send(ipc.Ask(8, "arm"))
    assert client.poll(0.0).events == [events[-1]]
    assert client.close().exit_code == 0


def test_a_station_that_dies_leaves_its_exit_code_and_its_error_output() -> None:
    client = start("crash")
    ended = next(event for event in events_of(client) if isinstance(event, StationEnded))
    assert ended.bye is None
    assert ended.exit_code == 1
    assert ended.stderr_tail == "fake station: planted failure"
    client.close()


def test_closing_tells_the_station_that_the_operator_is_lost() -> None:
    client = start("flight")
    next(events_of(client))
    ended = client.close()
    assert ended.exit_code == 0
    assert ended.bye is None


def test_a_listener_is_given_every_event_up_to_the_end() -> None:
    client = start("flight")
    queue: Queue[StationEvent] = Queue()
    client.listen(queue.put)
    assert isinstance(queue.get(timeout=PATIENT_S), ipc.Hello)
    client.send(ipc.Leave("done"))
    while not isinstance(last := queue.get(timeout=PATIENT_S), StationEnded):
        pass
    assert last.bye is not None
    client.close()


def test_a_good_bye_that_was_not_read_yet_is_not_lost_by_closing() -> None:
    client = start("flight")
    next(events_of(client))
    client.send(ipc.Leave("done"))
    assert client.close().bye == ipc.Bye(0, "logs/x.mcap", "done")


def test_a_line_that_is_no_event_is_a_trouble_and_not_fatal() -> None:
    client = StationClient.start(StationConfig(), (sys.executable, "-c", "print('Traceback?')"))
    first, *_, last = [event for event, _ in zip(events_of(client), range(2), strict=False)]
    assert isinstance(first, ipc.Trouble)
    assert "no event" in first.text
    assert isinstance(last, StationEnded)
    client.close()


def test_a_wait_ends_when_something_else_is_readable() -> None:
    client = start("silent")
    reader, writer = socket.socketpair()
    with reader, writer:
        writer.send(b"x")
        assert client.poll(60.0, (reader,)).ready == [reader]
    client.close()


@pytest.mark.parametrize(
    ("argv", "typed"),
    [
        (["/home/me/.venv/bin/gcs", "fly", "--sim"], "gcs fly --sim"),
        (["/x/gcs/__main__.py", "demo"], "gcs demo"),
        (["my flight.py", "a b"], "'my flight.py' 'a b'"),
        ([], "''"),
    ],
)
def test_what_was_typed_is_kept_without_the_machines_folders(argv: list[str], typed: str) -> None:
    assert command_line(argv) == typed


@pytest.mark.skipif(sys.platform == "win32", reason="no signal masks")
def test_no_ctrl_c_ends_a_station_before_it_is_in_its_own_session() -> None:
    """It was ended so where a busy machine let it wait between its start and that."""
    interrupted = "import os, signal, sys; os.kill(os.getpid(), signal.SIGINT); sys.exit(7)"
    client = StationClient.start(StationConfig(), (sys.executable, "-c", interrupted))
    ended = next(events_of(client))
    assert isinstance(ended, StationEnded)
    assert ended.exit_code == 7
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())
    client.close()
