"""The messages of one turn, as recorded and as made again: which differ."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from itertools import zip_longest
from typing import TypeAlias

from gcs.audit.keys import without_signature
from gcs.audit.messages import FRAME_TOPIC, GARBAGE_TOPIC, INPUT_TOPIC, Stored

LOG_TOPIC = "/log"
_FACTS = re.compile(
    f"{FRAME_TOPIC}|{GARBAGE_TOPIC}|{INPUT_TOPIC}$|{LOG_TOPIC}$"
    "|/gate/decision$|/vehicle/[0-9]+/(fsa|param)$"
)
"""Topics that tell what happened; all others are drawn from these."""

Pair: TypeAlias = tuple[Stored | None, Stored | None]
"""Recorded and reproduced; None where there is none."""


@dataclass(frozen=True, slots=True)
class Scope:
    """What is compared.  Without `pictures` only what happened, and without `log` no log lines:
    these are in the format of foxglove-sdk, which is not installed everywhere.  `signed`: frames
    that were sent are signed, with a key that nobody has here."""

    pictures: bool = True
    log: bool = True
    signed: bool = False

    @property
    def all(self) -> bool:
        return self.pictures and self.log

    def of(self, messages: Sequence[Stored]) -> list[Stored]:
        if self.signed:
            messages = [without_signature(m) for m in messages]
        if self.all:
            return list(messages)
        return [m for m in messages if self._has(m.topic)]

    def _has(self, topic: str) -> bool:
        if topic == LOG_TOPIC:
            return self.log
        return self.pictures or _FACTS.match(topic) is not None


def differing(
    recorded: Sequence[Stored], reproduced: Sequence[Stored], scope: Scope, *, cut: bool
) -> list[Pair]:
    """The messages that are not the same.  Where the record is `cut`, its last ones may lack."""
    ours, theirs = scope.of(recorded), scope.of(reproduced)
    if cut:
        theirs = theirs[: len(ours)]
    if ours == theirs:
        return []
    pairs: list[Pair] = []
    matcher = SequenceMatcher(None, [_key(m) for m in ours], [_key(m) for m in theirs], False)
    for tag, i, j, k, n in matcher.get_opcodes():
        if tag != "equal":
            pairs += _paired(ours[i:j], theirs[k:n])
        elif scope.all and not pairs:
            same = zip(ours[i:j], theirs[k:n], strict=True)
            pairs += [(a, b) for a, b in same if a.log_time_ns != b.log_time_ns][:1]
    return pairs


def _key(message: Stored) -> tuple[str, bytes]:
    return message.topic, message.data


def _paired(ours: Sequence[Stored], theirs: Sequence[Stored]) -> list[Pair]:
    """Of each topic the first with the first, the second with the second."""
    pairs: list[Pair] = []
    for topic in dict.fromkeys(m.topic for m in (*ours, *theirs)):
        left = [m for m in ours if m.topic == topic]
        right = [m for m in theirs if m.topic == topic]
        pairs += zip_longest(left, right)
    return pairs
