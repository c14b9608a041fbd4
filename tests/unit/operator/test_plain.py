"""`--plain`: one word at a time, one line for each verdict and each outcome."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from typing import Any

import pytest

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator.console.line_queue import LineQueue
from gcs.operator.console.plain import Plain, PlainConfig
from gcs.operator.errors import ExitError
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts


class Session:
    """One run of the console over a pipe and a fake station on a virtual clock."""

    def __init__(
        self,
        script: str,
        config: PlainConfig | None = None,
        scenario: str = "flight",
        rows: Sequence[ipc.PreflightRow] = (),
        connection: FakeConnection | None = None,
    ):
        station = FakeStation(scenario, preflight_rows=[*rows])
        self.connection = connection or FakeConnection(station)
        self.interrupts = NoInterrupts()
        self.out: list[str] = []
        self.err: list[str] = []
        reader, writer = os.pipe()
        with os.fdopen(writer, "w") as file:
            file.write(script)
        plain = Plain(
            self.connection,
            self.interrupts,
            config or PlainConfig(),
            self.out.append,
            self.err.append,
        )
        try:
            self.exit_code = plain.run(LineQueue(reader, "<stdin>"))
        finally:
            os.close(reader)

    def of_type(self, kind: str) -> list[dict[str, Any]]:
        return [told for line in self.out if (told := json.loads(line))["type"] == kind]

    @property
    def sent_words(self) -> list[str]:
        return [command.word for command in self.connection.sent if isinstance(command, ipc.Ask)]


FLIGHT = "arm\ntakeoff 2\ngoto 3 0 2\ngoto 500 0 2\nland\n"


def test_a_flight_is_answered_line_by_line_and_ends_in_order() -> None:
    session = Session(FLIGHT)
    assert session.out == [
        "arm: accepted",
        "arm: complete",
        "takeoff 2: accepted",
        "takeoff 2: complete",
        "goto 3 0 2: accepted",
        "goto 3 0 2: complete",
        "goto 500 0 2: refused OUTSIDE_FENCE: 350 m outside the fence `circle`",
        "land: accepted",
        "land: complete",
    ]
    assert session.exit_code == ExitCode.DONE
    assert session.err[-1] == "log: logs/x.mcap"
    assert session.connection.sent[-1] == ipc.Leave("quit")
    assert session.connection.closed


def test_the_next_word_waits_for_the_outcome_of_the_one_before() -> None:
    session = Session("arm\ntakeoff 2\nphoto\ngoto 1 0 2\n")
    assert "goto 1 0 2: complete" in session.out


def test_an_ampersand_lets_the_next_word_go_at_once() -> None:
    session = Session("arm\ntakeoff 2\nphoto &\ngoto 1 0 2\nwait 3\n")
    assert "goto 1 0 2: refused BUSY: the vehicle is TAKING_PICTURE" in session.out
    assert session.out.index("photo: complete") > session.out.index("photo: accepted") + 1


def test_a_word_not_understood_is_told_with_its_line_and_passed_over() -> None:
    session = Session("# a flight\n\narm\ngoto 1 2\nland\n")
    assert (
        "<stdin>:4: goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got 2\n"
        "  hint: for example: goto 3 0 2" in session.err
    )
    assert session.sent_words == ["arm", "land"]
    assert session.exit_code == ExitCode.USAGE


def test_a_last_line_without_a_newline_counts() -> None:
    assert Session("arm").out == ["arm: accepted", "arm: complete"]


def test_a_velocity_is_streamed_ten_times_a_second_and_ended() -> None:
    session = Session("arm\ntakeoff 2\nvelocity 1 -2 0.5 3\ngoto 1 0 2\n")
    samples = [sent for sent in session.connection.sent if isinstance(sent, ipc.Stream)]
    assert samples == [ipc.Stream(v_enu=(1.0, -2.0, 0.5))] * 30
    assert session.out[4:] == [
        "velocity 1 -2 0.5 3: accepted",
        "velocity 1 -2 0.5 3: complete",
        "goto 1 0 2: accepted",
        "goto 1 0 2: complete",
    ]


def test_a_velocity_that_is_refused_is_not_streamed() -> None:
    session = Session("velocity 1 0 0\n", PlainConfig(strict=True))
    assert session.sent_words == ["stream_begin"]
    assert session.exit_code == ExitCode.REFUSED_BY_GATE


def test_a_velocity_that_is_refused_on_the_way_is_told_and_ended() -> None:
    session = Session("arm\ntakeoff 2\nvelocity 99 0 0 3\nland\n", PlainConfig(strict=True))
    samples = [sent for sent in session.connection.sent if isinstance(sent, ipc.Stream)]
    assert len(samples) == 1
    assert session.out[4:] == [
        "velocity 99 0 0 3: accepted",
        "velocity 99 0 0 3: refused POLICY: too fast",
        "land: accepted",
        "land: complete",
    ]
    assert session.exit_code == ExitCode.REFUSED_BY_GATE


def test_quit_ends_it_before_the_end_of_the_input() -> None:
    assert Session("arm\nquit\nland\n").sent_words == ["arm"]


@pytest.mark.parametrize(
    ("script", "code"),
    [
        ("arm\n", ExitCode.DONE),
        ("takeoff 2\n", ExitCode.REFUSED_BY_GATE),
        (FLIGHT, ExitCode.REFUSED_BY_GATE),
    ],
)
def test_strict_makes_a_refusal_an_exit_code(script: str, code: ExitCode) -> None:
    assert Session(script).exit_code == ExitCode.DONE
    assert Session(script, PlainConfig(strict=True)).exit_code == code


def test_strict_counts_what_was_left_undone() -> None:
    script = "arm\ntakeoff 2\ngoto 9 0 2 &\nwait 1\nhold\n"
    session = Session(script, PlainConfig(strict=True))
    assert "goto 9 0 2: aborted OPERATOR" in session.out
    assert session.exit_code == ExitCode.NOT_COMPLETED


def test_mission_fly_starts_only_what_was_uploaded() -> None:
    session = Session("arm\ntakeoff 2\nmission fly demo.toml\n")
    assert session.sent_words[-2:] == ["mission_upload", "mission_start"]
    assert session.out[-1] == "mission start: complete"


def test_state_is_one_line() -> None:
    assert Session("state\n").out == [
        "state: GROUNDED, control NONE, severity NOMINAL, at E +0.00 N +0.00 U +0.00 m, "
        "mode AUTO.LOITER, disarmed, battery 98 %, in control: you"
    ]


def test_json_prints_the_events_and_snapshots_only_when_asked() -> None:
    session = Session("arm\nstate\n", PlainConfig(as_json=True))
    kinds = [json.loads(line)["type"] for line in session.out]
    assert kinds.count("snapshot") == 1
    assert kinds[0] == "hello"
    assert kinds[-1] == "bye"
    assert "verdict" in kinds


@pytest.mark.parametrize(("level", "heard"), [(1, True), (2, True), (3, False)])
def test_log_lines_are_told_by_level(level: int, heard: bool) -> None:
    session = Session("arm\ntakeoff 2\n", PlainConfig(min_level=level))
    assert ("INFO  gate: Current State: HOVERING" in session.err) == heard


def test_a_refusal_is_not_told_again_as_a_warning() -> None:
    session = Session("arm\ntakeoff 2\ngoto 500 0 2\n")
    assert any("refused OUTSIDE_FENCE" in line for line in session.out)
    assert not any("Refused" in line for line in session.err)


def test_nothing_is_asked_before_it_is_known_whether_the_vehicle_stands_or_flies() -> None:
    session = Session("takeoff 2\n", scenario="late landed")
    assert session.out == ["takeoff 2: refused NOT_ARMED: the vehicle is not armed"]


def test_without_a_vehicle_it_fails_and_asks_nothing() -> None:
    with pytest.raises(ExitError, match=r"no vehicle heard within 10 s \(.+\)") as failed:
        Session("arm\n", scenario="silent")
    assert failed.value.exit_code == ExitCode.NO_VEHICLE


def test_a_port_in_use_is_the_stations_own_exit_code() -> None:
    with pytest.raises(ExitError, match="address in use") as failed:
        Session("arm\n", scenario="port in use")
    assert failed.value.exit_code == ExitCode.ADDRESS_IN_USE


class Typist(NoInterrupts):
    """Types into a pipe, which the console reads, whenever it is told something that fits."""

    def __init__(
        self,
        first: str,
        then: dict[str, str],
        *,
        on_a_terminal: bool = False,
        scenario: str = "flight",
    ) -> None:
        """`then`: what is typed after which answer."""
        super().__init__()
        self.out: list[str] = []
        self.err: list[str] = []
        self.connection = FakeConnection(FakeStation(scenario))
        self._then = dict(then)
        reader, self._writer = os.pipe()
        self._type(first)
        plain = Plain(self.connection, self, PlainConfig(), self._hear, self.err.append)
        try:
            lines = LineQueue(reader, "<stdin>", typed=on_a_terminal)
            self.exit_code = plain.run(lines)
        finally:
            os.close(reader)
            if self._writer >= 0:
                os.close(self._writer)

    def _type(self, text: str) -> None:
        os.write(self._writer, text.encode())

    def _hear(self, line: str) -> None:
        self.out.append(line)
        text = self._then.pop(line, "")
        if text:
            self._type(text.removesuffix("EOF"))
        if text.endswith("EOF"):
            os.close(self._writer)
            self._writer = -1

    @property
    def words(self) -> list[str]:
        return [command.word for command in self.connection.sent if isinstance(command, ipc.Ask)]

    def sent_s(self, word: str) -> float:
        """When it was sent, on the virtual clock."""
        return self.connection.asked_at_s[self.words.index(word)]


def test_an_abort_in_a_pipe_acts_while_a_goto_is_under_way_and_drops_what_has_not_begun() -> None:
    typist = Typist(
        "arm\ntakeoff 2\ngoto 60 0 2\ngoto 0 0 2\nland\n",
        {"goto 60 0 2: accepted": "abort\nresume\nEOF"},
    )
    assert typist.words == ["arm", "takeoff", "goto", "abort", "resume"]
    assert typist.sent_s("abort") - typist.sent_s("goto") <= 0.1
    assert typist.out[-7:] == [
        "goto 0 0 2: dropped by abort, which did not wait for it",
        "land: dropped by abort, which did not wait for it",
        "goto 60 0 2: aborted OPERATOR",
        "abort: accepted",
        "abort: complete",
        "resume: accepted",
        "resume: complete",
    ]


@pytest.mark.parametrize(("abort", "in_turn"), [("abort", "hold"), ("abort all", "hold all")])
def test_an_abort_in_a_script_drops_the_lines_before_it(abort: str, in_turn: str) -> None:
    session = Session(f"arm\ntakeoff 2\n{abort}\nphoto\n")
    assert session.sent_words == ["abort", "photo"]
    assert (
        f"gcs: {abort} acted as soon as it was read: the 2 lines before it are not done\n"
        f"  hint: write {in_turn} for a stop that waits for its turn"
    ) in session.err


def test_strict_counts_what_was_dropped() -> None:
    script = "arm\ntakeoff 2\nabort\n"
    assert Session(script).exit_code == ExitCode.DONE
    assert Session(script, PlainConfig(strict=True)).exit_code == ExitCode.NOT_COMPLETED


def test_an_abort_waits_for_no_position_and_goes_out_with_the_first_word_of_the_vehicle() -> None:
    session = Session("abort\n", scenario="late landed")
    assert session.connection.asked_at_s == [pytest.approx(0.1)]


def test_after_an_abort_a_mission_that_is_still_sent_is_not_started() -> None:
    typist = Typist(
        "arm\ntakeoff 2\nmission fly demo.toml\n",
        {"mission upload demo.toml: accepted": "abort\nEOF"},
        scenario="slow upload",
    )
    assert "mission upload demo.toml: complete" in typist.out
    assert typist.words == ["arm", "takeoff", "mission_upload", "abort"]


def test_an_abort_ends_a_wait() -> None:
    typist = Typist("arm\nwait 1000\nland\n", {"arm: complete": "abort\nEOF"})
    assert typist.words == ["arm", "abort"]
    assert typist.connection.time_s < 10.0


@pytest.mark.parametrize("word", ["hold", "land", "rtl"])
@pytest.mark.parametrize(
    ("mark", "on_a_terminal", "waits"), [("", False, True), ("!", False, False), ("", True, False)]
)
def test_other_stops_act_at_once_on_a_terminal_or_with_a_mark(
    mark: str, on_a_terminal: bool, waits: bool, word: str
) -> None:
    typist = Typist(
        "arm\ntakeoff 2\ngoto 60 0 2\nphoto\n",
        {
            "goto 60 0 2: accepted": f"{mark}{word}\n" + ("" if on_a_terminal else "EOF"),
            f"{word}: complete": "quit\n" if on_a_terminal else "",
        },
        on_a_terminal=on_a_terminal,
    )
    assert typist.words == ["arm", "takeoff", "goto", *(["photo"] if waits else []), word]
    assert (typist.sent_s(word) - typist.sent_s("goto") > 10.0) == waits
    assert f"{word}: complete" in typist.out


@pytest.mark.parametrize("typed", ["quit\n", "EOF"])
def test_on_a_terminal_quit_and_the_end_of_the_input_do_not_wait(typed: str) -> None:
    then = {"goto 60 0 2: accepted": typed}
    typist = Typist("arm\ntakeoff 2\ngoto 60 0 2\nphoto\n", then, on_a_terminal=True)
    assert typist.exit_code == ExitCode.DONE
    assert typist.words == ["arm", "takeoff", "goto"]
    assert typist.connection.sent[-1] == ipc.Leave("quit")
    assert "goto 60 0 2: aborted OPERATOR" in typist.out


def test_on_a_terminal_state_and_help_are_answered_while_something_else_is_under_way() -> None:
    then = {"goto 60 0 2: accepted": "state\nhelp\naborrt\n", "goto 60 0 2: complete": "quit\n"}
    typist = Typist("arm\ntakeoff 2\ngoto 60 0 2\n", then, on_a_terminal=True)
    assert any(line.startswith("state: ") for line in typist.out)
    assert any(line.startswith("abort ") for line in typist.out)
    (told,) = (line for line in typist.err if line.startswith("<stdin>"))
    assert told == "<stdin>:6: aborrt: not a word of ours\n  hint: did you mean abort?"
    assert typist.sent_s("goto") < 10.0 < typist.connection.time_s


def test_ctrl_c_leaves_through_the_station_and_exits_130() -> None:
    class PressedInFlight(NoInterrupts):
        pass

    connection = FakeConnection()
    interrupts = PressedInFlight()
    told: list[str] = []

    def listen(line: str) -> None:
        told.append(line)
        if line == "goto 9 0 2: accepted":
            interrupts.name = "SIGINT"

    reader, writer = os.pipe()
    os.write(writer, b"arm\ntakeoff 2\ngoto 9 0 2\n")
    try:
        plain = Plain(connection, interrupts, PlainConfig(), listen, told.append)
        assert plain.run(LineQueue(reader, "<stdin>")) == ExitCode.INTERRUPTED
    finally:
        os.close(reader)
        os.close(writer)
    assert connection.sent[-1] == ipc.Leave("SIGINT")
    assert "goto 9 0 2: aborted OPERATOR" in told
    assert connection.station.state == "HOLDING"


def test_what_matters_before_a_take_off_is_a_line_a_row() -> None:
    session = Session("preflight\n")
    assert session.out == [
        "pass     gps        3D fix, 10 satellites",
        "CAUTION  failsafes  off",
        "                    > gcs param set NAV_DLL_ACT 2",
        "preflight: caution: failsafes",
    ]
    assert session.exit_code == ExitCode.DONE
    (told,) = Session("preflight\n", PlainConfig(as_json=True)).of_type("preflight_report")
    assert [row["verdict"] for row in told["rows"]] == ["pass", "caution"]


def test_a_strict_script_ends_with_1_where_something_fails() -> None:
    low = ipc.PreflightRow("battery", "fail", "12 %")
    for strict, code in ((True, ExitCode.DIFFERENT), (False, ExitCode.DONE)):
        session = Session("preflight\n", PlainConfig(strict=strict), rows=[low])
        assert session.exit_code == code
        assert session.out[-1] == "preflight: fails: battery; caution: failsafes"


def test_what_follows_a_choice_is_for_that_vehicle_and_a_stop_of_all_for_every_one() -> None:
    session = Session("arm\nvehicle 2\narm\nland all\nvehicle 300\n")
    asked = [command for command in session.connection.sent if isinstance(command, ipc.Ask)]
    assert [(each.word, each.vehicle) for each in asked] == [
        ("arm", 0),
        ("arm", 2),
        ("land", ipc.EVERY),
    ]
    assert ipc.Show(2) in session.connection.sent
    assert any(line.startswith("vehicle 2: GROUNDED") for line in session.out)
    assert any("from 1 to 255, got 300" in line for line in session.err)


def test_an_abort_that_overtakes_a_choice_is_for_every_vehicle() -> None:
    session = Session("arm\nvehicle 2\ngoto 1 0 2\nabort\n")
    asked = [command for command in session.connection.sent if isinstance(command, ipc.Ask)]
    assert [(each.word, each.vehicle) for each in asked] == [("abort", ipc.EVERY)]
