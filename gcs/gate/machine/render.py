"""The table, printed from the table: text for people, DOT for drawings.

Nothing here knows a state or an event by name; a table that changes prints differently, which
a golden copy in the tests notices.
"""

from __future__ import annotations

from collections.abc import Iterator

from gcs.gate.machine.events import REQUESTS, Event
from gcs.gate.machine.rules import BACK, BACK_STATES, COLUMNS, STAY, Answer, Branch, Cell
from gcs.gate.machine.table import STREAMS, TABLE, Streams, Table
from gcs.gate.states import State

IMPOSSIBLE = "cannot happen"


def text(table: Table = TABLE) -> str:
    """Every cell, one state after the other; cells that do nothing are named in one line."""
    lines = [
        f"{len(COLUMNS)} states x {len(Event)} events, {len(table)} cells.",
        "The first line of a cell whose conditions hold is taken; after -> is the next state.",
    ]
    for state in COLUMNS:
        lines += ["", *_state(table, state)]
    return "\n".join(lines) + "\n"


def _state(table: Table, state: State) -> Iterator[str]:
    yield f"{state.name} = {state.value}    streams {STREAMS[state].value}"
    quiet = [event for event in Event if _is_quiet(table[state, event])]
    never = [event for event in Event if not table[state, event]]
    for event in Event:
        if event not in quiet and event not in never:
            yield from _cell(event, table[state, event])
    for word, events in (("changes nothing", quiet), (IMPOSSIBLE, never)):
        if events:
            yield from _wrapped(f"  {word}: ", [event.value for event in events])


def _is_quiet(cell: Cell) -> bool:
    return cell == (Branch(),)


def _cell(event: Event, cell: Cell) -> Iterator[str]:
    label = event.value
    for branch in cell:
        yield f"  {label:<18} {describe(branch)}"
        label = ""


def describe(branch: Branch) -> str:
    """One line: conditions, answer, outcome, actions, next state."""
    parts: list[str] = []
    if branch.when:
        parts.append(f"if {' and '.join(branch.when)}:")
    if branch.needs:
        parts.append(f"needs [{'; '.join(branch.needs)}]")
    if branch.refuse is not None:
        parts.append(f"refused {branch.refuse}")
    if branch.answer is not Answer.NONE:
        parts.append(branch.answer.value)
    if branch.ends is not None:
        why = "" if branch.ends.code is None else f" {branch.ends.code}"
        why = " as judged" if branch.ends.judged else why
        parts.append(f"request {branch.ends.kind}{why}")
    if branch.do:
        parts.append(f"do [{'; '.join(branch.do)}]")
    if branch.to is BACK:
        parts.append("-> back to what was interrupted")
    elif isinstance(branch.to, State):
        parts.append(f"-> {branch.to.name}")
    return " ".join(parts) if parts else "nothing"


def _wrapped(head: str, words: list[str], width: int = 98) -> Iterator[str]:
    line = head
    for i, word in enumerate(words):
        piece = word + ("," if i + 1 < len(words) else "")
        if len(line) + len(piece) > width:
            yield line.rstrip()
            line = "      "
        line += piece + " "
    yield line.rstrip()


def dot(table: Table = TABLE) -> str:
    """A directed graph: an edge a pair of states, labelled with the events that lead there."""
    edges: dict[tuple[State, State], list[Event]] = {}
    for (state, event), cell in table.items():
        for branch in cell:
            for after in _targets(branch):
                events = edges.setdefault((state, after), [])
                if after is not state and event not in events:
                    events.append(event)
    lines = [
        "digraph gate {",
        "  rankdir=LR;",
        '  node [shape=box, style=rounded, fontname="Helvetica"];',
        '  edge [fontname="Helvetica", fontsize=9];',
    ]
    for state in COLUMNS:
        heavy = ", penwidth=2" if STREAMS[state] is not Streams.NOTHING else ""
        lines.append(f'  {state.name} [label="{state.name}\\n{state.value}"{heavy}];')
    for (before, after), events in sorted(edges.items()):
        if events:
            asked = all(event in REQUESTS for event in events)
            style = "" if asked else ", style=dashed"
            label = "\\n".join(event.value for event in events)
            lines.append(f'  {before.name} -> {after.name} [label="{label}"{style}];')
    lines += ["}", ""]
    return "\n".join(lines)


def _targets(branch: Branch) -> tuple[State, ...]:
    if branch.to is STAY:
        return ()
    if branch.to is BACK:
        return BACK_STATES
    assert isinstance(branch.to, State)
    return (branch.to,)
