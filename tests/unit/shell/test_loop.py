"""The one loop: every effect is performed, every input is handed on, and a bug costs no vehicle."""

from __future__ import annotations

import json
import os
import socket
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from gcs import ipc
from gcs.record.writer import Recorder
from gcs.report import LogEvent, PoseItem, RecordItem
from gcs.session.effects import (
    ClientVerified,
    Emit,
    Finish,
    LeaveOutPeer,
    ReadFile,
    Record,
    ShowTopics,
    Transmit,
    WriteFile,
)
from gcs.session.inputs import (
    ClientCame,
    Datagram,
    FileRead,
    FileWritten,
    Input,
    LinkEvent,
    OperatorGone,
    OperatorLine,
    OperatorNoise,
    RecorderChanged,
    RecorderGrew,
    SignalCame,
    SimGone,
    SimLine,
    Wake,
)
from gcs.shell.client_ports import ClientPorts
from gcs.shell.client_table import Arrival
from gcs.shell.loop import GATHER_NS, MAX_DATAGRAMS_A_TURN, MAX_PLAN_BYTES
from gcs.shell.operator_sockets import Connection, OperatorSockets
from gcs.shell.recording import Recording
from gcs.station.frame_intake import FramesRaisedError
from tests.unit.shell.rig import DONE, EXIT_BUG, MS, START_NS, TICK_NS, Rig, recorded

FIRST = Datagram(0, b"first")
HOLD = Transmit(0, b"hold")


@pytest.fixture
def rig() -> Iterator[Rig]:
    made = Rig()
    yield made
    made.close()


def trouble(text: str) -> Emit:
    return Emit(ipc.Trouble(text))


def texts(events: list[ipc.Event]) -> list[str]:
    return [event.text for event in events if isinstance(event, ipc.Trouble)]


# ------------------------------------------------------------------------------- effects


def test_frames_go_to_the_link_that_they_are_for(rig: Rig) -> None:
    rig.core.answers[FIRST] = [Transmit(1, b"to one"), Transmit(0, b"to nought")]
    assert rig.run(lambda: rig.links[0].bring(b"first")) == DONE
    assert [link.sent for link in rig.links] == [[b"to nought"], [b"to one"]]


def test_a_peer_is_left_out_by_the_link_that_it_is_on(rig: Rig) -> None:
    rig.core.answers[FIRST] = [LeaveOutPeer(1, b"sent back", 5)]
    assert rig.run(lambda: rig.links[0].bring(b"first")) == DONE
    assert [link.left_out for link in rig.links] == [[], [b"sent back"]]


def test_what_is_recorded_bears_the_time_that_the_core_was_told(rig: Rig) -> None:
    rig.core.answers[FIRST] = [recorded("a"), recorded("b")]
    rig.core.does[FIRST] = lambda: rig.advance(7)
    rig.run(lambda: rig.links[0].bring(b"first"))
    assert rig.recording.written == [(START_NS, "a"), (START_NS, "b")]
    assert rig.times_ns(FIRST) == [START_NS]


def test_the_operator_is_told_in_order(rig: Rig) -> None:
    rig.core.answers[FIRST] = [trouble("one"), trouble("two")]
    rig.run(lambda: rig.links[0].bring(b"first"))
    assert texts(rig.events()) == ["one", "two"]


def test_a_snapshot_is_dropped_where_the_pipe_is_full_and_a_verdict_is_not(rig: Rig) -> None:
    snapshot = ipc.Snapshot(0, "", "", "", [], 0.0, "", False, 0.0)
    flood = [trouble("x" * 1000) for _ in range(200)]
    verdict = Emit(ipc.VerdictEvent(1, "arm", "accepted"))
    rig.core.answers[FIRST] = [*flood, Emit(snapshot), verdict]
    seen: list[ipc.Event] = []
    look = [lambda: seen.extend(rig.events())] * 5
    rig.run(lambda: rig.links[0].bring(b"first"), *look)
    assert seen[-1] == verdict.event
    assert len(seen) == 201


