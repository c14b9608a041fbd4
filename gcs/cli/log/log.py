"""`gcs log`: recorded flights."""

from __future__ import annotations

import signal
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gcs.cli.log.audit import audit, sign
from gcs.cli.log.compare import compare
from gcs.cli.log.import_export import cannot_write, export_log, import_log
from gcs.cli.log.replay import replay
from gcs.cli.log.report import report
from gcs.cli.log.rewrite import compact, cut, merge, recover
from gcs.cli.records.files import (
    LAST,
    RECORD,
    chosen,
    one_record,
    reading_progress,
    still_written,
    told,
)
from gcs.exit_codes import ExitCode

if TYPE_CHECKING:
    from gcs.record.check import CheckResult
    from gcs.record.info import FlightInfo
    from gcs.record.viewer.layout import Purpose


@click.group()
def log() -> None:
    """Recorded flights: what is in them, how to look at them, how to save a broken one.

    Example: gcs log info logs/20260101-120000_flight.mcap
    """
    # A Ctrl-C ends what is under way here in order: a bar on the screen, a file half written.
    signal.signal(signal.SIGINT, signal.default_int_handler)


for command in (
    audit,
    compact,
    compare,
    cut,
    export_log,
    import_log,
    merge,
    recover,
    replay,
    report,
    sign,
):
    log.add_command(command)


@log.command()
@click.argument("files", type=RECORD, nargs=-1, metavar="FILE...")
@click.option("--last", is_flag=True, help="Only the newest of them; without FILE, of logs/*.mcap.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object a file, one a line.")
def info(files: tuple[Path, ...], last: bool, as_json: bool) -> None:
    """What each FILE holds: duration, topics and rates, states, decisions, gaps.

    Works on a file whose writer was killed, and says so.

    Examples: gcs log info --last  |  gcs log info logs/*.mcap --json
    """
    import msgspec

    from gcs.record.info import read_info

    for number, file in enumerate(chosen(files, last=last)):
        with told(file), reading_progress(file, "reading") as progress:
            flight = read_info(file, progress)
        if as_json:
            # JSON has no text but UTF-8; a file's name may be other.
            name = flight.path.encode(errors="backslashreplace").decode()
            click.echo(msgspec.json.encode(replace(flight, path=name)).decode())
        else:
            if number:
                click.echo()
            _print(flight)


@log.command()
@click.argument("file", type=RECORD, required=False)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Where to write the layout; without it, it is printed.",
)
@click.option(
    "--for",
    "purpose",
    type=click.Choice(["one", "fleet", "lab"]),
    default="one",
    show_default=True,
    help="One vehicle, all of them, or the lab's cage.",
)
@LAST
def layout(file: Path | None, output: Path | None, purpose: Purpose, last: bool) -> None:
    """A layout for Foxglove or Lichtblick: camera, grid and map fitted to the flight in FILE.

    Without FILE it is for any flight: the camera follows the vehicle.  Open the record, then import
    the layout (Layouts > Import from file).

    Example: gcs log layout --last -o flight-layout.json
    """
    import json

    from gcs.record.viewer.layout import layout_for

    file = one_record(file, last=last) if last else file
    if file is None:
        made = layout_for(None, purpose)
    else:
        with told(file), reading_progress(file, "reading") as progress:
            made = layout_for(file, purpose, progress)
    text = json.dumps(made, indent=1) + "\n"
    if output is None:
        click.echo(text, nl=False)
        return
    try:
        output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise cannot_write(output, error) from error
    click.echo(f"{output}: import it in Foxglove (Layouts > Import from file)")


