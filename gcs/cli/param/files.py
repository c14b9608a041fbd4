"""`gcs param save`, `load` and `diff`: files of parameters, beside what the vehicle holds."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Final, Unpack

import click
import msgspec

from gcs.cli.common_options import MeetsVehicle, ToVehicle
from gcs.cli.mission.live import LINK_OPTIONS
from gcs.cli.options import with_options
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from gcs.parameter_files.writer import FORMATS, SUFFIXES

if TYPE_CHECKING:
    from gcs.cli.param.talk import Talk
    from gcs.parameter_files.described import Description
    from gcs.parameter_files.model import Difference, Entry

EXITS = (
    "Exit codes: 0 done, 1 they differ, 2 usage, 3 no vehicle, 4 bad file, 5 refused by the "
    "vehicle, 6 refused by the policy, 8 not completed, 130 interrupted."
)
VEHICLE_WORD: Final = "vehicle"
PASSES: Final = 5
"""What is switched on brings parameters of its own, and these may bring others."""
COUNTED: Final = (
    *("STAT_", "LND_FLIGHT_T_", "COM_FLIGHT_UUID", "MIS_TOTAL", "FENCE_TOTAL", "RALLY_TOTAL"),
    *("FORMAT_VERSION", "SYSID_SW_MREV", "BARO1_GND_PRESS", "BARO2_GND_PRESS", "BARO3_GND_PRESS"),
)
"""How the names begin of what the vehicle itself counts or measures: not loaded.  An ArduCopter 4.7
denies to write the pressures (recorded)."""


@click.command(cls=MeetsVehicle, epilog=f"Example: gcs param save before.parm\n\n{EXITS}")
@click.argument("file")
@click.option("--format", "form", type=click.Choice(FORMATS), help="In place of the suffix's.")
@click.option("--force", is_flag=True, help="Write over a file that exists.")
@with_options(*LINK_OPTIONS)
def save(file: str, form: str | None, force: bool, **to: Unpack[ToVehicle]) -> None:
    """Write all parameters of the vehicle into FILE.

    The suffix chooses the format: .parm MAVProxy, .param Mission Planner, .params QGroundControl.
    """
    from pathlib import Path

    from gcs.cli.param.talk import with_vehicle
    from gcs.parameter_files.writer import format_of, write

    chosen = form or format_of(file)
    if not chosen:
        hint = f"one of {', '.join(SUFFIXES)}, or --format"
        raise ExitError(ExitCode.USAGE, f"{file}: the suffix names no format", hint)
    path = Path(file)
    if path.exists() and not force:
        raise ExitError(ExitCode.USAGE, f"{file}: exists already", "--force writes over it")

    def task(talk: Talk) -> ExitCode:
        entries = talk.parameters()
        try:
            path.write_text(write(chosen, entries.values(), talk.sysid), encoding="utf-8")
        except OSError as error:
            raise ExitError(ExitCode.BAD_FILE, f"{file}: {error.strerror}") from None
        said = {"path": file, "format": chosen, "parameters": len(entries)}
        text = f"{len(entries)} parameters are in {file} ({chosen})"
        talk.say(msgspec.json.encode(said).decode() if to["as_json"] else text)
        return ExitCode.DONE

    click.get_current_context().exit(with_vehicle("param save", to, task))


@click.command(cls=MeetsVehicle, epilog=f"Example: gcs param load before.parm\n\n{EXITS}")
@click.argument("file")
@click.option("--yes", is_flag=True, help="Do not ask before anything is sent.")
@click.option("--dry-run", is_flag=True, help="Show what differs, and send nothing.")
@with_options(*LINK_OPTIONS)
def load(file: str, yes: bool, dry_run: bool, **to: Unpack[ToVehicle]) -> None:
    """Set on the vehicle what differs from FILE, each read back.

    What differs is shown first.  What is beyond the vehicle's own bounds, where it tells them
    (PX4), is not sent.  What it counts or measures itself (STAT_*, totals, pressures) is left out.
    Parameters that appear once others are set, such as behind ArduPilot's *_ENABLE, follow in
    further passes.
    """
    from gcs.cli.param.talk import with_vehicle

    wanted = {name: each for name, each in _read(file).items() if not name.startswith(COUNTED)}
    shown: list[Difference] = []
    known: dict[str, Description] = {}

    def look(talk: Talk) -> ExitCode:
        shown.extend(_to_send(talk.parameters(), wanted))
        if shown and not dry_run:
            known.update(talk.descriptions())
        return ExitCode.DONE

    context = click.get_current_context()
    code = with_vehicle("param load", to, look)
    if code:
        context.exit(code)
    here = [each for each in shown if each.a is not None]
    absent = [each for each in shown if each.a is None]
    as_json = to["as_json"]
    if as_json and (dry_run or not here):
        click.echo(_json(here))
    if not as_json:
        click.echo("\n".join(_lines(here)) if here else f"nothing differs from {file}")
    if absent:
        names = ", ".join(each.name for each in absent)
        click.echo(f"not on the vehicle (now): {names}", err=True)
    if dry_run or not here:
        context.exit(ExitCode.DIFFERENT if shown else ExitCode.DONE)
    if not yes:
        if not sys.stdin.isatty():
            raise ExitError(ExitCode.USAGE, "nobody can be asked here", "--yes sends them")
        click.confirm(f"set these {len(here)} parameters?", abort=True)

    def task(talk: Talk) -> ExitCode:
        return _load(talk, wanted, here, known, as_json=as_json)

    code = with_vehicle("param load", to, task, record=True)
    context.exit(code)


def _load(
    talk: Talk,
    wanted: dict[str, Entry],
    first: list[Difference],
    known: dict[str, Description],
    *,
    as_json: bool,
) -> ExitCode:
    """Pass by pass, until nothing new has appeared.  What is beyond the vehicle's own bounds is not
    sent."""
    from gcs import ipc
    from gcs.cli.param.talk import failure

    tried: set[str] = set()
    failed: list[ExitCode] = []
    rows: list[dict[str, object]] = []
    sending = first
    for _ in range(PASSES):
        for each in sending:
            tried.add(each.name)
            assert each.b is not None
            value, code = float(each.b.value), ExitCode.USAGE
            described = known.get(each.name)
            why = "" if described is None else described.beyond(value)[0]
            if not why:
                tracked = talk.ask(ipc.Ask(0, "param_set", name=each.name, value=value))
                code = tracked.exit_code
                why = "" if tracked.completed else failure(tracked)
            rows.append({"name": each.name, "value": value, "set": not why, "why": why})
            if why:
                failed.append(code)
                talk.say(why, err=True)
        present = talk.parameters()
        left = [each for each in _to_send(present, wanted) if each.name not in tried]
        sending = [each for each in left if each.a is not None]
        if not sending:
            break
        talk.say(f"{len(sending)} more have appeared", err=as_json)
    done = f"{len(tried) - len(failed)} of {len(tried)} parameters are set"
    talk.say(msgspec.json.encode(rows).decode() if as_json else done)
    for each in left:
        talk.say(f"{each.name}: the vehicle does not have it", err=True)
    return failed[0] if failed else ExitCode.DIFFERENT if left else ExitCode.DONE


@click.command(cls=MeetsVehicle, epilog=f"Example: gcs param diff before.parm vehicle\n\n{EXITS}")
@click.argument("a")
@click.argument("b", default=VEHICLE_WORD)
@with_options(*LINK_OPTIONS)
def diff(a: str, b: str, **to: Unpack[ToVehicle]) -> None:
    """Show where A and B differ: files, or the word `vehicle`, which B is where it is left out.

    Beside a vehicle only what the file has is compared.
    """
    from gcs.cli.param.talk import with_vehicle
    from gcs.parameter_files.model import differences

    sides = {name: _read(name) for name in (a, b) if name != VEHICLE_WORD}

    def compared() -> ExitCode:
        found = differences(sides[a], sides[b])
        if VEHICLE_WORD in (a, b):
            file = sides[a] if b == VEHICLE_WORD else sides[b]
            found = [each for each in found if each.name in file]
        if to["as_json"]:
            rows = [{"name": each.name, "a": _value(each.a), "b": _value(each.b)} for each in found]
            click.echo(msgspec.json.encode(rows).decode())
        else:
            click.echo("\n".join(_lines(found)) if found else "no difference")
        return ExitCode.DIFFERENT if found else ExitCode.DONE

    def task(talk: Talk) -> ExitCode:
        sides[VEHICLE_WORD] = talk.parameters()
        return ExitCode.DONE

    code = with_vehicle("param diff", to, task) if VEHICLE_WORD in (a, b) else ExitCode.DONE
    click.get_current_context().exit(code or compared())


def _to_send(vehicle: dict[str, Entry], wanted: dict[str, Entry]) -> list[Difference]:
    """What the file has otherwise than the vehicle."""
    from gcs.parameter_files.model import differences

    return [each for each in differences(vehicle, wanted) if each.b is not None]


def _read(file: str) -> dict[str, Entry]:
    """Raises ExitError with BAD_FILE."""
    from pathlib import Path

    from gcs.parameter_files.model import ParameterFileError
    from gcs.parameter_files.reader import read

    try:
        return read(file, Path(file).read_bytes())
    except OSError as error:
        raise ExitError(ExitCode.BAD_FILE, f"{file}: {error.strerror}") from None
    except ParameterFileError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None


def _lines(found: list[Difference]) -> list[str]:
    """`NAME  was  is`, a line each."""
    return [
        f"{each.name:<16} {each.a.text if each.a else '-':>14} {each.b.text if each.b else '-':>14}"
        for each in found
    ]


def _json(found: list[Difference]) -> str:
    rows = [{"name": each.name, "a": _value(each.a), "b": _value(each.b)} for each in found]
    return msgspec.json.encode(rows).decode()


def _value(entry: Entry | None) -> int | float | None:
    return None if entry is None or entry.value != entry.value else entry.value
