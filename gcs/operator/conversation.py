"""One operator's talk with one station: what was asked, and what the station has told.  Pure.

Whoever talks with a station keeps one of these: typed lines, one-shot commands and the demo through
`dialogue.py`, the Python library, the keyboard screen, each connection of a live view.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import TypeAlias

import msgspec

from gcs import ipc, request_words
from gcs.exit_codes import ExitCode
from gcs.gate.refusal import Code
from gcs.gate.states import LandedState, State
from gcs.operator.client import StationEnded, StationEvent
from gcs.operator.errors import ExitError
from gcs.operator.station_loss import after_station_died, record_hint

KEPT_LINES = 200

_EXIT_CODE_OF_REFUSAL: dict[str, ExitCode] = {
    Code.NO_VEHICLE: ExitCode.NO_VEHICLE,
    Code.VEHICLE_REFUSED: ExitCode.REFUSED_BY_VEHICLE,
    Code.NO_ANSWER: ExitCode.NOT_COMPLETED,
    Code.BAD_MISSION: ExitCode.BAD_FILE,
    Code.BAD_PARAMETER: ExitCode.USAGE,
    Code.RECORDER_DOWN: ExitCode.RECORDER,
    Code.SEVERAL_VEHICLES: ExitCode.USAGE,
    "BAD_REQUEST": ExitCode.USAGE,  # the session's code for what is no request at all
}


Found: TypeAlias = ipc.ParametersEvent | ipc.FileDataEvent | ipc.FilesEvent | ipc.LogsEvent
"""What is read of a vehicle for a request."""


@dataclass(slots=True)
class TrackedRequest:
    """One request that was sent, and what the station has answered so far."""

    sent: ipc.Ask
    label: str
    verdict: ipc.VerdictEvent | None = None
    outcome: ipc.EndingEvent | None = None
    found: list[Found] = field(default_factory=list)
    """What was read for it; whoever works on it as it comes may empty the list."""

    @property
    def settled(self) -> bool:
        """Nothing more will be answered: it was refused or superseded, or its outcome is known."""
        if self.outcome is not None:
            return True
        return self.verdict is not None and self.verdict.outcome != "accepted"

    @property
    def completed(self) -> bool:
        return self.outcome is not None and self.outcome.ended == "complete"

    @property
    def exit_code(self) -> ExitCode:
        """What a one-shot command exits with because of it."""
        if self.completed:
            return ExitCode.DONE
        if self.verdict is None or self.outcome is not None or not self.settled:
            vehicle_refused = self.outcome is not None and self.outcome.code == Code.VEHICLE_REFUSED
            return ExitCode.REFUSED_BY_VEHICLE if vehicle_refused else ExitCode.NOT_COMPLETED
        return _EXIT_CODE_OF_REFUSAL.get(self.verdict.code, ExitCode.REFUSED_BY_GATE)


class Conversation:
    """The latest of everything that the station has told, and the requests it has still to answer.

    It is changed by `ask` and `told` alone.
    """

    def __init__(self) -> None:
        self._last_id = 0
        self._open: dict[int, TrackedRequest] = {}
        self.hello: ipc.Hello | None = None
        self.fence: list[ipc.FenceShape] = []
        self.snapshot: ipc.Snapshot | None = None
        self.bridge: ipc.BridgeStatus | None = None
        self.operators: ipc.Operators | None = None
        self.stream_verdict: ipc.StreamVerdictEvent | None = None
        self.operations: dict[int, ipc.Operation] | None = None
        """Of all operators; None before they were asked for."""
        self.checked: ipc.Checked | None = None
        self.lines: deque[ipc.LogEvent] = deque(maxlen=KEPT_LINES)
        self.preflight_report: ipc.PreflightReport | None = None
        self.trouble: ipc.Trouble | None = None
        self.ended: StationEnded | None = None

    @property
    def number(self) -> int:
        """The number that the station knows this operator by; 0 before it has said it."""
        return self.hello.client if self.hello else 0

    @property
    def position_known(self) -> bool:
        seen = self.snapshot
        return seen is not None and bool(seen.vehicle) and seen.pos_enu is not None

    @property
    def can_be_judged(self) -> bool:
        """Before that a vehicle on the ground and one in the air look alike to the gate."""
        seen = self.snapshot
        if seen is None or seen.home_enu is None or seen.state == State.STALE.name:
            return False
        return seen.landed not in ("", LandedState.UNDEFINED.name)

    def ask(self, request: ipc.Ask, label: str = "") -> TrackedRequest:
        """Number a request: what is to be sent is `sent` of what is returned."""
        self._last_id += 1
        numbered = msgspec.structs.replace(request, id=self._last_id)
        tracked = TrackedRequest(numbered, label or request_words.label(request))
        self._open[self._last_id] = tracked
        return tracked

    def check(self, request: ipc.Ask) -> ipc.Check:
        """Number a request that is only to be judged: what is to be sent."""
        self._last_id += 1
        return ipc.Check(msgspec.structs.replace(request, id=self._last_id))

    def preflight(self) -> ipc.Preflight:
        """Number a question for what matters before a take-off: what is to be sent."""
        self._last_id += 1
        return ipc.Preflight(self._last_id)

    def list_operations(self) -> ipc.ListOperations:
        """Number a question for what was accepted so far: what is to be sent."""
        self._last_id += 1
        return ipc.ListOperations(self._last_id)

    def preflight_answer(self, number: int) -> ipc.PreflightReport | None:
        """The answer to the question of that number, once it is there."""
        report = self.preflight_report
        return report if report is not None and report.id == number else None

    def told(self, event: StationEvent) -> TrackedRequest | None:
        """Note what the station says; the request that it answers, if it is one of this talk."""
        match event:
            case ipc.VerdictEvent() | ipc.EndingEvent() | ipc.ProgressEvent():
                return self._answered(event)
            case ipc.ParametersEvent() | ipc.FileDataEvent() | ipc.FilesEvent() | ipc.LogsEvent():
                tracked = self._open.get(event.id)
                if tracked is not None:
                    tracked.found.append(event)
                return tracked
            case ipc.Hello():
                self.hello = event
                self.fence = event.fence
            case ipc.Fences(zones):
                self.fence = zones
            case ipc.Snapshot():
                self.snapshot = event
            case ipc.BridgeStatus():
                self.bridge = event
            case ipc.Operators():
                self.operators = event
            case ipc.StreamVerdictEvent():
                self.stream_verdict = event
            case ipc.Checked():
                self.checked = event
            case ipc.PreflightReport():
                self.preflight_report = event
            case ipc.OperationList(_, operations):
                self.operations = {each.id: each for each in operations}
            case ipc.Operation() if self.operations is not None:
                self.operations[event.id] = event
            case ipc.LogEvent():
                self.lines.append(event)
            case ipc.Trouble():
                self.trouble = event
            case StationEnded():
                self.ended = event
            case _:
                pass
        return None

    def _answered(
        self, event: ipc.VerdictEvent | ipc.EndingEvent | ipc.ProgressEvent
    ) -> TrackedRequest | None:
        tracked = self._open.get(event.id)
        if tracked is None or isinstance(event, ipc.ProgressEvent):
            return tracked
        if isinstance(event, ipc.VerdictEvent):
            tracked.verdict = event
        else:
            tracked.outcome = event
        if tracked.settled:
            del self._open[event.id]
        return tracked

    def unexpected_end(self) -> ExitError:
        """Why the station ended although nobody asked it to, and what its vehicle does now."""
        ended, trouble, seen = self.ended, self.trouble, self.snapshot
        assert ended is not None
        if trouble is not None and trouble.exit_code:
            return ExitError(trouble.exit_code, trouble.text, trouble.hint)
        if ended.bye is not None:
            return ExitError(ended.bye.exit_code or ExitCode.BUG, ended.bye.sentence)
        if ended.exit_code is None:
            return ExitError(ExitCode.NOT_COMPLETED, "the connection to the station was lost")
        code, tail = ended.exit_code, ended.stderr_tail
        words = f"its last words:\n{tail}" if tail else "it left no word"
        return ExitError(
            ExitCode.BUG,
            f"the link process died (exit code {code}); {after_station_died(seen)}",
            "\n".join(filter(None, (record_hint(seen.log_path if seen else ""), words))),
        )


def exit_code_of(ended: StationEnded) -> int:
    """What the station's good-bye says the exit code is; BUG if there was no good-bye."""
    return ExitCode.BUG if ended.bye is None else ended.bye.exit_code
