"""Whether the vehicle is there, on which link, and what of it is in order and new."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs.protocol.sequence import SequenceTracker
from gcs.session.speedup_waits import Times
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire import messages as m
from gcs.wire.frame import Frame

ALIVE_EVERY_NS = 250_000_000
"""How often the gate is told that something of the vehicle was heard."""
LINK_SILENT_NS = 2_000_000_000
HEARD_AGAIN_NS = 1_500_000_000
"""After a longer silence it is heard again: a heartbeat comes every second, whatever else does."""
RESTART_SILENCE_NS = 500_000_000
"""A frame that seems older than others, and comes after such a silence, is of a vehicle that
restarted: on the way no frame is overtaken by that much."""

STATE_MESSAGES: Final = frozenset({m.Heartbeat, m.ExtendedSysState, m.SysStatus, m.MissionCurrent})
"""What tells a state is void once a newer one was seen; answers and events are not."""


class Presence:
    """Of one vehicle: its silences, its sequence numbers, and the link to answer on.

    `gone_ns` is the silence after which the gate has lost it.
    """

    def __init__(self, times: Times, gone_ns: int) -> None:
        self._link_silent_ns = times.real_ns(LINK_SILENT_NS)
        self._heard_again_ns = times.real_ns(HEARD_AGAIN_NS)
        self._restart_silence_ns = times.real_ns(RESTART_SILENCE_NS)
        self.gone_ns = gone_ns
        self._newest: dict[tuple[int, int], int] = {}
        self._heard_ns: dict[tuple[int, int], int] = {}
        self.losses = SequenceTracker()

    def number(self, frame: Frame, now_ns: int) -> int:
        """The frame's place among all of its sender; it is counted."""
        sender = (frame.sysid, frame.compid)
        heard_ns = self._heard_ns.get(sender, now_ns)
        self._heard_ns[sender] = now_ns
        number = self.losses.in_turn(sender, frame.seq)
        return self._out_of_turn(sender, frame.seq, now_ns - heard_ns) if number is None else number

    def all_in_turn(self, sender: tuple[int, int], frames: Sequence[Frame], now_ns: int) -> bool:
        """Count frames that came together, where all of them are the next ones of `sender`; where
        one is any other, nothing is counted."""
        sysid, compid = sender
        seqs = [frame.seq for frame in frames if frame.compid == compid and frame.sysid == sysid]
        in_turn = len(seqs) == len(frames) and self.losses.all_in_turn(sender, bytes(seqs))
        if in_turn:
            self._heard_ns[sender] = now_ns
        return in_turn

    def hears(self, sysid: int, compid: int) -> bool:
        """Whether that component was ever heard."""
        return (sysid, compid) in self._heard_ns

    def number_of(self, frame: Frame) -> int:
        """The same as `number` says, of one of the last 100 that were counted in turn."""
        return self.losses.number(frame.sysid, frame.compid, frame.seq)

    def number_all(self, frames: Sequence[Frame], now_ns: int) -> None:
        """The same for frames of one system that came together."""
        compid = frames[0].compid
        sender = (frames[0].sysid, compid)
        seqs = bytes([frame.seq for frame in frames if frame.compid == compid])
        if len(seqs) == len(frames) and self.losses.all_in_turn(sender, seqs):
            self._heard_ns[sender] = now_ns
        else:
            for frame in frames:
                self.number(frame, now_ns)

    def _out_of_turn(self, sender: tuple[int, int], seq: int, silence_ns: int) -> int:
        if silence_ns > self._restart_silence_ns and self.losses.late(*sender, seq):
            self.losses.restart(*sender)
        number = self.losses.number(*sender, seq)
        self.losses.seen(*sender, seq)
        return number

    def overtaken(self, frame: Frame, message: m.Message, number: int) -> bool:
        """A state that is older than one of the same kind that has come: void."""
        if type(message) not in STATE_MESSAGES:
            return False
        key = (frame.compid, frame.msgid)
        newest = self._newest.get(key)
        if newest is not None and number <= newest:
            return True
        self._newest[key] = number
        return False

    def choose_link(self, telemetry: Telemetry, link: int, now_ns: int) -> None:
        """Answer where it is heard; another link takes over only once that one is silent."""
        silent = now_ns - telemetry.link_ns > self._link_silent_ns
        if link == telemetry.link or silent:
            telemetry.link, telemetry.link_ns = link, now_ns

    def alive(self, telemetry: Telemetry, now_ns: int) -> bool:
        """Any message is a sign of life; True where the gate is to hear of it."""
        telemetry.was_gone |= self.is_gone(telemetry, now_ns)
        if now_ns - telemetry.heard_ns > self._heard_again_ns:
            telemetry.heard_again_ns = now_ns
        telemetry.heard_ns = now_ns
        if now_ns - telemetry.alive_told_ns < ALIVE_EVERY_NS:
            return False
        telemetry.alive_told_ns = now_ns
        return True

    def is_gone(self, telemetry: Telemetry, now_ns: int) -> bool:
        """It was silent for so long that the gate has lost it."""
        return 0 < telemetry.heard_ns < now_ns - self.gone_ns

    def back(self, telemetry: Telemetry, now_ns: int) -> None:
        """It is heard again after it was gone: its numbers begin anew."""
        telemetry.was_gone, telemetry.heard_ns = False, now_ns
        self.begins_anew(telemetry)

    def begins_anew(self, telemetry: Telemetry) -> None:
        """Its next frame follows its last one, whatever number it has."""
        self.losses.restart(telemetry.sysid, telemetry.compid)
