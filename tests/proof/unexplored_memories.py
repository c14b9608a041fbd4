"""What a walk left out: memories that it reached and did not go on from.

A walk goes on from the first memory of each situation.  Every other memory that it reaches in the
same situation should lead to the same situations and break nothing; whether it does depends on
`situation.py`.  Here letters are taken in some of those others too, and whatever new they reach
is walked to its end.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, cast

import numpy as np

from tests.proof.columns import Columns, Numbers
from tests.proof.letters import Letters
from tests.proof.walk import Begun, Judge, Walk

BATCH: Final = 8_192
"""The situations of so many memories at once."""


class LeftOut:
    """A sample of what a walk that is over, `met`, left out.

    `dice` chooses the memories.  Each is reached by a real way from the starts, so a fault that is
    met from it has a trace like any other.
    """

    def __init__(
        self, letters: Letters, judge: Judge, met: Begun, dice: np.random.Generator
    ) -> None:
        self._letters, self._judge, self._dice = letters, judge, dice
        self._met = met
        self._nodes, self._edge_to = met.nodes, list(met.edges)
        self._situations = np.unique(self._situations_of(met.nodes))

    @property
    def count(self) -> int:
        """How many memories were chosen."""
        return len(self._edge_to) - len(self._met.edges)

    def walk(self) -> Walk:
        """Goes on from the chosen memories, and from each new situation that they lead to."""
        return Walk(
            self._letters,
            self._judge,
            Begun(self._nodes, self._edge_to, len(self._met.edges)),
        )

    def choose(self, nodes: int, memories: int) -> None:
        """Every letter in so many of the nodes; so many of the memories that are left out there."""
        first = self._dice.choice(len(self._met.edges), nodes, replace=False)
        self._choose_after(np.sort(first), memories)

    def choose_farther(self, memories: int) -> None:
        """As many again, left out on the way on from those that were chosen last."""
        chosen = np.arange(len(self._edge_to) - self._last, len(self._edge_to))
        self._choose_after(chosen, memories)

    def _choose_after(self, nodes: Numbers, memories: int) -> None:
        found = list(self._left_out(nodes))
        after = np.concatenate([columns for columns, _ in found], axis=1)
        edges = np.concatenate([numbers for _, numbers in found])
        in_turn = np.argsort(edges)  # the same sample, in whatever order the trees were learnt
        after, edges = after[:, in_turn], edges[in_turn]
        _, distinct = np.unique(after, axis=1, return_index=True)
        chosen = self._dice.permutation(np.sort(distinct))[:memories]
        self._nodes = np.concatenate([self._nodes, after[:, chosen]], axis=1)
        self._edge_to += edges[chosen].tolist()
        self._last = len(chosen)

    def _left_out(self, nodes: Numbers) -> Iterator[tuple[Columns, Numbers]]:
        """What the letters lead to from these nodes, where that is no new situation, and by which
        edge."""
        before = self._nodes[:, nodes]
        one_by_one = before.T.tolist()
        for number, name in enumerate(self._letters.names):
            reached, edges = [], []
            for outcome, rows in self._letters.split(name, before, one_by_one):
                after = before[:, rows]
                outcome.write(before, rows, after)
                reached.append(after)
                edges.append(nodes[rows] * len(self._letters.names) + number)
            if reached:
                every = np.concatenate(reached, axis=1)
                old = self._is_met(self._situations_of(every))
                yield every[:, old], np.concatenate(edges)[old]

    def _is_met(self, situations: Numbers) -> Numbers:
        at = np.searchsorted(self._situations, situations)
        at[at == len(self._situations)] = 0
        return cast(Numbers, self._situations[at] == situations)

    def _situations_of(self, columns: Columns) -> Numbers:
        parts = range(0, columns.shape[1], BATCH)
        return np.concatenate(
            [self._judge.situations(columns[:, begin : begin + BATCH]) for begin in parts]
        )
