"""`gcs campaign`: many flights on a virtual clock, judged by the truth."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.campaign.campaign import Campaign
    from gcs.campaign.case import Row
    from gcs.campaign.plan import Plan
    from gcs.campaign.requirement import Requirement
    from gcs.campaign.statistics import Summary
    from gcs.campaign.store import Store
    from gcs.flight_report.flight import Flight

REPORT = "report.html"
PICTURES = 12


@click.group()
def campaign() -> None:
    """Would a mission, under a policy, stay inside its fence in any wind and with any failure?

    Thousands of flights of the whole station against a simulated vehicle, on a virtual clock, each
    judged by where the vehicle really was.

    Example: gcs campaign run wind.toml
    """
    # A Ctrl-C ends what is under way here in order: rows that were flown are kept.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@campaign.command()
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path), metavar="CAMPAIGN.toml")
@click.option(
    "-o",
    "--output",
    "folder",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="FOLDER",
    help="Where rows, records and the report go; without it, CAMPAIGN beside its file.",
)
@click.option(
    "--workers",
    type=click.IntRange(1, 1024),
    default=os.cpu_count() or 1,
    show_default="one a processor",
    help="Processes of this machine that fly.",
)
@click.option(
    "--scheduler",
    metavar="URL",
    default="",
    help="The workers of this Dask scheduler fly, such as tcp://10.0.0.5:8786.",
)
@click.option(
    "--keep",
    type=click.IntRange(0, 100_000),
    default=100,
    show_default=True,
    help="So many flights are kept as records: every breach, every failure and the worst of each "
    "cell, the nearest first.",
)
@click.option(
    "--require",
    "requires",
    multiple=True,
    metavar="'NAME OP NUMBER'",
    help="Exit with 1 unless it holds, such as 'breaches == 0' or 'breach_bound < 0.01'.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the summary as one JSON object.")
@click.pass_context
def run(
    ctx: click.Context,
    file: Path,
    folder: Path | None,
    workers: int,
    scheduler: str,
    keep: int,
    requires: tuple[str, ...],
    as_json: bool,
) -> None:
    """Fly the campaign of a file; where it was stopped, go on.

    Examples: gcs campaign run wind.toml --require 'breaches == 0'  |  gcs campaign run wind.toml
    --scheduler tcp://10.0.0.5:8786
    """
    import msgspec

    _check_installed()
    required = _requirements(requires)
    plan = _plan(file)
    store = _store(folder or file.with_suffix(""), plan)
    try:
        told = _run(plan, store, workers, scheduler, keep)
    except KeyboardInterrupt:
        click.echo(f"gcs: stopped; the same command goes on ({store.folder})", err=True)
        ctx.exit(ExitCode.INTERRUPTED)
    if as_json:
        click.echo(msgspec.json.encode(told).decode())
    else:
        _print(told, store)
    unmet = [each for each in required if not each.met(told)]
    for each in unmet:
        click.echo(f"gcs: required {each.text}, but it is {each.value(told):g}", err=True)
    ctx.exit(ExitCode.DIFFERENT if unmet or told.differing else ExitCode.DONE)


@campaign.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.argument("number", type=click.IntRange(0), metavar="ID")
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="The record; without it, ID.mcap in the folder's records.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the row as one JSON object.")
@click.pass_context
def show(ctx: click.Context, folder: Path, number: int, output: Path | None, as_json: bool) -> None:
    """Fly one flight of a campaign again, with its record, and audit that.

    The exit code is 1 where it becomes another row than it was, or where the audit finds a
    difference.

    Example: gcs campaign show wind 17
    """
    import msgspec

    from gcs.audit.audit import audit
    from gcs.audit.files import sessions
    from gcs.campaign.flight import fly
    from gcs.campaign.store import Store
    from gcs.shell.environment import environment

    _check_installed()
    plan, rows = _flown(folder)
    store = Store(folder)
    before = rows.get(number)
    if before is None:
        hint = f"flown so far: {len(rows)}"
        raise ExitError(ExitCode.USAGE, f"{folder}: no flight {number} in it", hint)
    record = output or store.record(number)
    record.unlink(missing_ok=True)
    row = fly(plan.case(number, before.inputs), record)
    same = row == before
    result = None
    if record.exists():
        [session] = sessions((record,))
        from gcs import __version__

        result = audit(session.messages(), session.attachments(), __version__, environment())
    good = result is not None and result.good
    if as_json:
        values = {"same": same, "audited": good, **msgspec.to_builtins(row), "record": str(record)}
        click.echo(msgspec.json.encode(values).decode())
    else:
        for name, value in msgspec.to_builtins(row).items():
            click.echo(f"{name:16} {_in_lines(value)}")
        click.echo("the same row as before" if same else "ANOTHER ROW than before")
        click.echo(f"audit: {'no difference' if good else 'DIFFERENCES: gcs log audit'}")
        click.echo(f"{record}: gcs log report {record}")
    ctx.exit(ExitCode.DONE if same and good else ExitCode.DIFFERENT)


@campaign.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.argument("simulator", metavar="px4-sitl|arducopter-sitl")
@click.option(
    "--flights",
    type=click.IntRange(1, 100_000),
    default=50,
    show_default=True,
    help="So many of the campaign's flights, spread evenly over those that it can fly.",
)
@click.option(
    "--at-once",
    type=click.IntRange(1, 64),
    default=1,
    show_default=True,
    help="So many at a time, each in a network of its own.",
)
@click.option("--json", "as_json", is_flag=True, help="Print what is compared as one JSON object.")
def beside(folder: Path, simulator: str, flights: int, at_once: int, as_json: bool) -> None:
    """Fly flights of a campaign once more on a real autopilot, in real time: do they agree?

    MAVGATE_PX4 and MAVGATE_ARDUCOPTER name the autopilots, each with its own simulation. Flights
    that are there already and count are not flown again.

    Example: gcs campaign beside wind px4-sitl --flights 50 --at-once 2
    """
    import msgspec

    from gcs.campaign.real_autopilot import NoAutopilotError, installed
    from gcs.campaign.real_comparison import NoneFitsError, chosen, compared, counts
    from gcs.campaign.real_time_flights import NoNetworkError, fly_apart
    from gcs.campaign.simulators import UnknownSimulatorError, real_time_factory
    from gcs.campaign.store import BESIDE

    _check_installed()
    plan, ours = _flown(folder)
    cases = [
        msgspec.structs.replace(plan.case(row.id, row.inputs), simulator=simulator)
        for row in ours.values()
    ]
    try:
        installed(simulator)
        picked = chosen(cases, real_time_factory(simulator), flights)
        store = _store(folder / BESIDE / simulator, plan)
        known = {row.id: row for row in store.rows()}
        left = [case for case in picked if case.id not in known or not counts(known[case.id])]
        with _progress(len(left)) as tell:
            for done, row in enumerate(fly_apart(left, at_once, store.records), 1):
                store.append(plan, [row])
                known[row.id] = row
                tell(done)
    except UnknownSimulatorError as error:
        raise ExitError(ExitCode.USAGE, str(error), error.hint) from error
    except (NoneFitsError, NoNetworkError, NoAutopilotError) as error:
        raise ExitError(ExitCode.NOT_COMPLETED, str(error)) from error
    told = compared(simulator, ours, known)
    store.finish(plan, [known[number] for number in sorted(known)])
    if as_json:
        click.echo(msgspec.json.encode(told).decode())
        return
    for line in told.lines():
        click.echo(line)


def _in_lines(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {each}" for name, each in value.items())
    return str(value).replace("\n", f"\n{'':17}")


def _check_installed() -> None:
    for name in ("dask", "distributed", "pyarrow", "cma"):
        if find_spec(name) is None:
            text = f"a campaign needs {name}"
            raise ExitError(ExitCode.USAGE, text, "pip install 'mavgate[campaign]'")


def _requirements(texts: tuple[str, ...]) -> list[Requirement]:
    from gcs.campaign.requirement import RequirementError, parse

    try:
        return [parse(text) for text in texts]
    except RequirementError as error:
        raise ExitError(ExitCode.USAGE, f"--require: {error}", error.hint) from error


def _plan(file: Path) -> Plan:
    from gcs.campaign.spec import read_plan
    from gcs.toml import TomlError

    try:
        return read_plan(file)
    except TomlError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from error
    except OSError as error:
        text = f"{error.filename or file}: {error.strerror}"
        raise ExitError(ExitCode.BAD_FILE, text) from error


def _store(folder: Path, plan: Plan) -> Store:
    from gcs.campaign.store import OtherCampaignError, Store

    store = Store(folder)
    try:
        store.begin(plan)
    except OtherCampaignError as error:
        hint = "name another folder with -o, or remove that one"
        raise ExitError(ExitCode.USAGE, str(error), hint) from error
    except OSError as error:
        raise ExitError(ExitCode.RECORDER, f"{error.filename}: {error.strerror}") from error
    return store


def _flown(folder: Path) -> tuple[Plan, dict[int, Row]]:
    import msgspec

    from gcs.campaign.store import Store

    store = Store(folder)
    try:
        return store.plan(), {row.id: row for row in store.rows()}
    except (OSError, msgspec.DecodeError) as error:
        hint = "FOLDER is where gcs campaign run has put its rows"
        raise ExitError(ExitCode.BAD_FILE, f"{folder}: no campaign: {error}", hint) from error


def _run(plan: Plan, store: Store, workers: int, scheduler: str, keep: int) -> Summary:
    import msgspec

    from gcs.campaign import engine
    from gcs.campaign.campaign import Campaign, kept
    from gcs.campaign.page import campaign_page
    from gcs.campaign.statistics import summary
    from gcs.campaign.store import rows_digest
    from gcs.cli.log.report import write_page

    with _workers(workers, scheduler) as client, _progress(plan.flights) as tell:
        fly = partial(engine.flown, client, plan)
        of: Campaign = Campaign(plan, store, fly, time.monotonic, tell)
        rows = of.run()
        differing = of.keep(kept(rows, keep))
    store.finish(plan, rows)
    told = summary(plan, rows, rows_digest(rows))
    told = msgspec.structs.replace(told, differing=differing)
    write_page(store.folder / REPORT, campaign_page(plan, told, rows, _records(store, told)))
    return told


def _records(store: Store, told: Summary) -> dict[int, Flight]:
    """The worst flights, as far as they are kept."""
    from gcs.flight_report.scan import scan

    files = {number: store.record(number) for number in told.worst[:PICTURES]}
    return {number: scan(file) for number, file in files.items() if file.exists()}


@contextmanager
def _workers(count: int, scheduler: str) -> Iterator[object]:
    from gcs.campaign.engine import NoWorkersError, workers

    try:
        with workers(count, scheduler) as client:
            yield client
    except NoWorkersError as error:
        hint = "dask scheduler, and dask worker URL --nthreads 1, must run there"
        raise ExitError(ExitCode.NOT_COMPLETED, str(error), hint) from error


@contextmanager
def _progress(flights: int) -> Iterator[Callable[[int], None]]:
    """A bar with the time that is left, on a terminal."""
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    with click.progressbar(
        length=flights, label="flying", file=sys.stderr, show_pos=True, show_eta=True
    ) as bar:
        yield lambda done: bar.update(done - bar.pos)


def _print(told: Summary, store: Store) -> None:
    from gcs.campaign.page import lead, probability

    click.echo(lead(told))
    for line in (probability(told), *_cell_lines(told)):
        if line:
            click.echo(line)
    click.echo(f"rows  {store.folder}/rows.parquet, SHA-256 of all {told.rows_sha256}")
    click.echo(f"page  {store.folder}/{REPORT}")
    if told.worst:
        click.echo(f"worst gcs campaign show {store.folder} {told.worst[0]}")
    if told.differing:
        click.echo(f"flown again, these became another row: {told.differing}", err=True)


def _cell_lines(told: Summary) -> Iterator[str]:
    for cell in sorted(told.cells, key=lambda each: (each.closest_m is None, each.closest_m)):
        near = "never flew" if cell.closest_m is None else f"closest {cell.closest_m:8.2f} m"
        share = cell.breaches
        yield f"  {near:20}  {share.hits:5d} of {share.of:5d} left the fence  {cell.cell}"
