"""`gcs fly --plain`: lines from standard input, one answer for each verdict and outcome."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import msgspec

from gcs import ipc, request_words
from gcs.exit_codes import ExitCode
from gcs.operator import line_parser, preflight
from gcs.operator.chosen_vehicle import ChosenVehicle
from gcs.operator.client import Polling, StationEnded
from gcs.operator.console.line_queue import AtOnce, BadLine, Lines
from gcs.operator.conversation import TrackedRequest, exit_code_of
from gcs.operator.dialogue import SETTLE_WAIT_S, Dialogue, InterruptSource
from gcs.operator.errors import ExitError, Interrupted
from gcs.operator.standstill import Standstill
from gcs.operator.text import event_text
from gcs.operator.text.event_text import WarningFilter

FRESH_WAIT_S = 0.5
SAMPLE_S = 0.1
"""From one sample of a velocity to the next."""
Printer = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class PlainConfig:
    """`min_level` is of the log lines, 1 debug .. 5 fatal; time-outs in seconds; `vehicle`: the
    system id of the one that is meant at first, 0 for none."""

    timeout_s: float = 10.0
    min_level: int = 2
    as_json: bool = False
    strict: bool = False
    speedup: float = 1.0
    simulated: bool = False
    vehicle: int = 0


class _LeaveNowError(Exception):
    """`quit` was typed: whatever is waited for is not waited for any more."""


class Plain:
    """The console: does a line when the one before is settled, prints what becomes of it.

    The input is read all the while: a line that acts at once (`request_words.ActsAtOnce`) is sent
    as it comes, and the lines before it that have not begun are dropped.  Answers go to `out`, log
    lines and complaints to `err`.
    """

    def __init__(
        self,
        connection: Polling,
        interrupts: InterruptSource,
        config: PlainConfig,
        out: Printer,
        err: Printer,
    ) -> None:
        self._config = config
        self._connection = ChosenVehicle(connection, config.vehicle)
        self._out, self._err = out, err
        self._dialogue = Dialogue(self._connection, interrupts, self._on_event)
        self._warnings = WarningFilter(cautions=True)
        self._standstill = Standstill()
        self._bad_lines = False
        self._dropped_lines = False
        self._overtaken = False
        self._velocity: str = ""
        """The line whose velocity is streamed now."""
        self._velocity_refused = False
        self._refused_velocities = False
        self._preflight_fails = False
        self._sent_at_once: list[TrackedRequest] = []
        self._until_heard: list[line_parser.Line] = []

    def run(self, lines: Lines) -> int:
        """Until `quit`, the end of the input, or Ctrl-C; returns the exit code."""
        try:
            self._watch(lines)
            self._dialogue.wait_for_vehicle(self._config.timeout_s)
            self._run_lines(lines)
        except _LeaveNowError:
            pass
        except Interrupted as interrupt:
            self._err(f"gcs: {interrupt}: leaving; the link holds the vehicle first")
            self._show_end(self._dialogue.leave(str(interrupt)))
            return ExitCode.INTERRUPTED
        except ExitError:
            self._dialogue.leave("failed")
            raise
        ended = self._dialogue.leave("quit")
        self._show_end(ended)
        return self._exit_code(ended)

    # ------------------------------------------------------------- lines that act at once

    def _watch(self, lines: Lines) -> None:
        if lines.ended or lines.full:
            self._dialogue.unwatch()
        else:
            self._dialogue.watch(lines, lambda: self._read(lines))

    def _read(self, lines: Lines) -> None:
        for each in lines.read():
            for dropped in each.dropped:
                self._tell_dropped(dropped, each.line)
            if each.dropped and not lines.typed:
                self._err(overtaken(each))
            self._act_at_once(each.line if not _chosen_before(each) else _for_every(each.line))
        if lines.typed_end:
            raise _LeaveNowError
        self._watch(lines)

    def _act_at_once(self, line: line_parser.Line | BadLine) -> None:
        if isinstance(line, BadLine):
            self._tell_bad(line)
            return
        match line.action:
            case request_words.SendRequests():
                self._overtaken = True
                seen = self._dialogue.snapshot
                if seen is not None and seen.vehicle:
                    self._send_at_once(line)
                else:
                    self._until_heard.append(line)
            case request_words.ShowState():
                self._show_state()
            case request_words.ShowHelp():
                self._show_help()
            case request_words.Quit():
                raise _LeaveNowError
            case (
                request_words.Wait()
                | request_words.FlyVelocity()
                | request_words.ChooseVehicle()
                | request_words.ShowPreflight()
            ):
                raise AssertionError("it has its turn")

    def _send_at_once(self, line: line_parser.Line) -> None:
        assert isinstance(line.action, request_words.SendRequests)
        (request,) = line.action.requests
        self._sent_at_once.append(self._dialogue.send(request, line.text))

    def _tell_dropped(
        self, line: line_parser.Line | BadLine, by: line_parser.Line | BadLine
    ) -> None:
        if isinstance(line, BadLine):
            self._tell_bad(line)
            return
        assert isinstance(by, line_parser.Line)
        self._dropped_lines = True
        tell = self._err if self._config.as_json else self._out
        tell(f"{line.text}: dropped by {by.text}, which did not wait for it")

    # --------------------------------------------------------------------- lines in turn

    def _run_lines(self, lines: Lines) -> None:
        while (line := self._next_line(lines)) is not None:
            self._overtaken = False
            if isinstance(line, BadLine):
                self._tell_bad(line)
            elif isinstance(line.action, request_words.Quit):
                return
            else:
                self._act(line)

    def _next_line(self, lines: Lines) -> line_parser.Line | BadLine | None:
        """None at the end of the input.  The station's events are read meanwhile."""
        while True:
            self._dialogue.wait_until(lambda: all(each.settled for each in self._sent_at_once))
            self._sent_at_once.clear()
            line = lines.take()
            self._watch(lines)
            if line is not None or lines.ended:
                return line
            self._dialogue.poll(1.0)

    def _act(self, line: line_parser.Line) -> None:
        match line.action:
            case request_words.SendRequests(requests) if line.wait:
                self._dialogue.send_in_turn(requests, line.text, lambda: not self._overtaken)
            case request_words.SendRequests(requests):
                # Not waited for: what has to follow another request cannot be sent blindly.
                self._dialogue.send(requests[0], line.text)
            case request_words.FlyVelocity():
                self._fly_velocity(line.text, line.action)
            case request_words.ChooseVehicle(sysid):
                self._choose(sysid)
            case request_words.Wait(seconds):
                seconds /= self._config.speedup
                self._dialogue.wait_until(lambda: self._overtaken, seconds)
            case request_words.ShowState():
                # As it is after whatever was answered last: the latest may be from before that.
                latest = self._dialogue.snapshot
                self._dialogue.wait_until(
                    lambda: self._dialogue.snapshot is not latest, FRESH_WAIT_S
                )
                self._show_state()
            case request_words.ShowPreflight():
                self._show_preflight()
            case request_words.ShowHelp():
                self._show_help()
            case request_words.Quit():
                return

    def _choose(self, sysid: int) -> None:
        """Until it is heard.  What follows is for that one, also where it is not: for no other."""
        dialogue = self._dialogue
        self._connection.choose(sysid)

        def there() -> bool:
            seen = dialogue.snapshot
            return self._overtaken or (seen is not None and seen.sysid == sysid)

        dialogue.wait_until(there, self._config.timeout_s)
        dialogue.wait_until(lambda: self._overtaken or dialogue.can_be_judged, SETTLE_WAIT_S)
        if not there():
            self._bad_lines = True
            heard = ", ".join(dialogue.snapshot.vehicles if dialogue.snapshot else []) or "none"
            self._err(f"vehicle {sysid}: not heard; there are: {heard}")
        elif not self._config.as_json:
            name = f"vehicle {sysid}"
            self._out(event_text.state_line(dialogue.snapshot, dialogue.number, name))

    def _fly_velocity(self, text: str, asked: request_words.FlyVelocity) -> None:
        """A stream of one velocity, until its time is over, it is refused on the way, as before the
        fence, a line overtakes it, or it ends."""
        self._velocity, self._velocity_refused = text, False
        begun = self._dialogue.send(ipc.Ask(0, "stream_begin"), text)
        samples = max(1, round(asked.seconds / self._config.speedup / SAMPLE_S))

        def over() -> bool:
            return begun.settled or self._overtaken

        for _ in range(samples):
            if not over() and not self._velocity_refused:
                self._connection.send(ipc.Stream(v_enu=asked.v_enu))
                self._dialogue.wait_until(lambda: over() or self._velocity_refused, SAMPLE_S)
        if not over():
            self._dialogue.send(ipc.Ask(0, "stream_end"))
            self._dialogue.wait_settled(begun)
        self._velocity = ""

    def _tell_bad(self, line: BadLine) -> None:
        self._bad_lines = True
        self._err(f"{line.where}: {line.sentence}\n  hint: {line.hint}")

    def _show_state(self) -> None:
        seen = self._dialogue.snapshot
        if self._config.as_json and seen is not None:
            self._out(ipc.encode(seen).decode().rstrip())
        else:
            self._out(event_text.state_line(seen, self._dialogue.number))

    def _show_preflight(self) -> None:
        """Where something fails, a strict script has failed."""
        report = self._dialogue.look_before_flight()
        self._preflight_fails |= report.fails
        if not self._config.as_json:  # else it was told as the event that it is
            for line in preflight.lines(report, self._dialogue.snapshot, self._dialogue.number):
                self._out(line)

    def _show_help(self) -> None:
        tell = self._err if self._config.as_json else self._out
        for line in request_words.help_lines():
            tell(line)

    def _on_event(self, event: ipc.Event, request: TrackedRequest | None) -> None:
        if isinstance(event, ipc.Snapshot):
            if event.vehicle:
                waiting, self._until_heard = self._until_heard, []
                for line in waiting:
                    self._send_at_once(line)
            stands = self._standstill.news(event)
            if stands and not self._config.as_json:
                self._out(stands)
            return
        if isinstance(event, ipc.StreamVerdictEvent) and event.outcome != "accepted":
            self._velocity_refused = self._refused_velocities = True
        if self._config.as_json:
            self._out(ipc.encode(event).decode().rstrip())
            return
        if self._warnings.hides(event, request) or self._says_nothing(event, request):
            return
        match event:
            case ipc.VerdictEvent() if request is not None:
                self._out(event_text.verdict_line(request.label, event))
            case ipc.StreamVerdictEvent(outcome, code, sentence) if outcome != "accepted":
                label = self._velocity or "velocity"
                self._out(event_text.answer_line(label, outcome, code, sentence))
            case ipc.EndingEvent() if request is not None:
                seen = self._dialogue.snapshot
                shown = seen is not None and request.sent.vehicle in (0, ipc.EVERY, seen.sysid)
                told = self._standstill.outcome(request.label, event, seen if shown else None)
                self._out(told)
            case ipc.LogEvent() if event.level >= self._config.min_level:
                self._err(event_text.log_line(event))
            case ipc.Trouble() if not event.exit_code:
                self._err("\n".join(event_text.trouble_lines(event)))
            case _:
                pass

    def _says_nothing(self, event: ipc.Event, request: TrackedRequest | None) -> bool:
        """Of a typed velocity: that its stream is ended in good order, as one that was refused is
        too.  That one's ending is the refusal, which has been told."""
        word = "" if request is None else request.sent.word
        match event:
            case ipc.VerdictEvent(outcome="accepted"):
                return word == "stream_end"
            case ipc.EndingEvent(ended="complete"):
                return word == "stream_end" or (word == "stream_begin" and self._velocity_refused)
            case _:
                return False

    def _show_end(self, ended: StationEnded) -> None:
        for line in event_text.end_lines(ended, simulated=self._config.simulated):
            self._err(line)

    def _exit_code(self, ended: StationEnded) -> int:
        if code := exit_code_of(ended):
            return code
        if self._bad_lines:
            return ExitCode.USAGE
        if not self._config.strict:
            return ExitCode.DONE
        undone = ExitCode.NOT_COMPLETED if self._dropped_lines else ExitCode.DONE
        if self._refused_velocities:
            undone = ExitCode.REFUSED_BY_GATE
        elif self._preflight_fails:
            undone = ExitCode.DIFFERENT
        return self._dialogue.first_failure() or undone


def _chosen_before(stop: AtOnce) -> bool:
    """A choice of another vehicle stood before it, and is dropped."""
    lines = (each for each in stop.dropped if isinstance(each, line_parser.Line))
    return any(isinstance(each.action, request_words.ChooseVehicle) for each in lines)


def _for_every(line: line_parser.Line | BadLine) -> line_parser.Line | BadLine:
    """A stop that may be meant for any of them."""
    if isinstance(line, BadLine) or not isinstance(line.action, request_words.SendRequests):
        return line
    requests = line.action.requests
    every = [msgspec.structs.replace(each, vehicle=ipc.EVERY) for each in requests]
    return replace(line, action=request_words.SendRequests(tuple(every)))


def overtaken(stop: AtOnce) -> str:
    """What a script is told whose stop came before the lines that stand before it."""
    assert isinstance(stop.line, line_parser.Line)
    count, text = len(stop.dropped), stop.line.text.removeprefix("!")
    lines = "the line before it is" if count == 1 else f"the {count} lines before it are"
    in_turn = text.replace("abort", "hold", 1)
    return (
        f"gcs: {stop.line.text} acted as soon as it was read: {lines} not done\n"
        f"  hint: write {in_turn} for a stop that waits for its turn"
    )
