"""The gate's invariants, as questions to one step: before, input, effects, after.

They are written from the design, not from the table, and look at nothing the table says; a table
that was edited wrongly is caught here.  The numbers are the design's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Final

from gcs.gate.airspace.limits import STANDING
from gcs.gate.condition import Severity
from gcs.gate.effects import (
    CommandKind,
    Outcome,
    OutcomeKind,
    Ruling,
    Say,
    SendCommand,
    Transition,
    Verdict,
)
from gcs.gate.inputs import (
    CommandEnded,
    HeartbeatSeen,
    HomeSeen,
    PositionSeen,
    Requested,
    Tick,
    VerifierChanged,
)
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.proof.edge import Edge, Objection
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    GoTo,
    Hold,
    Land,
    Resume,
    ReturnHome,
    StartMission,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, LandedState, State

STREAMING_STATES: Final = frozenset(
    {
        State.HOVERING,
        State.VERIFYING,
        State.MOVING,
        State.STREAMING,
        State.TAKING_PICTURE,
        State.HOLDING,
        State.STALE,  # for the grace only
    }
)
MOVES: Final = (GoTo, TakeControl, Resume, Arm, TakeOff, StartMission, TakePhoto)
GUARDED: Final = frozenset(
    {
        State.TAKING_OFF,
        State.HOVERING,
        State.MOVING,
        State.STREAMING,
        State.TAKING_PICTURE,
        State.FLYING_MISSION,
        State.RETURNING,
    }
)
"""Where a predicted breach is braked: a landing ends by itself, a held vehicle brakes already."""

NEEDS_POSITION: Final = GUARDED - {State.RETURNING}
"""Flown by us, so not without a position; a return and a landing are the vehicle's own."""

HOME_MOVED_M: Final = 1.0
OVERSHOOT_M: Final = 1.0
FORCE_REPEAT_NS: Final = 5 * SECOND_NS
"""How soon a forced disarm in the air has to be asked for again."""
SLACK_NS: Final = SECOND_NS // 5


def objections(edge: Edge) -> Iterator[Objection]:
    """Every invariant that the step breaks."""
    demanding = Requested | Tick | PositionSeen | VerifierChanged | CommandEnded
    if not edge.effects and not isinstance(edge.given, demanding):
        return  # nothing came of something that demands nothing
    for number, check in CHECKS:
        for sentence in check(edge):
            yield Objection(number, sentence)


def _sound(edge: Edge) -> Iterator[str]:
    after = edge.after
    if after.state is State.VERIFYING:
        yield "VERIFYING outlasts its tick"
    idle = (State.NO_VEHICLE, State.GROUNDED, State.EXTERNAL)
    if after.state in idle and after.control is not Control.NONE:
        yield f"control is {after.control.name} in {after.state.name}"
    if after.state in (State.MOVING, State.HOVERING) and after.control is Control.NONE:
        yield f"{after.state.name} without control"
    ours = after.control is Control.OURS
    if after.state is State.HOVERING and ours and after.task is not None:
        yield "HOVERING under control, and a request has no outcome"
    if after.state is State.MOVING and (after.goal is None or after.task is None):
        yield "MOVING without a goal and its request"


def _streams(edge: Edge) -> Iterator[str]:
    """1: no setpoint but for a verified goal, in a state that streams."""
    if not edge.setpoints:
        return
    known = [
        goal.pos_ned
        for memory in (edge.before, edge.after)
        for goal in (memory.hold, memory.goal)
        if goal is not None and goal.evidence
    ]
    for sent in edge.setpoints:
        pos_ned = sent.permit.pos_ned
        if edge.after.state not in STREAMING_STATES:
            yield f"a setpoint leaves in {edge.after.state.name}"
        if edge.after.control is Control.NONE:
            yield "a setpoint leaves without control"
        if pos_ned is None or not all(map(math.isfinite, pos_ned)):
            yield "a setpoint that is no number leaves"
        elif pos_ned not in known:
            yield f"a setpoint to {pos_ned} leaves, which nobody verified"
        if not isinstance(edge.given, Tick | PositionSeen):
            yield "a setpoint leaves between the ticks"


