"""Whose turn it is to read a plan of the vehicle.

PX4 answers one reader at a time: a MISSION_REQUEST_LIST takes the transfer over from whoever had
begun one, whose questions are not answered any more (`mavlink_mission.cpp`, from memory).  So a
client's list is held back while the station's own transfer or another client's download is under
way; clients ask for it again by themselves.  The client in control does not wait for another one,
which could keep its turn by asking on and on.
"""

from __future__ import annotations

from typing import Final

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
READS: Final = (
    MissionRequestList,
    MissionRequestPartialList,
    MissionRequest,
    MissionRequestInt,
    MissionAck,
)


class Downloads:
    """Of one vehicle, by all clients."""

    def __init__(self) -> None:
        self._reader: tuple[int, Address] | None = None
        self._reader_in_control = False
        self._until_ns = 0

    def holds(
        self,
        message: Message,
        reader: tuple[int, Address],
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
        other = self._reader is not None and self._reader != reader and now_ns < self._until_ns
        if isinstance(message, MissionRequestList | MissionRequestPartialList):
            if station_busy:
                return "the station's own transfer of a plan is under way"
            if other and (self._reader_in_control or not in_control):
                return "another client reads a plan of the vehicle"
            self._reader, self._reader_in_control = reader, in_control
        if self._reader == reader:
            self._until_ns = now_ns + (0 if isinstance(message, MissionAck) else SILENT_NS)
        return ""
