"""MAVLink FTP: one vehicle's files for any number of clients.

All times are wall time: bursts are paced, sessions time out, retries are known by their age.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple, TypeAlias

from vehicle_sim.effects import Client, Effect, Note, Send
from vehicle_sim.services.ftp.sessions import Bursts, Sessions
from vehicle_sim.services.ftp.wire import (
    DATA_MAX,
    FtpRefusedError,
    Nak,
    Opcode,
    Reply,
    Request,
    pack,
    parse,
    reason,
)
from vehicle_sim.storage.store import Store, StoreError, StoreFault, crc32, crc32_of
from vehicle_sim.storage.virtual_files import Tree, VirtualFiles
from vehicle_sim.wire import messages as m

RETRY_NS: Final = 1_500_000_000
"""Clients repeat within 1 s (QGroundControl; MAVSDK and mavftp 0.5 s).  Not much longer: MAVSDK
begins every operation with sequence 0, so that an equal request soon is one of its own."""
REPLIES_KEPT: Final = 8
CLIENTS_KEPT: Final = 32

REMEMBERED: Final = frozenset(
    {
        Opcode.TERMINATE_SESSION,
        Opcode.RESET_SESSIONS,
        Opcode.OPEN_FILE_RO,
        Opcode.CREATE_FILE,
        Opcode.OPEN_FILE_WO,
        Opcode.REMOVE_FILE,
        Opcode.CREATE_DIRECTORY,
        Opcode.REMOVE_DIRECTORY,
        Opcode.TRUNCATE_FILE,
        Opcode.RENAME,
    }
)
"""To read or write at an offset again does no harm."""
OPENING: Final = frozenset({Opcode.OPEN_FILE_RO, Opcode.CREATE_FILE, Opcode.OPEN_FILE_WO})


class _Sent(NamedTuple):
    request: Request
    reply: Reply
    heard_ns: int


class Replies:
    """What the last clients were told last: a request that comes again changes nothing twice."""

    def __init__(self) -> None:
        self._sent: dict[Client, dict[int, _Sent]] = {}  # by the request's sequence

    def recall(self, client: Client, request: Request, now_ns: int) -> Reply | None:
        """What the same request was answered with a moment ago."""
        sent = self._sent.get(client, {})
        known = sent.get(request.sequence)
        if known is None or known.request != request or now_ns - known.heard_ns > RETRY_NS:
            return None
        sent[request.sequence] = known._replace(heard_ns=now_ns)
        return known.reply

    def remember(self, client: Client, request: Request, reply: Reply, now_ns: int) -> None:
        if request.opcode not in REMEMBERED:
            return
        sent = self._sent.pop(client, {})
        sent.pop(request.sequence, None)
        sent[request.sequence] = _Sent(request, reply, now_ns)
        self._sent[client] = sent
        if len(sent) > REPLIES_KEPT:
            del sent[next(iter(sent))]
        if len(self._sent) > CLIENTS_KEPT:
            del self._sent[next(iter(self._sent))]

    def closed(self, client: Client, session: int | None) -> None:
        """A session is over, or all of them (None): its opening is not to be confirmed again."""
        sent = self._sent.get(client, {})
        for sequence, known in list(sent.items()):
            if known.request.opcode in OPENING and session in (None, known.reply.session):
                del sent[sequence]

    def forget(self, channel: int) -> None:
        self._sent = {
            client: sent for client, sent in self._sent.items() if client.channel != channel
        }


class FtpServer:
    """Pure: requests and time go in, replies come out."""

    def __init__(self, store: Store, virtual: VirtualFiles) -> None:
        self._store: Final = store
        self._tree: Final = Tree(store, virtual)
        self._sessions: Final = Sessions(self._tree)
        self._replies: Final = Replies()
        self._bursts: Final = Bursts(self._sessions)

    @property
    def deadline_ns(self) -> int:
        """When the next packet of a burst is due, or a session may be lost."""
        return min(self._bursts.deadline_ns, self._sessions.deadline_ns)

    def handle(self, client: Client, message: m.FileTransferProtocol, now_ns: int) -> list[Effect]:
        """One request; the packets of a burst come from `tick`."""
        request = parse(message.payload)
        if request.opcode in (Opcode.ACK, Opcode.NAK):
            return []
        known = self._replies.recall(client, request, now_ns)
        if known is not None:
            return [_send(client, known)]
        try:
            reply = self._answer(client, request, now_ns)
        except (FtpRefusedError, StoreError) as refusal:
            reply = _nak(request, refusal)
        if reply is None:
            return []
        self._replies.remember(client, request, reply, now_ns)
        return [_send(client, reply)]

    def tick(self, now_ns: int) -> list[Effect]:
        lost = self._sessions.expire(now_ns)
        return [
            *(_send(client, reply) for client, reply in self._bursts.packets(now_ns)),
            *(Note("info", f"FTP session timed out: {session.path}") for session in lost),
        ]

    def forget(self, channel: int) -> None:
        """The channel is gone, and all that its clients had open."""
        self._sessions.forget(channel)
        self._replies.forget(channel)
        self._bursts.forget(channel)

    def _answer(self, client: Client, request: Request, now_ns: int) -> Reply | None:
        """None: `tick` will answer.  Raises `FtpRefusedError` and `StoreError`."""
        if request.size > DATA_MAX:
            raise FtpRefusedError(Nak.INVALID_DATA_SIZE)
        handler = HANDLERS.get(request.opcode)
        if handler is None:
            raise FtpRefusedError(Nak.UNKNOWN_COMMAND)
        return handler(self, client, request, now_ns)

    # --------------------------------------------------------------------------- sessions

    def _terminate(self, client: Client, request: Request, now_ns: int) -> Reply:
        self._bursts.stop((client, request.session))
        self._replies.closed(client, request.session)
        self._sessions.close((client, request.session))
        return _ack(request)

    def _reset(self, client: Client, request: Request, now_ns: int) -> Reply:
        self._bursts.stop_all(client)
        self._replies.closed(client, None)
        self._sessions.close_all(client)
        return _ack(request)

    def _open_read(self, client: Client, request: Request, now_ns: int) -> Reply:
        key = (client, request.session)
        return _ack(request, _u32(self._sessions.open_read(key, _path(request.data), now_ns)))

    def _create(self, client: Client, request: Request, now_ns: int) -> Reply:
        key = (client, request.session)
        self._sessions.open_write(key, _path(request.data), now_ns, empty=True)
        return _ack(request)

    def _open_write(self, client: Client, request: Request, now_ns: int) -> Reply:
        key = (client, request.session)
        size = self._sessions.open_write(key, _path(request.data), now_ns, empty=False)
        return _ack(request, _u32(size))

    def _read(self, client: Client, request: Request, now_ns: int) -> Reply:
        session = self._sessions.use((client, request.session), now_ns, writing=False)
        data = self._sessions.read(session, request.offset, request.size or DATA_MAX)
        if not data:
            raise FtpRefusedError(Nak.EOF)
        return _ack(request, data)

    def _write(self, client: Client, request: Request, now_ns: int) -> Reply:
        session = self._sessions.use((client, request.session), now_ns, writing=True)
        self._sessions.write(session, request.offset, request.data)
        return _ack(request)

    def _burst(self, client: Client, request: Request, now_ns: int) -> None:
        self._bursts.start((client, request.session), request, now_ns)

    # ---------------------------------------------------------------- files and directories

    def _nothing(self, client: Client, request: Request, now_ns: int) -> Reply:
        return _ack(request)

    def _list(self, client: Client, request: Request, now_ns: int) -> Reply:
        """`F<name>\\t<size>`, `D<name>`, or `S` for what cannot be said; a NUL after each."""
        listing = b""
        for entry in self._tree.entries(_path(request.data))[request.offset :]:
            line = f"D{entry.name}" if entry.is_directory else f"F{entry.name}\t{entry.size}"
            encoded = line.encode("utf-8", "replace") + b"\0"
            if len(encoded) > DATA_MAX:
                encoded = b"S\0"
            if len(listing) + len(encoded) > DATA_MAX:
                break
            listing += encoded
        if not listing:
            # Also for an empty directory: after an empty ACK mavftp would ask for ever.
            raise FtpRefusedError(Nak.EOF)
        return _ack(request, listing)

    def _remove(self, client: Client, request: Request, now_ns: int) -> Reply:
        self._store.remove(self._free(request.data))
        return _ack(request)

    def _make_directory(self, client: Client, request: Request, now_ns: int) -> Reply:
        self._store.make_directory(self._free(request.data))
        return _ack(request)

    def _remove_directory(self, client: Client, request: Request, now_ns: int) -> Reply:
        self._store.remove_directory(self._free(request.data))
        return _ack(request)

    def _truncate(self, client: Client, request: Request, now_ns: int) -> Reply:
        self._store.truncate(self._free(request.data), request.offset)
        return _ack(request)

    def _rename(self, client: Client, request: Request, now_ns: int) -> Reply:
        old, nul, new = request.data.partition(b"\0")
        if not nul:
            raise FtpRefusedError(Nak.INVALID_DATA_SIZE)
        self._store.rename(self._free(old), self._free(new))
        return _ack(request)

    def _crc32(self, client: Client, request: Request, now_ns: int) -> Reply:
        path = _path(request.data)
        found = self._tree.virtual(path)
        crc = crc32(self._store, path) if found is None else crc32_of(found[0].read(found[1]))
        return _ack(request, _u32(crc))

    def _free(self, data: bytes) -> str:
        """A path that may be changed."""
        path = _path(data)
        self._tree.check_free(path)
        return path


Handler: TypeAlias = Callable[[FtpServer, Client, Request, int], Reply | None]

HANDLERS: Final[dict[int, Handler]] = {
    Opcode.NONE: FtpServer._nothing,
    Opcode.TERMINATE_SESSION: FtpServer._terminate,
    Opcode.RESET_SESSIONS: FtpServer._reset,
    Opcode.LIST_DIRECTORY: FtpServer._list,
    Opcode.OPEN_FILE_RO: FtpServer._open_read,
    Opcode.READ_FILE: FtpServer._read,
    Opcode.CREATE_FILE: FtpServer._create,
    Opcode.WRITE_FILE: FtpServer._write,
    Opcode.REMOVE_FILE: FtpServer._remove,
    Opcode.CREATE_DIRECTORY: FtpServer._make_directory,
    Opcode.REMOVE_DIRECTORY: FtpServer._remove_directory,
    Opcode.OPEN_FILE_WO: FtpServer._open_write,
    Opcode.TRUNCATE_FILE: FtpServer._truncate,
    Opcode.RENAME: FtpServer._rename,
    Opcode.CALC_FILE_CRC32: FtpServer._crc32,
    Opcode.BURST_READ_FILE: FtpServer._burst,
}


def _path(data: bytes) -> str:
    """Up to the first NUL."""
    try:
        return data.split(b"\0", 1)[0].decode("utf-8")
    except UnicodeDecodeError:
        raise StoreError(StoreFault.BAD_PATH) from None


def _u32(value: int) -> bytes:
    return min(value, 0xFFFFFFFF).to_bytes(4, "little")


def _ack(request: Request, data: bytes = b"") -> Reply:
    return Reply(
        request.sequence + 1, request.session, Opcode.ACK, request.opcode, request.offset, data
    )


def _nak(request: Request, refusal: FtpRefusedError | StoreError) -> Reply:
    return Reply(
        request.sequence + 1,
        request.session,
        Opcode.NAK,
        request.opcode,
        request.offset,
        reason(refusal),
    )


def _send(client: Client, reply: Reply) -> Send:
    return Send(
        client.channel, m.FileTransferProtocol(0, client.system, client.component, pack(reply))
    )