def _answers(edge: Edge) -> Iterator[str]:
    """3: one verdict, and for the accepted one outcome."""
    same = edge.before.pending is edge.after.pending and edge.before.task is edge.after.task
    if same and not edge.effects and not isinstance(edge.given, Requested):
        return
    verdicts = [e for e in edge.effects if isinstance(e, Verdict)]
    outcomes = [e.request_id for e in edge.effects if isinstance(e, Outcome)]
    given = {edge.given.request_id} if isinstance(edge.given, Requested) else set()
    waiting = {m.request_id for m in [edge.before.pending] if m is not None}
    running = {t.requested.request_id for t in [edge.before.task] if t is not None}
    still_waiting = {m.request_id for m in [edge.after.pending] if m is not None}
    still_running = {t.requested.request_id for t in [edge.after.task] if t is not None}
    judged = [v.request_id for v in verdicts]
    accepted = {v.request_id for v in verdicts if v.ruling is Ruling.ACCEPTED}
    if sorted([*judged, *still_waiting]) != sorted(given | waiting):
        yield f"verdicts {judged} for requests {sorted(given | waiting)}"
    if sorted([*outcomes, *still_running]) != sorted(running | accepted):
        yield f"outcomes {outcomes} for accepted {sorted(running | accepted)}"


def _gone(edge: Edge) -> Iterator[str]:
    """4: refused means gone."""
    refused = {
        effect.request_id
        for effect in edge.effects
        if isinstance(effect, Verdict) and effect.ruling is not Ruling.ACCEPTED
    }
    kept = [edge.after.pending, None if edge.after.task is None else edge.after.task.requested]
    if any(requested is not None and requested.request_id in refused for requested in kept):
        yield "a refused request is kept"
    takes = {State.HOVERING}
    if edge.policy.retarget == "replace":
        takes.add(State.MOVING)
    taken = isinstance(edge.request, GoTo) and (edge.accepted or edge.after.pending == edge.given)
    if taken and edge.before.state not in takes:
        yield f"a goal is taken in {edge.before.state.name}"


def _aborts(edge: Edge) -> Iterator[str]:
    """5: abort is legal in every state, at once; nothing revives the goal."""
    before, after = edge.before, edge.after
    if isinstance(edge.request, Abort) and before.heard_before:
        if not edge.accepted:
            yield f"abort is refused in {before.state.name}"
        on_ground = before.state is State.GROUNDED or before.on_ground
        safe = on_ground and not before.armed and CommandKind.ARM not in _kinds(before)
        if not safe and not {CommandKind.HOLD, CommandKind.DISARM} & set(edge.commands):
            yield "abort commands nothing"
        if after.goal is not None or after.pending is not None:
            yield "a goal outlives the abort"
        if before.armed and not edge.stands and CommandKind.HOLD not in edge.commands:
            yield f"abort in {before.state.name} does not hold what may fly"
    if not edge.effects:
        return
    resumed = isinstance(edge.request, Resume)
    leaves = {State.HOVERING, State.MOVING, State.TAKING_OFF, State.FLYING_MISSION}
    for moved in edge.effects:
        if not isinstance(moved, Transition):
            continue
        if moved.before is State.HOLDING and moved.after in leaves and not resumed:
            yield f"HOLDING is left for {moved.after.name} without resume"
        judged = any(isinstance(e, Verdict) and isinstance(e.request, GoTo) for e in edge.effects)
        if moved.after is State.MOVING and not judged and moved.before is not State.STALE:
            yield "MOVING begins without a verdict on a goal"


def _kinds(memory: Memory) -> set[CommandKind]:
    return {kind for _, kind in memory.outstanding}


def _brakes(edge: Edge) -> Iterator[str]:
    """6: a predicted breach is braked in the instant of the sample that predicts it."""
    before, given = edge.before, edge.given
    if not isinstance(given, PositionSeen) or before.verifier is None:
        return
    if before.control is Control.NONE or before.flown_state not in GUARDED:
        return
    floor = before.landed is LandedState.IN_AIR and before.flown_state not in (
        State.TAKING_OFF,
        State.RETURNING,
    )
    breach = before.verifier.predicted_stop(given.pos_ned, given.v_ned, floor_applies=floor)
    if breach is None:
        return
    if CommandKind.HOLD not in edge.commands:
        yield f"a breach is predicted in {before.state.name} and not held"
    if edge.after.state is not State.HOLDING:
        yield f"a breach is predicted and {edge.after.state.name} goes on"
    if breach.brake_pos_ned is not None and not edge.setpoints and not given.reset:
        yield f"a breach is predicted in {before.state.name} and not braked"


