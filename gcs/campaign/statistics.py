"""What all flights together say: how often, how near, and what it depends on."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from statistics import NormalDist
from typing import Final

import msgspec

from gcs.campaign.case import MEASURES, Row
from gcs.campaign.plan import Choice, Plan

CONFIDENCE: Final = 0.95
QUANTILES: Final = (0.0, 0.05, 0.5, 0.95, 1.0)
WORST_LISTED: Final = 12
LEAST_FOR_RANKS: Final = 8
"""With fewer flights a rank correlation says nothing."""


class Share(msgspec.Struct, frozen=True):
    """How many of how many, and between which bounds the probability lies (Wilson, 95 %)."""

    hits: int
    of: int
    low: float
    high: float


class Cell(msgspec.Struct, frozen=True):
    """The flights of one combination of choices; `worst` is the number of the nearest one."""

    cell: str
    breaches: Share
    failures: int
    closest_m: float | None
    worst: int


class Spread(msgspec.Struct, frozen=True):
    """Quantiles of a measure: 0, 5, 50, 95 and 100 %."""

    measure: str
    unit: str
    quantiles: tuple[float, ...]


class Dependence(msgspec.Struct, frozen=True):
    """Spearman's rank correlation of an axis of numbers with the closest approach: negative, more
    of it comes nearer to the fence."""

    axis: str
    rank_correlation: float


class Level(msgspec.Struct, frozen=True):
    """The flights with one value of an axis that is chosen from."""

    axis: str
    value: str
    breaches: Share
    median_m: float | None


class Summary(msgspec.Struct, frozen=True):
    """What `gcs campaign run --json` prints."""

    name: str
    plan: str
    sample: str
    planned: int
    flights: int
    breaches: Share
    failures: int
    refused: int
    critical: int
    closest_m: float | None
    first_breach: int | None
    """The number of the first flight that left its fence, by which a search is measured."""
    outcomes: dict[str, int]
    cells: list[Cell]
    spreads: list[Spread]
    dependences: list[Dependence]
    levels: list[Level]
    worst: list[int]
    rows_sha256: str
    differing: list[int] = []
    """Kept flights that became another row when they were flown again, which none should."""


def wilson(hits: int, of: int, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Wilson's score interval of a probability (E. B. Wilson, 1927), without a correction for
    continuity; 0 to 1 where nothing was tried."""
    if of == 0:
        return (0.0, 1.0)
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    share, scale = hits / of, 1.0 + z * z / of
    middle = (share + z * z / (2 * of)) / scale
    half = z / scale * math.sqrt(share * (1.0 - share) / of + z * z / (4 * of * of))
    low, high = max(0.0, middle - half), min(1.0, middle + half)
    return (0.0 if hits == 0 else low, 1.0 if hits == of else high)


def rank_correlation(xs: Sequence[float], ys: Sequence[float]) -> float | None:
    """Spearman's: Pearson's of the ranks, equal values sharing theirs.  None where either does not
    change at all."""
    a, b = _ranks(xs), _ranks(ys)
    mean = (len(a) + 1) / 2
    across = sum((x - mean) * (y - mean) for x, y in zip(a, b, strict=True))
    square = sum((x - mean) ** 2 for x in a) * sum((y - mean) ** 2 for y in b)
    return across / math.sqrt(square) if square > 0.0 else None


def _ranks(values: Sequence[float]) -> list[float]:
    order = sorted(range(len(values)), key=values.__getitem__)
    ranks = [0.0] * len(values)
    begin = 0
    while begin < len(order):
        end = begin
        while end < len(order) and values[order[end]] == values[order[begin]]:
            end += 1
        for place in order[begin:end]:
            ranks[place] = (begin + 1 + end) / 2
        begin = end
    return ranks


def quantile(ordered: Sequence[float], share: float) -> float:
    """Linear between the values."""
    place = share * (len(ordered) - 1)
    low = int(place)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (place - low) * (ordered[high] - ordered[low])


def nearness(row: Row) -> tuple[float, int]:
    """The nearest first; who never flew comes last."""
    return (math.inf if row.closest_m is None else row.closest_m, row.id)


def summary(plan: Plan, rows: Sequence[Row], sha256: str) -> Summary:
    """Of rows in the order of their numbers."""
    by_nearness = sorted(rows, key=nearness)
    return Summary(
        name=plan.name,
        plan=plan.digest,
        sample=plan.sample,
        planned=plan.flights,
        flights=len(rows),
        breaches=_share(rows),
        failures=sum(row.failed for row in rows),
        refused=sum(row.refused for row in rows),
        critical=sum(row.critical > 0 for row in rows),
        closest_m=by_nearness[0].closest_m if by_nearness else None,
        first_breach=next((row.id for row in rows if row.breach), None),
        outcomes=dict(sorted(Counter(row.outcome for row in rows).items())),
        cells=_cells(rows),
        spreads=list(_spreads(rows)),
        dependences=_dependences(plan, rows),
        levels=_levels(plan, rows),
        worst=[row.id for row in by_nearness[:WORST_LISTED] if row.closest_m is not None],
        rows_sha256=sha256,
    )


def _share(rows: Sequence[Row]) -> Share:
    hits = sum(row.breach for row in rows)
    return Share(hits, len(rows), *wilson(hits, len(rows)))


def _grouped(rows: Iterable[Row], key: Callable[[Row], str]) -> dict[str, list[Row]]:
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def _cells(rows: Sequence[Row]) -> list[Cell]:
    found = []
    for name, group in sorted(_grouped(rows, lambda row: row.cell).items()):
        worst = min(group, key=nearness)
        failures = sum(row.failed for row in group)
        found.append(Cell(name, _share(group), failures, worst.closest_m, worst.id))
    return found


def _spreads(rows: Sequence[Row]) -> Iterable[Spread]:
    flown = [row for row in rows if row.closest_m is not None]
    for name, unit in MEASURES.items():
        ordered = sorted(v for row in flown if (v := getattr(row, name)) is not None)
        if ordered:
            quantiles = tuple(quantile(ordered, share) for share in QUANTILES)
            yield Spread(name, unit, quantiles)


def _dependences(plan: Plan, rows: Sequence[Row]) -> list[Dependence]:
    """The strongest first."""
    flown = [row for row in rows if row.closest_m is not None]
    if len(flown) < LEAST_FOR_RANKS:
        return []
    near = [row.closest_m or 0.0 for row in flown]
    found = []
    for axis in plan.axes:
        values = [row.inputs[axis.name] for row in flown]
        numbers = [float(value) for value in values if isinstance(value, int | float)]
        rho = rank_correlation(numbers, near) if len(numbers) == len(near) else None
        if rho is not None:
            found.append(Dependence(axis.name, rho))
    return sorted(found, key=lambda each: -abs(each.rank_correlation))


def _levels(plan: Plan, rows: Sequence[Row]) -> list[Level]:
    found = []
    for axis in plan.axes:
        if not isinstance(axis, Choice) or len(axis.values) < 2:
            continue
        groups = _grouped(rows, lambda row, name=axis.name: str(row.inputs[name]))  # type: ignore[misc]
        for value in map(str, axis.values):
            group = groups.get(value, [])
            near = sorted(row.closest_m for row in group if row.closest_m is not None)
            middle = quantile(near, 0.5) if near else None
            found.append(Level(axis.name, value, _share(group), middle))
    return found
