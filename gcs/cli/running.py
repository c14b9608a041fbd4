"""Which running station a command goes through, if there is one."""

from __future__ import annotations

from collections.abc import Sequence

from gcs.cli.settings import usual_links
from gcs.config import Wanted
from gcs.exit_codes import ExitCode
from gcs.operator.differences import differences, hint, sentence
from gcs.operator.errors import ExitError
from gcs.operator.joined import (
    JoinedStation,
    running_stations,
    station_on,
    why_no_station_is_found,
)
from gcs.shell.stations import Description

HINT = "gcs stations lists them; name one by its link with --link"


def station_for(links: Sequence[str], *, anywhere: bool = False) -> Description | None:
    """The running station that has one of `links` open.

    `anywhere`: if none has, the only one that runs will do, whatever its link is.  Raises
    ExitError if there are several then.
    """
    found = station_on(links)
    if found is not None or not anywhere:
        return found
    everywhere = running_stations()
    if len(everywhere) > 1:
        text = "; ".join(described_shortly(each) for each in everywhere)
        raise ExitError(ExitCode.USAGE, f"{len(everywhere)} stations are running: {text}", HINT)
    return everywhere[0] if everywhere else None


def others_running(links: Sequence[str]) -> list[str]:
    """What to say to somebody who has named no link, where stations run on other ones, or may run
    and not be found."""
    if list(links) != usual_links():
        return []
    unsafe = why_no_station_is_found()
    if unsafe:
        return [
            f"a station that runs may not be found: {unsafe}; remove it, or set XDG_RUNTIME_DIR"
        ]
    return [
        f"a station runs: process {described_shortly(each)}; to go through it, name its link: "
        f"--link {each.endpoints[0]}"
        for each in running_stations()
        if each.endpoints
    ]


def the_station(links: Sequence[str]) -> Description:
    """The same for a command that needs one; without a link the default one's, or the only one.

    Raises ExitError with NO_VEHICLE if none runs."""
    found = station_for(links or usual_links(), anywhere=not links)
    if found is None:
        where = f" on {', '.join(links)}" if links else ""
        hint = "start one with gcs fly; gcs stations lists those that run"
        raise ExitError(ExitCode.NO_VEHICLE, f"no station is running{where}", hint)
    return found


def refuse_differences(found: Description, wanted: Wanted) -> None:
    """Raises ExitError if the station is not as was asked for, or a policy cannot be read."""
    try:
        different = differences(found, wanted)
    except OSError as error:
        raise ExitError(ExitCode.BAD_FILE, f"{wanted.policy}: {error.strerror}") from error
    if different:
        how = hint(found, different, "--")
        raise ExitError(ExitCode.USAGE, sentence(found, different), how)


def joined_station(
    described: Description, what: str, *, hold_on_leave: bool = True
) -> JoinedStation:
    """Join it.  Raises ExitError if it takes no connection."""
    try:
        return JoinedStation.join(described, what, hold_on_leave=hold_on_leave)
    except OSError as error:
        text = f"the station of process {described.pid} takes no connection: {error}"
        raise ExitError(ExitCode.NO_VEHICLE, text, HINT) from error


def described_shortly(described: Description) -> str:
    """Process, vehicle and links."""
    vehicle = described.vehicle or "no vehicle yet"
    return f"{described.pid} ({vehicle}) on {', '.join(described.endpoints)}"