def _verified(edge: Edge) -> Iterator[str]:
    """2, where the machine has its part in it: what is flown is what was verified, and still is."""
    before, after, verifier = edge.before, edge.after, edge.after.verifier
    pos_ned, v_ned = after.pos_ned, after.v_ned
    new = isinstance(edge.given, VerifierChanged) and before.verifier != verifier
    if new and after.control is not Control.NONE and verifier and pos_ned and v_ned:
        judged: object = None
        silent = after.state is State.STALE and after.grace_until_ns is None
        if silent or after.flown_state not in STREAMING_STATES:
            judged = None
        elif after.flown_state is State.MOVING and after.goal is not None:
            judged = verifier.goal(after.goal.pos_ned, None, pos_ned, v_ned)
        elif after.hold is not None:
            judged = verifier.hold_point(after.hold.pos_ned, STANDING, floor_applies=True)
        if isinstance(judged, Refusal):
            yield f"{after.state.name} goes on in a fence that refuses it: {judged.code}"
    if isinstance(edge.given, HomeSeen) and before.home_ned is not None and not before.on_ground:
        far = math.dist(before.home_ned, edge.given.pos_ned) > HOME_MOVED_M
        if far and after.control is not Control.NONE and after.state in GUARDED:
            yield f"home moves and {after.state.name} goes on"
    climbs = before.state is State.TAKING_OFF and isinstance(edge.given, Tick)
    if climbs and before.pos_ned is not None and not edge.stale:
        above_m = before.top_down_m - before.pos_ned[2]
        radius_m = edge.policy.arrival.radius_m
        if after.state is State.HOVERING and abs(above_m) >= radius_m:
            yield f"a climb is over {above_m:.1f} m above its top"
        if after.state is State.TAKING_OFF and above_m > radius_m + OVERSHOOT_M:
            yield f"a climb goes on {above_m:.1f} m above its top"


def _permits(edge: Edge) -> Iterator[str]:
    """7: stale or unknown never permits more; higher severity never permits more."""
    if isinstance(edge.request, MOVES) and edge.accepted:
        done = edge.after.task is None or edge.before.task == edge.after.task
        starts = not (done and not edge.commands)
        if starts and (edge.stale or edge.before.state is State.NO_VEHICLE):
            yield f"{edge.request} is accepted on a position too old"
        if starts and isinstance(edge.request, TakeOff) and not edge.before.on_ground:
            yield "a take-off is accepted though the vehicle is not known to stand"
        if starts and edge.severity >= Severity.HOLD and not isinstance(edge.request, TakePhoto):
            yield f"{edge.request} is accepted at severity {edge.severity.name}"
    for effect in edge.effects:
        moved = isinstance(effect, Transition) and effect.after is State.MOVING
        if moved and (edge.stale or edge.severity >= Severity.HOLD) and not _back(edge):
            yield f"MOVING begins, stale or at severity {edge.severity.name}"
    task = edge.before.task
    ended = [e for e in edge.effects if isinstance(e, Outcome) and e.kind is OutcomeKind.COMPLETE]
    goes = task is not None and isinstance(task.requested.request, GoTo)
    completed = {e.request_id for e in ended}
    if goes and task is not None and edge.stale and task.requested.request_id in completed:
        yield "a goal is complete on a position too old"
    if isinstance(edge.given, Tick) and edge.stale and edge.after.state in NEEDS_POSITION:
        yield f"{edge.after.state.name} goes on with a position too old"
    age_ns = edge.after.position_age_ns(edge.now_ns)
    grace_ns = (edge.policy.position_age_s + edge.policy.stale_grace_s) * SECOND_NS + SLACK_NS
    if isinstance(edge.given, Tick) and edge.setpoints and (age_ns is None or age_ns > grace_ns):
        until_ns = edge.after.grace_until_ns
        if until_ns is None or edge.now_ns >= until_ns:
            yield "setpoints leave though the position is too old for longer than the grace"


def _back(edge: Edge) -> bool:
    return edge.before.state is State.STALE and isinstance(edge.given, PositionSeen)


