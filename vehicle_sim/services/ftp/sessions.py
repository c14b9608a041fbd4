"""The files that MAVLink FTP's clients hold open, and the bursts that are read from them.

A *session* belongs to one client and has the number that the client asked for, as ArduPilot does
it: MAVSDK only ever uses 0, mavftp counts up.

BurstReadFile is one request and many packets, paced.  They count on from the request's sequence
number.  The last one of a burst says so, and the client asks for the next burst; the end of the
file is a NAK (EOF).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from vehicle_sim.effects import Client
from vehicle_sim.services.ftp.wire import (
    DATA_MAX,
    FtpRefusedError,
    Nak,
    Opcode,
    Reply,
    Request,
    reason,
)
from vehicle_sim.services.streams import NEVER
from vehicle_sim.storage.store import StoreError, StoreFault
from vehicle_sim.storage.virtual_files import Tree, Virtual

SESSIONS_MAX: Final = 32
SESSIONS_OF_A_CLIENT_MAX: Final = 8
IDLE_NS: Final = 3_000_000_000
"""After this long its client may open another file under the same number (ArduPilot)."""
LOST_NS: Final = 10_000_000_000
"""After this long a session is closed (PX4)."""
UPLOAD_BYTES_MAX: Final = 0xFFFF
"""Of a virtual file."""

PACE_NS_PER_BYTE: Final = 2_000
"""Half a megabyte per second and burst: slow readers lose nothing, and telemetry has its way."""
PACKETS_AT_ONCE: Final = 16
BURST_PACKETS: Final = 150
"""Then the client asks for more: PX4 sends about 35 kB at a time."""
EOF_PAUSE_NS: Final = 20_000_000
"""MAVSDK ends the session on the last byte, and would wonder about an end of file after that."""


@dataclass(slots=True)
class Session:
    """One open file.  What is virtual is held as a copy, so that it does not change meanwhile."""

    path: str
    writing: bool
    used_ns: int
    copy: bytearray | None = None
    virtual: Virtual | None = None
    fresh: bool = True  # nothing was read or written yet


Key: TypeAlias = tuple[Client, int]


class Sessions:
    """All of one vehicle's, bounded and timed out.

    Every method that takes a path raises `StoreError`, every method that takes a key
    `FtpRefusedError`.
    """

    def __init__(self, tree: Tree) -> None:
        self._tree: Final = tree
        self._open: dict[Key, Session] = {}
        self.deadline_ns = NEVER

    def __contains__(self, key: Key) -> bool:
        return key in self._open

    def open_read(self, key: Key, path: str, now_ns: int) -> int:
        """The file's size in bytes."""
        found = self._tree.virtual(path)
        copy = bytearray(found[0].read(found[1])) if found is not None else None
        session = Session(path, False, now_ns, copy)
        size = self.size(session)
        self._check_room(key, now_ns)
        self._add(key, session)
        return size

    def open_write(self, key: Key, path: str, now_ns: int, *, empty: bool) -> int:
        """Size of what is kept.  A file that is not there is created, as both autopilots do."""
        self._check_room(key, now_ns)
        found = self._tree.virtual(path)
        if found is not None:
            virtual, _ = found
            if virtual.write is None:
                raise StoreError(StoreFault.PROTECTED, path)
            self._add(key, Session(path, True, now_ns, bytearray(), virtual))
            return 0
        self._tree.check_free(path)
        size = 0 if empty else self._size_or_absent(path)
        if empty or size is None:
            self._tree.store.create(path)
        self._add(key, Session(path, True, now_ns))
        return size or 0

    def _size_or_absent(self, path: str) -> int | None:
        try:
            return self._tree.store.size(path)
        except StoreError as error:
            if error.fault is StoreFault.NOT_FOUND:
                return None
            raise

    def _check_room(self, key: Key, now_ns: int) -> None:
        """A number is free again if it is idle, or if the answer to its opening seems lost."""
        same = self._open.get(key)
        if same is not None and (same.fresh or now_ns - same.used_ns >= IDLE_NS):
            self._forget(key)
        of_client = sum(1 for client, _ in self._open if client == key[0])
        if (
            key in self._open
            or of_client >= SESSIONS_OF_A_CLIENT_MAX
            or len(self._open) >= SESSIONS_MAX
        ):
            raise FtpRefusedError(Nak.NO_SESSIONS_AVAILABLE)

    def _add(self, key: Key, session: Session) -> None:
        self._open[key] = session
        self.deadline_ns = min(self.deadline_ns, session.used_ns + LOST_NS)

    def use(self, key: Key, now_ns: int, *, writing: bool) -> Session:
        """The open session, which thereby lives on."""
        session = self._open.get(key)
        if session is None:
            raise FtpRefusedError(Nak.INVALID_SESSION)
        if session.writing is not writing:
            raise FtpRefusedError(Nak.FAIL)
        session.used_ns = now_ns
        session.fresh = False
        return session

    def size(self, session: Session) -> int:
        if session.copy is not None:
            return len(session.copy)
        return self._tree.store.size(session.path)

    def read(self, session: Session, offset: int, count: int) -> bytes:
        """Empty at and after the end."""
        if session.copy is not None:
            return bytes(session.copy[offset : offset + count])
        return self._tree.store.read(session.path, offset, count)

    def write(self, session: Session, offset: int, data: bytes) -> None:
        if session.copy is None:
            self._tree.store.write(session.path, offset, data)
            return
        end = offset + len(data)
        if end > UPLOAD_BYTES_MAX:
            raise StoreError(StoreFault.NO_SPACE, session.path)
        session.copy.extend(bytes(max(0, end - len(session.copy))))
        session.copy[offset:end] = data

    def close(self, key: Key) -> None:
        """An upload to a virtual file takes effect now.  Raises `StoreError` if it is no good."""
        session = self._open.get(key)
        if session is None:
            raise FtpRefusedError(Nak.INVALID_SESSION)
        self._forget(key)
        if session.virtual is not None and session.virtual.write is not None:
            session.virtual.write(bytes(session.copy or b""))

    def close_all(self, client: Client) -> None:
        """QGroundControl ends its uploads with this, and is not told what became of them."""
        for key in [key for key in self._open if key[0] == client]:
            try:
                self.close(key)
            except StoreError:
                continue

    def expire(self, now_ns: int) -> list[Session]:
        """Close what was left alone; an unfinished upload is dropped."""
        lost = [key for key, held in self._open.items() if now_ns - held.used_ns >= LOST_NS]
        gone = [self._open[key] for key in lost]
        for key in lost:
            self._forget(key)
        self._reckon()
        return gone

    def forget(self, channel: int) -> None:
        for key in [key for key in self._open if key[0].channel == channel]:
            self._forget(key)

    def _forget(self, key: Key) -> None:
        del self._open[key]
        self._reckon()

    def _reckon(self) -> None:
        used_ns = min((session.used_ns for session in self._open.values()), default=NEVER)
        self.deadline_ns = min(NEVER, used_ns + LOST_NS)


