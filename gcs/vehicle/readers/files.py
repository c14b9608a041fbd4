"""Jobs about the vehicle's files and logs: by MAVLink FTP one is read or summed up, a folder is
listed; by the log protocol logs are listed, and one is read.
"""

from __future__ import annotations

from collections.abc import Sequence

from gcs import ipc
from gcs.bridge.setup_policy.operator_rules import why_not_read_file
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Heard, Send, Wake
from gcs.protocol.transfers.ftp import (
    ANSWER_NS,
    FileCrc,
    FileCrcTold,
    FileData,
    FileEnd,
    FileFailed,
    FileRead,
    FolderListed,
    FolderRead,
    FtpEffect,
)
from gcs.protocol.transfers.vehicle_log import (
    QUIET_NS,
    LogBytes,
    LogEffect,
    LogEnd,
    LogFailed,
    LogList,
    LogRead,
    LogsListed,
)
from gcs.session.work import Work
from gcs.vehicle.readers.job import AN_EVENT, Asked, Job
from gcs.wire.messages import LogEntry

AN_EVENT_BYTES = 16_384


class FileJob(Job):
    """One machine after another; bytes are told in events of at most 16 kB."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        self._machine = self.machine()
        self._held = bytearray()
        self._offset = asked.ask.offset

    def machine(self) -> FileRead | FolderRead | FileCrc | LogList | LogRead:
        """What is done first."""
        return self.asked.file(self.asked.ask.path, self.asked.ask.offset)

    @property
    def wanted(self) -> str:
        """What it is about, empty where that was not said."""
        return self.asked.ask.path

    @property
    def deadline_ns(self) -> int | None:
        return self._machine.deadline_ns

    def start(self, now_ns: int) -> list[Work]:
        refusal = why_not_read_file(self.asked.policy.bridge, stands=self.asked.stands)
        if not self.wanted:
            refusal = Refusal(Code.BAD_PARAMETER, "which file?")
        if refusal is not None:
            return self.refuse(refusal)
        return [self.accept(), *self._follow(self._machine.start(now_ns), now_ns)]

    def handle(self, event: Heard | Wake, now_ns: int) -> list[Work]:
        if not self.asked.stands:
            # Armed meanwhile: the link is the flight's.
            refusal = why_not_read_file(self.asked.policy.bridge, stands=False)
            if refusal is not None:
                return [*self.stopped(), *self.abort(refusal.code, refusal.sentence)]
        return self._follow(self._machine.handle(event, now_ns), now_ns)

    def stopped(self) -> list[Work]:
        return [each for each in self._machine.stop() if isinstance(each, Send)]

    def _follow(self, effects: Sequence[FtpEffect | LogEffect], now_ns: int) -> list[Work]:
        work: list[Work] = []
        for effect in effects:
            match effect:
                case Send():
                    work.append(effect)
                case FileData(data=data, size=size):
                    work += self._read(data, size)
                case LogBytes(data=data):
                    work += self._read(data, self.size)
                case FileEnd(size) | LogEnd(size):
                    work += [*self._given(size), *self.complete(f"{size} bytes")]
                case FileFailed(error, text):
                    code = Code.NO_ANSWER if error is None else Code.VEHICLE_REFUSED
                    work += self.abort(code, f"{self.asked.ask.path}: {text}")
                case LogFailed(text):
                    work += self.abort(Code.NO_ANSWER, text)
                case FolderListed(entries):
                    work += self._listed([ipc.FileInfo(each.name, each.size) for each in entries])
                case FileCrcTold(crc):
                    work += self._listed([ipc.FileInfo(self.asked.ask.path, None, crc)])
                case LogsListed(logs):
                    work += self.logs_known(logs, now_ns)
        return work

    @property
    def size(self) -> int:
        """Of the log that is read."""
        return 0

    def logs_known(self, logs: tuple[LogEntry, ...], now_ns: int) -> list[Work]:
        """Which logs the vehicle keeps."""
        infos = [ipc.LogInfo(each.id, each.size, each.time_utc) for each in logs]
        parts = [infos[at : at + AN_EVENT] for at in range(0, len(infos), AN_EVENT)]
        told = [self.tell(ipc.LogsEvent(self.asked.ask.id, part)) for part in parts]
        return [*told, *self.complete(f"{len(logs)} logs")]

    def _listed(self, files: list[ipc.FileInfo]) -> list[Work]:
        parts = [files[at : at + AN_EVENT] for at in range(0, len(files), AN_EVENT)]
        told = [self.tell(ipc.FilesEvent(self.asked.ask.id, part)) for part in parts]
        return [*told, *self.complete(f"{len(files)} entries")]

    def _read(self, data: bytes, size: int) -> list[Work]:
        self._held += data
        if len(self._held) < AN_EVENT_BYTES:
            return []
        return [*self._given(size), self.progress(self._offset, size, "bytes")]

    def _given(self, size: int) -> list[Work]:
        """What was held back until there was enough for an event."""
        work: list[Work] = []
        for at in range(0, len(self._held), AN_EVENT_BYTES):
            data = bytes(self._held[at : at + AN_EVENT_BYTES])
            work.append(self.tell(ipc.FileDataEvent(self.asked.ask.id, self._offset, data, size)))
            self._offset += len(data)
        self._held.clear()
        return work


class ListFolder(FileJob):
    """What a folder holds."""

    def machine(self) -> FolderRead:
        asked = self.asked
        return FolderRead(asked.own, asked.target, asked.ask.path, asked.times.real_ns(ANSWER_NS))


class SumUpFile(FileJob):
    """The check sum of a file."""

    def machine(self) -> FileCrc:
        asked = self.asked
        return FileCrc(asked.own, asked.target, asked.ask.path, asked.times.real_ns(ANSWER_NS))


class ListLogs(FileJob):
    """Which logs there are, by the log protocol."""

    def machine(self) -> LogList:
        return LogList(self.asked.target, self.asked.times.real_ns(QUIET_NS))

    @property
    def wanted(self) -> str:
        return "logs"


class ReadLog(ListLogs):
    """The bytes of a log from an offset on, by the log protocol: its size is in the list."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        self._size = 0

    @property
    def size(self) -> int:
        return self._size

    def logs_known(self, logs: tuple[LogEntry, ...], now_ns: int) -> list[Work]:
        asked = self.asked
        entry = next((each for each in logs if each.id == asked.ask.item), None)
        if entry is None:
            numbers = ", ".join(str(each.id) for each in logs) or "none"
            text = f"there is no log {asked.ask.item} on the vehicle; there are: {numbers}"
            return self.abort(Code.BAD_PARAMETER, text)
        self._size, quiet_ns = entry.size, asked.times.real_ns(QUIET_NS)
        self._machine = LogRead(asked.target, entry.id, entry.size, asked.ask.offset, quiet_ns)
        return self._follow(self._machine.start(now_ns), now_ns)