def test_the_finish_ends_the_loop_and_nothing_is_handled_after_it(rig: Rig) -> None:
    rig.core.answers[FIRST] = [Finish(5, "enough"), trouble("said after it all the same")]
    finish = rig.run(lambda: rig.links[0].bring(b"first", b"second"))
    assert finish == Finish(5, "enough")
    assert rig.core.inputs == [FIRST]
    assert texts(rig.events()) == ["said after it all the same"]


# --------------------------------------------------------------------------------- files


def read_answer(rig: Rig, path: str) -> FileRead:
    """What the core hears of a file that it asks for."""
    rig.core.answers[FIRST] = [ReadFile(9, path)]
    rig.run(lambda: rig.links[0].bring(b"first"))
    (answer,) = [given for given in rig.core.inputs if isinstance(given, FileRead)]
    assert (answer.token, answer.path) == (9, path)
    return answer


def test_a_file_that_is_asked_for_is_read(rig: Rig, tmp_path: Path) -> None:
    (tmp_path / "a.plan").write_bytes(b"\0\xff plan")
    assert read_answer(rig, str(tmp_path / "a.plan")).data == b"\0\xff plan"


def test_a_shipped_mission_is_found_by_its_name(rig: Rig) -> None:
    shipped = Path(__file__).parents[3] / "missions" / "demo.toml"
    assert read_answer(rig, "demo").data == shipped.read_bytes()


def test_a_file_that_is_not_there_is_told_with_what_there_is(rig: Rig, tmp_path: Path) -> None:
    answer = read_answer(rig, str(tmp_path / "none.plan"))
    assert answer.data is None
    assert "no such file" in answer.error
    assert "demo.toml" in answer.error


def test_a_name_that_no_file_can_have_is_an_error_and_no_fault(rig: Rig) -> None:
    answer = read_answer(rig, "a\0b")
    assert answer.data is None
    assert answer.error
    assert rig.core.faults == []


def test_a_file_that_is_too_large_is_not_taken(rig: Rig, tmp_path: Path) -> None:
    (tmp_path / "huge.plan").touch()
    os.truncate(tmp_path / "huge.plan", MAX_PLAN_BYTES + 1)
    answer = read_answer(rig, str(tmp_path / "huge.plan"))
    assert answer.data is None
    assert answer.error == "larger than 16 MiB"


@pytest.mark.parametrize(
    ("name", "error"),
    [
        ("new.plan", ""),
        ("a folder", "is no regular file"),
        ("no folder/new.plan", "No such file or directory"),
        ("a\0b", "embedded null byte"),
    ],
)
def test_a_file_is_written_or_it_is_told_why_not(
    rig: Rig, tmp_path: Path, name: str, error: str
) -> None:
    (tmp_path / "a folder").mkdir()
    path = str(tmp_path / name)
    rig.core.answers[FIRST] = [WriteFile(9, path, b"data")]
    rig.run(lambda: rig.links[0].bring(b"first"))
    assert [given for given in rig.core.inputs if isinstance(given, FileWritten)] == [
        FileWritten(9, path, error)
    ]
    if not error:
        assert Path(path).read_bytes() == b"data"


def test_what_a_file_leads_to_comes_after_all_effects_of_the_input_that_asked(
    rig: Rig, tmp_path: Path
) -> None:
    """The record is the order in which the core was given its inputs."""
    path = str(tmp_path / "new.plan")
    rig.core.answers[FIRST] = [recorded("before"), WriteFile(9, path, b""), recorded("after")]
    rig.core.answers[FileWritten(9, path)] = [recorded("written")]
    rig.run(lambda: rig.links[0].bring(b"first"))
    assert [item for _, item in rig.recording.written] == ["before", "after", "written"]


# -------------------------------------------------------------------------------- faults


def test_a_bug_in_the_core_is_reported_to_it_and_its_answer_is_performed(rig: Rig) -> None:
    rig.core.fails_at.add(FIRST)
    rig.core.answer_to_fault = [HOLD]
    rig.run(lambda: rig.links[0].bring(b"first", b"second"))
    ((given, report),) = rig.core.faults
    assert given == FIRST
    assert report.splitlines()[-1] == "ZeroDivisionError: planted"
    assert rig.links[0].sent == [b"hold"]
    assert Datagram(0, b"second") in rig.core.inputs


