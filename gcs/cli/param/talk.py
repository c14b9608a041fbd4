"""How the commands of `gcs param` ask a station: the parameters it tells, and what it refuses."""

from __future__ import annotations

from collections.abc import Callable

import click

from gcs import ipc
from gcs.cli.common_options import ToVehicle, set_up
from gcs.cli.oneshot_session import run
from gcs.cli.progress import ProgressDisplay
from gcs.exit_codes import ExitCode
from gcs.operator.conversation import TrackedRequest
from gcs.operator.dialogue import Dialogue
from gcs.operator.text import event_text
from gcs.parameter_files.described import PATHS, Description, described
from gcs.parameter_files.model import Entry


class NotDone(Exception):  # noqa: N818 - how a task ends early, not an error of ours
    """A request was refused or has failed, and this was told."""

    def __init__(self, code: ExitCode) -> None:
        super().__init__(code)
        self.code = code


class Talk:
    """One dialogue with a station, about what its vehicle keeps."""

    def __init__(self, dialogue: Dialogue, display: ProgressDisplay, wait_s: float) -> None:
        self.dialogue = dialogue
        self._display = display
        self._wait_s = wait_s

    @property
    def sysid(self) -> int:
        """The vehicle's."""
        seen = self.dialogue.snapshot
        text = "" if seen is None else seen.vehicle.partition("/")[0]
        return int(text) if text.isdecimal() else 1

    @property
    def is_ardupilot(self) -> bool:
        seen = self.dialogue.snapshot
        return seen is not None and "ardupilot" in seen.vehicle

    def ask(self, request: ipc.Ask) -> TrackedRequest:
        """Send it and wait for its end, whatever that is."""
        return self.dialogue.wait_settled(self.dialogue.send(request), self._wait_s)

    def done(self, request: ipc.Ask) -> TrackedRequest:
        """The same of one without which nothing goes on.  Raises NotDone."""
        tracked = self.ask(request)
        if not tracked.completed:
            self.say(failure(tracked), err=True)
            raise NotDone(tracked.exit_code)
        return tracked

    def parameters(self) -> dict[str, Entry]:
        """All of the vehicle's.  Raises NotDone."""
        return entries_of(self.done(ipc.Ask(0, "param_list")))

    def pour(self, request: ipc.Ask, into: Callable[[ipc.FileDataEvent], None]) -> TrackedRequest:
        """Send it, hand on the bytes as they come, and wait for its end."""
        tracked = self.dialogue.send(request)
        while True:
            self.dialogue.wait_until(lambda: bool(tracked.found) or tracked.settled, self._wait_s)
            found, tracked.found[:] = list(tracked.found), []
            for each in found:
                if isinstance(each, ipc.FileDataEvent):
                    into(each)
            if not found:
                return tracked

    def file(self, path: str) -> bytes | None:
        """One of the vehicle's files; None where it has none of that name."""
        tracked = self.ask(ipc.Ask(0, "file_read", path=path))
        parts = [each.data for each in tracked.found if isinstance(each, ipc.FileDataEvent)]
        return b"".join(parts) if tracked.completed else None

    def descriptions(self) -> dict[str, Description]:
        """What the vehicle says of its own parameters; nothing where it has no such file, as an
        ArduPilot, or where none may be read now, as in the air."""
        for path in () if self.is_ardupilot else PATHS:
            data = self.file(path)
            if data is not None:
                try:
                    return described(path, data)
                except ValueError as error:
                    self.say(f"gcs: its descriptions cannot be read: {error}", err=True)
                    return {}
        return {}

    def folder(self, path: str) -> list[ipc.FileInfo]:
        """What one of the vehicle's folders holds; nothing where there is none of that name."""
        tracked = self.ask(ipc.Ask(0, "file_list", path=path))
        events = [each for each in tracked.found if isinstance(each, ipc.FilesEvent)]
        return [each for event in events for each in event.files]

    def say(self, line: str, *, err: bool = False) -> None:
        self._display.clear()
        click.echo(line, err=err)


def entries_of(tracked: TrackedRequest) -> dict[str, Entry]:
    """The parameters that were told, by name."""
    told = [each for each in tracked.found if isinstance(each, ipc.ParametersEvent)]
    return {
        each.name: Entry(each.name, float("nan") if each.value is None else each.value, each.kind)
        for event in told
        for each in event.parameters
    }


def failure(tracked: TrackedRequest) -> str:
    """What the station says of a request that was not completed."""
    if tracked.outcome is not None:
        return event_text.outcome_line(tracked.label, tracked.outcome)
    if tracked.verdict is not None and tracked.settled:
        return event_text.verdict_line(tracked.label, tracked.verdict)
    return f"{tracked.label}: not completed in time"


def with_vehicle(
    what: str, to: ToVehicle, task: Callable[[Talk], ExitCode], *, record: bool = False
) -> ExitCode:
    """Do `task` through the running station, or one of our own; `record`: it changes something."""
    takes = to["take"] and record  # to read needs no control
    setup, how = set_up("param", what, to, record=record, take=takes, placed=False, told=False)

    def talk(dialogue: Dialogue, display: ProgressDisplay) -> ExitCode:
        try:
            return task(Talk(dialogue, display, to["wait"]))
        except NotDone as ended:
            return ended.code

    return ExitCode(run(setup, how, talk))
