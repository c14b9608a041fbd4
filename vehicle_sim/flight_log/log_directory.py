"""Where the logs of a vehicle lie in its store, how they are named, and how many there may be.

px4: `/fs/microsd/log/<date>/<time>.ulg`, in UTC; ardupilot: `/APM/LOGS/<number>.BIN`.
"""

from __future__ import annotations

import re
from contextlib import suppress
from typing import Final, NamedTuple

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.storage.store import Store, StoreError, StoreFault, parts_of, put

LOG_BYTES_MAX: Final = 8 * 1024 * 1024
"""A log that grows to this size is closed, and another begun: about 20 minutes of flight."""
ALL_BYTES_MAX: Final = 32 * 1024 * 1024
LOGS_MAX: Final = 40

ROOTS: Final[dict[Personality, str]] = {"px4": "/fs/microsd/log", "ardupilot": "/APM/LOGS"}
SUFFIXES: Final[dict[Personality, str]] = {"px4": ".ulg", "ardupilot": ".BIN"}
NUMBERED: Final[dict[Personality, bool]] = {"px4": False, "ardupilot": True}
"""Named by a number, all in one directory; else by the time, in a directory for each day."""
LAST_LOG: Final = "LASTLOG.TXT"  # where ArduPilot keeps the number of its last log

DAY_S: Final = 86_400
NAMED: Final = re.compile(r"/(\d{4})-(\d\d)-(\d\d)/(\d\d)_(\d\d)_(\d\d)")


class LogFile(NamedTuple):
    path: str
    size: int  # bytes
    time_utc_s: int  # of the last write; of an earlier run, what its name says; 0 = not known


class LogDirectory:
    """The logs of one vehicle.  Methods raise `StoreError` where the store does."""

    def __init__(self, store: Store, personality: Personality) -> None:
        self._store = store
        self._numbered: Final = NUMBERED[personality]
        self._root: Final = ROOTS[personality]
        self._suffix: Final = SUFFIXES[personality]
        self._written_s: dict[str, int] = {}
        self._make_root()

    def logs(self) -> tuple[LogFile, ...]:
        """Oldest first."""
        return tuple(
            LogFile(path, size, self._written_s.get(path) or named_s(path))
            for path, size in self._files()
        )

    def begin(self, unix_s: int) -> str:
        """Make room for a log and open it; its path."""
        self._make_room(LOG_BYTES_MAX)
        path = self._new_path(unix_s)
        put(self._store, path, b"")
        return path

    def append(self, path: str, data: bytes, unix_s: int) -> None:
        """A full store is relieved of its oldest logs."""
        while True:
            try:
                self._store.write(path, self._store.size(path), data)
            except StoreError as error:
                oldest = self.logs()[:1]
                if error.fault is not StoreFault.NO_SPACE or not oldest or oldest[0].path == path:
                    raise
                self.remove(oldest[0].path)
            else:
                self._written_s[path] = unix_s
                return

    def read(self, path: str, offset: int, count: int) -> bytes:
        return self._store.read(path, offset, count)

    def remove(self, path: str) -> None:
        self._store.remove(path)
        self._written_s.pop(path, None)
        directory = path.rpartition("/")[0]
        if directory != self._root and not self._store.entries(directory):
            self._store.remove_directory(directory)

    def _make_root(self) -> None:
        """Clients list it before the first log, and a card that autopilots wrote to has it."""
        path = ""
        for part in parts_of(self._root):
            path = f"{path}/{part}"
            with suppress(StoreError):  # it is there, or the disk is not ours to write to
                self._store.make_directory(path)

    def _make_room(self, wanted: int) -> None:
        logs = list(self.logs())
        while logs and (
            len(logs) >= LOGS_MAX or sum(log.size for log in logs) + wanted > ALL_BYTES_MAX
        ):
            self.remove(logs.pop(0).path)

    def _files(self) -> list[tuple[str, int]]:
        """Paths and sizes, by name, which is by age."""
        found: list[tuple[str, int]] = []
        try:
            directories = [self._root]
            if not self._numbered:
                directories = [
                    f"{self._root}/{entry.name}"
                    for entry in self._store.entries(self._root)
                    if entry.is_directory
                ]
            for directory in directories:
                found += [
                    (f"{directory}/{entry.name}", entry.size)
                    for entry in self._store.entries(directory)
                    if not entry.is_directory and entry.name.endswith(self._suffix)
                ]
        except StoreError as error:
            if error.fault is not StoreFault.NOT_FOUND:
                raise
        return found

    def _new_path(self, unix_s: int) -> str:
        taken = {path for path, _ in self._files()}
        if self._numbered:
            number = 1 + max((_number(path) for path in taken), default=0)
            put(self._store, f"{self._root}/{LAST_LOG}", f"{number}\r\n".encode("ascii"))
            return f"{self._root}/{number:08d}{self._suffix}"
        date, of_day_s = civil_date(unix_s // DAY_S), unix_s % DAY_S
        clock = f"{of_day_s // 3600:02d}_{of_day_s // 60 % 60:02d}_{of_day_s % 60:02d}"
        stem = f"{self._root}/{date[0]:04d}-{date[1]:02d}-{date[2]:02d}/{clock}"
        path, again = f"{stem}{self._suffix}", 0
        while path in taken:
            again += 1
            path = f"{stem}_{again}{self._suffix}"
        return path


def _number(path: str) -> int:
    """Of ArduPilot's file; 0 for one that somebody else named."""
    stem = parts_of(path)[-1].partition(".")[0]
    return int(stem) if stem.isdecimal() else 0


def civil_date(days: int) -> tuple[int, int, int]:
    """Year, month, day of a count of days since 1970-01-01.

    Reckoned in years that begin in March, so that the leap day is the last of a year.
    """
    since_0000 = days + 719_468
    era, of_era = divmod(since_0000, 146_097)
    year = (of_era - of_era // 1460 + of_era // 36_524 - of_era // 146_096) // 365
    of_year = of_era - (365 * year + year // 4 - year // 100)
    month = (5 * of_year + 2) // 153
    day = of_year - (153 * month + 2) // 5 + 1
    month += 3 if month < 10 else -9
    return (year + era * 400 + (1 if month <= 2 else 0), month, day)


def unix_days(year: int, month: int, day: int) -> int:
    """The inverse of `civil_date`."""
    year -= 1 if month <= 2 else 0
    of_year = (153 * ((month + 9) % 12) + 2) // 5 + day - 1
    return year * 365 + year // 4 - year // 100 + year // 400 + of_year - 719_468


def named_s(path: str) -> int:
    """Unix time in the name of a px4 log; 0 if there is none."""
    found = NAMED.search(path)
    if found is None:
        return 0
    year, month, day, hour, minute, second = map(int, found.groups())
    return unix_days(year, month, day) * DAY_S + hour * 3600 + minute * 60 + second
