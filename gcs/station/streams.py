"""Setpoint streams of operators: their samples become inputs of the gate, its verdicts events.

A sample has no number and no answer of its own.  Who may not stream is told so once, and again
after it has been silent for a while.  The record has where samples begin to be refused, with the
sample and the reason, and where that is over: flown again, or ended without that.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

from gcs import ipc
from gcs.frames import Vec3, as_on_the_wire, finite_or_nan, heading_rad, ned_from_enu
from gcs.gate.attitude import Attitude, attitude_of
from gcs.gate.effects import StreamVerdict
from gcs.gate.inputs import StreamSeen
from gcs.gate.refusal import Refusal
from gcs.session import announcements
from gcs.session.requests import operator_of, source_of
from gcs.session.work import Work

EPISODE_NS: Final = 5_000_000_000
"""Who is silent for so long is told anew that it may not stream."""

BEGUN_WITHIN_NS: Final = 1_000_000_000
"""Where nobody is in control: two samples within so long are a stream (a PX4 wants more than 2 Hz
of it)."""

BEGIN: Final = ipc.Ask(0, "stream_begin")
"""A sample asks for what this asks for."""


@dataclass(slots=True)
class _Refused:
    """Samples of one operator for one vehicle that are refused, one after the other."""

    code: str
    """Of the last reason that was told."""
    last_ns: int
    samples: int = 1


class Streams:
    """Which operators stream, and which of them were told that they may not."""

    def __init__(self) -> None:
        self._first_ns: dict[int, int] = {}
        """The last sample of operators who are not in control."""
        self._streamed_ns: dict[tuple[int, int], int] = {}
        """The last sample that a gate was given, by operator and vehicle."""
        self._refused_ns: dict[int, int] = {}
        self._last: dict[tuple[int, int], ipc.Stream] = {}
        """The last sample that a gate was given, by operator and the vehicle that it named."""
        self._refused: dict[tuple[int, int], _Refused] = {}
        """By operator and system id; 0: those that reach no gate."""

    def goes_on(self, operator: int, sample: ipc.Stream, now_ns: int) -> bool:
        """Whether it is a stream: a sample that says something, soon after another one.  One alone
        takes no control."""
        if not _says_something(sample):
            return False
        before_ns = self._first_ns.get(operator)
        self._first_ns[operator] = now_ns
        return before_ns is not None and now_ns - before_ns <= BEGUN_WITHIN_NS

    def others(self, operator: int, now_ns: int) -> list[tuple[int, int]]:
        """Who else has a stream that may not be over yet, and at which vehicle; told once."""
        found = [
            key
            for key, last_ns in self._streamed_ns.items()
            if key[0] != operator and now_ns - last_ns <= EPISODE_NS
        ]
        for key in found:
            del self._streamed_ns[key]
        return found

    def seen(self, operator: int, sample: ipc.Stream, now_ns: int) -> StreamSeen:
        """The sample for the gate, in NED and as it is on the wire."""
        source = source_of(operator)
        self._refused_ns.pop(operator, None)
        self._last[operator, sample.vehicle] = sample
        for (who, sysid), refused in self._refused.items():
            if who == operator and sysid and sample.vehicle in (0, sysid):
                refused.samples += 1
                refused.last_ns = now_ns
        self._streamed_ns[operator, sample.vehicle] = now_ns
        yaw_deg, rate_deg_s = sample.yaw_deg, sample.yaw_rate_deg_s
        attitude = _attitude(sample)
        return StreamSeen(
            source,
            _ned(sample.pos_enu),
            _ned(sample.v_enu),
            _ned(sample.a_enu),
            None if yaw_deg is None or attitude is not None else heading_rad(yaw_deg),
            None if rate_deg_s is None else as_on_the_wire(math.radians(rate_deg_s)),
            attitude,
        )

    def refuse(
        self, operator: int, sample: ipc.Stream, refusal: Refusal, now_ns: int
    ) -> StreamVerdict | None:
        """A sample that does not reach the gate: told once an episode."""
        refused = self._refused.setdefault((operator, 0), _Refused(refusal.code.value, now_ns, 0))
        refused.samples, refused.last_ns = refused.samples + 1, now_ns
        last_ns = self._refused_ns.get(operator)
        self._refused_ns[operator] = now_ns
        if last_ns is not None and now_ns - last_ns <= EPISODE_NS:
            return None
        refused.code = refusal.code.value
        numbers = (*asked_numbers(sample), *refusal.numbers)
        return StreamVerdict(source_of(operator), refusal, numbers)

    def verdict(self, told: StreamVerdict, sysid: int, now_ns: int) -> StreamVerdict:
        """The gate's, with what the last sample asked for."""
        operator = operator_of(told.source)
        if told.refusal is None:
            self._refused.pop((operator, sysid), None)
        else:
            refused = self._refused.setdefault((operator, sysid), _Refused("", now_ns))
            refused.code = told.refusal.code.value
        sample = self._last.get((operator, sysid)) or self._last.get((operator, 0))
        asked = () if sample is None else asked_numbers(sample)
        return replace(told, evidence=(*asked, *told.evidence))

    def second(self, now_ns: int) -> list[Work]:
        """Once a second: whose refused samples have stopped."""
        ended = [key for key, each in self._refused.items() if now_ns - each.last_ns > EPISODE_NS]
        return [*self._ended(ended, f"none for {EPISODE_NS / 1e9:.0f} s")]

    def forget(self, operator: int) -> list[Work]:
        """It has left, and its number is never given again."""
        ended = [
            *self._ended([key for key in self._refused if key[0] == operator], "and it has gone")
        ]
        self._first_ns.pop(operator, None)
        self._refused_ns.pop(operator, None)
        self._streamed_ns = {key: at for key, at in self._streamed_ns.items() if key[0] != operator}
        self._last = {key: each for key, each in self._last.items() if key[0] != operator}
        return ended

    def _ended(self, keys: list[tuple[int, int]], why: str) -> Iterator[Work]:
        for operator, sysid in keys:
            refused = self._refused.pop((operator, sysid))
            text = f"{refused.samples} samples were refused, {why}"
            samples = float(refused.samples)
            yield announcements.stream_ended(
                source_of(operator), sysid, refused.code, text, samples
            )


