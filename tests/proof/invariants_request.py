"""What becomes of requests (invariants 3, 4, 5, 7 and 10)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gcs.gate.condition import Severity
from gcs.gate.effects import CommandKind, Outcome, Ruling, Transition, Verdict
from gcs.gate.inputs import Requested
from gcs.gate.machine.memory import Memory
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Abort,
    Arm,
    BeginStream,
    Disarm,
    GoTo,
    Hold,
    Land,
    Request,
    Resume,
    ReturnHome,
    SetMode,
    StartMission,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, State
from tests.proof.edge import Edge, same

FLIES: Final = (GoTo, TakeControl, Resume, TakeOff, StartMission, BeginStream)
MOVES: Final = (*FLIES, Arm, TakePhoto)
LEFT_BY_RESUME: Final = (
    State.HOVERING,
    State.MOVING,
    State.STREAMING,
    State.TAKING_OFF,
    State.FLYING_MISSION,
)


def answers_once(edge: Edge) -> Iterator[str]:
    """3: one verdict for each request, and one outcome for each that was accepted."""
    verdicts = [effect for effect in edge.effects if isinstance(effect, Verdict)]
    outcomes = [effect.request_id for effect in edge.effects if isinstance(effect, Outcome)]
    given = {edge.given.request_id} if isinstance(edge.given, Requested) else set()
    kept = all(same(edge.before, edge.after, name) for name in ("pending", "task"))
    if kept and not verdicts and not outcomes and not given:
        return
    before, after = edge.before, edge.after
    waiting = {m.request_id for m in [before.pending] if m is not None}
    running = {t.requested.request_id for t in [before.task] if t is not None}
    still_waiting = {m.request_id for m in [after.pending] if m is not None}
    still_running = {t.requested.request_id for t in [after.task] if t is not None}
    judged = [verdict.request_id for verdict in verdicts]
    accepted = {v.request_id for v in verdicts if v.ruling is Ruling.ACCEPTED}
    if sorted([*judged, *still_waiting]) != sorted(given | waiting):
        yield f"verdicts {judged} for requests {sorted(given | waiting)}"
    if sorted([*outcomes, *still_running]) != sorted(running | accepted):
        yield f"outcomes {outcomes} for accepted {sorted(running | accepted)}"


def leaves_no_request_open(edge: Edge) -> Iterator[str]:
    """3: whoever leaves is told an ending of what was under way, but for a hold that is not shown
    yet, for which the station waits."""
    after = edge.after
    if after.task is not None and after.hold_again_ns is None:
        yield f"{after.task.requested.request} has no ending, and the operator leaves"


def keeps_nothing_refused(edge: Edge) -> Iterator[str]:
    """4: refused means gone."""
    refused = {
        effect.request_id
        for effect in edge.effects
        if isinstance(effect, Verdict) and effect.ruling is not Ruling.ACCEPTED
    }
    if not refused:
        return
    task, pending = edge.after.task, edge.after.pending
    kept = [] if task is None else [task.requested.request_id]
    kept += [] if pending is None else [pending.request_id]
    if not refused.isdisjoint(kept):
        yield "a refused request is kept"


def takes_goals_where_it_hovers(edge: Edge) -> Iterator[str]:
    """4: a goal is taken in HOVERING; in MOVING, and near the top of a climb, by policy from the
    owner of what is flown; in STREAMING from the client whose stream it ends."""
    if not isinstance(edge.request, GoTo):
        return
    if not edge.accepted and edge.after.pending != edge.given:
        return
    state, task = edge.before.state, edge.before.task
    assert isinstance(edge.given, Requested)
    owner = None if task is None else task.requested.source
    replaces = edge.policy.retarget == "replace" and edge.given.source == owner
    if state is State.STREAMING:
        if edge.given.source != edge.before.streamer:
            yield f"a goal of {edge.given.source} is taken in the stream of another"
    elif state is State.TAKING_OFF and replaces:
        yield from _near_its_top(edge)
    elif state is not State.HOVERING and not (state is State.MOVING and replaces):
        yield f"a goal is taken in {state.name} from {edge.given.source}, flown for {owner}"


def _near_its_top(edge: Edge) -> Iterator[str]:
    before, radius_m = edge.before, edge.policy.arrival.radius_m
    assert before.pos_ned is not None
    assert before.ground_down_m is not None
    climb_m = before.ground_down_m - before.top_ned[2]
    climbed_m = before.ground_down_m - before.pos_ned[2]
    if climbed_m <= 0.9 * climb_m - 1e-9 and climbed_m <= climb_m - radius_m:
        yield f"a goal is taken {climbed_m} m up on a climb of {climb_m} m"


def decides_goals_under_control(edge: Edge) -> Iterator[str]:
    """4: a goal that came while control was being taken waits until the vehicle shows its mode."""
    accepted = any(
        isinstance(effect, Verdict)
        and isinstance(effect.request, GoTo)
        and effect.ruling is Ruling.ACCEPTED
        for effect in edge.effects
    )
    if accepted and edge.before.control is not Control.OURS:
        yield "a goal is accepted before control is had"


def aborts_at_once(edge: Edge) -> Iterator[str]:
    """5: abort is legal in every state and takes effect at once."""
    before, after = edge.before, edge.after
    if not isinstance(edge.request, Abort) or not before.heard_before:
        return
    if not edge.accepted:
        yield f"abort is refused in {before.state.name}"
    on_ground = before.state is State.GROUNDED or before.on_ground
    safe = on_ground and not before.armed and CommandKind.ARM not in _commanded(before)
    if not safe and not {CommandKind.HOLD, CommandKind.DISARM} & set(edge.commands):
        yield "abort commands nothing"
    if after.goal is not None or after.pending is not None:
        yield "a goal outlives the abort"
    if before.armed and not edge.stands and CommandKind.HOLD not in edge.commands:
        yield f"abort in {before.state.name} does not hold what may fly"


def stays_aborted(edge: Edge) -> Iterator[str]:
    """5: nothing but `resume` ends the hold, nothing but a verdict makes the vehicle move."""
    judged = any(isinstance(e, Verdict) and isinstance(e.request, GoTo) for e in edge.effects)
    judged |= _goes_on_to_the_top(edge)
    for moved in edge.effects:
        if not isinstance(moved, Transition):
            continue
        left = moved.before is State.HOLDING and moved.after in LEFT_BY_RESUME
        if left and not isinstance(edge.request, Resume):
            yield f"HOLDING is left for {moved.after.name} without resume"
        if moved.after is State.MOVING and not judged and moved.before is not State.STALE:
            yield "MOVING begins without a verdict on a goal"


def _goes_on_to_the_top(edge: Edge) -> bool:
    """The rest of a take-off, of which the verdict was the take-off's own."""
    task, goal = edge.before.task, edge.after.goal
    climbs = task is not None and isinstance(task.requested.request, TakeOff)
    taking = edge.before.control is Control.TAKING
    return climbs and taking and goal is not None and goal.pos_ned == edge.before.top_ned


