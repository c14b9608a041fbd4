"""MAVLink FTP as a client: a file is read in bursts, and what was lost is asked for again.

https://mavlink.io/en/services/ftp.html.  The payload: seq (2 bytes), session, opcode, size,
req_opcode, burst_complete, padding, offset (4 bytes), data (up to 239).

A file is over where a read says so (EOF), not where its size has been reached: ArduPilot gives a
size that is too large for what it makes up while it is read (`@PARAM/param.pck`).
"""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.transfers.byte_pieces import Pieces
from gcs.wire.ids import FtpError, FtpOpcode
from gcs.wire.messages import FileTransferProtocol

DATA_BYTES: Final = 239
_HEADER: Final = struct.Struct("<HBBBBBxI")
_PAYLOAD: Final = 251

ANSWER_NS: Final = 500_000_000
"""Without an answer for so long, what was asked for is asked for again."""
WAITS: Final = 12
"""For so many such waits nothing at all may come.  At 20 % loss either way, where one piece is
asked for at a time, one in 200,000 comes to that."""
OPEN_WAITS: Final = 4
"""The same of the first question: a vehicle without FTP does not answer at all."""
CRC_WAITS: Final = 60
"""So many such waits a vehicle has for the check sum of a file; it is asked again each few."""
CRC_AGAIN_WAITS: Final = 6
AT_ONCE: Final = 4
"""Missing pieces that are asked for together; ArduPilot queues five requests."""
APART: Final = 251
"""What sequence numbers jump by: both autopilots repeat their last answer to the number before it,
and a burst counts its packets."""


@dataclass(frozen=True, slots=True)
class FileData:
    """The next bytes of a file, in order; `size` is what the vehicle says of all of it."""

    offset: int
    data: bytes
    size: int


@dataclass(frozen=True, slots=True)
class FileEnd:
    """All of it was given out."""

    size: int


@dataclass(frozen=True, slots=True)
class FileFailed:
    """`error`: the vehicle's own (FtpError), None where it did not answer."""

    error: int | None
    text: str


@dataclass(frozen=True, slots=True)
class FileEntry:
    """What a folder of the vehicle holds; `size` in bytes, None for a folder."""

    name: str
    size: int | None


@dataclass(frozen=True, slots=True)
class FolderListed:
    entries: tuple[FileEntry, ...]


@dataclass(frozen=True, slots=True)
class FileCrcTold:
    """CRC-32 of a whole file, of the polynomial 0xEDB88320 from zero, not inverted."""

    crc: int


FtpEffect: TypeAlias = Send | FileData | FileEnd | FileFailed | FolderListed | FileCrcTold


@dataclass(frozen=True, slots=True)
class _Reply:
    seq: int
    session: int
    opcode: int
    asked: int
    last_of_burst: bool
    offset: int
    data: bytes

    @property
    def error(self) -> int:
        """Of a negative answer."""
        return self.data[0] if self.data else int(FtpError.FAIL)


class _Client:
    """Sequence numbers and addresses of one talk."""

    def __init__(self, own: Address, target: Address, answer_ns: int) -> None:
        self._own = own
        self._target = target
        self.answer_ns = answer_ns
        self._seq = 0

    def begin(self, now_ns: int) -> None:
        """A talk of its own: with the numbers of the one before, a PX4 would repeat its answer."""
        self._seq = now_ns // 1_000_000 % 0x10000

    def send(
        self,
        opcode: FtpOpcode,
        *,
        session: int = 0,
        offset: int = 0,
        size: int = 0,
        data: bytes = b"",
        again: bool = False,
    ) -> Send:
        """`again`: with the number that it had, so that nothing is done twice."""
        if not again:
            self._seq = (self._seq + APART) % 0x10000
        head = _HEADER.pack(self._seq, session, opcode, size or len(data), 0, 0, offset)
        payload = (head + data).ljust(_PAYLOAD, b"\0")
        return Send(
            FileTransferProtocol(0, self._target.sysid, self._target.compid, tuple(payload))
        )

    def reply(self, heard: Heard) -> _Reply | None:
        """An answer to this client, from its vehicle."""
        message = heard.message
        if not isinstance(message, FileTransferProtocol):
            return None
        if not self._target.includes(heard.sysid, heard.compid):
            return None
        if not Address(message.target_system, message.target_component).includes(
            self._own.sysid, self._own.compid
        ):
            return None
        raw = bytes(message.payload)
        seq, session, opcode, size, asked, last, offset = _HEADER.unpack_from(raw)
        if opcode not in (FtpOpcode.ACK, FtpOpcode.NAK):
            return None
        data = raw[_HEADER.size : _HEADER.size + min(size, DATA_BYTES)]
        return _Reply(seq, session, opcode, asked, bool(last), offset, data)


