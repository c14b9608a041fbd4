"""What MAVLink FTP's clients were told last: a request that comes again changes nothing twice."""

from __future__ import annotations

from typing import Final, NamedTuple

from vehicle_sim.effects import Client
from vehicle_sim.services.ftp_wire import Opcode, Reply, Request

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


class _Sent(NamedTuple):
    request: Request
    reply: Reply
    heard_ns: int


class Replies:
    """The last few of each of the last clients."""

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


OPENING: Final = frozenset({Opcode.OPEN_FILE_RO, Opcode.CREATE_FILE, Opcode.OPEN_FILE_WO})
