"""The gate's invariants, as questions to one step: before, input, effects, after.

They are written from the design, not from the table, and look at nothing the table says; a table
that was edited wrongly is found here.  The numbers are the design's; 0 is for what the design
says beside its numbered invariants.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

from gcs.gate.effects import (
    Outcome,
    SendCommand,
    SendSetpoint,
    StreamVerdict,
    Transition,
    Verdict,
)
from gcs.gate.inputs import (
    CommandEnded,
    ConditionChanged,
    HomeSeen,
    MissionLoaded,
    OperatorLost,
    PositionSeen,
    Requested,
    StreamSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.memory import Memory
from gcs.gate.policy.policy import Policy
from tests.proof import (
    invariants_command,
    invariants_motion,
    invariants_request,
    invariants_stream,
)
from tests.proof.edge import Edge, Objection


@dataclass(frozen=True, slots=True)
class StepCheck:
    """Says how a step breaks an invariant.

    It is asked of steps that bring one of these inputs or have one of these effects; of every
    step, where none is named.
    """

    invariant: int
    broken: Callable[[Edge], Iterator[str]]
    concerns: tuple[type, ...] = ()


STEP_CHECKS: Final = (
    StepCheck(1, invariants_motion.streams_what_was_verified, (SendSetpoint,)),
    StepCheck(6, invariants_motion.leaves_room_for_a_hold, (SendSetpoint,)),
    StepCheck(2, invariants_motion.flies_what_clears, (VerifierChanged,)),
    StepCheck(2, invariants_motion.flies_the_mission_that_was_verified, (MissionLoaded,)),
    StepCheck(2, invariants_motion.holds_when_home_moves, (HomeSeen,)),
    StepCheck(2, invariants_motion.returns_by_clear_ways, (SendCommand,)),
    StepCheck(2, invariants_motion.climbs_to_its_top, (Tick,)),
    StepCheck(2, invariants_motion.ends_a_climb_at_its_top, (Outcome,)),
    StepCheck(2, invariants_motion.turns_to_the_heading_asked_for, (Outcome,)),
    StepCheck(3, invariants_request.answers_once),
    StepCheck(3, invariants_request.leaves_no_request_open, (OperatorLost,)),
    StepCheck(4, invariants_request.keeps_nothing_refused, (Verdict,)),
    StepCheck(4, invariants_request.takes_goals_where_it_hovers, (Requested,)),
    StepCheck(4, invariants_request.decides_goals_under_control, (Verdict,)),
    StepCheck(5, invariants_request.aborts_at_once, (Requested,)),
    StepCheck(5, invariants_request.stays_aborted, (Transition,)),
    StepCheck(6, invariants_motion.brakes_for_a_breach, (PositionSeen,)),
    StepCheck(7, invariants_request.accepts_what_is_known_to_be_safe, (Requested,)),
    StepCheck(7, invariants_request.hears_an_operator_that_is_there, (Requested,)),
    StepCheck(8, invariants_stream.sends_samples_that_clear, (SendSetpoint,)),
    StepCheck(8, invariants_stream.takes_samples_of_one_client, (StreamSeen,)),
    StepCheck(1, invariants_stream.lets_no_refused_sample_go_on, (StreamVerdict,)),
    StepCheck(1, invariants_stream.keeps_what_it_flies),
    StepCheck(7, invariants_motion.learns_nothing_from_the_past, (PositionSeen,)),
    StepCheck(7, invariants_motion.moves_on_fresh_positions, (Transition, Outcome, Tick)),
    StepCheck(0, invariants_motion.does_what_severity_demands, (ConditionChanged, PositionSeen)),
    StepCheck(7, invariants_command.arms_on_a_fresh_position, (SendCommand,)),
    StepCheck(9, invariants_command.leaves_guided_before_it_arms_again, (SendCommand,)),
    StepCheck(7, invariants_command.loses_only_what_is_silent, (Transition,)),
    StepCheck(0, invariants_command.lets_down_what_comes_down, (OperatorLost,)),
    StepCheck(9, invariants_command.ends_what_it_commands, (SendCommand,)),
    StepCheck(9, invariants_command.acts_on_no_late_answer, (CommandEnded,)),
    StepCheck(0, invariants_command.cuts_motors_on_a_second_request),
    StepCheck(0, invariants_command.holds_until_it_is_shown),
    StepCheck(10, invariants_request.never_refuses_to_stop, (Requested,)),
)

MEMORY_CHECKS: Final[tuple[tuple[int, Callable[[Policy, Memory], Iterator[str]]], ...]] = (
    (0, invariants_motion.is_sound),
    (7, invariants_motion.stands_still_at_severity),
    (9, invariants_command.abandons_with_the_request),
)


def objections(edge: Edge) -> Iterator[Objection]:
    """Every invariant that the step breaks."""
    yield from objections_to_step(edge)
    yield from objections_to_memory(edge.policy, edge.after)


def objections_to_step(edge: Edge) -> Iterator[Objection]:
    """How the step breaks an invariant, whatever the gate remembers then."""
    kinds = {type(edge.given), *map(type, edge.effects)}
    for check in STEP_CHECKS:
        if check.concerns and kinds.isdisjoint(check.concerns):
            continue
        for sentence in check.broken(edge):
            yield Objection(check.invariant, sentence)


def objections_to_memory(policy: Policy, memory: Memory) -> Iterator[Objection]:
    """How what the gate remembers breaks an invariant, whatever step led there."""
    for invariant, broken in MEMORY_CHECKS:
        for sentence in broken(policy, memory):
            yield Objection(invariant, sentence)
