"""When each message is due on one channel.

Every stream lies on an absolute grid of its own: it is due at the multiples of its interval.
Rates hold per second of wall time: a vehicle that lives `speedup` times faster spaces its
messages as much wider in its own time, so that a client is not flooded.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Stream

from .profile import DATA_STREAMS, MESSAGE_INTERVAL_MIN_NS, Profile

NEVER: Final = 1 << 62


class Streams:
    """Rates table of one channel.  Times are the vehicle's own, in nanoseconds."""

    def __init__(
        self, profile: Profile, streamable: frozenset[int], speedup: Fraction, now_ns: int
    ) -> None:
        self._profile = profile
        self._streamable = streamable
        self._stretch = max(Fraction(1), speedup)
        self._interval_ns: dict[int, int] = {}
        self._due_ns: dict[int, int] = {}
        self.next_ns = NEVER
        for number, interval_ns in profile.intervals_ns.items():
            self._set(number, interval_ns, now_ns)

    def _set(self, number: int, interval_ns: int, now_ns: int) -> None:
        """0 stops the stream."""
        if interval_ns == 0:
            self._interval_ns.pop(number, None)
            self._due_ns.pop(number, None)
        else:
            clipped_ns = max(interval_ns, MESSAGE_INTERVAL_MIN_NS)
            self._interval_ns[number] = clipped_ns
            self._due_ns[number] = _after(now_ns, int(clipped_ns * self._stretch))
        self.next_ns = min(self._due_ns.values(), default=NEVER)

    def due(self, now_ns: int) -> list[int]:
        """Numbers of the messages to send now, in the order of the rates table."""
        if now_ns < self.next_ns:
            return []
        due = [number for number, at_ns in self._due_ns.items() if at_ns <= now_ns]
        for number in due:
            self._due_ns[number] = _after(now_ns, int(self._interval_ns[number] * self._stretch))
        self.next_ns = min(self._due_ns.values())
        return due

    def interval_us(self, number: int) -> int | None:
        """MESSAGE_INTERVAL's value: -1 = off, None = this vehicle has no such stream."""
        if number not in self._streamable:
            return None
        interval_ns = self._interval_ns.get(number)
        return -1 if interval_ns is None else interval_ns // 1000

    def set_interval(self, number: int, interval_us: float, now_ns: int) -> bool:
        """SET_MESSAGE_INTERVAL: -1 = off, 0 = the default.  False = not to be had."""
        if number not in self._streamable or number in self._profile.fixed:
            return False
        if interval_us < 0:
            self._set(number, 0, now_ns)
        elif interval_us == 0:
            self._set(number, self._profile.intervals_ns.get(number, 0), now_ns)
        else:
            self._set(number, min(round(interval_us * 1000), NEVER >> 8), now_ns)
        return True

    def request(self, asked: m.RequestDataStream, now_ns: int) -> None:
        """The old REQUEST_DATA_STREAM, still what MAVProxy and DroneKit use."""
        if asked.req_stream_id == Stream.ALL:
            kinds = [kind for group in DATA_STREAMS.values() for kind in group]
        else:
            kinds = [
                kind
                for stream, group in DATA_STREAMS.items()
                if stream == asked.req_stream_id
                for kind in group
            ]
        rate_hz = asked.req_message_rate if asked.start_stop else 0
        for kind in kinds:
            if m.IDS[kind] not in self._profile.fixed:
                self._set(m.IDS[kind], 1_000_000_000 // rate_hz if rate_hz else 0, now_ns)


def _after(now_ns: int, interval_ns: int) -> int:
    """The first multiple of the interval later than now."""
    return (now_ns // interval_ns + 1) * interval_ns