def test_an_effect_that_cannot_be_performed_is_a_fault_and_the_rest_is_performed(rig: Rig) -> None:
    rig.links[1].send_fails = True
    rig.core.answers[FIRST] = [Transmit(1, b"x"), trouble("the rest"), Transmit(0, b"y")]
    rig.core.answer_to_fault = [HOLD]
    assert rig.run(lambda: rig.links[0].bring(b"first")) == DONE
    ((given, report),) = rig.core.faults
    assert given == FIRST
    assert "planted: send" in report
    assert rig.links[0].sent == [b"y", b"hold"]
    assert texts(rig.events()) == ["the rest"]


def test_an_effect_that_fails_on_the_clock_ends_the_link_after_the_hold_has_left(rig: Rig) -> None:
    """A recorder that raises what nobody foresaw must not leave a vehicle to itself."""
    rig.recording.fails_at.append("a tick")
    rig.core.answers[Wake()] = [recorded("a tick")]
    rig.core.answer_to_fault = [HOLD]
    assert rig.run(lambda: rig.advance(50)).exit_code == EXIT_BUG
    assert rig.links[0].sent == [b"hold"]


def test_frames_that_raise_within_a_run_are_faults_and_the_rest_of_it_is_performed(
    rig: Rig,
) -> None:
    bad = Datagram(0, b"bad")
    rest = [Transmit(0, b"of the rest")]
    rig.core.raises[FIRST] = FramesRaisedError(rest, [(bad, ZeroDivisionError("planted"))])
    rig.core.answer_to_fault = [HOLD]
    rig.run(lambda: rig.links[0].bring(b"first", b"second"))
    ((given, report),) = rig.core.faults
    assert given == bad
    assert report.splitlines()[-1] == "ZeroDivisionError: planted"
    assert rig.links[0].sent == [b"of the rest", b"hold"]
    assert Datagram(0, b"second") in rig.core.inputs


def test_an_answer_to_a_fault_that_fails_too_keeps_no_other_from_leaving(rig: Rig) -> None:
    rig.links[1].send_fails = True
    rig.recording.fails_at.append("the fault")
    rig.core.answers[Wake()] = [Transmit(1, b"x")]
    rig.core.answer_to_fault = [recorded("the fault"), Transmit(1, b"hold"), HOLD]
    assert rig.run(lambda: rig.advance(50)).exit_code == EXIT_BUG
    assert rig.links[0].sent == [b"hold"]
    assert len(rig.core.faults) == 1


def test_a_failure_outside_of_any_input_ends_the_link_after_the_hold_has_left(rig: Rig) -> None:
    rig.links[1].drain_fails = True
    rig.core.answer_to_fault = [HOLD]
    assert rig.run(lambda: rig.links[1].bring(b"x")).exit_code == EXIT_BUG
    assert "planted: drain" in rig.core.faults[0][1]
    assert rig.links[0].sent == [b"hold"]


# ---------------------------------------------------------------------------------- time


def test_it_wakes_the_core_at_its_deadline_and_not_before(rig: Rig) -> None:
    rig.run(lambda: rig.advance(49.999), lambda: rig.advance(0.001))
    assert rig.times_ns(Wake()) == [START_NS + TICK_NS, START_NS + 2 * TICK_NS]


def test_a_wake_that_comes_late_comes_once(rig: Rig) -> None:
    rig.run(lambda: rig.advance(175))
    assert rig.times_ns(Wake()) == [START_NS + 175 * MS, START_NS + 4 * TICK_NS]


def test_a_deadline_that_passes_while_datagrams_keep_coming_is_served_between_them(
    rig: Rig,
) -> None:
    rig.core.does[FIRST] = lambda: rig.advance(51)
    rig.run(lambda: rig.links[0].bring(b"first", b"second"))
    assert rig.core.inputs[:3] == [FIRST, Wake(), Datagram(0, b"second")]


