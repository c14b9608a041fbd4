"""Alterations of the gate's table, made on its values, wherever and however they are written.

Every entry (state, event) is replaced once: what does something by what does nothing (a request:
by a refusal with another code), what does nothing by the next cell of that event that does
something whatever is the case (by a hold where there is none).

Every different cell is altered once for each part of each of its branches, in all entries that
share it: a branch, a guard, a check, an action, the outcome or the next state is dropped; a code,
an outcome or a reply becomes another.

Entries of a state that no branch leads to are left alone: nothing could notice.  So are cells
that cannot happen.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final, TypeAlias, TypeVar

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.actions import Action
from gcs.gate.machine.events import REQUESTS, Event
from gcs.gate.machine.rows.row import STAY, Branch, Cell
from gcs.gate.machine.sentences import ENDED, REFUSED
from gcs.gate.machine.step_context import End, Reply
from gcs.gate.refusal import Code
from gcs.gate.states import State
from tests.mutants.mutant import Kind

Item = TypeVar("Item")

Entry: TypeAlias = tuple[State, Event]
Table: TypeAlias = Mapping[Entry, Cell]

NOTHING: Final[Cell] = (Branch(),)
HOLDS: Final[Cell] = (Branch(do=(Action.HOLD,), to=State.HOLDING),)

OTHER_KIND: Final = {
    OutcomeKind.COMPLETE: OutcomeKind.ABORTED,
    OutcomeKind.ABORTED: OutcomeKind.TIMED_OUT,
    OutcomeKind.SUPERSEDED: OutcomeKind.ABORTED,
    OutcomeKind.TIMED_OUT: OutcomeKind.ABORTED,
    OutcomeKind.TAKEN_OVER: OutcomeKind.ABORTED,
}
OTHER_REPLY: Final = {
    Reply.ACCEPTED: Reply.DONE,
    Reply.DONE: Reply.ACCEPTED,
    Reply.PENDING: Reply.DONE,
}


@dataclass(frozen=True, slots=True)
class TableAlteration:
    """`cells` are the names of the entries that differ; `apply` makes the altered table."""

    kind: Kind
    name: str
    before: str
    after: str
    cells: tuple[str, ...]
    apply: Callable[[Table], Table]


def name_of(entry: Entry) -> str:
    return f"{entry[0].name} / {entry[1].value}"


def alterations(table: Table) -> Iterator[TableAlteration]:
    """Entries first, then the parts of each different cell, in the table's own order."""
    reached = _reached(table)
    entries = [entry for entry, cell in table.items() if cell and entry[0] in reached]
    yield from _entries(table, entries)
    yield from _parts(table, entries)


def _reached(table: Table) -> frozenset[State]:
    """The states that some branch leads to, and the one the gate begins in."""
    ways = {branch.to for cell in table.values() for branch in cell}
    return frozenset({State.NO_VEHICLE} | {to for to in ways if isinstance(to, State)})


# ---------------------------------------------------------------------------------- entries


def _entries(table: Table, entries: list[Entry]) -> Iterator[TableAlteration]:
    for entry in entries:
        before, after = table[entry], _instead(table, entry)
        yield TableAlteration(
            Kind.CELL,
            name_of(entry),
            _cell_text(before),
            _cell_text(after),
            (name_of(entry),),
            _changed({entry: after}),
        )


def _instead(table: Table, entry: Entry) -> Cell:
    state, event = entry
    cell = table[entry]
    if cell != NOTHING:
        codes = {branch.refuse for branch in cell}
        other = next(code for code in REFUSED if code not in codes)
        return (Branch(refuse=other),) if event in REQUESTS else NOTHING
    states = list(State)
    at = states.index(state)
    order = [table[other, event] for other in (*states[at + 1 :], *states[:at])]
    return next((c for c in order if c and c[-1] != NOTHING[0]), HOLDS)


# ------------------------------------------------------------------------------------ parts


def _parts(table: Table, entries: list[Entry]) -> Iterator[TableAlteration]:
    shared: dict[Cell, list[Entry]] = {}
    for entry in entries:
        shared.setdefault(table[entry], []).append(entry)
    for cell, sharers in shared.items():
        more = f" and {len(sharers) - 1} more" if len(sharers) > 1 else ""
        for i, branch in enumerate(cell):
            for before, after, other in _other_branches(branch, last=i == len(cell) - 1):
                changed = (*cell[:i], *other, *cell[i + 1 :])
                yield TableAlteration(
                    Kind.BRANCH,
                    f"{name_of(sharers[0])}{more}, branch {i + 1}",
                    before,
                    after,
                    tuple(map(name_of, sharers)),
                    _changed(dict.fromkeys(sharers, changed)),
                )


def _other_branches(branch: Branch, *, last: bool) -> Iterator[tuple[str, str, tuple[Branch, ...]]]:
    """What is altered, to what, and the branches that stand in the place of `branch`."""
    if not last:
        yield f"if {' and '.join(branch.when)}", "no such branch", ()
    for i, guard in enumerate(branch.when):
        yield f"if {guard}", "always", (replace(branch, when=_drop(branch.when, i)),)
    for i, check in enumerate(branch.needs):
        yield f"needs {check}", "needs nothing", (replace(branch, needs=_drop(branch.needs, i)),)
    for i, do in enumerate(branch.do):
        yield f"do {do}", "do nothing", (replace(branch, do=_drop(branch.do, i)),)
    if branch.to is not STAY:
        name = branch.to.name
        yield f"-> {name}", "-> stay", (replace(branch, to=STAY),)
    if branch.refuse is not None:
        code = _next(branch.refuse, tuple(REFUSED))
        yield f"refused {branch.refuse}", f"refused {code}", (replace(branch, refuse=code),)
    if branch.reply is not Reply.NONE:
        reply = OTHER_REPLY[branch.reply]
        yield branch.reply.value, reply.value, (replace(branch, reply=reply),)
    if branch.ends is not None:
        for after, ends in _other_ends(branch.ends):
            yield _end_text(branch.ends), after, (replace(branch, ends=ends),)


def _other_ends(end: End) -> Iterator[tuple[str, End | None]]:
    yield "the request goes on", None
    kind = replace(end, kind=OTHER_KIND[end.kind])
    yield _end_text(kind), kind
    if end.code is not None:
        code = replace(end, code=_next(end.code, tuple(ENDED)))
        yield _end_text(code), code


def _next(code: Code, codes: tuple[Code, ...]) -> Code:
    return codes[(codes.index(code) + 1) % len(codes)] if code in codes else codes[0]


def _drop(items: tuple[Item, ...], i: int) -> tuple[Item, ...]:
    return (*items[:i], *items[i + 1 :])


def _end_text(end: End) -> str:
    code = "as judged" if end.judged else end.code or ""
    return f"request {end.kind} {code}".strip()


def _cell_text(cell: Cell) -> str:
    """A cell of one branch in words, of several their number."""
    if len(cell) > 1:
        return f"{len(cell)} branches"
    (branch,) = cell
    words = [f"refused {branch.refuse}" if branch.refuse else "", "; ".join(branch.do)]
    return " ".join(filter(None, words)) or ("nothing" if cell == NOTHING else "1 branch")


def _changed(cells: Mapping[Entry, Cell]) -> Callable[[Table], Table]:
    return lambda table: {**table, **cells}
