"""A live view as a program: `python -m gcs.live.program '<Wanted as JSON>'`.

Prints one `Opened` as JSON, serves until the station ends, and needs nobody to wait for it.
"""

from __future__ import annotations

import os
import select
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec

import msgspec

from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from gcs.operator.joined import running_stations
from gcs.shell.pipes import LineSource
from gcs.shell.stations import Description

COMMAND = (sys.executable, "-m", "gcs.live.program")
OPEN_WAIT_S = 60.0
"""A busy machine takes seconds to start a process; one that has ended is told at once."""
STATION_WAIT_S = 30.0
LOOK_AGAIN_S = 0.1


class Wanted(msgspec.Struct, frozen=True):
    """`pid` of the station; `port` 0: the first usual one that is free; `allow`: `Admission`."""

    pid: int
    host: str
    port: int
    allow: list[str] = []


class Opened(msgspec.Struct, frozen=True):
    """Where viewers connect, what lets them take control and where the layout is; or why there is
    no live view."""

    url: str = ""
    code: str = ""
    layout: str = ""
    error: str = ""
    hint: str = ""
    exit_code: int = 0


def opened_by(wanted: Wanted, station_runs: Callable[[], bool] = lambda: True) -> Opened | None:
    """Start the program and wait until it listens.

    None if the station has ended meanwhile: it says itself why.  Raises ExitError if the live view
    cannot be opened.
    """
    process = subprocess.Popen(
        [*COMMAND, msgspec.json.encode(wanted).decode()],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    assert process.stdout is not None
    deadline_s = time.monotonic() + OPEN_WAIT_S
    lines: list[bytes] = []
    with process.stdout as stdout:
        source = LineSource(stdout.fileno())
        while not (lines or source.ended) and station_runs() and time.monotonic() < deadline_s:
            if select.select([source], [], [], LOOK_AGAIN_S)[0]:
                lines += source.read()
        source.close()
    process.returncode = 0  # it ends with the station, and nobody is to wait for it
    if not (lines or station_runs()):
        return None
    try:
        opened = msgspec.json.decode(b"".join(lines), type=Opened)
    except msgspec.DecodeError:
        raise ExitError(ExitCode.BUG, "the live view did not start") from None
    if opened.error:
        raise ExitError(opened.exit_code, opened.error, opened.hint)
    return opened


def check_installed() -> None:
    """Raises ExitError where the server's library is missing."""
    if find_spec("websockets") is None:
        raise ExitError(
            ExitCode.USAGE,
            "a live view needs websockets, which is not installed here",
            "pip install websockets",
        )


def _the_station(pid: int) -> Description:
    deadline_s = time.monotonic() + STATION_WAIT_S
    while time.monotonic() < deadline_s:
        for each in running_stations():
            if each.pid == pid:
                return each
        time.sleep(LOOK_AGAIN_S)
    raise ExitError(
        ExitCode.NO_VEHICLE, f"the station of process {pid} cannot be reached by other programs"
    )


def main(argument: str) -> int:
    wanted = msgspec.json.decode(argument, type=Wanted)
    try:
        check_installed()
        from gcs.live.view import Address, open_view

        address = Address(wanted.host, wanted.port, frozenset(wanted.allow))
        view = open_view(_the_station(wanted.pid), address)
    except ExitError as error:
        _tell(Opened(error=str(error), hint=error.hint, exit_code=error.exit_code))
        return error.exit_code
    _tell(Opened(view.url, view.code, view.layout.path))
    try:
        view.run()
    finally:
        view.close()
    return 0


def _tell(opened: Opened) -> None:
    """Once; then nobody reads what is printed here."""
    sys.stdout.buffer.write(msgspec.json.encode(opened) + b"\n")
    sys.stdout.buffer.flush()
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, sys.stdout.fileno())
    os.close(null)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