def test_one_turn_takes_no_more_than_its_share_of_a_flood(rig: Rig) -> None:
    flood = [b"%d" % n for n in range(MAX_DATAGRAMS_A_TURN + 1)]
    rig.run(lambda: rig.links[0].bring(*flood), lambda: rig.advance(1), lambda: None)
    last, next_turn = Datagram(0, flood[-2]), Datagram(0, flood[-1])
    assert rig.times_ns(last) == [START_NS]
    assert rig.times_ns(next_turn) == [START_NS + 1 * MS]


def test_it_waits_for_the_first_deadline_of_core_recorder_and_links(rig: Rig) -> None:
    def recorder_is_due() -> None:
        rig.recording.due_ns = START_NS + 20 * MS

    def link_is_due() -> None:
        rig.links[1].due_ns = START_NS + 10 * MS

    rig.run(recorder_is_due, link_is_due, lambda: None)
    assert rig.clock.waits_s[:3] == pytest.approx([0.050, 0.020, 0.010])


def test_a_link_that_is_due_is_poked_though_nothing_came(rig: Rig) -> None:
    rig.links[1].open = False
    rig.links[1].due_ns = START_NS + 10 * MS
    rig.links[1].tell("connected")
    rig.run(lambda: rig.advance(9), lambda: rig.advance(1))
    assert rig.links[1].pokes_ns == [START_NS + 10 * MS]
    assert LinkEvent(1, "connected") in rig.core.inputs


def test_what_a_link_tells_of_itself_follows_what_it_brought(rig: Rig) -> None:
    rig.links[0].tell("127.0.0.1:5 sends to us")
    rig.links[0].tell("127.0.0.1:6, too", trouble=True)
    rig.run(lambda: rig.links[0].bring(b"first"))
    told = [LinkEvent(0, "127.0.0.1:5 sends to us"), LinkEvent(0, "127.0.0.1:6, too", trouble=True)]
    assert rig.core.inputs[:3] == [FIRST, *told]


# ------------------------------------------------------------------------------ operator


def test_the_operator_s_lines_are_commands(rig: Rig) -> None:
    asked = ipc.Ask(1, "land")
    rig.run(lambda: rig.type(ipc.encode(asked) + ipc.encode(ipc.Leave())))
    assert rig.core.inputs[:2] == [OperatorLine(1, asked), OperatorLine(1, ipc.Leave())]


@pytest.mark.parametrize(
    "line", ["land!", "{}", '{"type":"ask","id":"one","word":"land"}', "[" * 5000, b"\xff\xfe"]
)
def test_a_line_that_is_no_command_is_told_with_its_beginning(rig: Rig, line: str | bytes) -> None:
    data = line.encode() if isinstance(line, str) else line
    rig.run(lambda: rig.type(data + b"\n" + ipc.encode(ipc.Ask(1, "land"))))
    noise, next_one = rig.core.inputs[:2]
    assert isinstance(noise, OperatorNoise)
    assert repr(data[:200]) in noise.text
    assert next_one == OperatorLine(1, ipc.Ask(1, "land"))
    assert rig.core.faults == []


def test_the_end_of_the_command_stream_is_told_once_after_its_last_line(rig: Rig) -> None:
    rig.run(
        lambda: rig.type(ipc.encode(ipc.Ask(1, "land"))[:-1]),
        rig.hang_up,
        lambda: None,
        lambda: rig.advance(50),
    )
    assert rig.core.inputs[:3] == [
        OperatorLine(1, ipc.Ask(1, "land")),
        OperatorGone(1, "the command stream ended"),
        Wake(),
    ]


def test_a_screen_that_nobody_reads_is_an_operator_who_is_gone_and_told_once(rig: Rig) -> None:
    rig.core.answers[FIRST] = [trouble("is anybody there?")]
    rig.run(rig.look_away, lambda: rig.links[0].bring(b"first"), rig.hang_up, lambda: None)
    gone = [given for given in rig.core.inputs if isinstance(given, OperatorGone)]
    assert gone == [OperatorGone(1, "nobody reads the link's output")]


def test_a_signal_is_an_operator_who_is_gone_by_its_name(rig: Rig) -> None:
    rig.run(lambda: rig.signals.bring("SIGTERM"))
    assert rig.core.inputs[0] == SignalCame("SIGTERM")


