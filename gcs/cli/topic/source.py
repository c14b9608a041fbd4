"""Where `gcs topic` and `gcs graph` look: a record, a running station, or a link itself."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import click

from gcs.cli import completers
from gcs.cli.options import UTF8, FiniteRange, Seconds
from gcs.cli.records.files import newest, told
from gcs.config import DEFAULT_LINK
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.mcap_file.format import Record
    from gcs.shell.stations import Description
    from gcs.topics.topic import Heard, Topic

LOOK_S = 0.1
"""How often the growing record of a station is looked at."""
REFRESH_S = 1.0
NOBODY_S = 3.0
"""Silence on a link for so long is told once."""

LOG = click.Option(
    ["--log", "log_file"],
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Look into this record instead of listening.",
    shell_complete=completers.files(".mcap"),
)
LAST = click.Option(["--last"], is_flag=True, help="Look into the newest record of logs/.")
LINK = click.Option(
    ["--link", "links"],
    multiple=True,
    type=UTF8,
    metavar="URL",
    help=f"Where to listen: the station that has this link open, or the link itself.  "
    f"[default: the running station; without one {DEFAULT_LINK}]",
)
SECONDS = click.Option(
    ["-t", "--time", "seconds"],
    type=Seconds(),
    metavar="S",
    help="End after so many seconds.",
)
FROM = click.Option(
    ["--from", "from_s"],
    type=FiniteRange(min=0),
    metavar="S",
    help="--log: from so many seconds after its first message.",
)
TO = click.Option(
    ["--to", "to_s"], type=FiniteRange(min=0), metavar="S", help="--log: until so many seconds."
)

Heards: TypeAlias = "Iterator[Heard | None]"
"""Messages as they come; None now and then while nothing comes."""


@dataclass(frozen=True, slots=True)
class Where:
    """What was asked for; `source` opens it."""

    log_file: Path | None
    last: bool
    links: tuple[str, ...]
    from_s: float | None = None
    to_s: float | None = None

    @property
    def recorded(self) -> bool:
        """A whole record is looked into, on its own clock."""
        return self.log_file is not None or self.last

    @property
    def path(self) -> Path:
        """Raises ExitError where there is no last record."""
        if self.log_file is not None:
            return self.log_file
        return newest()

    def heard(
        self, seconds: float | None = None, past: Callable[[Heard], None] | None = None
    ) -> Heards:
        """`past` is given what a running station recorded before.

        Raises UsageError, and ExitError for a bad file, no station, a link that cannot open.
        """
        if self.recorded:
            if self.links:
                raise click.UsageError("a record has no link: leave out --link, or --log")
            return within(recorded(self.path), self.from_s, self.to_s)
        if self.from_s is not None or self.to_s is not None:
            raise click.UsageError("--from and --to are for a record: name it with --log")
        return for_seconds(_live(self.links, past), seconds)


def records_of(path: Path) -> Iterator[Record]:
    """Every record of the file, which may have been killed, or of a log of another format.

    Raises ExitError.
    """
    from gcs.logfile.as_record import open_log

    with told(path):
        records = iter(open_log(path))
    while True:
        with told(path):
            record = next(records, None)
        if record is None:
            return
        yield record


def recorded(path: Path) -> Iterator[Heard]:
    """Every message of a finished record, or of one whose writer was killed."""
    from gcs.topics.recorded import RecordedTopics

    return RecordedTopics().heard(records_of(path))


def within(heards: Iterator[Heard], from_s: float | None, to_s: float | None) -> Iterator[Heard]:
    """Those of a time, counted from the first."""
    start_ns: int | None = None
    for heard in heards:
        if start_ns is None:
            start_ns = heard.time_ns
        t_s = (heard.time_ns - start_ns) / 1e9
        if to_s is not None and t_s > to_s:
            return
        if from_s is None or t_s >= from_s:
            yield heard


def for_seconds(heards: Heards, seconds: float | None) -> Heards:
    """End after so long, by the wall clock."""
    end_s = time.monotonic() + seconds if seconds is not None else None
    for heard in heards:
        if end_s is not None and time.monotonic() >= end_s:
            return
        yield heard


# --------------------------------------------------------------------------------- live


def _live(links: Sequence[str], past: Callable[[Heard], None] | None) -> Heards:
    from gcs.cli.running import station_for
    from gcs.cli.settings import usual_links

    meant = links or usual_links()
    found = station_for(meant, anywhere=not links)
    return _of_station(found, past) if found is not None else _of_links(meant)


def _of_station(described: Description, past: Callable[[Heard], None] | None) -> Heards:
    """What a running station records, from now on, at every rate that it is recorded at.

    A subscription over its socket is told at most ten times a second and MAVLink only; its record
    has everything, a second later at most, and costs the station nothing.
    """
    from gcs.mcap_file.reader import Following
    from gcs.topics.recorded import RecordedTopics

    path, joined = _record_of(described), False
    while True:
        with told(path):
            following = Following(path)
        topics = RecordedTopics()
        while not following.condition.closed:
            with told(path):
                fresh = [*topics.heard(following.new_records())]
            if joined:
                yield from fresh
            elif past is not None:
                for heard in fresh:
                    past(heard)
            joined = True
            yield None
            if not fresh:
                time.sleep(LOOK_S)
        later = _later_part(described.pid, path)
        if later is None:
            return
        path = later


def _record_of(described: Description) -> Path:
    if not described.log_path:
        raise ExitError(
            ExitCode.NO_VEHICLE,
            f"the station of process {described.pid} records nothing",
            "its record is what is looked at",
        )
    return Path(described.log_path)


def _later_part(pid: int, path: Path) -> Path | None:
    """Where the station went on recording; None if it has ended."""
    from gcs.operator.joined import running_stations

    for _ in range(round(2 * REFRESH_S / LOOK_S)):
        now = next((each for each in running_stations() if each.pid == pid), None)
        if now is None:
            return None
        if now.log_path and Path(now.log_path) != path:
            return Path(now.log_path)
        time.sleep(LOOK_S)
    return None


def _of_links(links: Sequence[str]) -> Heards:
    from gcs.shell.clock import Clock
    from gcs.shell.endpoints import EndpointError, parse_endpoint
    from gcs.shell.listener import Listener
    from gcs.shell.sockets.base import AddressInUse
    from gcs.topics.topic import Heard, live_topic

    try:
        endpoints = [parse_endpoint(link) for link in links]
    except EndpointError as error:
        raise ExitError(ExitCode.USAGE, str(error), error.hint) from error
    try:
        listener = Listener(endpoints, Clock())
    except AddressInUse as error:
        hint = "if it is a station of yours, gcs stations tells its links"
        raise ExitError(ExitCode.ADDRESS_IN_USE, str(error), hint) from error
    except OSError as error:
        text = f"{', '.join(links)}: {error.strerror or error}"
        raise ExitError(ExitCode.NO_VEHICLE, text) from error
    topics: dict[tuple[int, int, int], Topic] = {}
    started_s, heard_any = time.monotonic(), False
    with listener:
        while True:
            for time_ns, frame in listener.frames():
                heard_any = True
                key = (frame.sysid, frame.compid, frame.msgid)
                topic = topics.get(key)
                if topic is None:
                    topic = topics[key] = live_topic(frame)
                yield Heard(topic, time_ns, frame.raw)
            if not heard_any and time.monotonic() - started_s > NOBODY_S:
                heard_any = True
                click.echo(f"gcs: nothing is heard on {', '.join(links)} yet", err=True)
            yield None


def print_now(line: str) -> None:
    """A line that whoever reads the pipe has at once."""
    click.echo(line)
    sys.stdout.flush()
