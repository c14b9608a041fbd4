"""What became of the mutants, for people and for programs."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from tests.mutants.mutant import Fate, Mutant, Result

KILLED_LEAST = 0.95


@dataclass(frozen=True, slots=True)
class Report:
    """`judged` are the equivalent mutants by key; `wrong` what is wrong with the lists of them."""

    all_mutants: int
    results: Sequence[Result]
    judged: Mapping[str, str]
    wrong: Sequence[str]
    wall_s: float

    @classmethod
    def of(
        cls,
        mutants: Sequence[Mutant],
        results: Sequence[Result],
        equivalent: Mapping[str, str],
        unreached: Mapping[str, str],
        wall_s: float,
    ) -> Report:
        place = {mutant.key: i for i, mutant in enumerate(mutants)}
        ordered = sorted(results, key=lambda result: place[result.mutant.key])
        never = [m for m in mutants if m.cells and all(cell in unreached for cell in m.cells)]
        judged = {mutant.key: unreached[mutant.cells[0]] for mutant in never} | dict(equivalent)
        known = {cell for mutant in mutants for cell in mutant.cells}
        dead = {result.mutant.key: result.by for result in results if result.dead}
        wrong = [f"names no mutant: {key}" for key in equivalent if key not in place]
        wrong += [f"names no entry of a table: {cell}" for cell in unreached if cell not in known]
        wrong += [f"is killed by {dead[key]}: {key}" for key in equivalent if key in dead]
        return cls(len(mutants), ordered, judged, wrong, wall_s)

    @property
    def survivors(self) -> list[Result]:
        return [r for r in self.results if not r.dead and r.mutant.key not in self.judged]

    @property
    def equivalent(self) -> list[Result]:
        return [r for r in self.results if not r.dead and r.mutant.key in self.judged]

    @property
    def killed(self) -> int:
        return sum(result.dead for result in self.results)

    @property
    def share(self) -> float:
        """Killed, of those that are not equivalent."""
        return 1.0 - len(self.survivors) / max(1, len(self.results) - len(self.equivalent))

    @property
    def passed(self) -> bool:
        return self.share >= KILLED_LEAST and not self.wrong

    def text(self) -> str:
        lines = []
        for result in self.survivors:
            mutant = result.mutant
            lines += [
                f"{result.fate}: {mutant.where}: {mutant.kind}: {mutant.key}",
                f"    {result.ran} tests ran",
            ]
        lines += [f"equivalent.py: an entry {fault}" for fault in self.wrong]
        lines += ["", *self._counts("kind", lambda r: r.mutant.kind)]
        lines += ["", *self._counts("file", lambda r: r.mutant.file)]
        cpu_s = sum(result.cpu_s for result in self.results)
        fates = Counter(result.fate for result in self.results)
        lines += [
            "",
            f"{len(self.results)} of {self.all_mutants} mutants: "
            + ", ".join(f"{fates[fate]} {fate}" for fate in Fate)
            + f"; {len(self.equivalent)} equivalent",
            f"killed: {self.killed / max(1, len(self.results)):.1%} of all, "
            f"{self.share:.1%} of those that are not equivalent",
            f"{self.wall_s:.0f} s, {cpu_s:.0f} s of processor time, load {os.getloadavg()[0]:.1f}",
        ]
        return "\n".join(lines)

    def _counts(self, title: str, of: Callable[[Result], str]) -> list[str]:
        total, dead = Counter(map(of, self.results)), Counter(of(r) for r in self.results if r.dead)
        same = Counter(map(of, self.equivalent))
        head = f"{title:<42} {'number':>7} {'killed':>7} {'equivalent':>11}"
        return [
            head,
            *(f"{key:<42} {total[key]:>7} {dead[key]:>7} {same[key]:>11}" for key in sorted(total)),
        ]

    def json(self) -> str:
        """One object a mutant, in order."""
        return json.dumps(
            {
                "killed_of_not_equivalent": self.share,
                "wall_s": self.wall_s,
                "mutants": [
                    {
                        "key": r.mutant.key,
                        "where": r.mutant.where,
                        "kind": r.mutant.kind,
                        "fate": r.fate,
                        "by": r.by,
                        "tests": r.ran,
                        "cpu_s": round(r.cpu_s, 3),
                        "equivalent": self.judged.get(r.mutant.key),
                    }
                    for r in self.results
                ],
            },
            indent=1,
        )
