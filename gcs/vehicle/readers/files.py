"""Jobs about the vehicle's files, by MAVLink FTP: one is read, a folder is listed."""

from __future__ import annotations

from gcs import ipc
from gcs.bridge.setup_policy.operator_rules import why_not_read_file
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Heard, Send, Wake
from gcs.protocol.ftp import (
    ANSWER_NS,
    FileData,
    FileEnd,
    FileFailed,
    FileRead,
    FolderListed,
    FolderRead,
    FtpEffect,
)
from gcs.session.work import Work
from gcs.vehicle.readers.job import AN_EVENT, Asked, Job

AN_EVENT_BYTES = 16_384


class ReadVehicleFile(Job):
    """The bytes of a file from an offset on, in events of at most 16 kB."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        self._machine: FileRead | FolderRead = asked.file(asked.ask.path, asked.ask.offset)
        self._held = bytearray()
        self._offset = asked.ask.offset

    @property
    def deadline_ns(self) -> int | None:
        return self._machine.deadline_ns

    def start(self, now_ns: int) -> list[Work]:
        refusal = why_not_read_file(self.asked.policy.bridge, stands=self.asked.stands)
        if not self.asked.ask.path:
            refusal = Refusal(Code.BAD_PARAMETER, "which file?")
        if refusal is not None:
            return self.refuse(refusal)
        return [self.accept(), *self._follow(self._machine.start(now_ns))]

    def handle(self, event: Heard | Wake, now_ns: int) -> list[Work]:
        if isinstance(event, Wake) and not self.asked.stands:
            # Armed meanwhile: the link is the flight's.
            refusal = why_not_read_file(self.asked.policy.bridge, stands=False)
            if refusal is not None:
                return [*self.stopped(), *self.abort(refusal.code, refusal.sentence)]
        return self._follow(self._machine.handle(event, now_ns))

    def stopped(self) -> list[Work]:
        return [each for each in self._machine.stop() if isinstance(each, Send)]

    def _follow(self, effects: list[FtpEffect]) -> list[Work]:
        work: list[Work] = []
        for effect in effects:
            match effect:
                case Send():
                    work.append(effect)
                case FileData(data=data, size=size):
                    self._held += data
                    if len(self._held) >= AN_EVENT_BYTES:
                        work += self._given(size)
                        work.append(self.progress(self._offset, size, "bytes"))
                case FileEnd(size):
                    work += [*self._given(size), *self.complete(f"{size} bytes")]
                case FileFailed(error, text):
                    code = Code.NO_ANSWER if error is None else Code.VEHICLE_REFUSED
                    work += self.abort(code, f"{self.asked.ask.path}: {text}")
                case FolderListed(entries):
                    files = [ipc.FileInfo(each.name, each.size) for each in entries]
                    for at in range(0, len(files), AN_EVENT):
                        part = files[at : at + AN_EVENT]
                        work.append(self.tell(ipc.FilesEvent(self.asked.ask.id, part)))
                    work += self.complete(f"{len(files)} entries")
        return work

    def _given(self, size: int) -> list[Work]:
        """What was held back until there was enough for an event."""
        work: list[Work] = []
        for at in range(0, len(self._held), AN_EVENT_BYTES):
            data = bytes(self._held[at : at + AN_EVENT_BYTES])
            work.append(self.tell(ipc.FileDataEvent(self.asked.ask.id, self._offset, data, size)))
            self._offset += len(data)
        self._held.clear()
        return work


class ListVehicleFolder(ReadVehicleFile):
    """What a folder holds."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        answer_ns = asked.times.real_ns(ANSWER_NS)
        self._machine = FolderRead(asked.own, asked.target, asked.ask.path, answer_ns)
