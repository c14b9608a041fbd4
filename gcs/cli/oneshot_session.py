"""One command, then leave: start a station, wait for a vehicle, send, see the outcome, go."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import click
import msgspec

from gcs import ipc
from gcs.cli.progress import ProgressDisplay
from gcs.cli.running import (
    joined_station,
    others_running,
    refuse_differences,
    station_for,
)
from gcs.config import ANY_STATION, StationConfig, Wanted
from gcs.exit_codes import ExitCode
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.ipc import Ask
from gcs.operator.chosen_vehicle import ChosenVehicle
from gcs.operator.client import Polling, StationClient
from gcs.operator.conversation import TrackedRequest, exit_code_of
from gcs.operator.dialogue import Dialogue, InterruptSource
from gcs.operator.errors import ExitError, Interrupted
from gcs.operator.interrupts import Interrupts
from gcs.operator.standstill import Standstill
from gcs.operator.text import event_text
from gcs.operator.text.event_text import WARNING, WarningFilter
from gcs.request_words import REQUESTS, SendRequests
from gcs.shell.stations import Description

STARTED_IT = 1
"""The number of the operator whose program has started the station."""
STANDS_WAIT_S = 15.0
"""How long a stop that is complete is watched until the vehicle stands."""
Task = Callable[[Dialogue, ProgressDisplay], ExitCode]
"""What to do once a vehicle is heard.  It clears the display before it prints anything itself."""


@dataclass(frozen=True, slots=True)
class OneShotConfig:
    """`wait_s` limits the wait for the outcome, `timeout_s` that for a vehicle; seconds.

    `cautions`: show what is always wrong with this vehicle, too.  `placed`: wait for its position,
    which a stop needs not, and then a moment for its home and landed state.

    Through a running station: `anywhere` says that the only one that runs will do, whatever its
    link is; `take`, to take control over from another operator; `stops`, that nothing is to delay
    it.  `at_once`: do not wait to hear how the vehicle is, the station knows.  `wanted`: what of
    the station was asked for by name.  `min_level`: of the log lines that are shown.  `quiet`: no
    progress is shown.
    """

    timeout_s: float
    wait_s: float
    as_json: bool
    what: str
    cautions: bool = False
    anywhere: bool = False
    take: bool = False
    stops: bool = False
    at_once: bool = False
    placed: bool = True
    wanted: Wanted = ANY_STATION
    min_level: int = WARNING
    quiet: bool = False
    told: bool = True
    """Verdicts and endings are printed; else the task prints what it has to say of them."""


def run(setup: StationConfig, how: OneShotConfig, task: Task) -> int:
    """Do it through the running station that has one of the links open, else with a station of our
    own; returns the exit code.

    Raises ExitError if the running one is not as `how.wanted` says.  A stop takes it as it is,
    unless it would stop another vehicle.
    """
    found = station_for(setup.endpoints, anywhere=how.anywhere)
    if found is not None:
        wanted = Wanted(vehicle=how.wanted.vehicle) if how.stops else how.wanted
        refuse_differences(found, wanted)
        return run_through(found, how, task)
    for line in others_running(setup.endpoints):
        click.echo(f"gcs: {line}", err=True)
    how = replace(how, take=False)
    with Interrupts() as interrupts:
        return run_over(StationClient.start(setup), interrupts, how, task)


def run_through(found: Description, how: OneShotConfig, task: Task) -> int:
    """Do it through a running station, which goes on."""
    with Interrupts() as interrupts:
        joined: Polling = joined_station(found, f"gcs {how.what}", hold_on_leave=False)
        if not how.quiet:
            click.echo(f"gcs: through the running station of process {found.pid}", err=True)
        how = replace(how, at_once=how.stops)
        if found.vehicles and how.wanted.vehicle is not None:
            joined = ChosenVehicle(joined, how.wanted.vehicle)
        return run_over(joined, interrupts, how, task)


def run_over(
    connection: Polling, interrupts: InterruptSource, how: OneShotConfig, task: Task
) -> int:
    """The same with a station that is there already."""
    warnings = WarningFilter(cautions=how.cautions)
    standstill = Standstill()
    shown = False if how.quiet else None
    with ProgressDisplay(how.what, connection.now_s(), shown=shown) as display:

        def on_event(event: ipc.Event, request: TrackedRequest | None) -> None:
            display.update(event, connection.now_s())
            if warnings.hides(event, request):
                return
            seen, shown = dialogue.snapshot, request if how.told else None
            for line, err in _lines(event, shown, seen, standstill, how):
                display.clear()
                click.echo(line, err=err)

        dialogue = Dialogue(connection, interrupts, on_event)
        try:
            if how.placed and not how.at_once:
                dialogue.wait_for_vehicle(how.timeout_s)
            elif not how.at_once:
                dialogue.wait_until_heard(how.timeout_s)
            if how.take:
                taken = dialogue.wait_settled(dialogue.send(Ask(0, "station_take")))
                if not taken.completed:
                    return _left(dialogue, taken.exit_code, display)
            code = task(dialogue, display)
            dialogue.wait_until(lambda: not standstill.stopping, min(how.wait_s, STANDS_WAIT_S))
        except Interrupted:
            ended = dialogue.leave("interrupted", hold=True)
            display.clear()
            for line in event_text.bye_lines(ended.bye) if ended.bye else ():
                click.echo(line, err=True)
            return ExitCode.INTERRUPTED
        except ExitError:
            dialogue.leave("failed")
            raise
        return _left(dialogue, code, display)


def _left(dialogue: Dialogue, code: int, display: ProgressDisplay) -> int:
    """Leave in good order; the exit code, which the station may have one for if we have none.

    Where a request was not completed, what the station says of the vehicle at the end is shown.
    """
    ended = dialogue.leave("done")
    if code == ExitCode.NOT_COMPLETED and ended.bye is not None:
        display.clear()
        for line in event_text.bye_lines(ended.bye):
            click.echo(line, err=True)
    return code or exit_code_of(ended)


def sending(action: SendRequests, wait_s: float) -> Task:
    """The task of sending these requests.

    A station of our own takes control first if one of them needs it: each one-shot command leaves
    the vehicle held, and the next one cannot know by whom.  In a station that runs a hold, and a
    vehicle that somebody else flies, stay as they are until `resume` or `control` is asked for.
    """

    def task(dialogue: Dialogue, display: ProgressDisplay) -> ExitCode:
        needs_control = any(REQUESTS[request.word].needs_control for request in action.requests)
        if needs_control and dialogue.number == STARTED_IT:
            control = dialogue.take_control()
            if control is not None and not control.completed:
                return control.exit_code
        for request in action.requests:
            sent = dialogue.wait_settled(dialogue.send(request), wait_s)
            if not sent.settled:
                display.clear()
                click.echo(f"{sent.label}: not completed within {wait_s:g} s", err=True)
            hint = _hint(sent, dialogue.snapshot)
            if hint:
                display.clear()
                click.echo(f"  hint: {hint}", err=True)
            if sent.exit_code:
                return sent.exit_code
        return ExitCode.DONE

    return task


def _hint(sent: TrackedRequest, seen: ipc.Snapshot | None) -> str:
    """The command that gives back the control which a refused request needs."""
    code = "" if sent.verdict is None else sent.verdict.code
    if seen is None or code not in (Code.HOLDING, Code.NOT_IN_CONTROL):
        return ""
    return {State.HOLDING.name: "gcs resume", State.EXTERNAL.name: "gcs control"}.get(
        seen.state, ""
    )


def _lines(
    event: ipc.Event,
    request: TrackedRequest | None,
    seen: ipc.Snapshot | None,
    standstill: Standstill,
    how: OneShotConfig,
) -> Iterator[tuple[str, bool]]:
    """What to print of an event, and whether it goes to standard error."""
    match event:
        case ipc.VerdictEvent() | ipc.EndingEvent() if request is not None and how.as_json:
            yield msgspec.json.encode(event).decode(), False
        case ipc.VerdictEvent() if request is not None:
            if event.outcome != "accepted":
                yield event_text.verdict_line(request.label, event), False
        case ipc.EndingEvent() if request is not None:
            yield standstill.outcome(request.label, event, seen), False
        case ipc.Snapshot():
            if stands := standstill.news(event):
                yield stands, False
        case ipc.LogEvent() if event.level >= how.min_level:
            yield event_text.log_line(event), True
        case ipc.Trouble() if not event.exit_code:
            yield "\n".join(event_text.trouble_lines(event)), True
        case _:
            pass
