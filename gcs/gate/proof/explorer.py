"""Walk every combination that the gate can reach, and check its invariants on every edge.

Breadth first over the real machine and the real table: a node is what the gate remembers, with
every age reduced to what can still make a difference (`situation`); an edge is a letter of
`alphabet.py`.  Because the walk is breadth first, the trace to the first broken invariant is
the shortest one there is.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind, SwitchedFence
from gcs.gate.inputs import HomeSeen, MissionLoaded, ReturnHeightSeen, VerifierChanged
from gcs.gate.machine.events import Event
from gcs.gate.machine.gate import Gate, ImpossibleError
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.table import TABLE, Table
from gcs.gate.policy.policy import Policy
from gcs.gate.proof.alphabet import ABOVE, ALPHABET, EDGE, GOAL, TOP, YARD
from gcs.gate.proof.edge import Edge, Objection
from gcs.gate.proof.invariants import FORCE_REPEAT_NS, objections
from gcs.gate.states import Control, FlightMode, State

HOME = (0.0, 0.0, 0.0)

MODES_THAT_MATTER: Final = {
    State.GROUNDED: frozenset({FlightMode.RETURN, FlightMode.LAND}),
    State.STALE: frozenset({FlightMode.RETURN, FlightMode.LAND}),
    State.TAKING_OFF: frozenset({FlightMode.HOLD, FlightMode.GUIDED}),
    State.HOVERING: frozenset({FlightMode.HOLD, FlightMode.GUIDED}),
    State.HOLDING: frozenset({FlightMode.HOLD}),
    State.FLYING_MISSION: frozenset({FlightMode.MISSION}),
    State.RETURNING: frozenset({FlightMode.RETURN}),
    State.LANDING: frozenset({FlightMode.LAND}),
}
"""The modes that are told apart in a state; in any other state none is."""

PLACES_THAT_MATTER: Final = frozenset(
    {State.TAKING_OFF, State.HOVERING, State.FLYING_MISSION, State.HOLDING, State.EXTERNAL}
)
"""Where a dash for the fence matters beyond the sample that shows it: staying is judged there."""

ALIKE: Final = {
    Event.RESUME: Event.CONTROL,
    Event.RETURN: Event.LAND,
    Event.FORCE_DISARM: Event.DISARM,
}
"""Requests that are treated alike once they are under way."""

LATE_GUIDED: Final = (State.HOLDING, State.EXTERNAL)

Combination: TypeAlias = tuple[State, Severity, Control, Condition | None]


@dataclass(frozen=True, slots=True)
class Fault:
    """A broken invariant and the shortest way to it, letter by letter with the state reached."""

    objection: Objection
    trace: tuple[tuple[str, State], ...]

    def __str__(self) -> str:
        lines = [f"{self.objection}", "shortest trace:"]
        lines += [f"  {letter:<32} -> {state.name}" for letter, state in self.trace]
        return "\n".join(lines)


@dataclass(frozen=True, slots=True)
class Explored:
    """What the walk saw.  `combinations` are the (state, severity, control, condition) met."""

    situations: int
    edges: int
    combinations: frozenset[Combination]
    fault: Fault | None


@dataclass(frozen=True, slots=True)
class _Node:
    memory: Memory
    now_ns: int
    parent: _Node | None
    letter: str

    def trace(self) -> tuple[tuple[str, State], ...]:
        steps: list[tuple[str, State]] = []
        node: _Node | None = self
        while node is not None and node.parent is not None:
            steps.append((node.letter, node.memory.state))
            node = node.parent
        return tuple(reversed(steps))


def explore(
    table: Table = TABLE,
    policy: Policy = YARD,
    autopilot: str = "px4",
    *,
    return_up_m: float = 10.0,
) -> Explored:
    """Breadth first from a gate that has heard nobody; stops at the first broken invariant."""
    verifier = verifier_for(policy, autopilot, HOME, None)
    start = _start(policy, table, verifier, return_up_m)
    seen: set[Hashable] = {situation(policy, start.memory, start.now_ns)}
    combinations: set[Combination] = set()
    queue = deque([start])
    edges = 0
    while queue:
        node = queue.popleft()
        for name, letter in ALPHABET.items():
            steps = tuple(letter(policy, node.memory, node.now_ns))
            if not steps:
                continue
            edges += 1
            memory, before = node.memory.copy(), node.memory
            gate = Gate.resumed(policy, memory, node.now_ns, table)
            now_ns = node.now_ns
            for passes_ns, given in steps:
                now_ns += passes_ns
                try:
                    effects = gate.handle(given, now_ns)
                except ImpossibleError as bug:
                    objection = Objection(0, f"a cell that cannot be entered: {bug}")
                    return _found(objection, node, name, gate, now_ns, seen, edges, combinations)
                edge = Edge(policy, before, given, now_ns, effects, memory)
                for objection in objections(edge):
                    return _found(objection, node, name, gate, now_ns, seen, edges, combinations)
                if any(isinstance(effect, SwitchedFence) for effect in effects):
                    gate.handle(VerifierChanged(verifier), now_ns)
                if len(steps) > 1:
                    before = memory.copy()
            combinations |= _combinations(gate)
            key = situation(policy, memory, now_ns)
            if key not in seen:
                seen.add(key)
                queue.append(_Node(memory, now_ns, node, name))
    return Explored(len(seen), edges, frozenset(combinations), None)


def _found(
    objection: Objection,
    node: _Node,
    letter: str,
    gate: Gate,
    now_ns: int,
    seen: set[Hashable],
    edges: int,
    combinations: set[Combination],
) -> Explored:
    last = _Node(gate.memory, now_ns, node, letter)
    fault = Fault(objection, last.trace())
    return Explored(len(seen), edges, frozenset(combinations), fault)


def _combinations(gate: Gate) -> set[Combination]:
    conditions = gate.conditions or (None,)
    return {(gate.state, gate.severity, gate.control, condition) for condition in conditions}


def _force_disarm_may_repeat(memory: Memory, now_ns: int) -> bool:
    """A first forced disarm was asked for, and the time for the second one runs.

    In HOVERING only, which stands for every state of flight: the table treats all alike.
    """
    asked_ns = memory.force_asked_ns
    in_time = asked_ns is not None and now_ns - asked_ns <= FORCE_REPEAT_NS
    return in_time and memory.state is State.HOVERING


def _start(policy: Policy, table: Table, verifier: Verifier, return_up_m: float) -> _Node:
    gate = Gate(policy, verifier.autopilot, SECOND_NS, table)
    for given in (
        HomeSeen(HOME),
        ReturnHeightSeen(return_up_m),
        VerifierChanged(verifier),
        MissionLoaded("square", 4),
    ):
        gate.handle(given, SECOND_NS)
    return _Node(gate.memory, SECOND_NS, None, "")


def situation(policy: Policy, memory: Memory, now_ns: int) -> Hashable:
    """What can still make a difference: memory without ids and sentences, ages as yes or no.

    What the present state does not look at is left out, so that two memories which differ only
    there are one situation; what they were met with is counted all the same.
    """
    age_ns = memory.position_age_ns(now_ns)
    stale = age_ns is None or age_ns > policy.position_age_s * SECOND_NS
    task, state, flies = memory.task, memory.state, memory.flown_state
    told_ns = memory.landed_ns
    aged = told_ns is not None and now_ns - told_ns >= policy.heartbeat_age_s * SECOND_NS
    climbs = state in (State.GROUNDED, State.STALE) and now_ns < memory.takeoff_until_ns
    severities = [policy.severities[name] for name, _ in memory.conditions]
    worst = Severity.LAND if state is State.STALE else Severity.RETURN
    unanswered = [kind for _, kind in memory.outstanding if kind is not CommandKind.HOLD]
    awaited = memory.asked_mode is not None and memory.hold_again_ns is None
    return (
        state,
        memory.control,
        min(max(severities, default=Severity.CAUTION), worst),
        memory.heard_before if state is State.NO_VEHICLE else None,
        memory.armed,
        memory.mode if memory.mode in MODES_THAT_MATTER.get(flies, ()) else None,
        (memory.airborne, memory.on_ground) if not aged else not memory.armed,
        memory.climbed if flies is State.TAKING_OFF else None,
        memory.pos_ned in (TOP, ABOVE) and memory.pos_ned if flies is State.TAKING_OFF else None,
        memory.operator_lost,
        stale,
        memory.pos_ned == EDGE and state in PLACES_THAT_MATTER,
        memory.pos_ned == GOAL and memory.goal is not None,
        memory.mission_over if flies is State.FLYING_MISSION else None,
        None if task is None else (ALIKE.get(task.kind, task.kind), task.waiting),
        None if memory.pending is None else memory.pending.request,
        memory.hold is not None,
        memory.goal is not None,
        memory.goal is not None and memory.within_since_ns is not None,
        tuple(unanswered[-1:]),
        memory.asked_mode if awaited else None,
        awaited and now_ns < memory.asked_until_ns,
        state in LATE_GUIDED and now_ns < memory.guided_until_ns,
        climbs,
        memory.ask_control_ns is not None,
        memory.hold_again_ns is not None,
        memory.lifted if flies in (State.TAKING_OFF, State.FLYING_MISSION) else None,
        memory.back_to,
        memory.grace_until_ns is not None,
        _force_disarm_may_repeat(memory, now_ns),
    )