@dataclass(slots=True)
class _Burst:
    sequence: int  # of the next packet
    offset: int
    count: int  # bytes in a packet
    packets_left: int
    due_ns: int


class Bursts:
    """Those that are on their way, at most one a session."""

    def __init__(self, sessions: Sessions) -> None:
        self._sessions: Final = sessions
        self._running: dict[Key, _Burst] = {}
        self.deadline_ns = NEVER

    def start(self, key: Key, request: Request, now_ns: int) -> None:
        """A second one in the same session starts anew, from its own offset.

        Raises `FtpRefusedError`.
        """
        self._sessions.use(key, now_ns, writing=False)
        count = request.size or DATA_MAX
        self._running[key] = _Burst(
            request.sequence + 1, request.offset, count, BURST_PACKETS, now_ns
        )
        self._reckon()

    def stop(self, key: Key) -> None:
        self._running.pop(key, None)
        self._reckon()

    def stop_all(self, client: Client) -> None:
        self._running = {key: burst for key, burst in self._running.items() if key[0] != client}
        self._reckon()

    def forget(self, channel: int) -> None:
        self._running = {
            key: burst for key, burst in self._running.items() if key[0].channel != channel
        }
        self._reckon()

    def packets(self, now_ns: int) -> list[tuple[Client, Reply]]:
        """What is due, and to whom."""
        due: list[tuple[Client, Reply]] = []
        for key, burst in list(self._running.items()):
            for _ in range(PACKETS_AT_ONCE):
                if burst.due_ns > now_ns:
                    break
                reply = self._packet(key, burst, now_ns)
                due.append((key[0], reply))
                if reply.burst_complete:
                    del self._running[key]
                    break
            # What could not be sent in time is not made up for.
            burst.due_ns = max(burst.due_ns, now_ns + 1)
        self._reckon()
        return due

    def _reckon(self) -> None:
        self.deadline_ns = min((burst.due_ns for burst in self._running.values()), default=NEVER)

    def _packet(self, key: Key, burst: _Burst, now_ns: int) -> Reply:
        sequence, offset = burst.sequence, burst.offset
        try:
            session = self._sessions.use(key, now_ns, writing=False)
            data = self._sessions.read(session, offset, burst.count)
            if not data:
                raise FtpRefusedError(Nak.EOF)
            at_end = offset + len(data) >= self._sessions.size(session)
        except (FtpRefusedError, StoreError) as refusal:
            kind, data, complete = Opcode.NAK, reason(refusal), True
        else:
            burst.sequence += 1
            burst.offset += len(data)
            burst.packets_left -= 1
            burst.due_ns = (
                now_ns + EOF_PAUSE_NS if at_end else burst.due_ns + len(data) * PACE_NS_PER_BYTE
            )
            kind, complete = Opcode.ACK, not burst.packets_left
        return Reply(sequence, key[1], kind, Opcode.BURST_READ_FILE, offset, data, complete)