def _dangerous(edge: Edge) -> Iterator[str]:
    """9: a late effect is reported and not acted on; no command without an end."""
    if not edge.effects and edge.before.outstanding is edge.after.outstanding:
        return
    for sent in edge.effects:
        if isinstance(sent, SendCommand):
            if not edge.now_ns < sent.deadline_ns <= edge.now_ns + 60 * SECOND_NS:
                yield f"{sent.kind.value} has no deadline that holds"
            asked = edge.after.task is not None or edge.accepted
            if sent.kind in (CommandKind.ARM, CommandKind.TAKE_OFF) and not asked:
                yield f"{sent.kind.value} is sent though nobody asks for it"
    if isinstance(edge.given, CommandEnded):
        key = (edge.given.request_id, edge.given.kind)
        late = key not in edge.before.outstanding
        if late and not all(isinstance(effect, Say) for effect in edge.effects):
            yield "a late answer is acted on"
    ours = {CommandKind.ARM, CommandKind.TAKE_OFF} & _kinds(edge.after)
    if ours and edge.after.task is None:
        yield "arm or take-off goes on being tried though its request has ended"


def _attended(edge: Edge) -> Iterator[str]:
    """Once the operator is lost, nobody withdraws the hold that followed."""
    if edge.before.operator_lost and not isinstance(edge.request, Abort | Hold | Land | Disarm):
        refusal = None if edge.verdict is None else edge.verdict.refusal
        if edge.request is not None and (refusal is None or refusal.code is not Code.OPERATOR_LOST):
            yield f"{edge.request} is heard though the operator is lost"


def _force_disarms(edge: Edge) -> Iterator[str]:
    """Motors are cut in the air on a second, explicit request only, soon after the first."""
    if CommandKind.FORCE_DISARM not in edge.commands:
        return
    asked_ns = edge.before.force_asked_ns
    if not edge.policy.allow_force_disarm:
        yield "a forced disarm leaves though the policy forbids it"
    if not (isinstance(edge.request, Disarm) and edge.request.force):
        yield "a forced disarm leaves though nobody asks for it"
    if asked_ns is None or edge.now_ns - asked_ns > FORCE_REPEAT_NS:
        yield "the first request for a forced disarm cuts the motors"


def _holds_until_shown(edge: Edge) -> Iterator[str]:
    """HOLD is commanded once a second until it is shown, or not wanted any more."""
    before, after, commands = edge.before, edge.after, set(edge.commands)
    if before.hold_again_ns is not None and after.hold_again_ns is None:
        shown = after.mode is FlightMode.HOLD
        replaced = edge.accepted or commands & {CommandKind.LAND, CommandKind.RETURN}
        taken_over = isinstance(edge.given, HeartbeatSeen) and after.control is Control.NONE
        lost = after.state is State.NO_VEHICLE
        down = not after.armed or after.on_ground
        if not (shown or replaced or taken_over or lost or down):
            yield "a hold that is not shown has no next try"
    due = before.hold_again_ns is not None and before.hold_again_ns <= edge.now_ns
    if due and isinstance(edge.given, Tick) and after.hold_again_ns == before.hold_again_ns:
        yield "a hold that is due is not commanded"


def _never_refused(edge: Edge) -> Iterator[str]:
    """10: hold, landing in place and disarming on the ground are never refused."""
    if edge.before.state is State.NO_VEHICLE or edge.after.state is State.NO_VEHICLE:
        return
    stops = {CommandKind.HOLD, CommandKind.LAND, CommandKind.RETURN} & set(edge.commands)
    may_fly = edge.before.armed and not edge.stands
    stop = isinstance(edge.request, Hold | Land | ReturnHome) and edge.accepted
    if stop and may_fly and not stops:
        yield f"{edge.request} in {edge.before.state.name} commands nothing to what may fly"
    verdict = edge.verdict
    refused = verdict is not None and verdict.ruling is Ruling.REFUSED
    if not refused or verdict is None or verdict.refusal is None:
        return
    standing = edge.before.state is State.GROUNDED and not edge.stale
    ground = standing or edge.before.on_ground
    if isinstance(edge.request, Hold | Land) or (isinstance(edge.request, Disarm) and ground):
        yield f"{edge.request} is refused in {edge.before.state.name}"
    if edge.before.operator_lost:
        return
    if isinstance(edge.request, ReturnHome) and verdict.refusal.code is not Code.RTL_BLOCKED:
        yield f"a return is refused with {verdict.refusal.code} in {edge.before.state.name}"


CHECKS: Final[tuple[tuple[int, Callable[[Edge], Iterator[str]]], ...]] = (
    (0, _sound),
    (1, _streams),
    (2, _verified),
    (3, _answers),
    (4, _gone),
    (5, _aborts),
    (6, _brakes),
    (7, _permits),
    (7, _attended),
    (4, _force_disarms),
    (4, _holds_until_shown),
    (9, _dangerous),
    (10, _never_refused),
)
"""By the design's numbers.  8 is for streams of others."""