# ---------------------------------------------------------------------- recorder, vehicle


def test_a_recorder_that_fails_is_told_before_the_next_input(rig: Rig) -> None:
    failed = RecorderChanged(False, "a.mcap", "disk full")
    rig.core.does[FIRST] = lambda: rig.recording.news.append(failed)
    rig.run(lambda: rig.links[0].bring(b"first", b"second"))
    assert rig.core.inputs[:3] == [FIRST, failed, Datagram(0, b"second")]
    assert rig.times_ns(failed) == rig.times_ns(FIRST)


def test_what_the_recorder_finds_at_its_own_time_is_handed_on(rig: Rig) -> None:
    grew = RecorderGrew(123_456)
    rig.recording.upkeep_news.append(grew)
    rig.recording.due_ns = START_NS + 10 * MS
    rig.run(lambda: rig.advance(9), lambda: rig.advance(1))
    assert rig.times_ns(grew) == [START_NS + 10 * MS]


def test_before_its_own_time_the_recorder_is_left_alone(rig: Rig) -> None:
    grew = RecorderGrew(123_456)
    rig.recording.upkeep_news.append(grew)
    rig.run(lambda: rig.advance(9), lambda: rig.links[0].bring(b"first"))
    assert grew not in rig.core.inputs


def test_a_vehicle_of_our_own_is_heard_line_by_line_and_its_end_once(rig: Rig) -> None:
    rig.run(
        lambda: rig.sim_prints("INFO sim: ready\nhalf"),
        lambda: rig.sim_prints(" a line \u00fc\n"),
        rig.sim_ends,
        lambda: None,
    )
    told = [given for given in rig.core.inputs if isinstance(given, SimLine | SimGone)]
    assert told == [SimLine("INFO sim: ready"), SimLine("half a line \u00fc"), SimGone(3)]


def test_an_event_on_the_pipe_is_one_line_of_json(rig: Rig) -> None:
    rig.core.answers[FIRST] = [trouble("a\nb")]
    rig.run(lambda: rig.links[0].bring(b"first"))
    (event,) = rig.events()
    assert json.loads(ipc.encode(event))["text"] == "a\nb"


# --------------------------------------------------------------------- further operators


class PaperOperators(OperatorSockets):
    """Connections of the test's making: what they bring, and what they are told."""

    def __init__(self) -> None:
        self._near, self._far = socket.socketpair()
        self.brings: list[Input] = []
        self.told: list[tuple[str, int, bool, bool]] = []
        self.may_have_more: list[int] = []

    def fileno(self) -> int:
        return self._near.fileno()

    @property
    def alone(self) -> bool:
        return False

    @property
    def sources(self) -> list[OperatorSockets | Connection]:
        return [self]

    @property
    def sinks(self) -> list[Connection]:
        return []

    @property
    def busy(self) -> bool:
        return False

    def turn(self, readable: Sequence[object], writable: Sequence[object]) -> Iterator[Input]:
        while self.brings:
            yield self.brings.pop(0)

    def tell(self, line: bytes, operator: int, *, droppable: bool, last: bool) -> None:
        self.told.append((type(ipc.decode_event(line)).__name__, operator, droppable, last))

    def allow_more(self, operator: int) -> None:
        self.may_have_more.append(operator)

    def close(self) -> None:
        self._near.close()
        self._far.close()


@pytest.fixture
def operators() -> Iterator[PaperOperators]:
    made = PaperOperators()
    yield made
    made.close()


class Listening(OperatorSockets):
    """Nobody is connected, until somebody knocks."""

    let_in = False

    def _accept(self, now_s: float) -> Iterator[Input]:
        self.let_in = True
        self._listener.recv(1)
        yield from ()


def test_who_connects_where_nobody_was_is_let_in() -> None:
    near, far = socket.socketpair()
    with near, far:
        operators = Listening(near)
        seen: list[bool] = []
        rig = Rig(others=operators)
        rig.run(
            lambda: seen.append(operators.let_in),
            lambda: far.send(b"x") and None,
            lambda: seen.append(operators.let_in),
        )
        rig.close()
        assert seen == [False, True]


