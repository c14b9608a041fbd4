"""Follows what comes closest to a breach: a few flights everywhere, then CMA-ES from the worst.

The choices of the worst flight stay as they are while its ranges are searched; once that has
converged, it goes on from the worst flight of another combination of choices.  What is asked for
next depends on the rows of the generations before alone, so a search that goes on, or has more
workers, flies the same flights.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from gcs.campaign.case import Row
from gcs.campaign.plan import Plan, Range
from gcs.campaign.sampling import Places, latin
from gcs.campaign.statistics import nearness

if TYPE_CHECKING:
    from cma import CMAEvolutionStrategy

FIRST_SHARE: Final = 0.2
FIRST_LEAST: Final = 10
STEP: Final = 0.2
"""Of the first generation, as a share of each range."""
CONVERGED: Final = 0.01
NOT_FLOWN_M: Final = 1e6
"""What never flew is as far away as this."""


class Search:
    """`ask` for a generation's places, `tell` its rows, until `plan.flights` were asked for."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._ranges = [n for n, axis in enumerate(plan.axes) if isinstance(axis, Range)]
        self._asked = 0
        self._flown: list[tuple[Places, Row]] = []
        self._pending: list[Places] = []
        self._engine: CMAEvolutionStrategy | None = None
        self._from: Places = []
        self._started: set[str] = set()

    def ask(self) -> list[Places]:
        """Empty where all were asked for."""
        left = self._plan.flights - self._asked
        if not self._flown:
            first = max(FIRST_LEAST, round(FIRST_SHARE * self._plan.flights))
            wanted = self._everywhere(min(first, left), 0)
        elif not self._ranges:
            wanted = self._everywhere(left, 1)
        else:
            wanted = self._followed()
        self._pending = wanted[:left]
        self._asked += len(self._pending)
        return self._pending

    def tell(self, rows: Sequence[Row]) -> None:
        """The rows of what was asked for last, in that order."""
        self._flown += zip(self._pending, rows, strict=True)
        engine = self._engine
        if engine is not None and len(rows) == engine.popsize:
            places = [[place[n] for n in self._ranges] for place in self._pending]
            engine.tell(places, [_score(row) for row in rows])
            if engine.stop():
                self._engine = None

    def _everywhere(self, count: int, part: int) -> list[Places]:
        seed = self._plan.seed
        columns = [latin(seed, f"{axis.name} {part}", count) for axis in self._plan.axes]
        return [list(place) for place in zip(*columns, strict=True)]

    def _followed(self) -> list[Places]:
        if self._engine is None:
            self._engine = self._begun()
        wanted = []
        for found in self._engine.ask():
            place = list(self._from)
            for n, value in zip(self._ranges, found, strict=True):
                place[n] = float(value)
            wanted.append(place)
        return wanted

    def _begun(self) -> CMAEvolutionStrategy:
        """From the worst flight of a combination of choices that was not followed yet, or else from
        the worst of all."""
        ordered = sorted(self._flown, key=lambda each: nearness(each[1]))
        fresh = (each for each in ordered if each[1].cell not in self._started)
        places, row = next(fresh, ordered[0])
        self._started.add(row.cell)
        self._from = places
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what it could plot
            import cma
        options = {
            "bounds": [0.0, 1.0],
            "seed": self._plan.seed * 1_000 + len(self._started) + 1,
            "tolx": CONVERGED,
            "verbose": -9,
        }
        return cma.CMAEvolutionStrategy([places[n] for n in self._ranges], STEP, options)


def _score(row: Row) -> float:
    closest_m = row.closest_m
    return NOT_FLOWN_M if closest_m is None or not math.isfinite(closest_m) else closest_m
