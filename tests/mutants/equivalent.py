"""Mutants that change nothing that can be seen from outside, each with the reason.

Both lists are by target.  An entry that names no mutant is an error of the run, and so is an
equivalent mutant that a test kills.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tests.unit.gate import unreached as gate_table

EQUIVALENT: Final[Mapping[str, Mapping[str, str]]] = {"gate": {}}
"""Reasons by the mutant's key."""

UNREACHED: Final[Mapping[str, Mapping[str, str]]] = {
    "gate": {
        entry: unreached.why for unreached in gate_table.UNREACHED for entry in unreached.entries
    }
}
"""Reasons by the name that the table's alterations give to an entry."""