class FileRead:
    """Reads a file from `start` on: OPENING, then bursts, and what they left out, until EOF."""

    def __init__(
        self,
        own: Address,
        target: Address,
        path: str,
        start: int = 0,
        answer_ns: int = ANSWER_NS,
    ) -> None:
        self._client = _Client(own, target, answer_ns)
        self._path = path.encode()
        self._session: int | None = None
        self._pieces = Pieces(start, DATA_BYTES)
        self._asked: dict[int, int] = {}
        """When each piece that is missing was asked for, by its offset."""
        self._probes = False
        """Whether there is more is asked at the present end."""
        self._heard_ns = 0
        """When it was asked first, or answered last."""
        self._reset = False
        self.size = 0
        """As the vehicle has told it when the file was opened."""
        self.deadline_ns: int | None = None
        self.done = False

    def start(self, now_ns: int) -> list[FtpEffect]:
        self._client.begin(now_ns)
        self._heard_ns = now_ns
        self.deadline_ns = now_ns + self._client.answer_ns
        return [self._client.send(FtpOpcode.OPENFILERO, data=self._path)]

    def stop(self) -> list[FtpEffect]:
        """It is not wanted any more."""
        self.done, self.deadline_ns = True, None
        if self._session is None:
            return []
        return [self._client.send(FtpOpcode.TERMINATESESSION, session=self._session)]

    def handle(self, event: Heard | Wake, now_ns: int) -> list[FtpEffect]:
        if self.done:
            return []
        if isinstance(event, Wake):
            due = self.deadline_ns is not None and now_ns >= self.deadline_ns
            return self._silent(now_ns) if due else []
        reply = self._client.reply(event)
        if reply is None:
            return []
        self._heard_ns = now_ns
        if self._session is None:
            return self._opened(reply, now_ns)
        if reply.session != self._session:
            return []
        if reply.asked == FtpOpcode.BURSTREADFILE:
            return self._burst(reply, now_ns)
        if reply.asked == FtpOpcode.READFILE:
            return self._piece(reply, now_ns)
        return []

    # ---------------------------------------------------------------------------- opening

    def _opened(self, reply: _Reply, now_ns: int) -> list[FtpEffect]:
        if reply.asked == FtpOpcode.RESETSESSION:
            self.deadline_ns = now_ns + self._client.answer_ns
            return [self._client.send(FtpOpcode.OPENFILERO, data=self._path)]
        if reply.asked != FtpOpcode.OPENFILERO:
            return []
        if reply.opcode == FtpOpcode.NAK:
            if reply.error == FtpError.NOSESSIONSAVAILABLE and not self._reset:
                self._reset = True  # PX4 has one, which an end that was lost left open
                self.deadline_ns = now_ns + self._client.answer_ns
                return [self._client.send(FtpOpcode.RESETSESSION)]
            return self._failed(reply.error)
        self._session = reply.session
        self.size = int.from_bytes(reply.data[:4], "little")
        return self._next_burst(now_ns)

    # ---------------------------------------------------------------------------- reading

    def _next_burst(self, now_ns: int) -> list[FtpEffect]:
        assert self._session is not None
        self.deadline_ns = now_ns + self._client.answer_ns
        self._asked.clear()
        self._probes = False
        return [
            self._client.send(
                FtpOpcode.BURSTREADFILE,
                session=self._session,
                offset=self._pieces.end,
                size=DATA_BYTES,
            )
        ]

    def _burst(self, reply: _Reply, now_ns: int) -> list[FtpEffect]:
        if reply.opcode == FtpOpcode.NAK:
            if reply.error not in (FtpError.EOF, FtpError.UNKNOWNCOMMAND):
                return self._failed(reply.error)
            # Whether this end is that of the file or of what did not come, a read says.
            return self._fill(now_ns, probes=True)
        taken = self._taken(reply)
        if not self._asked:
            self.deadline_ns = now_ns + self._client.answer_ns
        if reply.last_of_burst and not self._asked:
            return [*taken, *self._fill(now_ns)]
        return taken

    def _piece(self, reply: _Reply, now_ns: int) -> list[FtpEffect]:
        """One that was asked for by itself."""
        if reply.opcode == FtpOpcode.NAK:
            if reply.error != FtpError.EOF:
                return self._failed(reply.error)
            if self._probes and self._pieces.at == self._pieces.end:
                return [*self.stop(), FileEnd(self._pieces.end)]
            return []
        self._asked.pop(reply.offset, None)
        more = reply.offset >= self._pieces.end and bool(reply.data)
        taken = self._taken(reply)
        if more and self._probes:
            return [*taken, *self._next_burst(now_ns)]
        return [*taken, *self._fill(now_ns, probes=self._probes)]

    def _taken(self, reply: _Reply) -> list[FtpEffect]:
        at = self._pieces.at
        data = self._pieces.add(reply.offset, reply.data)
        return [FileData(at, data, self.size)] if data else []

    def _fill(self, now_ns: int, *, probes: bool = False) -> list[FtpEffect]:
        """Ask for what is missing; where nothing is, for more, or whether there is more."""
        pieces = self._pieces
        missing = pieces.missing(AT_ONCE)
        if not missing and pieces.at >= self.size > 0 and pieces.at == pieces.end:
            return [*self.stop(), FileEnd(pieces.end)]
        if not missing and not probes:
            return self._next_burst(now_ns)
        self._probes = probes
        wanted = missing or [pieces.end]
        again_ns = now_ns - self._client.answer_ns
        sends: list[FtpEffect] = []
        for offset in wanted:
            if self._asked.get(offset, again_ns) <= again_ns:
                self._asked[offset] = now_ns
                assert self._session is not None
                ask = FtpOpcode.READFILE
                sends.append(
                    self._client.send(ask, session=self._session, offset=offset, size=DATA_BYTES)
                )
        self.deadline_ns = min(self._asked[each] for each in wanted) + self._client.answer_ns
        return sends

    # ---------------------------------------------------------------------------- failing

    def _silent(self, now_ns: int) -> list[FtpEffect]:
        waits = OPEN_WAITS if self._session is None else WAITS
        if now_ns - self._heard_ns >= waits * self._client.answer_ns:
            return [*self.stop(), FileFailed(None, "the vehicle does not answer")]
        if self._session is None:
            self.deadline_ns = now_ns + self._client.answer_ns
            return [self._client.send(FtpOpcode.OPENFILERO, data=self._path, again=True)]
        # A piece was lost, the end of a burst, or the asking for one.
        return self._fill(now_ns, probes=self._probes)

    def _failed(self, error: int) -> list[FtpEffect]:
        return [*self.stop(), FileFailed(error, error_words(error))]


