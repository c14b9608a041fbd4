"""Tables whose rows are short flights: a situation, what happens then, and what the gate does.

    # What we fly is held when its operator quits, and may be left when the hold is seen.
    {MOVING, HOVERING} | quits      | HOLDING OURS, sends HOLD, it aborted OPERATOR_LOST; unsettled
                       | shows HOLD | =; settled

A comment names the rows that follow it.  A row goes on with lines that begin with `|`, a cell with
lines that begin with `...`.  `{a, b}` stands for one row with each (the same group for the same
word), `<a, b>` for one row with each, in step with all other `<...>` of the row; the names of
`SETS` stand for several, and `-a` takes one out.

A situation may begin with `settings:` (an autopilot, `lab`, keys of the policy, severities of
conditions).  Then it is a state with a request under way, which is called `it`, or steps (`Flight`
has them).  A reaction is the state and the control (`=`: both as before), the commands that were
sent, and what became of the requests: nothing else was sent and decided.  `$` is the request that
was made last.  Behind `;` stands what is looked at besides.  Places are the operator's (east,
north, up).
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from gcs.gate.states import FlightMode
from tests.unit.gate.flight_words import MOTION, Flight, Step
from tests.unit.gate.situations import (
    AIRBORNE,
    FLIGHT,
    GUIDED_STATES,
    HEARD,
    STATES,
    VERIFIED,
)

SETS: dict[str, list[str]] = {
    "AIRBORNE": [state.name for state in AIRBORNE],
    "FLIGHT": [state.name for state in FLIGHT],
    "GUIDED_STATES": [state.name for state in GUIDED_STATES],
    "HEARD": [state.name for state in HEARD],
    "STATES": [state.name for state in STATES],
    "VERIFIED": [state.name for state in VERIFIED],
    "MODES": [mode.name for mode in FlightMode],
    "MOTION": [*MOTION],
}


@dataclass(frozen=True, slots=True)
class Row:
    says: str
    situation: str
    events: tuple[tuple[str, str], ...]
    steps: Mapping[str, Step]

    def __str__(self) -> str:
        return " | ".join((f"{self.says}: {self.situation}", *(event for event, _ in self.events)))

    def fly(self) -> None:
        flight = Flight.begun(self.situation, self.steps)
        for event, reaction in self.events:
            told = flight.told(event, reaction)
            assert told == reaction.replace("$", flight.asked), f"{self}\nat {event!r}"


def rows(table: str, *steps: Step) -> list[Row]:
    """All rows of the table; `steps` are words of its own (`-` for `_`), called with the flight and
    the words behind them."""
    own = {step.__name__.replace("_", "-"): step for step in steps}
    found: list[Row] = []
    says = ""
    for line in _lines(table):
        if line.startswith("#"):
            says = line.removeprefix("#").strip().rstrip(".")
            continue
        for one in _alternatives(line):
            situation, *columns = (column.strip() for column in one.split("|"))
            assert columns, line
            pairs = tuple(zip(columns[::2], columns[1::2], strict=True))
            found.append(Row(says, situation, pairs, own))
    return found


def _lines(table: str) -> Iterator[str]:
    """Comments and rows, each as one line."""
    joined = re.sub(r"\n *(?:# )?\.\.\.", "", re.sub(r"\n *\|", " |", table))
    return (" ".join(line.split()) for line in joined.splitlines() if line.strip())


def _words(group: str) -> list[str]:
    words: list[str] = []
    for word in re.split(r",\s*|\s+(?=-)", group.strip()):
        if word.startswith("-") and word[1:] in words:
            words.remove(word[1:])
        else:
            words += SETS.get(word, [word])
    return words


def _alternatives(line: str) -> Iterator[str]:
    """`line` once for each choice of its groups."""
    parts = re.split(r"(\{[^}]*\}|<[^>]*>)", line)
    chosen = list(dict.fromkeys(part for part in parts if part.startswith("{")))
    steps = {part: _words(part[1:-1]) for part in parts if part.startswith("<")}
    for step in range(max(map(len, steps.values()), default=1)):
        for choice in itertools.product(*(_words(group[1:-1]) for group in chosen)):
            words = dict(zip(chosen, choice, strict=True))
            words |= {group: of[step] for group, of in steps.items()}
            yield "".join(words.get(part, part) for part in parts)
