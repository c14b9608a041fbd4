"""The frames of one vehicle: counted, put in order, decoded where somebody interprets them.

At 100,000 a second every call counts here; what a message leads to is in `messages.py`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs.gate import inputs
from gcs.session.work import GateInput, Work
from gcs.vehicle.interpreted_messages import INTERPRETED
from gcs.vehicle.messages import VehicleMessages
from gcs.vehicle.parts import VehicleParts
from gcs.vehicle.talk.liveness import STATE_MESSAGES
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire import messages as m
from gcs.wire.codec import decode
from gcs.wire.frame import Frame

ALIVE: Final[Sequence[Work]] = (GateInput(inputs.MessageSeen()),)
"""What the gate is to hear of any frame of the autopilot, now and then."""
MOST_IN_TURN: Final = 100
"""Frames that are counted as one: fewer than half of the ring of sequence numbers."""


class VehicleFrames:
    """What came of a vehicle, or of its radio, on any link."""

    def __init__(self, parts: VehicleParts) -> None:
        self._parts = parts
        self._messages = VehicleMessages(parts)

    def passes(self, link: int, frames: Sequence[Frame], now_ns: int) -> bool:
        """Good frames of messages that are not in `INTERPRETED`: counted, and not decoded.

        True: the gate is to hear that the vehicle lives.
        """
        telemetry = self._parts.telemetry
        if telemetry is None:
            return False
        own = [frame for frame in frames if frame.sysid == telemetry.sysid]
        if not own:
            return False
        self._parts.presence.number_all(own, now_ns)
        telemetry.count_frames(len(own), now_ns)
        of_autopilot = telemetry.compid in [frame.compid for frame in own]
        return of_autopilot and self._alive(telemetry, link, now_ns)

    def _alive(self, telemetry: Telemetry, link: int, now_ns: int) -> bool:
        """A frame of its autopilot came; whether the gate is to hear of it."""
        if telemetry.heard_ns == now_ns == telemetry.link_ns:
            return False  # the datagram's first frame has told it
        self._parts.presence.choose_link(telemetry, link, now_ns)
        return self._parts.presence.alive(telemetry, now_ns)

    def in_turn(self, link: int, frames: Sequence[Frame], now_ns: int) -> Sequence[Work] | None:
        """Good frames that came together, all of its autopilot and each the next one: counted.

        What the gate is to hear of that.  None where they are any others, or very many: then
        nothing was counted.
        """
        telemetry = self._parts.telemetry
        if telemetry is None or len(frames) > MOST_IN_TURN:
            return None
        if not self._parts.presence.all_in_turn(
            (telemetry.sysid, telemetry.compid), frames, now_ns
        ):
            return None
        telemetry.count_frames(len(frames), now_ns)
        return ALIVE if self._alive(telemetry, link, now_ns) else ()

    def counted(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """One of those that `in_turn` has counted, of this vehicle or of another that has a radio
        of its own: that tells of the link."""
        parts = self._parts
        work: list[Work] = []
        message = decode(frame) if frame.msgid in INTERPRETED else None
        if isinstance(message, m.Heartbeat):
            work += self._messages.heartbeat(link, frame, message, now_ns)
        elif isinstance(message, m.RadioStatus):
            work += parts.watch.radio(message, now_ns)
        telemetry = parts.telemetry
        if message is None or telemetry is None or frame.sysid != telemetry.sysid:
            return work
        state = type(message) in STATE_MESSAGES
        if state and parts.presence.overtaken(frame, message, parts.presence.number_of(frame)):
            return work
        return work + self._messages.heard(telemetry, frame, message, now_ns)

    def placed(self, frame: Frame, now_ns: int) -> list[Work]:
        """The same of one that tells where the vehicle is: nothing else of it is changed by that,
        and nobody waits for it."""
        message, telemetry = decode(frame), self._parts.telemetry
        if message is None or telemetry is None:
            return []
        return self._messages.updated(telemetry, message, now_ns)

    def frame(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """A good frame of anybody on `link`; what is not our vehicle's changes nothing."""
        parts = self._parts
        work: list[Work] = []
        message = decode(frame) if frame.msgid in INTERPRETED else None
        if isinstance(message, m.Heartbeat):
            work += self._messages.heartbeat(link, frame, message, now_ns)
        telemetry = parts.telemetry
        if isinstance(message, m.RadioStatus):
            work += parts.watch.radio(message, now_ns)
        if telemetry is None or frame.sysid != telemetry.sysid:
            return work
        number = parts.presence.number(frame, now_ns)
        telemetry.count_frames(1, now_ns)
        if frame.compid == telemetry.compid and self._alive(telemetry, link, now_ns):
            work += ALIVE
        if message is not None and not parts.presence.overtaken(frame, message, number):
            work += self._messages.heard(telemetry, frame, message, now_ns)
        return work