class _Question(ABC):
    """Asks about a path, once or again and again, and needs no session of the vehicle's."""

    opcode: FtpOpcode

    def __init__(
        self, own: Address, target: Address, path: str, answer_ns: int = ANSWER_NS
    ) -> None:
        self._client = _Client(own, target, answer_ns)
        self._path = path.encode()
        self._began_ns = 0
        self.deadline_ns: int | None = None
        self.done = False

    def start(self, now_ns: int) -> list[FtpEffect]:
        self._client.begin(now_ns)
        self._began_ns = now_ns
        return self._ask(now_ns)

    def stop(self) -> list[FtpEffect]:
        """It is not wanted any more."""
        self.done, self.deadline_ns = True, None
        return []

    def handle(self, event: Heard | Wake, now_ns: int) -> list[FtpEffect]:
        if self.done:
            return []
        if isinstance(event, Wake):
            due = self.deadline_ns is not None and now_ns >= self.deadline_ns
            return self._silent(now_ns) if due else []
        reply = self._client.reply(event)
        if reply is None or reply.asked != self.opcode:
            return []
        if reply.opcode == FtpOpcode.NAK:
            return self._denied(reply)
        return self._told(reply, now_ns)

    def _denied(self, reply: _Reply) -> list[FtpEffect]:
        return [*self.stop(), FileFailed(reply.error, error_words(reply.error))]

    @abstractmethod
    def _ask(self, now_ns: int) -> list[FtpEffect]: ...

    @abstractmethod
    def _silent(self, now_ns: int) -> list[FtpEffect]:
        """No answer came in time."""

    @abstractmethod
    def _told(self, reply: _Reply, now_ns: int) -> list[FtpEffect]: ...


