"""A campaign's flights beside the same ones on a real autopilot: do they agree?"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import msgspec

from gcs.campaign.case import ERROR, MEASURES, STARVED, Case, Row
from gcs.campaign.simulators import RealTimeFactory
from gcs.campaign.statistics import QUANTILES, Spread, quantile


class NoneFitsError(Exception):
    """The real autopilot can fly none of the campaign's flights."""


class Pair(msgspec.Struct, frozen=True):
    """One flight, as the campaign has it and as the real autopilot flew it."""

    id: int
    task: str
    ours: Row
    real: Row


class Compared(msgspec.Struct, frozen=True):
    """What `gcs campaign beside --json` prints.

    `differences` are quantiles of what the real one has more than ours, of the flights that both
    flew.  `nearer` are the flights in which the real one came nearer to leaving the fence than
    ours, at the most by `nearer_m`.
    """

    simulator: str
    flights: int
    uncounted: list[int]
    """Their machine was too slow, or they did not come about."""
    other_outcome: list[int]
    compared: int
    ours_closest_m: float | None
    real_closest_m: float | None
    nearer: list[int]
    nearer_m: float
    breaches_ours: int
    breaches_real: int
    differences: list[Spread]
    pairs: list[Pair]

    def lines(self) -> Iterator[str]:
        """For a person."""
        left = f"{len(self.uncounted)} do not count" if self.uncounted else "all count"
        yield f"{self.flights} flights on {self.simulator}, {left}; {self.compared} compared."
        yield f"outside the fence: ours {self.breaches_ours}, real {self.breaches_real}"
        if self.ours_closest_m is not None and self.real_closest_m is not None:
            both = f"ours {self.ours_closest_m:.2f} m, real {self.real_closest_m:.2f} m"
            yield f"the nearest to leaving it: {both}"
            worst = f", by {self.nearer_m:.2f} m at the most" if self.nearer else ""
            yield f"the real one came nearer in {len(self.nearer)} of {self.compared}{worst}"
        if self.other_outcome:
            yield f"ended otherwise: {', '.join(map(str, self.other_outcome))}"
        yield f"{'real less ours':16}{'least':>9}{'5 %':>9}{'median':>9}{'95 %':>9}{'most':>9}"
        for each in self.differences:
            figures = "".join(f"{value:+9.2f}" for value in each.quantiles)
            yield f"{each.measure:16}{figures} {each.unit}"


def chosen(cases: Iterable[Case], make: RealTimeFactory, most: int) -> list[Case]:
    """At most so many of those that it can fly, spread evenly.  Raises NoneFitsError."""
    fitting, why = [], ""
    for case in cases:
        try:
            make({**case.table, "start_ns": 0}).close()
            fitting.append(case)
        except ValueError as error:
            why = str(error)
    if not fitting:
        raise NoneFitsError(f"it can fly none of them: {why}")
    count = min(most, len(fitting))
    return [fitting[place * len(fitting) // count] for place in range(count)]


def counts(row: Row) -> bool:
    """Whether it says something: the machine was fast enough, and it came about."""
    return row.outcome not in (STARVED, ERROR)


def compared(simulator: str, ours: Mapping[int, Row], real: Mapping[int, Row]) -> Compared:
    """Rows by number; those of `real` are flights of `ours`."""
    counted = [row for _, row in sorted(real.items()) if counts(row)]
    pairs = [Pair(row.id, str(row.inputs["task"]), ours[row.id], row) for row in counted]
    both = [p for p in pairs if p.ours.closest_m is not None and p.real.closest_m is not None]
    by = {p.id: _more(p, "closest_m") or 0.0 for p in both}
    return Compared(
        simulator,
        len(real),
        sorted(set(real) - {row.id for row in counted}),
        [p.id for p in pairs if p.ours.outcome != p.real.outcome],
        len(both),
        min((p.ours.closest_m for p in both if p.ours.closest_m is not None), default=None),
        min((p.real.closest_m for p in both if p.real.closest_m is not None), default=None),
        [number for number, more_m in by.items() if more_m < 0.0],
        max((-more_m for more_m in by.values() if more_m < 0.0), default=0.0),
        sum(p.ours.breach for p in both),
        sum(p.real.breach for p in both),
        list(_differences(both)),
        pairs,
    )


def _differences(pairs: Sequence[Pair]) -> Iterable[Spread]:
    for name, unit in MEASURES.items():
        found = (_more(pair, name) for pair in pairs)
        ordered = sorted(each for each in found if each is not None)
        if ordered:
            yield Spread(name, unit, tuple(quantile(ordered, share) for share in QUANTILES))


def _more(pair: Pair, measure: str) -> float | None:
    """What the real one has more; None where either has no such figure."""
    ours, real = getattr(pair.ours, measure), getattr(pair.real, measure)
    return None if ours is None or real is None else real - ours
