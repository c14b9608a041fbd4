"""What one connection to the station's socket can do, and what it cannot do to the others."""

from __future__ import annotations

import socket
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from gcs import ipc
from gcs.session.effects import EVERYONE
from gcs.session.inputs import Input, OperatorGone, OperatorJoined, OperatorLine, OperatorNoise
from gcs.shell import operator_sockets
from gcs.shell.operator_sockets import OperatorSockets

pytestmark = pytest.mark.slow  # sockets


class Bench:
    """A listening socket, the operators' ends of connections, and a clock of the test's own."""

    def __init__(self, token: str = "") -> None:
        self.time_s = 100.0
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.operators = OperatorSockets(self._listener, token, lambda: self.time_s)
        self.ends: list[socket.socket] = []

    def connect(self, *lines: bytes) -> socket.socket:
        """Another program, which has said these."""
        end = socket.create_connection(self._listener.getsockname())
        self.ends.append(end)
        end.sendall(b"".join(lines))
        return end

    def joined(self) -> socket.socket:
        end = self.connect(ipc.encode(ipc.Join("a test")))
        self.turns()
        return end

    def turns(self, count: int = 6) -> list[Input]:
        """Turns of the loop in which everything is looked at."""
        given: list[Input] = []
        for _ in range(count):
            given += self.operators.turn([*self.operators.sources], [*self.operators.sinks])
        return given

    def tell(self, event: ipc.Event, operator: int = EVERYONE) -> None:
        droppable = isinstance(event, ipc.Snapshot)
        last = isinstance(event, ipc.Bye)
        self.operators.tell(ipc.encode(event), operator, droppable=droppable, last=last)

    def close(self) -> None:
        self.operators.close()
        for end in self.ends:
            end.close()


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench()
    yield made
    made.close()


def heard(end: socket.socket) -> list[ipc.Event]:
    """What the operator can read by now, to the end where the station has closed."""
    end.settimeout(0.05)
    data = b""
    try:
        while piece := end.recv(1 << 20):
            data += piece
    except (TimeoutError, ConnectionResetError):
        pass
    return [ipc.decode_event(line) for line in data.splitlines()]


def dropped_because(end: socket.socket) -> str:
    """The last that a operator is told by a station that closes the connection."""
    *_, trouble = heard(end)
    assert isinstance(trouble, ipc.Trouble)
    assert end.recv(1) == b"", "it is closed"
    return trouble.text.removeprefix("the station closed the connection: ")


LAND = ipc.Ask(1, "land")
SNAPSHOT = ipc.Snapshot(0, "HOVERING", "OURS", "NOMINAL", [], 0.0, "x" * 500, True, 0.0)


# ---------------------------------------------------------------------------------- joining


def test_one_that_joins_is_told_to_the_session_and_its_lines_follow(bench: Bench) -> None:
    bench.connect(ipc.encode(ipc.Join("gcs abort, pid 7", hold_on_leave=False)), ipc.encode(LAND))
    assert bench.turns() == [
        OperatorJoined(2, "gcs abort, pid 7", False),
        OperatorLine(2, LAND),
    ]


def test_numbers_begin_after_the_first_operator_s_and_are_never_given_again(bench: Bench) -> None:
    bench.connect().close()  # somebody who only looks whether the station lives
    bench.joined().close()
    assert OperatorGone(2, "its connection ended") in bench.turns()
    bench.connect(ipc.encode(ipc.Join("again")))
    assert bench.turns() == [OperatorJoined(3, "again")]


def test_the_session_hears_nothing_of_one_that_has_not_joined(bench: Bench) -> None:
    for data in (b"garbage\n", b"\xff\xfe\n", ipc.encode(LAND), b"half", b""):
        bench.connect(data)
    assert bench.turns() == []
    bench.time_s += operator_sockets.JOIN_WAIT_S + 0.1
    assert bench.turns() == []
    assert [dropped_because(end) for end in bench.ends] == [
        *["the first line must be a `join`"] * 3,
        *["no `join` within 2 s"] * 2,
    ]


