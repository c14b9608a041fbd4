"""Mutants that change nothing that can be seen from outside, each with the reason.

Both lists are by target.  An entry that names no mutant, or one that a test kills, is an error of
the run.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Unreached:
    """Entries of a table that are never read: the event does not happen in these states."""

    event: str
    states: str
    why: str

    @property
    def cells(self) -> list[str]:
        """The names that the table's alterations give to the entries."""
        return [f"{state} / {self.event}" for state in self.states.split()]


EQUIVALENT: Final[Mapping[str, Mapping[str, str]]] = {"gate": {}}
"""Reasons by the mutant's key."""

UNREACHED: Final[Mapping[str, tuple[Unreached, ...]]] = {"gate": ()}
