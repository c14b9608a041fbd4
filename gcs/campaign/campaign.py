"""A campaign from its first flight to its kept records; nothing is flown twice but what is kept."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, Protocol

from gcs.campaign.case import Row, Value
from gcs.campaign.engine import Flight, Flown
from gcs.campaign.plan import Plan
from gcs.campaign.sampling import places_of
from gcs.campaign.search import Search
from gcs.campaign.statistics import nearness
from gcs.campaign.store import Store

PART_ROWS: Final = 100
PART_S: Final = 10.0
"""A part is written after so many flights, or so much time: more is not lost."""


class Engine(Protocol):
    """Flies; `gcs.campaign.engine` is one on Dask."""

    def __call__(self, flights: Iterable[Flight], *, recorded: bool = False) -> Iterator[Flown]: ...


@dataclass(slots=True)
class Campaign:
    """`tell` is called with how many flights are done, after each."""

    plan: Plan
    store: Store
    fly: Engine
    now_s: Callable[[], float]
    tell: Callable[[int], None]

    def run(self) -> list[Row]:
        """All rows, by number."""
        known = {row.id: row for row in self.store.rows()}
        self.tell(len(known))
        if self.plan.sample == "search":
            self._search(known)
        else:
            places = places_of(self.plan)
            left = (n for n in range(self.plan.flights) if n not in known)
            self._fly(((n, self._inputs(n, places(n))) for n in left), known)
        return [known[number] for number in sorted(known)]

    def keep(self, rows: Sequence[Row]) -> list[int]:
        """Fly these again with the recorder on; the numbers of those that became another row."""
        of = {row.id: row for row in rows}
        left = [row for row in rows if not self.store.record(row.id).exists()]
        differing = []
        for row, data in self.fly(((each.id, each.inputs) for each in left), recorded=True):
            if row != of[row.id]:
                differing.append(row.id)
            if data:
                self.store.record(row.id).write_bytes(data)
        return sorted(differing)

    def _search(self, known: dict[int, Row]) -> None:
        search, number = Search(self.plan), 0
        while generation := search.ask():
            flights = [(number + n, self._inputs(number + n, p)) for n, p in enumerate(generation)]
            number += len(generation)
            self._fly((each for each in flights if each[0] not in known), known)
            search.tell([known[each[0]] for each in flights])

    def _inputs(self, number: int, places: Sequence[float]) -> dict[str, Value]:
        return self.plan.case(number, self.plan.inputs(places)).inputs

    def _fly(self, flights: Iterable[Flight], known: dict[int, Row]) -> None:
        part: list[Row] = []
        began_s = self.now_s()
        try:
            for row, _ in self.fly(flights):
                part.append(row)
                known[row.id] = row
                self.tell(len(known))
                if len(part) >= PART_ROWS or self.now_s() - began_s >= PART_S:
                    self.store.append(self.plan, part)
                    part, began_s = [], self.now_s()
        finally:
            if part:
                self.store.append(self.plan, part)


def kept(rows: Sequence[Row], most: int) -> list[Row]:
    """Every breach and failure, and the worst of each cell: the nearest first, at most so many."""
    worst: dict[str, Row] = {}
    for row in sorted(rows, key=nearness):
        worst.setdefault(row.cell, row)
    chosen = {row.id: row for row in worst.values() if row.closest_m is not None}
    chosen |= {row.id: row for row in rows if row.breach or row.failed}
    return sorted(chosen.values(), key=nearness)[:most]
