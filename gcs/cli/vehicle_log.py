"""`gcs vehicle-log`: the flight logs that a vehicle keeps, listed and fetched."""

from __future__ import annotations

import os
import zlib
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final, Unpack

import click
import msgspec

from gcs.cli.common_options import MeetsVehicle, ToVehicle
from gcs.cli.mission.live import LINK_OPTIONS
from gcs.cli.options import with_options
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs import ipc
    from gcs.cli.param.talk import Talk

EXITS = (
    "Exit codes: 0 done, 1 there are none, 2 usage or no such log, 3 no vehicle, 4 bad file, 5 "
    "refused by the vehicle, 6 refused by the policy, 8 not completed, 130 interrupted."
)
FOLDERS: Final = {
    "ardupilot": ("/APM/LOGS", "/logs", "logs"),
    "px4": ("/fs/microsd/log", "/log"),
}
"""Where the autopilots keep them: on a board, and in their simulations."""
SUFFIXES: Final = {"ardupilot": ".BIN", "px4": ".ulg"}


@click.group("vehicle-log")
def vehicle_log() -> None:
    """Flight logs that the vehicle keeps, on the ground: list and get them."""


@vehicle_log.command("list", cls=MeetsVehicle, epilog=f"Example: gcs vehicle-log list\n\n{EXITS}")
@with_options(*LINK_OPTIONS)
def list_(**to: Unpack[ToVehicle]) -> None:
    """List the logs: number, bytes, when each was last written to (UTC)."""
    from gcs.cli.param.talk import with_vehicle

    def task(talk: Talk) -> ExitCode:
        logs = _logs(talk)
        if to["as_json"]:
            talk.say(msgspec.json.encode(logs).decode())
        else:
            lines = [f"{each.number:>5} {each.size:>12}  {_written(each)}" for each in logs]
            talk.say("\n".join(lines) or "no logs", err=not logs)
        return ExitCode.DONE if logs else ExitCode.DIFFERENT

    click.get_current_context().exit(with_vehicle("vehicle-log list", to, task))


@vehicle_log.command(
    cls=MeetsVehicle, epilog=f"Example: gcs vehicle-log get latest --import flight.mcap\n\n{EXITS}"
)
@click.argument("which", metavar="NUMBER|latest")
@click.option("-o", "--output", help="The new file.  [default: vehicle_log_NUMBER.ulg or .BIN]")
@click.option("--force", is_flag=True, help="Write over a file that exists.")
@click.option(
    "--by",
    type=click.Choice(["auto", "ftp", "messages"]),
    default="auto",
    show_default=True,
    help="MAVLink FTP, which is checked by a check sum, or the log protocol.",
)
@click.option("--import", "record", metavar="FILE", help="Make a record of it, too (.mcap).")
@with_options(*LINK_OPTIONS)
def get(
    which: str,
    output: str | None,
    force: bool,
    by: str,
    record: str | None,
    **to: Unpack[ToVehicle],
) -> None:
    """Fetch a log.  What is broken off goes on where it was: the part is kept beside it (.part)."""
    from gcs.cli.param.talk import NotDone, failure, with_vehicle

    if which != "latest" and not which.isdecimal():
        raise ExitError(ExitCode.USAGE, f"{which!r}: expected a number of the list, or latest")
    for new in filter(None, (output, record)):
        if Path(new).exists() and not force:
            raise ExitError(ExitCode.USAGE, f"{new}: exists already", "--force writes over it")
    fetched: list[Path] = []

    def task(talk: Talk) -> ExitCode:
        from gcs import ipc

        log = _chosen(_logs(talk), which)
        path = _on_board(talk, log) if by != "messages" else ""
        if by == "ftp" and not path:
            talk.say("the vehicle's log folder is not found by FTP: --by messages", err=True)
            raise NotDone(ExitCode.NOT_COMPLETED)
        kind = "ardupilot" if talk.is_ardupilot else "px4"
        target = Path(output or f"vehicle_log_{log.number}{SUFFIXES[kind]}")
        if target.exists() and not force:
            raise ExitError(ExitCode.USAGE, f"{target}: exists already", "--force writes over it")
        part = target.with_name(f"{target.name}.part")
        begun = part.stat().st_size if part.exists() else 0
        if begun > log.size:
            begun = 0
        word = "file_read" if path else "log_read"
        ask = ipc.Ask(0, word, path=path, item=log.number, offset=begun)
        with part.open("ab") as file:
            file.truncate(begun)
            tracked = talk.pour(ask, lambda event: _append(file.fileno(), event))
        if not tracked.completed:
            talk.say(failure(tracked), err=True)
            talk.say(f"the part is {part}: the same command goes on with it", err=True)
            raise NotDone(tracked.exit_code or ExitCode.NOT_COMPLETED)
        checked = _check(talk, part, path, log.size)
        os.replace(part, target)
        fetched.append(target)
        size = target.stat().st_size
        went_on = f", of which {begun} were there" if begun else ""
        said = {"path": str(target), "number": log.number, "bytes": size, "checked": checked}
        text = f"{target}: {size} bytes{went_on}, {checked}"
        talk.say(msgspec.json.encode(said).decode() if to["as_json"] else text)
        return ExitCode.DONE

    context = click.get_current_context()
    code = with_vehicle("vehicle-log get", to, task)
    if record and fetched and not code:
        from gcs.cli.log.import_export import import_log

        context.invoke(import_log, file=fetched[0], output=Path(record), as_json=to["as_json"])
    context.exit(code)


