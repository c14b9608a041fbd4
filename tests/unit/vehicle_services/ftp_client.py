"""A client of MAVLink FTP for the tests, and a server to talk to on a clock of the test's own."""

from __future__ import annotations

from vehicle_sim.effects import Client, Effect, Send
from vehicle_sim.services.ftp.ftp import FtpServer
from vehicle_sim.services.ftp.wire import Nak, Opcode, Reply
from vehicle_sim.storage.store import MemoryStore
from vehicle_sim.storage.virtual_files import VirtualFiles
from vehicle_sim.wire import messages as m

MS = 1_000_000
S = 1000 * MS
GROUND = Client(0, 255, 190)


def frame(
    opcode: int,
    data: bytes = b"",
    *,
    sequence: int = 0,
    session: int = 0,
    offset: int = 0,
    size: int | None = None,
) -> m.FileTransferProtocol:
    """As the specification lays it out; `size` may lie."""
    length = len(data) if size is None else size
    head = sequence.to_bytes(2, "little") + bytes((session, opcode, length, 0, 0, 0))
    payload = head + offset.to_bytes(4, "little") + data
    return m.FileTransferProtocol(0, 1, 1, payload.ljust(251, b"\0")[:251])


def understood(message: m.Message) -> Reply:
    """A reply by the same layout."""
    assert isinstance(message, m.FileTransferProtocol)
    raw = message.payload
    assert len(raw) <= 251
    raw = raw.ljust(251, b"\0")
    return Reply(
        sequence=int.from_bytes(raw[0:2], "little"),
        session=raw[2],
        opcode=Opcode(raw[3]),
        req_opcode=raw[5],
        offset=int.from_bytes(raw[8:12], "little"),
        data=raw[12 : 12 + raw[4]],
        burst_complete=bool(raw[6]),
    )


class FtpBench:
    """One server, its store, a clock, and clients that count their requests."""

    def __init__(self, virtual: VirtualFiles | None = None) -> None:
        self.store = MemoryStore()
        self.server = FtpServer(self.store, virtual if virtual is not None else {})
        self.now_ns = 0
        self.sequence = 0

    def ask(
        self,
        opcode: int,
        data: bytes = b"",
        *,
        client: Client = GROUND,
        session: int = 0,
        offset: int = 0,
        size: int | None = None,
        sequence: int | None = None,
    ) -> Reply:
        """The one reply; the sequence counts on by itself."""
        self.sequence += 2
        used = self.sequence if sequence is None else sequence
        asked = frame(opcode, data, sequence=used, session=session, offset=offset, size=size)
        (reply,) = self.replies(self.server.handle(client, asked, self.now_ns), client)
        assert reply.sequence == (used + 1) & 0xFFFF
        assert reply.req_opcode == opcode
        return reply

    def burst(self, *, session: int = 0, offset: int = 0, size: int = 239) -> None:
        """Asked for; the packets come with `advance`."""
        self.sequence += 2
        asked = frame(
            Opcode.BURST_READ_FILE,
            sequence=self.sequence,
            session=session,
            offset=offset,
            size=size,
        )
        assert self.server.handle(GROUND, asked, self.now_ns) == []

    def advance(self, ns: int, client: Client = GROUND) -> list[Reply]:
        """What comes meanwhile, with a look at the server's deadline every 4 ms."""
        heard: list[Reply] = []
        end_ns = self.now_ns + ns
        while self.now_ns < end_ns:
            self.now_ns += 4 * MS
            if self.now_ns >= self.server.deadline_ns:
                heard += self.replies(self.server.tick(self.now_ns), client)
        return heard

    def replies(self, effects: list[Effect], client: Client) -> list[Reply]:
        heard = []
        for effect in effects:
            if isinstance(effect, Send):
                message = effect.message
                assert isinstance(message, m.FileTransferProtocol)
                assert effect.channel == client.channel
                assert message[:3] == (0, client.system, client.component)
                heard.append(understood(message))
        return heard


def refused(reply: Reply) -> Nak:
    """Why."""
    assert reply.opcode is Opcode.NAK
    return Nak(reply.data[0])
