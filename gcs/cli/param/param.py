"""`gcs param`: list, get, set and show what the vehicle holds."""

from __future__ import annotations

import fnmatch
from collections.abc import Mapping
from typing import TYPE_CHECKING, Unpack

import click
import msgspec

from gcs.cli.common_options import MeetsVehicle, ToVehicle
from gcs.cli.mission.live import LINK_OPTIONS
from gcs.cli.options import with_options
from gcs.cli.param.files import diff, load, save
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.cli.param.talk import Talk
    from gcs.parameter_files.model import Entry

EXITS = (
    "Exit codes: 0 done, 1 nothing is so, 2 usage or no such parameter, 3 no vehicle, 4 bad file, "
    "5 refused by the vehicle, 6 refused by the policy, 8 not completed, 130 interrupted."
)


@click.group()
def param() -> None:
    """Parameters of the vehicle, and files of them.

    Through the running station where there is one.  A file is MAVProxy's (.parm), Mission
    Planner's (.param) or QGroundControl's (.params).
    """


@param.command("list", cls=MeetsVehicle, epilog=f"Example: gcs param list 'RTL_*'\n\n{EXITS}")
@click.argument("pattern", default="*")
@with_options(*LINK_OPTIONS)
def list_(pattern: str, **to: Unpack[ToVehicle]) -> None:
    """List the parameters whose names match PATTERN: * for any letters, or a part of the name."""
    from gcs.cli.param.talk import with_vehicle

    def task(talk: Talk) -> ExitCode:
        found = matching(talk.parameters(), pattern)
        if to["as_json"]:
            talk.say(as_json(found))
        elif found:
            talk.say("\n".join(f"{each.name:<16} {each.text}" for each in found.values()))
        else:
            talk.say(f"no parameter matches {pattern!r}", err=True)
        return ExitCode.DONE if found else ExitCode.DIFFERENT

    click.get_current_context().exit(with_vehicle("param list", to, task))


@param.command(
    cls=MeetsVehicle, epilog=f"Example: gcs param get RTL_RETURN_ALT NAV_DLL_ACT\n\n{EXITS}"
)
@click.argument("names", nargs=-1, required=True, metavar="NAME...")
@with_options(*LINK_OPTIONS)
def get(names: tuple[str, ...], **to: Unpack[ToVehicle]) -> None:
    """Read parameters by their names."""
    from gcs import ipc
    from gcs.cli.param.talk import entries_of, failure, with_vehicle

    def task(talk: Talk) -> ExitCode:
        found: dict[str, Entry] = {}
        code = ExitCode.DONE
        for name in names:
            tracked = talk.ask(ipc.Ask(0, "param_get", name=name.upper()))
            if tracked.completed:
                found |= entries_of(tracked)
            else:
                talk.say(failure(tracked), err=True)
                code = code or tracked.exit_code
        if to["as_json"]:
            talk.say(as_json(found))
        elif found:
            talk.say("\n".join(f"{each.name:<16} {each.text}" for each in found.values()))
        return code

    click.get_current_context().exit(with_vehicle("param get", to, task))


@param.command(
    "set",
    epilog=f"Example: gcs param set NAV_DLL_ACT 2\n\n{EXITS}",
    context_settings={"ignore_unknown_options": True},
)
@click.argument("name")
@click.argument("value")
@with_options(*LINK_OPTIONS)
def set_(name: str, value: str, **to: Unpack[ToVehicle]) -> None:
    """Set a parameter and read it back.

    A value beyond the bounds that a PX4 itself tells (gcs param show) is refused.  What safety
    stands on (`gcs bridge --explain NAME`) is set while the vehicle is disarmed on
    the ground only.
    """
    from gcs import ipc
    from gcs.cli.param.talk import failure, with_vehicle
    from gcs.gate.refusal import Code
    from gcs.operator.text.number_text import read_number

    try:
        number = read_number(value)
    except ValueError as error:
        raise ExitError(ExitCode.USAGE, f"{name}: {error}") from None

    def task(talk: Talk) -> ExitCode:
        known = talk.descriptions().get(name.upper())
        beyond, numbers = known.beyond(number) if known is not None else ("", {})
        if beyond:
            code = Code.BAD_PARAMETER
            verdict = ipc.VerdictEvent(0, "param_set", "refused", code, beyond, numbers=numbers)
            told_line = f"refused {code}: {beyond}"
            talk.say(ipc.encode(verdict).decode().rstrip() if to["as_json"] else told_line)
            return ExitCode.USAGE
        tracked = talk.ask(ipc.Ask(0, "param_set", name=name.upper(), value=number))
        told = tracked.outcome or tracked.verdict
        if to["as_json"] and told is not None:
            talk.say(msgspec.json.encode(told).decode())
        elif tracked.completed and tracked.outcome is not None:
            talk.say(tracked.outcome.sentence)
        else:
            talk.say(failure(tracked), err=True)
        return tracked.exit_code

    click.get_current_context().exit(with_vehicle("param set", to, task, record=True))


@param.command(cls=MeetsVehicle, epilog=f"Example: gcs param show NAV_DLL_ACT\n\n{EXITS}")
@click.argument("name")
@with_options(*LINK_OPTIONS)
def show(name: str, **to: Unpack[ToVehicle]) -> None:
    """What a parameter is and what it means, where the autopilot itself says so.

    PX4 does, by its component metadata (MAVLink FTP); ArduPilot has no such file on board.
    """
    from gcs import ipc
    from gcs.cli.param.talk import entries_of, with_vehicle
    from gcs.parameter_files.described import lines_of

    def task(talk: Talk) -> ExitCode:
        tracked = talk.done(ipc.Ask(0, "param_get", name=name.upper()))
        entry = entries_of(tracked)[name.upper()]
        known = talk.descriptions().get(entry.name)
        if to["as_json"]:
            whole = {"name": entry.name, "value": finite(entry), "type": entry.kind}
            talk.say(msgspec.json.encode(whole | {"description": known}).decode())
            return ExitCode.DONE
        talk.say(f"{entry.name} = {entry.text} ({entry.kind})")
        where = "https://ardupilot.org/copter/docs/parameters.html lists them"
        no_file = f"ArduPilot has no descriptions on board: {where}"
        none = no_file if talk.is_ardupilot else "the vehicle has no description of it"
        talk.say("\n".join(lines_of(known)) if known else none)
        return ExitCode.DONE

    click.get_current_context().exit(with_vehicle("param show", to, task))


for _command in (save, load, diff):
    param.add_command(_command)


def matching(entries: Mapping[str, Entry], pattern: str) -> dict[str, Entry]:
    """Those whose name matches, in the order of names; without a wildcard, those that have it."""
    wild = any(letter in pattern for letter in "*?[")
    pattern = pattern.upper() if wild else f"*{pattern.upper()}*"
    return {name: entries[name] for name in sorted(entries) if fnmatch.fnmatchcase(name, pattern)}


def finite(entry: Entry) -> int | float | None:
    """As JSON has it."""
    return entry.value if abs(entry.value) < float("inf") else None


def as_json(entries: Mapping[str, Entry]) -> str:
    rows = [
        {"name": each.name, "value": finite(each), "type": each.kind} for each in entries.values()
    ]
    return msgspec.json.encode(rows).decode()