def _logs(talk: Talk) -> list[ipc.LogInfo]:
    """All that the vehicle lists.  Raises NotDone."""
    from gcs import ipc

    tracked = talk.done(ipc.Ask(0, "log_list"))
    events = [each for each in tracked.found if isinstance(each, ipc.LogsEvent)]
    return [each for event in events for each in event.logs]


def _chosen(logs: list[ipc.LogInfo], which: str) -> ipc.LogInfo:
    if not logs:
        raise ExitError(ExitCode.DIFFERENT, "the vehicle keeps no logs")
    if which == "latest":  # PX4's numbers are in no order
        return max(logs, key=lambda each: (each.time_utc_s, each.number))
    found = next((each for each in logs if each.number == int(which)), None)
    if found is None:
        numbers = f"{logs[0].number} to {logs[-1].number}"
        raise ExitError(ExitCode.USAGE, f"there is no log {which}", f"the list has {numbers}")
    return found


def _on_board(talk: Talk, log: ipc.LogInfo) -> str:
    """The file of a log, by its number (ArduPilot's names), else by its size; empty where no file
    or more than one is it."""
    kind = "ardupilot" if talk.is_ardupilot else "px4"
    for folder in FOLDERS[kind]:
        entries = talk.folder(folder)
        if kind == "px4":
            inside = [f"{folder}/{each.name}" for each in entries if each.size is None]
            files = [(f"{day}/{each.name}", each) for day in inside for each in talk.folder(day)]
        else:
            files = [(f"{folder}/{each.name}", each) for each in entries]
        suffix = SUFFIXES[kind].lower()
        logs = [(path, e) for path, e in files if path.lower().endswith(suffix)]
        by_number = [path for path, e in logs if e.name.split(".")[0] == f"{log.number:08d}"]
        by_size = [path for path, e in logs if e.size == log.size]
        found = by_number if kind == "ardupilot" else by_size
        if len(found) == 1:
            return found[0]
    return ""


def _append(descriptor: int, event: ipc.FileDataEvent) -> None:
    os.write(descriptor, event.data)


def _check(talk: Talk, part: Path, path: str, size: int) -> str:
    """What was checked.  Raises NotDone where it is not the vehicle's file."""
    from gcs import ipc
    from gcs.cli.param.talk import NotDone

    have = part.stat().st_size
    if have > size:
        return f"not checked: it is still being written ({size} bytes were listed)"
    if path:
        tracked = talk.ask(ipc.Ask(0, "file_crc", path=path))
        told = [each.files[0].crc for each in tracked.found if isinstance(each, ipc.FilesEvent)]
        if told and told[0] is not None:
            if told[0] == _crc(part):
                return "its check sum is the vehicle's"
            part.unlink()
            text = f"{part}: its check sum is not the vehicle's: it was removed, fetch it anew"
            talk.say(text, err=True)
            raise NotDone(ExitCode.NOT_COMPLETED)
    if have < size:
        talk.say(f"{part}: {have} bytes of {size}", err=True)
        raise NotDone(ExitCode.NOT_COMPLETED)
    return "its size is the vehicle's"


def _crc(path: Path) -> int:
    """CRC-32 as MAVLink FTP has it: from zero, not inverted."""
    crc = 0xFFFFFFFF
    with path.open("rb") as file:
        while data := file.read(1 << 20):
            crc = zlib.crc32(data, crc)
    return crc ^ 0xFFFFFFFF


def _written(log: ipc.LogInfo) -> str:
    if not log.time_utc_s:
        return "-"
    return datetime.fromtimestamp(log.time_utc_s, UTC).strftime("%Y-%m-%d %H:%M:%S")