def _print(flight: FlightInfo) -> None:
    writing = "" if flight.closed else still_written(Path(flight.path))
    state = "complete" if flight.closed else writing or "NOT CLOSED: its writer was killed"
    click.echo(f"{flight.path}: {flight.size / 1e6:.2f} MB, {state}")
    if not flight.closed and not writing:
        click.echo("  viewers refuse such a file: recover it first")
        click.echo(f"  hint: gcs log recover {flight.path} -o whole.mcap")
    if flight.damaged:
        click.echo(f"  {flight.damaged} damaged records were skipped")
    click.echo(f"{flight.messages} messages in {flight.seconds:.1f} s{_began(flight.start_ns)}")
    if flight.topics:
        width = max(len(topic.topic) for topic in flight.topics)
        click.echo(f"\n{'topic':{width}}  {'messages':>8}  {'Hz':>7}  schema")
        for topic in flight.topics:
            rate = f"{topic.hz:7.1f}" if topic.hz else "      -"
            click.echo(f"{topic.topic:{width}}  {topic.messages:8d}  {rate}  {topic.schema}")
    if flight.states:
        click.echo("\nstates")
        for change in flight.states:
            event = f"  ({change.event})" if change.event else ""
            click.echo(f"  {change.t_s:8.2f} s  vehicle {change.vehicle}  {change.state}{event}")
    if flight.decisions:
        click.echo("\ndecisions")
        for decision in flight.decisions:
            why = "  ".join(part for part in (decision.code, decision.sentence) if part)
            click.echo(
                f"  {decision.t_s:8.2f} s  #{decision.request_id} {decision.word}: "
                f"{decision.outcome}  {why}".rstrip()
            )
    for gap in flight.gaps:
        click.echo(f"\ngap: nothing for {gap.seconds:.1f} s after {gap.t_s:.1f} s")
    if flight.attachments:
        click.echo(f"\nattachments: {', '.join(flight.attachments)}")


def _began(start_ns: int | None) -> str:
    from datetime import UTC, datetime

    if start_ns is None:
        return ""
    try:
        began = datetime.fromtimestamp(start_ns / 1e9, UTC)
    except (OverflowError, ValueError, OSError):
        return ""
    return f", from {began:%Y-%m-%d %H:%M:%S} UTC"


@log.command()
@click.argument("files", type=RECORD, nargs=-1, required=True, metavar="FILE...")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object a file, one a line.")
@click.pass_context
def check(ctx: click.Context, files: tuple[Path, ...], as_json: bool) -> None:
    """Is each FILE whole, indexed and in order, and can every message be decoded?

    The exit code is 1 where anything is wrong, and 4 where a FILE is no MCAP at all. Whether the
    messages are those that were written is what gcs log audit tells.

    Example: gcs log check logs/*.mcap
    """
    import msgspec

    from gcs.record.check import check as check_file

    good = True
    for file in files:
        with told(file), reading_progress(file, "checking") as progress:
            writing = still_written(file)
            result = check_file(file, progress, still_written=bool(writing))
        good = good and result.good
        if as_json:
            name = result.path.encode(errors="backslashreplace").decode()
            values = {**msgspec.to_builtins(result), "path": name, "good": result.good}
            click.echo(msgspec.json.encode(values).decode())
        else:
            _print_check(result, writing)
    ctx.exit(ExitCode.DONE if good else ExitCode.DIFFERENT)


def _print_check(result: CheckResult, writing: str) -> None:
    word = "good" if result.good else "NOT GOOD"
    word += f", {writing}" if writing else ""
    click.echo(
        f"{result.path}: {word}: {result.messages} messages on {result.channels} channels, "
        f"{result.seconds:.1f} s"
    )
    for finding in result.findings:
        click.echo(f"  {finding.kind}: {finding.text}")
    for kind, count in result.counts.items():
        shown = sum(finding.kind == kind for finding in result.findings)
        if count > shown:
            click.echo(f"  {kind}: {count - shown} more")
    if "file" in result.counts:
        click.echo(f"  hint: gcs log recover {result.path} -o whole.mcap")
    if result.not_decoded:
        click.echo(f"  {result.not_decoded} messages are of encodings that are not decoded here")
