"""Prints the table: as text for people, and as a DOT graph for drawings.

Nothing here names a state or an event, so a table that changes prints differently; a golden copy
in the tests notices it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from gcs.gate.machine.events import REQUESTS, Event
from gcs.gate.machine.rows.row import BACK, BACK_STATES, COLUMNS, STAY, Branch, Cell
from gcs.gate.machine.step_context import Reply
from gcs.gate.machine.table import STREAMS, TABLE, Streams, Table
from gcs.gate.states import State


def text(table: Table = TABLE) -> str:
    """Every cell, one state after the other; the events that change nothing share one line."""
    lines = [
        f"{len(COLUMNS)} states x {len(Event)} events, {len(table)} cells.",
        "The first line of a cell whose conditions hold is taken; after -> is the next state.",
    ]
    for state in COLUMNS:
        lines += ["", *_state(table, state)]
    return "\n".join(lines) + "\n"


def _state(table: Table, state: State) -> Iterator[str]:
    yield f"{state.name} = {state.value}    streams {STREAMS[state].value}"
    idle = [event for event in Event if table[state, event] == (Branch(),)]
    impossible = [event for event in Event if not table[state, event]]
    for event in Event:
        if event not in idle and event not in impossible:
            yield from _cell(event, table[state, event])
    for heading, events in (("changes nothing", idle), ("cannot happen", impossible)):
        if events:
            yield from _wrapped(f"  {heading}: ", [event.value for event in events])


def short(state: State, table: Table = TABLE, among: Collection[State] = COLUMNS) -> str:
    """What leads out of one state to those `among`: its events, and what may follow, in words."""
    lines = [f"{state.name} = {state.value}    streams {STREAMS[state].value}"]
    for event in Event:
        cell = table[state, event]
        leads = [branch for branch in cell if branch.to is STAY or {*_targets(branch)} & {*among}]
        ways = list(dict.fromkeys(filter(None, map(_way, leads))))
        if ways:
            refuses = " (or refused)" if any(branch.refuse is not None for branch in cell) else ""
            lines.append(f"  {event.value:<18} {' or '.join(ways)}{refuses}")
    return "\n".join(lines) + "\n"


def _way(branch: Branch) -> str:
    """Where it leads; empty where it changes neither the state nor the goal."""
    if branch.reply is Reply.PENDING:
        return Reply.PENDING.value
    if branch.to is STAY:
        return ""
    return f"-> {branch.to.name if isinstance(branch.to, State) else 'what was interrupted'}"


def _cell(event: Event, cell: Cell) -> Iterator[str]:
    label = event.value
    for branch in cell:
        yield f"  {label:<18} {describe(branch)}"
        label = ""


def describe(branch: Branch) -> str:
    """One line: conditions, checks, refusal or reply, outcome, actions, next state."""
    parts: list[str] = []
    if branch.when:
        parts.append(f"if {' and '.join(branch.when)}:")
    if branch.needs:
        parts.append(f"needs [{'; '.join(branch.needs)}]")
    if branch.refuse is not None:
        parts.append(f"refused {branch.refuse}")
    if branch.reply is not Reply.NONE:
        parts.append(branch.reply.value)
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


def dot(table: Table = TABLE, among: Collection[State] = COLUMNS) -> str:
    """A directed graph of the states `among`: an edge for each pair, labelled with its events.

    States that send setpoints have a heavy frame.  An edge is dashed where an event that is not
    a request takes it.
    """
    edges: dict[tuple[State, State], list[Event]] = {}
    for (state, event), cell in table.items():
        for branch in cell:
            for after in _targets(branch):
                events = edges.setdefault((state, after), [])
                if after is not state and event not in events and {state, after} <= {*among}:
                    events.append(event)
    lines = [
        "digraph gate {",
        "  rankdir=LR;",
        '  node [shape=box, style=rounded, fontname="Helvetica"];',
        '  edge [fontname="Helvetica", fontsize=9];',
    ]
    for state in among:
        heavy = ", penwidth=2" if STREAMS[state] is not Streams.NOTHING else ""
        lines.append(f'  {state.name} [label="{state.name}\\n{state.value}"{heavy}];')
    for (before, after), events in sorted(edges.items()):
        if events:
            requested = all(event in REQUESTS for event in events)
            style = "" if requested else ", style=dashed"
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