def asked_numbers(sample: ipc.Stream) -> tuple[tuple[str, float], ...]:
    """What a sample asks for, by name; an axis that was left out is not there."""
    triples = (
        ("asked_{}_m", sample.pos_enu),
        ("asked_v_{}_m_s", sample.v_enu),
        ("asked_a_{}_m_s2", sample.a_enu),
    )
    numbers = [
        (name.format(axis), value)
        for name, triple in triples
        if triple is not None
        for axis, value in zip(("east", "north", "up"), triple, strict=True)
    ]
    numbers += [
        ("asked_roll_deg", sample.roll_deg),
        ("asked_pitch_deg", sample.pitch_deg),
        ("asked_yaw_deg", sample.yaw_deg),
        ("asked_yaw_rate_deg_s", sample.yaw_rate_deg_s),
        ("asked_thrust", sample.thrust),
    ]
    return tuple((name, value) for name, value in numbers if value is not None)


def _says_something(sample: ipc.Stream) -> bool:
    """Somewhere to fly to or some way to fly, and no number that is none."""
    triples = [each for each in (sample.pos_enu, sample.v_enu, sample.a_enu) if each is not None]
    numbers = [value for triple in triples for value in triple]
    numbers += [sample.yaw_deg, sample.yaw_rate_deg_s, *_attitude_parts(sample)]
    given = [value for value in numbers if value is not None]
    moves = bool(triples) or None not in _attitude_parts(sample)
    return moves and all(math.isfinite(value) for value in given)


def _attitude_parts(sample: ipc.Stream) -> tuple[float | None, ...]:
    return (sample.roll_deg, sample.pitch_deg, sample.thrust)


def _attitude(sample: ipc.Stream) -> Attitude | None:
    """As it is on the wire.  A part that is missing is not finite, and the gate refuses it."""
    parts = _attitude_parts(sample)
    if parts == (None, None, None):
        return None
    roll, pitch, yaw, thrust = (
        math.nan if value is None or not math.isfinite(value) else value
        for value in (sample.roll_deg, sample.pitch_deg, sample.yaw_deg, sample.thrust)
    )
    w, x, y, z = map(as_on_the_wire, attitude_of(*map(math.radians, (roll, pitch, yaw))))
    return Attitude((w, x, y, z), as_on_the_wire(thrust))


def _ned(enu: ipc.Maybe3 | None) -> Vec3 | None:
    return None if enu is None else ned_from_enu(finite_or_nan(enu))