def test_another_schema_is_told_and_not_guessed_at(bench: Bench) -> None:
    end = bench.connect(ipc.encode(ipc.Join("a later one", schema=ipc.SCHEMA + 1)))
    assert bench.turns() == []
    assert dropped_because(end) == f"it speaks schema {ipc.SCHEMA + 1}, this station {ipc.SCHEMA}"


@pytest.mark.parametrize(("token", "joins"), [("secret", True), ("", False), ("wrong", False)])
def test_a_port_asks_for_the_token_of_the_description(token: str, joins: bool) -> None:
    bench = Bench("secret")
    end = bench.connect(ipc.encode(ipc.Join("a test", token=token)))
    assert bool(bench.turns()) is joins
    if not joins:
        assert dropped_because(end) == "the token is not this station's"
    bench.close()


def test_a_name_is_cut(bench: Bench) -> None:
    bench.connect(ipc.encode(ipc.Join("x" * 5000)))
    assert bench.turns() == [OperatorJoined(2, "x" * operator_sockets.NAME_LETTERS)]


# ------------------------------------------------------------------------------------ limits


def test_a_line_in_pieces_is_one_line(bench: Bench) -> None:
    end = bench.joined()
    line = ipc.encode(LAND)
    for byte in line[:-1]:
        end.sendall(bytes((byte,)))
        assert bench.turns(1) == []
    end.sendall(line[-1:])
    assert bench.turns(2) == [OperatorLine(2, LAND)]


def test_a_line_that_does_not_end_is_dropped(bench: Bench) -> None:
    end = bench.joined()
    end.sendall(b"x" * (operator_sockets.MAX_LINE_BYTES + 1))
    why = f"a line of more than {operator_sockets.MAX_LINE_BYTES} bytes"
    assert bench.turns() == [OperatorGone(2, why)]
    assert dropped_because(end) == why


def test_a_flood_is_handed_on_a_few_lines_a_turn_and_ended(bench: Bench) -> None:
    end = bench.joined()
    end.sendall(ipc.encode(LAND) * 150)
    first = bench.turns(1)
    assert 0 < len(first) <= operator_sockets.MAX_LINES_A_TURN + 1
    bench.turns(40)
    assert dropped_because(end) == "more than 50 lines a second"


def test_fifty_lines_a_second_are_no_flood(bench: Bench) -> None:
    end = bench.joined()
    for _ in range(300):
        bench.time_s += 0.02
        end.sendall(ipc.encode(LAND))
        assert OperatorLine(2, LAND) in bench.turns(2)


def test_empty_lines_count(bench: Bench) -> None:
    end = bench.joined()
    end.sendall(b"\n" * 500)
    bench.turns()
    assert dropped_because(end) == "more than 50 lines a second"


def test_noise_is_told_ten_times(bench: Bench) -> None:
    end = bench.joined()
    end.sendall(b"land!\n" * 11)
    *noise, gone = bench.turns()
    assert len(noise) == 10
    assert all(isinstance(given, OperatorNoise) and given.operator == 2 for given in noise)
    assert gone == OperatorGone(2, "more than 10 lines that are no command")


@pytest.mark.parametrize("line", [b"[" * 5000, b'{"type":"ask"}', b"{}", b"null", b"\x00"])
def test_whatever_is_no_command_is_noise(bench: Bench, line: bytes) -> None:
    end = bench.joined()
    end.sendall(line + b"\n")
    (noise,) = bench.turns()
    assert isinstance(noise, OperatorNoise)
    assert repr(line[:200]) in noise.text


