"""Whose turn it is to read a plan of the vehicle.

PX4 answers one reader at a time: a MISSION_REQUEST_LIST takes the transfer over from whoever had
begun one, whose questions are not answered any more (`mavlink_mission.cpp`, from memory).  So a
client's list is held back while the station's own transfer or another client's download is under
way; clients ask for it again by themselves, and are served in the order in which they began to.
One that asks on and on keeps its turn for `TURN_NS` at the most where others wait, and the client
in control waits for none that is not.

A reader is known by link and address.  Two programs behind one link have addresses of their own;
two programs with one address have links of their own, and so has a client that comes back from
another port: it waits `SILENT_NS` for its own last question at the most, as nobody can tell it from
a second program with that address.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.protocol.effects import Address
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
    MissionRequestPartialList,
)

SILENT_NS: Final = 2_000_000_000
"""A reader that has asked for nothing for so long has finished, or given up."""
ASKS_ON_NS: Final = 3_000_000_000
"""Who was held back and has not asked again for so long does not wait any more."""
TURN_NS: Final = 60_000_000_000
"""So long may one read while others wait; 500 items over a poor link take about as long."""
PATIENCE_NS: Final = 1_500_000_000
"""MAVSDK asks four times, 0.5 s apart, and QGroundControl five times, 1 s apart (from memory):
after so long the next one is answered, so that its user is told."""
ANOTHER: Final = "another client reads a plan of the vehicle"
READS: Final = (
    MissionRequestList,
    MissionRequestPartialList,
    MissionRequest,
    MissionRequestInt,
    MissionAck,
)

Reader: TypeAlias = tuple[int, Address]
"""The link and the component that reads."""


@dataclass(frozen=True, slots=True)
class _Waits:
    """Since when, and when it asked last."""

    since_ns: int
    asked_ns: int


class Downloads:
    """Of one vehicle, by all clients."""

    def __init__(self) -> None:
        self._reader: Reader | None = None
        self._reader_in_control = False
        self._begun_ns = 0
        self._until_ns = 0
        self._waiting: dict[Reader, _Waits] = {}
        """Who was held back and asks on, in the order in which they began to."""

    def holds(
        self,
        message: Message,
        reader: Reader,
        station_busy: bool,
        now_ns: int,
        *,
        in_control: bool = False,
    ) -> str:
        """Why this message is not for the vehicle now; empty where it is.

        `reader` is the link and the component that it comes from, `in_control` whether that client
        is the one in control.
        """
        if not isinstance(message, READS):
            return ""
        if isinstance(message, MissionRequestList | MissionRequestPartialList):
            why = self._why_not_begin(reader, station_busy, now_ns, in_control)
            if why:
                since_ns = self._waiting[reader].since_ns if reader in self._waiting else now_ns
                self._waiting[reader] = _Waits(since_ns, now_ns)
                return why
            self._waiting.pop(reader, None)
            if self._reader != reader:
                self._begun_ns = now_ns
            self._reader, self._reader_in_control = reader, in_control
        if self._reader == reader:
            self._until_ns = now_ns + (0 if isinstance(message, MissionAck) else SILENT_NS)
            if isinstance(message, MissionAck):
                self._reader = None
        return ""

    def gone(self, link: int) -> None:
        """Nobody who was heard on that link is there any more; its number may be another's soon."""
        if self._reader is not None and self._reader[0] == link:
            self._reader = None
        self._waiting = {who: waits for who, waits in self._waiting.items() if who[0] != link}

    def answers(self, reader: Reader, now_ns: int) -> bool:
        """A reader that is held back has waited for so long that it is to be told no."""
        waits = self._waiting.get(reader)
        return waits is not None and now_ns - waits.since_ns >= PATIENCE_NS

    def _why_not_begin(
        self, reader: Reader, station_busy: bool, now_ns: int, in_control: bool
    ) -> str:
        self._waiting = {
            each: waits
            for each, waits in self._waiting.items()
            if now_ns - waits.asked_ns <= ASKS_ON_NS
        }
        if station_busy:
            return "the station's own transfer of a plan is under way"
        others = [each for each in self._waiting if each != reader]
        if self._reader is not None and now_ns < self._until_ns:
            long = now_ns - self._begun_ns >= TURN_NS
            if self._reader == reader and long and others and not in_control:
                self._reader = None
                self._waiting.pop(reader, None)  # to the end of the queue
                return ANOTHER
            if self._reader != reader and not long and (self._reader_in_control or not in_control):
                return ANOTHER
        if self._reader == reader or in_control or not others:
            return ""
        return "" if next(iter(self._waiting)) == reader else ANOTHER
