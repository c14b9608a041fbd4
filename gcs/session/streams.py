"""Setpoint streams of operators: their samples become inputs of the gate, its verdicts events.

A sample has no number and no answer of its own.  Who may not stream is told so once, and again
after it has been silent for a while.
"""

from __future__ import annotations

import math
from typing import Final

from gcs import ipc
from gcs.frames import Vec3, as_on_the_wire, ned_from_enu
from gcs.gate.effects import Level, StreamVerdict
from gcs.gate.inputs import StreamSeen
from gcs.gate.refusal import Refusal
from gcs.session import teller
from gcs.session.requests import client_of, finite_or_nan, heading_rad, source_of
from gcs.session.work import Log, Work

EPISODE_NS: Final = 5_000_000_000
"""Who is silent for so long is told anew that it may not stream."""

BEGUN_WITHIN_NS: Final = 1_000_000_000
"""Where nobody is in control: two samples within so long are a stream (a PX4 wants more than 2 Hz
of it)."""

BEGIN: Final = ipc.Ask(0, "stream_begin")
"""A sample asks for what this asks for."""

NODE: Final = "link"


class Streams:
    """Which operators stream, and which of them were told that they may not."""

    def __init__(self) -> None:
        self._first_ns: dict[int, int] = {}
        """The last sample of operators who are not in control."""
        self._streamed_ns: dict[tuple[int, int], int] = {}
        """The last sample that a gate was given, by operator and vehicle."""
        self._refused_ns: dict[int, int] = {}

    def goes_on(self, client: int, sample: ipc.Stream, now_ns: int) -> bool:
        """Whether it is a stream: a sample that says something, soon after another one.  One alone
        takes no control."""
        if not _says_something(sample):
            return False
        before_ns = self._first_ns.get(client)
        self._first_ns[client] = now_ns
        return before_ns is not None and now_ns - before_ns <= BEGUN_WITHIN_NS

    def others(self, client: int, now_ns: int) -> list[tuple[int, int]]:
        """Who else has a stream that may not be over yet, and at which vehicle; told once."""
        found = [
            key
            for key, last_ns in self._streamed_ns.items()
            if key[0] != client and now_ns - last_ns <= EPISODE_NS
        ]
        for key in found:
            del self._streamed_ns[key]
        return found

    def seen(self, client: int, sample: ipc.Stream, now_ns: int) -> StreamSeen:
        """The sample for the gate, in NED and as it is on the wire."""
        source = source_of(client)
        self._refused_ns.pop(client, None)
        self._streamed_ns[client, sample.vehicle] = now_ns
        yaw_deg, rate_deg_s = sample.yaw_deg, sample.yaw_rate_deg_s
        return StreamSeen(
            source,
            _ned(sample.pos_enu),
            _ned(sample.v_enu),
            _ned(sample.a_enu),
            None if yaw_deg is None else heading_rad(yaw_deg),
            None if rate_deg_s is None else as_on_the_wire(math.radians(rate_deg_s)),
        )

    def refuse(self, client: int, refusal: Refusal, sysid: int, now_ns: int) -> list[Work]:
        """A sample that does not reach the gate: told once an episode."""
        last_ns = self._refused_ns.get(client)
        self._refused_ns[client] = now_ns
        if last_ns is not None and now_ns - last_ns <= EPISODE_NS:
            return []
        source = source_of(client)
        text = f"stream of {source}: refused {refusal.code.value}: {refusal.sentence}"
        verdict = StreamVerdict(source, refusal, refusal.numbers)
        told = teller.stream_verdict(verdict, client, sysid)
        return [*told, Log(Level.WARNING, NODE, text)]

    def verdict(self, told: StreamVerdict, sysid: int) -> list[Work]:
        """The gate's, for the operator whose stream it is."""
        return [*teller.stream_verdict(told, client_of(told.source), sysid)]

    def forget(self, client: int) -> None:
        """It has left, and its number is never given again."""
        self._first_ns.pop(client, None)
        self._refused_ns.pop(client, None)
        self._streamed_ns = {key: at for key, at in self._streamed_ns.items() if key[0] != client}


def _says_something(sample: ipc.Stream) -> bool:
    """Somewhere to fly to or some way to fly, and no number that is none."""
    triples = [each for each in (sample.pos_enu, sample.v_enu, sample.a_enu) if each is not None]
    numbers = [value for triple in triples for value in triple]
    numbers += [sample.yaw_deg, sample.yaw_rate_deg_s]
    given = [value for value in numbers if value is not None]
    return bool(triples) and all(math.isfinite(value) for value in given)


def _ned(enu: ipc.Maybe3 | None) -> Vec3 | None:
    return None if enu is None else ned_from_enu(finite_or_nan(enu))
