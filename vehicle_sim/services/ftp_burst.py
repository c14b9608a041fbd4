"""BurstReadFile: one request, many packets, paced.

The packets count on from the request's sequence number.  The last one of a burst says so, and the
client asks for the next burst; the end of the file is a NAK (EOF).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.effects import Client
from vehicle_sim.services.ftp_refusals import FtpRefusedError, reason
from vehicle_sim.services.ftp_sessions import Key, Sessions
from vehicle_sim.services.ftp_wire import DATA_MAX, Nak, Opcode, Reply, Request
from vehicle_sim.services.streams import NEVER
from vehicle_sim.storage.store import StoreError

PACE_NS_PER_BYTE: Final = 2_000
"""Half a megabyte per second and burst: slow readers lose nothing, and telemetry has its way."""
PACKETS_AT_ONCE: Final = 16
BURST_PACKETS: Final = 150
"""Then the client asks for more: PX4 sends about 35 kB at a time."""
EOF_PAUSE_NS: Final = 20_000_000
"""MAVSDK ends the session on the last byte, and would wonder about an end of file after that."""


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
