"""Take one letter: run the gate on its inputs, one after another."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from gcs.gate.effects import SwitchedFence
from gcs.gate.inputs import Requested, VerifierChanged
from gcs.gate.machine.events import Event
from gcs.gate.machine.gate import Gate, ImpossibleError
from gcs.gate.machine.memory import GATE, Memory
from gcs.gate.machine.rows.row import Cell
from gcs.gate.machine.table import Table
from gcs.gate.states import State
from tests.proof.alphabet import LATE_ID, OTHER, OWNER, PENDING_ID, TASK_ID, Letter
from tests.proof.edge import Edge, same
from tests.proof.world import World


class NotedTable(Mapping[tuple[State, Event], Cell]):
    """A table that notes which of its cells are looked up."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self.cells: set[tuple[State, Event]] = set()

    def __getitem__(self, cell: tuple[State, Event]) -> Cell:
        self.cells.add(cell)
        return self._table[cell]

    def __iter__(self) -> Iterator[tuple[State, Event]]:
        return iter(self._table)

    def __len__(self) -> int:
        return len(self._table)


@dataclass
class Taken:
    """What came of a letter: a step for each of its inputs, and where the gate is then.

    `cells` are those of the table that had a part in it.  `bug` is what the machine says of
    itself when it cannot go on.
    """

    memory: Memory
    now_ns: int
    cells: set[tuple[State, Event]]
    steps: list[Edge] = field(default_factory=list)
    bug: ImpossibleError | AssertionError | None = None


def take(letter: Letter, world: World, table: Table, memory: Memory, now_ns: int) -> Taken | None:
    """Take `letter` from `memory`, which is not changed; None where the letter makes no sense."""
    inputs = deque(letter(world, memory, now_ns))
    if not inputs:
        return None
    noted = NotedTable(table)
    taken = Taken(memory.copy(), now_ns, noted.cells)
    gate = Gate.resumed(world.policy, taken.memory, now_ns, noted)
    while inputs:
        passes_ns, given = inputs.popleft()
        taken.now_ns += passes_ns
        before = taken.memory.copy()
        try:
            effects = gate.handle(given, taken.now_ns)
        except (ImpossibleError, AssertionError) as bug:
            taken.bug = bug
            return taken
        after = taken.memory.copy()
        taken.steps.append(Edge(world.policy, before, given, taken.now_ns, effects, after))
        switched = any(isinstance(effect, SwitchedFence) for effect in effects)
        if switched and before.verifier is not None:
            inputs.appendleft((0, VerifierChanged(world.verifier)))
    _rename(memory, taken.memory)
    return taken


def _rename(before: Memory, after: Memory) -> None:
    """Give the requests in `after` the ids and sources that they always have between letters:
    then a new request's id is new, and memories that differ in names alone are equal."""
    if not same(before, after, "streamer"):
        after.streamer = OWNER
    task = None if same(before, after, "task") else after.task
    pending = None if same(before, after, "pending") else after.pending
    if (task is None or _named(task.requested, TASK_ID)) and (
        pending is None or _named(pending, PENDING_ID)
    ):
        return
    task, pending = after.task, after.pending
    owner = next((r.source for r in (task and task.requested, pending) if r), OWNER)
    ids = {GATE: GATE, LATE_ID: LATE_ID}
    for requested, name in ((task and task.requested, TASK_ID), (pending, PENDING_ID)):
        if requested:
            ids[requested.request_id] = name
    if task is not None:
        after.task = replace(
            task, requested=replace(task.requested, request_id=TASK_ID, source=OWNER)
        )
    if pending is not None:
        source = OWNER if pending.source == owner else OTHER
        after.pending = replace(pending, request_id=PENDING_ID, source=source)
    for request_id, _ in after.outstanding:
        ids.setdefault(request_id, LATE_ID - len(ids))
    after.outstanding = tuple((ids[old], kind) for old, kind in after.outstanding)


def _named(requested: Requested, request_id: int) -> bool:
    return (requested.request_id, requested.source) == (request_id, OWNER)
