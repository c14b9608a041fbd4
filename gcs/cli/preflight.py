"""`gcs preflight`: everything that matters before a take-off, and what to do about it."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Unpack

import click

from gcs.cli.common_options import COMMON, MeetsVehicle, ToVehicle, set_up
from gcs.cli.options import with_options
from gcs.exit_codes import ExitCode

if TYPE_CHECKING:
    from gcs import ipc
    from gcs.cli.progress import ProgressDisplay
    from gcs.operator.dialogue import Dialogue

EXITS = (
    "Exit codes: 0 nothing fails (cautions may be told), 1 something fails, 2 usage, 3 no vehicle, "
    "9 address in use, 130 interrupted."
)
LOOK_S = 0.5
"""Between two looks at what may still come."""
READ_S = 15.0
"""For one thing that is read of the vehicle."""


@click.command(cls=MeetsVehicle, epilog=f"Example: gcs preflight --json\n\n{EXITS}")
@with_options(*COMMON)
def preflight(**to: Unpack[ToVehicle]) -> None:
    """Look at everything that matters before a take-off, on the vehicle and in the station.

    Tells pass, caution or fail of each, and the commands that mend it.  What comes slowly is waited
    for, up to --timeout; the mission on board and the parameters that shape a stop are read.
    """
    from gcs.cli import oneshot_session

    # That there is no position is one of the rows.
    setup, how = set_up("preflight", "preflight", to, placed=False, told=False)
    task = partial(_look, as_json=to["as_json"], timeout_s=to["timeout"])
    click.get_current_context().exit(oneshot_session.run(setup, how, task))


def _look(
    dialogue: Dialogue, display: ProgressDisplay, *, as_json: bool, timeout_s: float
) -> ExitCode:
    from gcs import ipc
    from gcs.operator.preflight import lines, to_read

    report = _settled(dialogue, timeout_s)
    for alternatives in to_read(report):
        for ask in alternatives:
            if dialogue.wait_settled(dialogue.send(ask), READ_S).completed:
                break
    report = dialogue.look_before_flight()
    display.clear()
    if as_json:
        click.echo(ipc.encode(report).decode().rstrip())
    else:
        click.echo("\n".join(lines(report, dialogue.snapshot, dialogue.number)))
    return ExitCode.DIFFERENT if report.fails else ExitCode.DONE


def _settled(dialogue: Dialogue, timeout_s: float) -> ipc.PreflightReport:
    """The report once nothing is still to come, or the time is over."""
    from gcs.operator.preflight import waiting

    report = dialogue.look_before_flight()
    left_s = timeout_s
    while waiting(report) and left_s > 0.0:
        dialogue.wait_until(lambda: False, LOOK_S)
        left_s -= LOOK_S
        report = dialogue.look_before_flight()
    return report