def test_an_event_goes_to_whom_it_is_for(operators: PaperOperators) -> None:
    rig = Rig(others=operators)
    snapshot = ipc.Snapshot(0, "", "", "", [], 0.0, "", False, 0.0)
    rig.core.answers[FIRST] = [
        Emit(ipc.Trouble("for all")),
        Emit(ipc.Trouble("for the first"), 1),
        Emit(ipc.Trouble("for another"), 2),
        Emit(snapshot),
        Emit(ipc.BridgeStatus(0, [], [])),
        Emit(ipc.Bye(0, "", "", goes_on=True), 2),
    ]
    rig.run(lambda: rig.links[0].bring(b"first"))
    assert texts(rig.events()) == ["for all", "for the first"]
    assert operators.told == [
        ("Trouble", 0, False, False),
        ("Trouble", 2, False, False),
        ("Snapshot", 0, True, False),
        ("BridgeStatus", 0, True, False),
        ("Bye", 2, False, True),
    ]
    rig.close()


def test_between_two_lines_of_others_the_deadline_is_met(operators: PaperOperators) -> None:
    rig = Rig(others=operators)
    lines = [OperatorLine(2, ipc.Ask(number, "land")) for number in range(3)]
    rig.core.does[lines[0]] = lambda: rig.advance(60)
    operators.brings = [*lines]
    rig.run(lambda: None)
    assert rig.core.inputs[:4] == [lines[0], Wake(), lines[1], lines[2]]
    rig.close()


def test_the_first_operator_s_good_bye_ends_its_pipe_and_not_the_loop(
    operators: PaperOperators,
) -> None:
    rig = Rig(others=operators)
    rig.core.answers[FIRST] = [
        Emit(ipc.Bye(0, "", "kept", goes_on=True), 1),
        Emit(ipc.Trouble("for those who stay")),
    ]
    rig.run(lambda: rig.links[0].bring(b"first"), rig.hang_up, lambda: rig.advance(50))
    (bye,) = rig.events()
    assert isinstance(bye, ipc.Bye)
    assert not any(isinstance(given, OperatorGone) for given in rig.core.inputs)
    assert ("Trouble", 0, False, False) in operators.told
    rig.close()


def test_each_snapshot_is_shown_to_whoever_describes_the_station(
    operators: PaperOperators,
) -> None:
    seen: list[ipc.Snapshot] = []
    rig = Rig(others=operators, on_snapshot=seen.append)
    snapshot = ipc.Snapshot(0, "", "", "", [], 0.0, "", False, 0.0)
    rig.core.answers[FIRST] = [Emit(snapshot), Emit(snapshot, 2)]
    rig.run(lambda: rig.links[0].bring(b"first"))
    assert seen == [snapshot, snapshot]
    rig.close()


