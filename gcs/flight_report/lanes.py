"""What a state was and when: the rows of the state timeline."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

MAX_CHANGES = 4_000
"""A lane that changes more often is cut off, and says so."""


class Span(NamedTuple):
    """A state from `start_s` to `end_s`."""

    start_s: float
    end_s: float
    value: str


@dataclass(slots=True)
class Lane:
    """The changes of one state, in time order."""

    title: str
    changes: list[tuple[float, str]] = field(default_factory=list)
    cut_off: bool = False

    def add(self, t_s: float, value: str) -> None:
        if self.changes and self.changes[-1][1] == value:
            return
        if len(self.changes) >= MAX_CHANGES:
            self.cut_off = True
            return
        self.changes.append((t_s, value))

    def spans(self, end_s: float) -> list[Span]:
        """Each state until the next; the last until `end_s`."""
        ends = [t_s for t_s, _ in self.changes[1:]] + [end_s]
        return [
            Span(start_s, max(start_s, next_s), value)
            for (start_s, value), next_s in zip(self.changes, ends, strict=True)
        ]

    def debounced(self, end_s: float, shortest_s: float) -> list[Span]:
        """Spans of at least `shortest_s`: a shorter one is drawn as the state before it.

        Neighbours that are then the same are one.
        """
        kept: list[Span] = []
        for span in self.spans(end_s):
            brief = span.end_s - span.start_s < shortest_s
            value = kept[-1].value if kept and brief else span.value
            if kept and kept[-1].value == value:
                kept[-1] = kept[-1]._replace(end_s=span.end_s)
            else:
                kept.append(span)
        return kept