def test_one_client_more_than_there_is_room_for_ends_the_one_silent_longest(bench: Bench) -> None:
    for _ in range(operator_sockets.MAX_OPERATORS):
        bench.time_s += 0.1
        bench.joined()
    bench.time_s += 0.1
    bench.ends[0].sendall(ipc.encode(LAND))
    bench.turns()
    bench.connect(ipc.encode(ipc.Join("gcs abort")), ipc.encode(ipc.Ask(1, "abort")))
    gone, joined, line, *_ = bench.turns()
    assert gone == OperatorGone(3, "too many operators: you were silent")
    assert isinstance(joined, OperatorJoined)
    assert line == OperatorLine(joined.operator, ipc.Ask(1, "abort"))


def test_room_is_made_first_by_those_who_have_not_joined(bench: Bench) -> None:
    bench.joined()
    for _ in range(operator_sockets.MAX_OPERATORS):
        bench.connect()
    bench.connect(ipc.encode(ipc.Join("gcs abort")))
    given = bench.turns(10)
    assert not any(isinstance(each, OperatorGone) for each in given)
    assert OperatorJoined(3, "gcs abort") in given


# ------------------------------------------------------------------------------ being told


def test_answers_go_to_one_and_facts_to_all(bench: Bench) -> None:
    one, other = bench.joined(), bench.joined()
    waiting = bench.connect()
    bench.turns()
    bench.tell(ipc.Trouble("for you"), 3)
    bench.tell(ipc.Trouble("for all"))
    assert [heard(end) for end in (one, other, waiting)] == [
        [ipc.Trouble("for all")],
        [ipc.Trouble("for you"), ipc.Trouble("for all")],
        [],
    ]


def test_a_good_bye_is_the_last_and_closes(bench: Bench) -> None:
    end = bench.joined()
    bench.tell(ipc.Bye(0, "", "the station goes on", goes_on=True), 2)
    bench.tell(ipc.Trouble("after it"), 2)
    assert bench.turns() == [OperatorGone(2, "it has left")]
    assert heard(end) == [ipc.Bye(0, "", "the station goes on", goes_on=True)]
    assert end.recv(1) == b""


def test_a_client_that_never_reads_costs_snapshots_first_and_then_its_connection(
    bench: Bench,
) -> None:
    bench.joined()
    reads = bench.joined()
    for _ in range(20_000):
        bench.tell(SNAPSHOT)
        bench.time_s += 0.01
        heard_now = reads.recv(1 << 20)
        assert heard_now.endswith(b"\n")
        given = bench.turns(1)
        if given:
            break
    assert given == [OperatorGone(2, "it does not read")]


def test_what_waits_for_a_client_that_does_not_read_is_bounded(bench: Bench) -> None:
    bench.joined()
    (connection,) = bench.operators._connections
    for _ in range(3_000):
        bench.tell(ipc.Trouble("x" * 1_000))
        assert connection._queued_bytes <= operator_sockets.MAX_QUEUED_BYTES
    assert bench.turns() == [OperatorGone(2, "its connection ended")]


def test_more_may_wait_for_one_that_watches_topics_and_that_is_bounded_too(bench: Bench) -> None:
    bench.joined()
    bench.operators.allow_more(2)
    (connection,) = bench.operators._connections
    most = 0
    for _ in range(9_000):
        bench.tell(ipc.Trouble("x" * 1_000))
        most = max(most, connection._queued_bytes)
    assert operator_sockets.MAX_QUEUED_BYTES < most <= operator_sockets.MAX_QUEUED_TOPIC_BYTES
    assert bench.turns() == [OperatorGone(2, "its connection ended")]


@pytest.mark.skipif(sys.platform == "win32", reason="no such sockets there")
@pytest.mark.parametrize("end_it", [socket.socket.close, lambda end: end.shutdown(socket.SHUT_WR)])
def test_one_that_goes_without_a_word_is_gone(
    tmp_path: Path, bench: Bench, end_it: Callable[[socket.socket], None]
) -> None:
    end = bench.joined()
    end.sendall(ipc.encode(LAND))
    end_it(end)
    assert bench.turns() == [OperatorLine(2, LAND), OperatorGone(2, "its connection ended")]
