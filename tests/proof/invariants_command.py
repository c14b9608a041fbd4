"""What the vehicle is commanded, for how long, and by whom (invariant 9, forced disarm, hold)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from gcs.gate.effects import CommandKind, Say, SendCommand, Transition
from gcs.gate.inputs import CommandEnded, HeartbeatSeen, LandedSeen, Tick
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.policy.policy import Policy
from gcs.gate.requests import Abort, Disarm, Hold
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.proof.edge import Edge, same

RISKY: Final = frozenset({CommandKind.ARM, CommandKind.TAKE_OFF})
"""Commands whose late effect is dangerous."""

LONGEST_NS: Final = 60 * SECOND_NS
FORCE_WINDOW_NS: Final = 5 * SECOND_NS
HOLD_EVERY_NS: Final = SECOND_NS

INSTEAD: Final = frozenset(
    {CommandKind.LAND, CommandKind.RETURN, CommandKind.DISARM, CommandKind.FORCE_DISARM}
)
"""What may be commanded in place of a hold, by whomever."""


def ends_what_it_commands(edge: Edge) -> Iterator[str]:
    """9: every command has a deadline, and one whose late effect is dangerous has a request."""
    for sent in edge.effects:
        if not isinstance(sent, SendCommand):
            continue
        if not edge.now_ns < sent.deadline_ns <= edge.now_ns + LONGEST_NS:
            yield f"{sent.kind.value} has no deadline that holds"
        if sent.kind in RISKY and edge.after.task is None and not edge.accepted:
            yield f"{sent.kind.value} is sent though nobody asks for it"


def arms_on_a_fresh_position(edge: Edge) -> Iterator[str]:
    """7: arming is commanded where there is a fresh position, whenever it was asked for."""
    if CommandKind.ARM not in edge.commands:
        return
    age_ns = edge.after.position_age_ns(edge.now_ns)
    waits = edge.before.task is not None and edge.before.task.waiting is CommandKind.ARM
    fresh = age_ns is not None and age_ns <= edge.policy.position_age_s * SECOND_NS
    if not fresh and not (waits and isinstance(edge.given, HeartbeatSeen)):
        yield "arming is commanded without a fresh position"


def leaves_guided_before_it_arms_again(edge: Edge) -> Iterator[str]:
    """9: an ArduCopter is armed in no guided mode in which it may have kept a take-off."""
    after = edge.after
    if CommandKind.ARM not in edge.commands or after.autopilot != "ardupilot":
        return
    if after.mode is FlightMode.GUIDED and after.guided_used:
        yield "arming is commanded in a guided mode in which it was armed before"


def lets_down_what_comes_down(edge: Edge) -> Iterator[str]:
    """Whoever leaves cancels no return and no landing.

    Not judged where the vehicle is lost, or a mode or the request under way is overdue at that
    moment: the gate deals with that first, as at a tick.
    """
    comes_down = edge.before.state in (State.RETURNING, State.LANDING)
    if not comes_down or edge.after.state is State.NO_VEHICLE:
        return
    if edge.mode_overdue or edge.task_overdue:
        return
    if edge.after.state is not edge.before.state or edge.commands:
        yield f"the operator leaves, and {edge.before.state.name} does not go on"
    if _brings_down(edge.before) != _brings_down(edge.after):
        yield f"the operator leaves, and what {edge.before.state.name} needs is asked for no more"


def _brings_down(memory: Memory) -> list[tuple[int, CommandKind]]:
    """The unanswered commands that a return or landing needs.  Another one, such as a forced
    disarm, ends with its request."""
    needed = (CommandKind.RETURN, CommandKind.LAND, CommandKind.HOLD)
    return [command for command in memory.outstanding if command[1] in needed]


def loses_only_what_is_silent(edge: Edge) -> Iterator[str]:
    """7: any message of the vehicle is a sign of life."""
    lost = any(e.after is State.NO_VEHICLE for e in edge.effects if isinstance(e, Transition))
    heard_ns = edge.before.heard_ns
    if lost and heard_ns is not None:
        silent_ns = edge.now_ns - heard_ns
        if silent_ns < edge.policy.heartbeat_age_s * SECOND_NS:
            yield "a vehicle is lost that was heard a moment ago"


def acts_on_no_late_answer(edge: Edge) -> Iterator[str]:
    """9: an answer that comes when nobody waits for it is reported, and not acted on."""
    assert isinstance(edge.given, CommandEnded)
    if all(isinstance(effect, Say) for effect in edge.effects):
        return
    if (edge.given.request_id, edge.given.kind) not in edge.before.outstanding:
        yield "a late answer is acted on"


def abandons_with_the_request(_policy: Policy, after: Memory) -> Iterator[str]:
    """9: arm and take-off are not tried on once their request has ended."""
    if after.task is None and any(kind in RISKY for _, kind in after.outstanding):
        yield "arm or take-off goes on being tried though its request has ended"


def cuts_motors_on_a_second_request(edge: Edge) -> Iterator[str]:
    """A forced disarm leaves only on a second explicit request for it, soon after a first one
    which was refused, and where the policy allows it."""
    asked = isinstance(edge.request, Disarm) and edge.request.force
    if CommandKind.FORCE_DISARM in edge.commands:
        first_ns = edge.before.force_asked_ns
        if not asked or not edge.accepted:
            yield "a forced disarm leaves, and nobody asked for it"
        if not edge.policy.allow_force_disarm:
            yield "a forced disarm leaves, and the policy forbids it"
        if first_ns is None or edge.now_ns - first_ns > FORCE_WINDOW_NS:
            yield "a forced disarm leaves at the first request for it"
    if same(edge.before, edge.after, "force_asked_ns"):
        return
    if not asked or edge.accepted or edge.after.force_asked_ns != edge.now_ns:
        yield "a first request for a forced disarm is noted, and there was none"


def holds_until_it_is_shown(edge: Edge) -> Iterator[str]:
    """A hold that is commanded and not shown always has a next try, at 1 Hz.

    The first one may be later, of a vehicle that setpoints stop (`brakes_for_a_breach`)."""
    before, after = edge.before, edge.after
    again_ns = after.hold_again_ns
    given_up = not INSTEAD.isdisjoint(edge.commands) or _taken_back(edge)
    if CommandKind.HOLD in edge.commands and again_ns is None and not given_up:
        yield f"hold is commanded in {after.state.name} and has no next try"
    if before.hold_again_ns is None:
        return
    if again_ns is None:
        if not _hold_is_over(edge):
            yield f"hold is not shown and has no next try in {after.state.name}"
    elif isinstance(edge.given, Tick) and again_ns <= edge.now_ns:
        yield f"hold is due in {after.state.name} and not commanded"
    elif again_ns > edge.now_ns + HOLD_EVERY_NS and again_ns != before.hold_again_ns:
        yield "the next try of hold is too far off"


def _taken_back(edge: Edge) -> bool:
    """A mode or a request was overdue when the operator asked for control, so the vehicle was told
    to hold in the same step, before control is taken of what holds: that hold is cancelled."""
    overdue = edge.mode_overdue or edge.task_overdue
    return overdue and edge.accepted and edge.after.control is Control.TAKING


def _chosen_by_others(edge: Edge) -> bool:
    """The heartbeat shows a mode that we did not command, and nobody asked for the hold."""
    given, before = edge.given, edge.before
    if not isinstance(given, HeartbeatSeen) or given.mode is before.mode:
        return False
    return before.state is State.EXTERNAL and not before.hold_requested


def _prepared(memory: Memory) -> bool:
    """The hold is the mode that a request to arm needs, and ends with that request."""
    return memory.task is not None and memory.task.waiting is CommandKind.ARM


def _hold_is_over(edge: Edge) -> bool:
    """The heartbeat shows it; or it flies no more; or something else was commanded in its place.

    A hold that was asked for goes on where the vehicle is not heard any more, unless it stood.
    """
    given, after = edge.given, edge.after
    if isinstance(given, HeartbeatSeen) and (given.mode is FlightMode.HOLD or not given.armed):
        return True
    if isinstance(given, LandedSeen) and given.landed is LandedState.ON_GROUND:
        return True
    if _chosen_by_others(edge):
        return True
    before = edge.before
    asked = before.task is not None and isinstance(before.task.requested.request, Hold | Abort)
    lost = after.state is State.NO_VEHICLE and before.state is not State.NO_VEHICLE
    if lost and (before.state is State.GROUNDED or not (asked or before.hold_requested)):
        return True
    if _prepared(before) and (after.task is None or before.outstanding != after.outstanding):
        return True
    if not INSTEAD.isdisjoint(edge.commands):
        return True
    if edge.accepted and not isinstance(edge.request, Hold | Abort):
        return True
    return edge.stands and edge.before.state is not State.NO_VEHICLE
