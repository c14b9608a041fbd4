"""A position that a newer one has overtaken on its way changes nothing, and no invariant asks that
anything follows from it.  (Hostile seeds 61039670 and 61049660 did.)"""

from __future__ import annotations

from dataclasses import replace

from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged, PositionSeen, Requested, Tick
from gcs.gate.machine.memory import SECOND_NS
from gcs.gate.requests import Abort
from gcs.gate.states import State
from tests.proof.edge import Edge
from tests.proof.invariants import objections
from tests.proof.world import DASH, EDGE, SPOT, STILL
from tests.unit.gate.test_invariants import Run


def test_a_dash_for_the_fence_that_was_overtaken_is_not_braked_for() -> None:
    run = Run().hover()
    run.feed(PositionSeen(SPOT, STILL, 1_000))
    run.feed(PositionSeen(EDGE, DASH, 999))
    assert (run.gate.state, run.gate.pos_ned) == (State.HOVERING, SPOT)
    run.feed(PositionSeen(EDGE, DASH, 1_000))
    assert run.gate.state is State.HOLDING


def state_after(run: Run, told: PositionSeen) -> State:
    run.feed(told)
    return run.gate.state


def test_an_overtaken_position_ends_no_staleness() -> None:
    run = Run().hover()
    run.feed(PositionSeen(SPOT, STILL, 1_000))
    run.feed(ConditionChanged(Condition.ORIGIN_MISMATCH, True))
    run.feed(Requested(9, "test", Abort()))
    run.feed(Tick(0), round(run.policy.position_age_s * SECOND_NS) + 1)
    assert state_after(run, PositionSeen(SPOT, STILL, 999)) is State.STALE
    assert state_after(run, PositionSeen(SPOT, STILL, 1_001)) is State.LANDING


def test_who_takes_it_for_the_present_position_is_found() -> None:
    run = Run().hover()
    run.feed(PositionSeen(SPOT, STILL, 1_000))
    before = run.gate.memory
    late = PositionSeen(EDGE, STILL, 999)
    after = replace(before, pos_ned=late.pos_ned)
    edge = Edge(run.policy, before, late, run.now_ns, [], after)
    assert [(found.invariant, found.sentence) for found in objections(edge)] == [
        (7, "a position that was overtaken is taken for the present one")
    ]
