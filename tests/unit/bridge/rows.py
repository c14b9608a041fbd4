"""Rows about one message each: what a client sends, how the vehicle is, what is asked for by it.

An answer is told in words and numbers:

- `hold, goto 50 100 17 yaw 90`: requests in their order, with east, north, up; `-` is not given;
- `sample pos 4 5 -20 v 1 0 0 yaw 1.5`: a setpoint of a stream, north, east, down;
- `goto 5 4 20 / sample pos 4 5 -20`: a request, and the setpoint that it is in a stream;
- `POLICY: the sticks`: refused with this code, and this in its sentence;
- `forwarded`, or nothing at all: so already.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import pytest

from gcs import ipc
from gcs.bridge.translate.meaning import Forward, Meaning, Reject, Sample, Seen, Words
from gcs.bridge.translate.translate import meaning_of
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.wire.messages import Message
from tests.unit.bridge.vehicles import flying, standing

P, A = (PX4,), (ARDUPILOT,)
BOTH = (PX4, ARDUPILOT)
How: TypeAlias = Callable[[Autopilot], Seen]
NEAR, FAR = 1e-4, 0.02
"""What a float32 leaves of a number below 40; 1e-7 degrees of a place 100 m away, in metres."""


def air(state: State = State.HOVERING, **changed: Any) -> How:
    """Flown by the gate, 10 m above home."""
    return lambda autopilot: flying(autopilot, state=state, **changed)


def ground(**changed: Any) -> How:
    return lambda autopilot: standing(autopilot, **changed)


@dataclass(frozen=True, slots=True)
class Row:
    """`note`: in what the client reads beside it; "" is that it reads nothing, None anything."""

    who: Sequence[Autopilot]
    how: How
    sends: Message | Mapping[str, Message]
    asks_for: str
    note: str | None = ""


def table(subjects: Mapping[str, Sequence[Row]]) -> pytest.MarkDecorator:
    """One test for each subject, of all its rows."""
    return pytest.mark.parametrize("rows", subjects.values(), ids=[*subjects])


def hold(rows: Sequence[Row]) -> None:
    """Each row is as it says, for each of its autopilots."""
    for row in rows:
        for autopilot in row.who:
            sends = row.sends[autopilot.name] if isinstance(row.sends, Mapping) else row.sends
            try:
                _is(meaning_of(sends, row.how(autopilot)), row)
            except Exception as failed:
                failed.add_note(f"{autopilot.name}, {row.asks_for!r}: {sends}")
                raise


def _is(meaning: Meaning, row: Row) -> None:
    if isinstance(meaning, Reject):
        said = f"{meaning.refusal.code}: {meaning.refusal.sentence}"
        code, _, sentence = row.asks_for.partition(": ")
        assert said.startswith(f"{code}: "), said
        assert sentence in said
        return
    said = told(meaning)
    actual, wanted = _parts(said), _parts(row.asks_for)
    assert len(actual) == len(wanted), said
    for one, other in zip(actual, wanted, strict=True):
        if isinstance(one, float) and isinstance(other, float):
            assert math.isclose(one, other, abs_tol=FAR if abs(other) > 40 else NEAR), said
        else:
            assert one == other, said
    note = meaning.note if isinstance(meaning, Words) else ""
    if row.note is not None:
        assert row.note in note
        assert bool(row.note) is bool(note), note


def _parts(text: str) -> list[str | float]:
    return [_part(word) for word in text.replace(",", " ,").split()]


def _part(word: str) -> str | float:
    try:
        return float(word)
    except ValueError:
        return word


def told(meaning: Meaning) -> str:
    """In words and numbers."""
    match meaning:
        case Forward():
            return "forwarded"
        case Sample():
            return _sample(meaning)
        case Words(asks=asks, if_repeated=again):
            said = ", ".join(map(_ask, asks))
            return said if again is None else f"{said} / {_sample(again)}"
    raise AssertionError(meaning)


def _ask(ask: ipc.Ask) -> str:
    parts: list[object] = [ask.word]
    if ask.goal_enu is not None:
        parts += ["-" if axis is None else axis for axis in ask.goal_enu]
    parts += [ask.up_m] if ask.up_m is not None else []
    parts += [ask.item] if ask.word == "mission_set_current" else []
    parts += [ask.mode] * bool(ask.mode) + ["by force"] * ask.force
    parts += ["yaw", ask.yaw_deg] if ask.yaw_deg is not None else []
    return " ".join(map(str, parts))


def _sample(sample: Sample) -> str:
    parts: list[object] = ["sample"]
    for name, triple in (("pos", sample.pos_ned), ("v", sample.v_ned), ("a", sample.a_ned)):
        parts += [name, *triple] if triple is not None else []
    for name, angle in (("yaw", sample.yaw_rad), ("rate", sample.yaw_rate_rad_s)):
        parts += [name, angle] if angle is not None else []
    return " ".join(map(str, parts))