def _commanded(memory: Memory) -> set[CommandKind]:
    return {kind for _, kind in memory.outstanding}


def accepts_what_is_known_to_be_safe(edge: Edge) -> Iterator[str]:
    """7: what is too old or not known never permits more; neither does a higher severity."""
    before, after = edge.before, edge.after
    if not isinstance(edge.request, MOVES) or not edge.accepted:
        return
    if not edge.commands and (after.task is None or before.task == after.task):
        return  # nothing was left to do
    waits = isinstance(edge.request, Arm) and before.pos_ned is None and not edge.commands
    if (edge.stale and not waits) or before.state is State.NO_VEHICLE:
        yield f"{edge.request} is accepted on a position too old"
    if isinstance(edge.request, FLIES) and before.verifier is None:
        yield f"{edge.request} is accepted though home and fence are not known"
    if isinstance(edge.request, StartMission) and before.mission_items == 0:
        yield "a mission is started that was not verified"
    if isinstance(edge.request, TakeOff) and not before.on_ground:
        yield "a take-off is accepted though the vehicle is not known to stand"
    if edge.severity >= Severity.HOLD and not isinstance(edge.request, TakePhoto):
        yield f"{edge.request} is accepted at severity {edge.severity.name}"


def _stops(request: Request | None) -> bool:
    """What invariant 10 has heard in any state, by its own name or as the mode that means it."""
    if isinstance(request, SetMode):
        return request.meaning in (FlightMode.HOLD, FlightMode.LAND)
    return isinstance(request, Abort | Hold | Land | Disarm)


def hears_an_operator_that_is_there(edge: Edge) -> Iterator[str]:
    """7: once the operator is lost, nobody withdraws the hold that followed."""
    if _stops(edge.request) or not edge.before.operator_lost:
        return
    refusal = None if edge.verdict is None else edge.verdict.refusal
    if refusal is None or refusal.code is not Code.OPERATOR_LOST:
        yield f"{edge.request} is heard though the operator is lost"


def _stops_what_is_not_heard(edge: Edge) -> Iterator[str]:
    """10: hold, abort and landing go out to a vehicle that was heard once."""
    if not isinstance(edge.request, Hold | Abort | Land) or not edge.before.heard_before:
        return
    if not edge.accepted or edge.commands == []:
        yield f"{edge.request} is not sent to a vehicle that is not heard any more"


def never_refuses_to_stop(edge: Edge) -> Iterator[str]:
    """10: hold, landing in place and disarming on the ground are never refused, and a return
    only for its path."""
    before, request = edge.before, edge.request
    if State.NO_VEHICLE in (before.state, edge.after.state):
        yield from _stops_what_is_not_heard(edge)
        return
    stops = {CommandKind.HOLD, CommandKind.LAND, CommandKind.RETURN} & set(edge.commands)
    stop = isinstance(request, Hold | Land | ReturnHome) and edge.accepted
    if stop and not stops and before.armed and not edge.stands:
        yield f"{request} in {before.state.name} commands nothing to what may fly"
    refusal = None if edge.verdict is None else edge.verdict.refusal
    if refusal is None:
        return
    ground = isinstance(request, Disarm) and (
        before.on_ground or (before.state is State.GROUNDED and not edge.stale)
    )
    if isinstance(request, Hold | Land) or ground:
        yield f"{request} is refused in {before.state.name}"
    blocked = refusal.code is Code.RTL_BLOCKED
    if isinstance(request, ReturnHome) and not blocked and not before.operator_lost:
        yield f"a return is refused with {refusal.code} in {before.state.name}"