def test_what_cannot_be_recorded_is_a_fault_of_the_datagram_that_it_was_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Though it is recorded later, by the clock: on that a fault would end the station."""
    recorder = Recorder.open(tmp_path, "test", "20260101-000000", START_NS)
    pose = PoseItem(1, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    write = Recorder.write

    def refuse_poses(self: Recorder, item: RecordItem, now_ns: int) -> None:
        if item == pose:
            raise ZeroDivisionError("planted")
        write(self, item, now_ns)

    monkeypatch.setattr(Recorder, "write", refuse_poses)
    rig = Rig(recording=Recording(recorder))
    rig.core.answers[FIRST] = [Record(pose)]
    rig.core.answers[Wake()] = [Record(LogEvent(START_NS, 2, "gate", "a tick"))]
    rig.run(lambda: rig.links[0].bring(b"first"), lambda: rig.advance(50), lambda: None)
    ((given, report),) = rig.core.faults
    assert given == FIRST
    assert "planted" in report
    assert recorder.close(START_NS)
    rig.close()


def test_who_watches_topics_is_told_of_them_until_it_has_gone(
    operators: PaperOperators, tmp_path: Path
) -> None:
    recorder = Recorder.open(tmp_path, "test", "20260101-000000", START_NS)
    line = LogEvent(START_NS, 2, "gate", "Complete")
    watch = OperatorLine(2, ipc.WatchTopics())
    rig = Rig(others=operators, recording=Recording(recorder))
    rig.core.answers[watch] = [ShowTopics(2)]
    rig.core.answers[FIRST] = [Record(line)]
    operators.brings = [watch]
    rig.run(
        lambda: None,
        lambda: rig.links[0].bring(b"first"),
        lambda: operators.brings.append(OperatorGone(2, "it has left")),
        lambda: rig.links[0].bring(b"first"),
    )
    assert operators.may_have_more == [2]
    kinds = [told[0] for told in operators.told]
    topics = kinds.count("Topic")
    assert set(operators.told) == {("Topic", 2, False, False), ("TopicMessage", 2, False, False)}
    assert topics == kinds.count("TopicMessage"), "one message of each: the line, and what is first"
    assert recorder.close(START_NS)
    rig.close()


class PaperPorts(ClientPorts):
    """Client ports without sockets: what they bring, and what they are told to send."""

    def __init__(self) -> None:
        super().__init__(2)
        self.brings: list[Arrival] = []
        self.sent: list[tuple[int, bytes]] = []
        self.verified: list[int] = []
        self.due_ns = 1 << 62
        self.turns_ns: list[int] = []

    @property
    def deadline_ns(self) -> int:
        return self.due_ns

    def turn(
        self, readable: Sequence[object], writable: Sequence[object], now_ns: int
    ) -> list[Arrival]:
        self.turns_ns.append(now_ns)
        brings, self.brings = self.brings, []
        return brings

    def send(self, link: int, data: bytes) -> None:
        self.sent.append((link, data))

    def verify(self, link: int, now_ns: int) -> None:
        self.verified.append(link)


def _gathered(rig: Rig) -> list[int]:
    """Which of its waits were for more datagrams of vehicles, counted from 0."""
    waits_s = [round(wait_s, 9) for wait_s in rig.clock.waits_s]
    return [number for number, wait_s in enumerate(waits_s) if wait_s == GATHER_NS / 1e9]


def test_turns_are_apart_where_datagrams_are_dense_and_nowhere_else(rig: Rig) -> None:
    link = rig.links[0]

    def bring(after_ms: float, count: int) -> Callable[[], None]:
        def step() -> None:
            rig.advance(after_ms)
            link.bring(*[b"x"] * count)

        return step

    def gathers() -> None:
        """A wait of its own, before the one for all."""

    rig.run(
        *(bring(8.0, 1), bring(8.0, 2), bring(1.0, 1), bring(0.4, 1), gathers),
        *(bring(8.0, 3), gathers, bring(8.0, 1)),
    )
    assert _gathered(rig) == [4, 6]


def test_while_turns_are_apart_all_others_are_heard_at_once(rig: Rig) -> None:
    link = rig.links[0]

    def both() -> None:
        rig.type(b"no command\n")
        link.bring(b"4")

    rig.run(lambda: link.bring(b"1", b"2", b"3"), both, lambda: rig.advance(2.0), lambda: None)
    came = [type(given) for given in rig.core.inputs]
    assert came[:5] == [Datagram, Datagram, Datagram, OperatorNoise, Datagram]


def test_what_may_be_a_vehicle_s_answer_is_not_waited_for(rig: Rig) -> None:
    link = rig.links[0]
    rig.core.answers[Datagram(0, b"asked")] = [Transmit(0, b"answer")]
    steps = [lambda: link.bring(b"asked")] * 5
    rig.run(*steps, lambda: rig.advance(1.9), lambda: link.bring(b"1", b"2", b"3"))
    assert _gathered(rig) == []


def test_where_datagrams_come_far_apart_a_turn_reads_one_and_loses_none(rig: Rig) -> None:
    link = rig.links[0]

    def bring(after_ms: float, *datagrams: bytes) -> Callable[[], None]:
        def step() -> None:
            rig.advance(after_ms)
            if datagrams:
                link.bring(*datagrams)

        return step

    rig.run(
        bring(8.0, b"1", b"2"),
        bring(8.0, b"3", b"4"),
        bring(0.1),
        bring(0.0),  # it is waited for more
        bring(8.0, b"5", b"6"),
        bring(8.0, b"7"),
    )
    came = [(now_ns, each.data) for now_ns, each in rig.core.given if isinstance(each, Datagram)]
    ms = [8.0, 8.0, 16.0, 16.1, 24.1, 24.1, 32.1]
    assert came == [(START_NS + round(at * MS), b"%d" % n) for n, at in enumerate(ms, 1)]


def test_two_vehicles_at_once_are_not_dense(rig: Rig) -> None:

    def bring() -> None:
        rig.advance(8.0)
        for link in rig.links:
            link.bring(b"x")

    rig.run(bring, bring)
    assert _gathered(rig) == []


def test_no_tick_waits_for_datagrams(rig: Rig) -> None:
    rig.run(lambda: rig.advance(49), lambda: rig.links[0].bring(b"1", b"2", b"3"))
    assert rig.clock.waits_s[2] == pytest.approx(0.001)


def test_while_vehicles_send_all_else_is_looked_at_every_tick_and_at_once_where_it_has_come() -> (
    None
):
    ports = PaperPorts()
    rig = Rig(client_ports=ports)

    def flood(milliseconds: float) -> None:
        rig.advance(milliseconds)
        rig.links[0].bring(b"of a vehicle")

    steps = [lambda: flood(10)] * 12
    rig.run(*steps)
    assert [(now_ns - START_NS) // MS for now_ns in ports.turns_ns][:3] == [10, 60, 110]

    second = Rig(client_ports=PaperPorts())
    asked = ipc.encode(ipc.Ask(1, "abort"))

    def abort_in_the_flood() -> None:
        second.links[0].bring(b"of a vehicle")
        second.type(asked)

    second.run(lambda: second.links[0].bring(b"first"), abort_in_the_flood)
    assert OperatorLine(1, ipc.Ask(1, "abort")) in second.core.inputs[:4]
    rig.close()
    second.close()


def test_what_clients_send_is_handed_on_and_what_is_for_them_goes_to_their_ports() -> None:
    ports = PaperPorts()
    rig = Rig(links=2, client_ports=ports)
    came: list[Arrival] = [ClientCame(2, "udp 127.0.0.1:5", False), Datagram(2, b"theirs")]
    ports.brings = [*came]
    rig.core.answers[came[1]] = [Transmit(0, b"for the vehicle"), Transmit(2, b"for the operator")]
    rig.run(lambda: None)
    assert rig.core.inputs[:2] == came
    assert rig.links[0].sent == [b"for the vehicle"]
    assert ports.sent == [(2, b"for the operator")]
    rig.close()


def test_which_client_has_shown_its_key_is_told_to_its_port_at_once() -> None:
    ports = PaperPorts()
    rig = Rig(client_ports=ports)
    came: list[Arrival] = [Datagram(2, b"signed"), Datagram(3, b"not signed")]
    ports.brings = [*came]
    seen: list[list[int]] = []
    rig.core.answers[came[0]] = [ClientVerified(2)]
    rig.core.does[came[1]] = lambda: seen.append([*ports.verified])
    rig.run(lambda: None)
    assert seen == [[2]], "before the next input"
    rig.close()


def test_between_two_datagrams_of_clients_the_deadline_is_met() -> None:
    ports = PaperPorts()
    rig = Rig(client_ports=ports)
    came = [Datagram(2, b"%d" % number) for number in range(3)]
    rig.core.does[came[0]] = lambda: rig.advance(60)
    ports.brings = [*came]
    rig.run(lambda: None)
    assert rig.core.inputs[:4] == [came[0], Wake(), came[1], came[2]]
    rig.close()


def test_the_loop_waits_no_longer_than_the_client_ports_say() -> None:
    ports = PaperPorts()
    ports.due_ns = START_NS + 7 * MS
    rig = Rig(client_ports=ports)
    rig.run(lambda: None)
    assert rig.clock.waits_s[0] == pytest.approx(0.007)
    rig.close()