class FolderRead(_Question):
    """Lists a folder: the entries from offset on, until EOF."""

    opcode = FtpOpcode.LISTDIRECTORY

    def __init__(
        self, own: Address, target: Address, path: str, answer_ns: int = ANSWER_NS
    ) -> None:
        super().__init__(own, target, path, answer_ns)
        self._entries: list[FileEntry] = []
        self._passed = 0
        self._tries = 0

    def _ask(self, now_ns: int) -> list[FtpEffect]:
        self.deadline_ns = now_ns + self._client.answer_ns
        return [self._client.send(self.opcode, offset=self._passed, data=self._path)]

    def _silent(self, now_ns: int) -> list[FtpEffect]:
        self._tries += 1
        if self._tries >= OPEN_WAITS:
            return [*self.stop(), FileFailed(None, "the vehicle does not answer")]
        return self._ask(now_ns)

    def _denied(self, reply: _Reply) -> list[FtpEffect]:
        if reply.error == FtpError.EOF:
            return [*self.stop(), FolderListed(tuple(self._entries))]
        return super()._denied(reply)

    def _told(self, reply: _Reply, now_ns: int) -> list[FtpEffect]:
        if reply.offset != self._passed:
            return []  # the answer to one that was asked twice
        self._tries = 0
        for line in filter(None, reply.data.split(b"\0")):
            self._passed += 1
            self._note(line.decode("utf-8", "replace"))
        return self._ask(now_ns)

    def _note(self, line: str) -> None:
        """`Fname<tab>size`, `Dname`, or `S` for what is left out."""
        name, _, size = line[1:].partition("\t")
        if line[:1] == "D" and name not in (".", ".."):
            self._entries.append(FileEntry(name, None))
        elif line[:1] == "F":
            self._entries.append(FileEntry(name, int(size) if size.isdecimal() else 0))


class FileCrc(_Question):
    """Asks for the check sum of a file, which the vehicle reads whole for it."""

    opcode = FtpOpcode.CALCFILECRC

    def _ask(self, now_ns: int, *, again: bool = False) -> list[FtpEffect]:
        self.deadline_ns = now_ns + CRC_AGAIN_WAITS * self._client.answer_ns
        return [self._client.send(self.opcode, data=self._path, again=again)]

    def _silent(self, now_ns: int) -> list[FtpEffect]:
        if now_ns - self._began_ns >= CRC_WAITS * self._client.answer_ns:
            return [*self.stop(), FileFailed(None, "the vehicle tells no check sum")]
        return self._ask(now_ns, again=True)

    def _told(self, reply: _Reply, now_ns: int) -> list[FtpEffect]:
        return [*self.stop(), FileCrcTold(int.from_bytes(reply.data[:4], "little"))]


def error_words(error: int) -> str:
    """What a negative answer says."""
    return _WORDS.get(error, f"the vehicle's file transfer failed (error {error})")


_WORDS: Final = {
    int(FtpError.FAILERRNO): "the vehicle could not open or read it",
    int(FtpError.NOSESSIONSAVAILABLE): "the vehicle serves files to somebody else",
    int(FtpError.UNKNOWNCOMMAND): "the vehicle does not know this way to read files",
    int(FtpError.FILEPROTECTED): "the vehicle does not give it out",
    int(FtpError.FILENOTFOUND): "there is no such file on the vehicle",
}
