"""A client gets what it asked for as often as it asked, where the gate needs it more often.

A vehicle sends one set of streams on a link, and the gate has it send some messages faster than a
ground station wants them (`needed_rates.py`).  So what a client asked for with SET_MESSAGE_INTERVAL
or REQUEST_DATA_STREAM is remembered here, the last word for each message, and frames that come in
between do not go to that client.  A message that a client never spoke of, or for which it asked for
the vehicle's own rate, goes to it as it comes: what the vehicle would send unasked is not known.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.bridge.rates.asked_rates import ALL_STREAMS
from gcs.bridge.rates.needed_rates import Rates
from gcs.protocol.effects import Address
from gcs.wire.frame import Frame
from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandInt, CommandLong, RequestDataStream

Asks: TypeAlias = CommandLong | CommandInt | RequestDataStream

EARLY_NS: Final = 200_000_000
"""So much earlier than its turn a frame may come: radios, and computers that were busy, give
several frames at once."""
WHOLE: Final = frozenset({int(MsgId.MISSION_CURRENT), int(MsgId.BATTERY_STATUS)})
"""Never thinned: the first also answers who sets the current item, the second comes once for each
battery."""
OF_GROUP: Final[Mapping[int, tuple[MsgId, ...]]] = {
    2: (MsgId.SYS_STATUS, MsgId.GPS_RAW_INT),
    6: (MsgId.GLOBAL_POSITION_INT, MsgId.LOCAL_POSITION_NED),
    10: (MsgId.ATTITUDE,),
    12: (MsgId.EKF_STATUS_REPORT,),
}
"""MAV_DATA_STREAM -> what of it the gate needs as well.  That ArduCopter sets them with a request
for all is recorded (`asked_rates.OF_ALL`), in which group each of them is, from memory."""

_Key: TypeAlias = tuple[int, int, int]
"""System and component of the vehicle, message id."""


@dataclass(slots=True)
class _Stream:
    """One message of one vehicle, for one client."""

    interval_ns: int
    """0: the client asked that none comes."""
    due_ns: int = 0
    once: bool = False
    """The client asked for one: the next is for it."""

    def passes(self, now_ns: int) -> bool:
        """A frame of it came: whether it is for the client."""
        if self.once:
            self.once = False
            return True
        if self.interval_ns == 0 or now_ns < self.due_ns - EARLY_NS:
            return False
        self.due_ns = max(self.due_ns, now_ns) + self.interval_ns
        return True


class ThinnedStreams:
    """Of all client links, for all vehicles."""

    def __init__(self, needed_hz: Rates) -> None:
        """`needed_hz`: how often the gate needs which message."""
        self._needed_hz = {of: hz for of, hz in needed_hz.items() if of not in WHOLE}
        self._of_link: dict[int, dict[_Key, _Stream]] = {}

    def asked(self, link: int, vehicle: Address, message: Asks, *, obeyed: bool = True) -> None:
        """A client asks a component of a vehicle for something, which goes on to it.

        `obeyed`: the vehicle acts on REQUEST_DATA_STREAM.  One that does not goes on sending what
        is to be stopped, and so it goes on to the client.
        """
        if isinstance(message, RequestDataStream):
            hz = float(message.req_message_rate) if message.start_stop else 0.0
            for group, msgids in OF_GROUP.items():
                if message.req_stream_id in (group, ALL_STREAMS) and (hz > 0.0 or obeyed):
                    for each in msgids:
                        self._set(link, (vehicle.sysid, vehicle.compid, each), hz)
            return
        msgid = int(message.param1) if 0.0 <= message.param1 < 1e8 else 0
        key = (vehicle.sysid, vehicle.compid, msgid)
        if message.command == Cmd.REQUEST_MESSAGE:
            stream = self._of_link.get(link, {}).get(key)
            if stream is not None:
                stream.once = True
        elif message.command == Cmd.SET_MESSAGE_INTERVAL:
            interval_us = message.param2
            if interval_us > 0.0:
                self._set(link, key, 1e6 / interval_us)
            else:
                self._set(link, key, 0.0 if interval_us < 0.0 else None)

    def _set(self, link: int, key: _Key, hz: float | None) -> None:
        """None: as the vehicle sends it."""
        streams = self._of_link.setdefault(link, {})
        streams.pop(key, None)
        if hz is not None and hz < self._needed_hz.get(key[2], 0.0):
            streams[key] = _Stream(round(1e9 / hz) if hz > 0.0 else 0)
        if not streams:
            del self._of_link[link]

    def forget(self, link: int) -> None:
        """The client on it is not there any more."""
        self._of_link.pop(link, None)

    def left_out(self, frames: Sequence[Frame], now_ns: int) -> Mapping[int, Sequence[bytes]]:
        """Which of the frames that came together do not go to which client link."""
        found: dict[int, list[bytes]] = {}
        for link, streams in self._of_link.items():
            for frame in frames:
                stream = streams.get((frame.sysid, frame.compid, frame.msgid))
                if stream is not None and not stream.passes(now_ns):
                    found.setdefault(link, []).append(frame.raw)
        return found
