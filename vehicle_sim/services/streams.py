"""When each message is due on one channel.

Every stream lies on an absolute grid of its own: it is due at the multiples of its interval,
behind the vehicle's turn in a fleet.
Rates hold per second of wall time: a vehicle that lives `speedup` times faster spaces its
messages as much wider in its own time, so that a client is not flooded.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from vehicle_sim.services.profile import MESSAGE_INTERVAL_MIN_NS, Profile
from vehicle_sim.services.stream_sets import Groups, Intervals
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import DataStream

NEVER: Final = 1 << 62
INTERVAL_MAX_NS: Final = ((1 << 31) - 1) * 1000
"""The longest that MESSAGE_INTERVAL can tell: 36 minutes."""


class Streams:
    """Rates table of one channel.  Times are the vehicle's own, in nanoseconds.

    Messages of one interval are due together, whenever they were asked for: so what is looked
    after is intervals, of which there are few.
    """

    def __init__(
        self,
        profile: Profile,
        unasked: Intervals,
        streamable: frozenset[int],
        speedup: Fraction,
        now_ns: int,
        phase_ns: int = 0,
        *,
        groups: Groups,
    ) -> None:
        """`unasked` is what is sent at the beginning; `phase_ns` shifts the whole grid: vehicles
        of a fleet take turns; `groups` is what REQUEST_DATA_STREAM asks for."""
        self._profile = profile
        self._unasked = unasked
        self._streamable = streamable
        self._stretch = max(Fraction(1), speedup)
        self._phase_ns = phase_ns
        self._groups = groups
        self._interval_ns: dict[int, int] = {}
        self._spaced_ns: dict[int, int] = {}  # in the vehicle's own time
        self._due_ns: dict[int, int] = {}  # by the spaced interval
        self._rows: dict[tuple[int, ...], tuple[int, ...]] = {}  # intervals due -> messages
        self.next_ns = NEVER
        for number, interval_ns in unasked.items():
            self._note(number, interval_ns)
        self._reckon(now_ns)

    def _set(self, number: int, interval_ns: int, now_ns: int) -> None:
        """0 stops the stream."""
        self._note(number, interval_ns)
        self._reckon(now_ns)

    def _note(self, number: int, interval_ns: int) -> None:
        if interval_ns == 0:
            self._interval_ns.pop(number, None)
            self._spaced_ns.pop(number, None)
        else:
            clipped_ns = max(interval_ns, MESSAGE_INTERVAL_MIN_NS)
            self._interval_ns[number] = clipped_ns
            self._spaced_ns[number] = int(clipped_ns * self._stretch)

    def _reckon(self, now_ns: int) -> None:
        known = self._due_ns
        self._due_ns = {
            spaced_ns: known.get(spaced_ns) or self._after(now_ns, spaced_ns)
            for spaced_ns in self._spaced_ns.values()
        }
        self._rows.clear()
        self.next_ns = min(self._due_ns.values(), default=NEVER)

    def _after(self, now_ns: int, interval_ns: int) -> int:
        """The first point of the interval's grid later than now."""
        return now_ns - (now_ns - self._phase_ns) % interval_ns + interval_ns

    def due(self, now_ns: int) -> tuple[int, ...]:
        """Numbers of the messages to send now, in the order of the rates table."""
        if now_ns < self.next_ns:
            return ()
        due_ns = self._due_ns
        over = tuple([spaced_ns for spaced_ns, at_ns in due_ns.items() if at_ns <= now_ns])
        for spaced_ns in over:
            due_ns[spaced_ns] = self._after(now_ns, spaced_ns)
        self.next_ns = min(due_ns.values())
        row = self._rows.get(over)
        if row is None:
            spaced = self._spaced_ns
            row = self._rows[over] = tuple(each for each in spaced if spaced[each] in over)
        return row

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
            self._set(number, self._unasked.get(number, 0), now_ns)
        else:
            self._set(number, min(round(interval_us * 1000), INTERVAL_MAX_NS), now_ns)
        return True

    def begin(self, number: int, interval_us: int, now_ns: int) -> None:
        """A stream that runs already keeps its rate."""
        if number not in self._interval_ns:
            self._set(number, interval_us * 1000, now_ns)

    def request(self, asked: m.RequestDataStream, now_ns: int) -> None:
        """The old REQUEST_DATA_STREAM, still what MAVProxy and DroneKit use."""
        if asked.req_stream_id == DataStream.ALL:
            kinds = [kind for group in self._groups.values() for kind in group]
        else:
            kinds = [
                kind
                for stream, group in self._groups.items()
                if stream == asked.req_stream_id
                for kind in group
            ]
        rate_hz = asked.req_message_rate if asked.start_stop else 0
        for kind in kinds:
            if m.IDS[kind] not in self._profile.fixed:
                self._set(m.IDS[kind], 1_000_000_000 // rate_hz if rate_hz else 0, now_ns)
