"""Which vehicles are there; of ours, on which link, and what of it is in order and new."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs.gate.refusal import Code, Refusal
from gcs.protocol.autopilot import autopilot_of, type_name
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
LISTEN_NS: Final = 1_200_000_000
"""A heartbeat comes once a second: after this time every vehicle of a good link was heard."""

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


class Roster:
    """Every autopilot that was heard, by its system id, and whether it is clear which is meant."""

    def __init__(self, chosen: int, times: Times, gone_ns: int) -> None:
        """`chosen`: the system id that the operator named, 0 for none; a vehicle that is silent for
        `gone_ns` counts no more."""
        self._chosen = chosen
        self._listen_ns = times.real_ns(LISTEN_NS)
        self._gone_ns = gone_ns
        self._labels: dict[int, str] = {}
        self._heard_ns: dict[int, int] = {}
        self._first_ns: int | None = None
        self._committed = False

    def heard(self, sysid: int, compid: int, beat: m.Heartbeat, now_ns: int) -> bool:
        """A heartbeat of an autopilot; whether it is the first of one among others."""
        new = sysid not in self._labels
        autopilot = autopilot_of(beat.autopilot, beat.type)
        self._labels[sysid] = f"{sysid}/{compid} {autopilot.name} {type_name(beat.type)}"
        self._heard_ns[sysid] = now_ns
        self._first_ns = now_ns if self._first_ns is None else self._first_ns
        return new and len(self._labels) > 1

    def names(self, now_ns: int) -> list[str]:
        """Those that are heard now, by id."""
        return [
            self._labels[sysid] for sysid in sorted(self._heard_ns) if self.hears(sysid, now_ns)
        ]

    def hears(self, sysid: int, now_ns: int) -> bool:
        """Whether the autopilot of that system is heard now."""
        heard_ns = self._heard_ns.get(sysid)
        return heard_ns is not None and now_ns - heard_ns <= self._gone_ns

    def listening(self, now_ns: int) -> bool:
        """Whether others may still be heard that were there all the time."""
        if self._chosen or self._first_ns is None:
            return False
        return now_ns - self._first_ns < self._listen_ns

    def refusal(self, now_ns: int) -> Refusal | None:
        """Why a request cannot be for any of them: there are several, and none was chosen.

        Once a request was for the only one, whoever comes later changes nothing: what flies must be
        stopped.
        """
        names = self.names(now_ns)
        if self._chosen or self._committed or len(names) <= 1:
            self._committed |= bool(names)
            return None
        heard = f"{len(names)} vehicles are heard: {', '.join(names)}"
        sentence = f"{heard}; choose one with --vehicle"
        return Refusal(Code.SEVERAL_VEHICLES, sentence, (("vehicles", float(len(names))),))
