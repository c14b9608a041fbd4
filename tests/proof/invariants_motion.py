"""What moves the vehicle: setpoints, the fence, the brake, severity (invariants 1, 2, 6, 7)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from gcs.gate.airspace.bounds import STANDING
from gcs.gate.airspace.stopping import OnWayBack, OwnPath, Path, Setpoints, StopBy
from gcs.gate.condition import Severity
from gcs.gate.effects import CommandKind, Outcome, OutcomeKind, Transition
from gcs.gate.inputs import HomeSeen, MissionLoaded, PositionSeen, Tick, VerifierChanged
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Refusal
from gcs.gate.requests import GoTo, TakeOff
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.proof.edge import Edge, severity_of
from tests.proof.invariants_stream import EXACT_M, is_sample, on_the_way

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
FLIES_BY_ITSELF: Final = frozenset({State.FLYING_MISSION, State.RETURNING, State.LANDING})
"""A vehicle that still follows setpoints is held in its place until it does."""
FLOWN_BY_US: Final = frozenset(
    {
        State.TAKING_OFF,
        State.HOVERING,
        State.MOVING,
        State.STREAMING,
        State.TAKING_PICTURE,
        State.FLYING_MISSION,
    }
)
"""Flown by us, so not without a position and not at a severity of HOLD; a return and a landing
are the vehicle's own."""

BRAKED: Final = FLOWN_BY_US | {State.RETURNING}
"""Where a predicted breach is braked: a landing ends by itself, a held vehicle brakes already."""

CRAWL_M_S: Final = 1.0
HEIGHT_WITHIN_M: Final = 0.35
LIFT_OFF_M: Final = 0.5
"""A mission begins on the ground: so low above where it stood the floor does not apply."""
HOME_MOVED_M: Final = 1.0
OVERSHOOT_M: Final = 1.0
SLACK_NS: Final = SECOND_NS // 5


def is_sound(_policy: Policy, after: Memory) -> Iterator[str]:
    """The state, control and the request under way fit together."""
    state, control = after.state, after.control
    if state is State.VERIFYING:
        yield "VERIFYING outlasts its tick"
    idle = (State.NO_VEHICLE, State.GROUNDED, State.EXTERNAL)
    if state in idle and control is not Control.NONE:
        yield f"control is {control.name} in {state.name}"
    if state in (State.MOVING, State.HOVERING, State.STREAMING) and control is Control.NONE:
        yield f"{state.name} without control"
    if state is State.HOVERING and control is Control.OURS and after.task is not None:
        yield "HOVERING under control, and a request has no outcome"
    if state is State.MOVING and (after.goal is None or after.task is None):
        yield "MOVING without a goal and its request"
    if state is State.STREAMING and (after.flown is None) == (after.hold is None):
        yield "STREAMING with neither a sample nor a hold in its place, or with both"


def stands_still_at_severity(policy: Policy, after: Memory) -> Iterator[str]:
    """7: what must not begin at a severity of HOLD does not go on either."""
    if after.state in FLOWN_BY_US and severity_of(policy, after) >= Severity.HOLD:
        yield f"{after.state.name} at severity {severity_of(policy, after).name}"


def streams_what_was_verified(edge: Edge) -> Iterator[str]:
    """1: no setpoint but for a verified goal, in a state that streams."""
    known = [
        goal.pos_ned
        for memory in (edge.before, edge.after)
        for goal in (memory.hold, memory.goal)
        if goal is not None and goal.evidence
    ]
    for sent in edge.setpoints:
        pos_ned = sent.permit.pos_ned
        if not _may_stream(edge.after):
            yield f"a setpoint leaves in {edge.after.state.name}"
        if edge.after.control is Control.NONE:
            yield "a setpoint leaves without control"
        if is_sample(edge, sent):
            continue
        if pos_ned is None or not all(map(math.isfinite, pos_ned)):
            yield "a setpoint that is no number leaves"
        elif not any(on_the_way(edge, pos_ned, goal_ned) for goal_ned in known):
            yield f"a setpoint to {pos_ned} leaves, which nobody verified"
        if not isinstance(edge.given, Tick | PositionSeen):
            yield "a setpoint leaves between the ticks"


def leaves_room_for_a_hold(edge: Edge) -> Iterator[str]:
    """6: the speed at which the vehicle is sent somewhere is one from which a hold ends inside.

    Where the position is too old, what was sent before is sent on.
    """
    after, paced = edge.after, edge.after.paced
    sent = [s.permit.pos_ned for s in edge.setpoints if s.permit.pos_ned is not None]
    if not sent or edge.stale or after.verifier is None or after.pos_ned is None:
        return
    if paced is None or after.paced_ns != edge.now_ns or sent != [paced.target_ned]:
        yield f"the vehicle is sent to {sent}, at no speed that was chosen"
        return
    here_ned, verifier = after.pos_ned, after.verifier
    if verifier.predicted_stop(here_ned, STANDING, floor_applies=True) is not None:
        if math.hypot(*paced.v_ned) > CRAWL_M_S + EXACT_M:
            yield "the vehicle is sent from outside, and faster than at a crawl"
    elif verifier.predicted_stop(here_ned, paced.v_ned, floor_applies=True) is not None:
        yield f"the vehicle is sent at {paced.v_ned} m/s, and its hold does not fit"


def _may_stream(after: Memory) -> bool:
    if after.state in FLIES_BY_ITSELF:
        return after.mode is FlightMode.GUIDED and after.asked_mode is not None
    return after.state in STREAMING_STATES


def flies_what_clears(edge: Edge) -> Iterator[str]:
    """2: what is flown was verified, and still clears in the fence that is now."""
    before, after, verifier = edge.before, edge.after, edge.after.verifier
    assert isinstance(edge.given, VerifierChanged)
    if before.verifier == verifier or after.control is Control.NONE:
        return
    pos_ned, v_ned, flown = after.pos_ned, after.v_ned, after.flown_state
    if verifier is None or pos_ned is None or v_ned is None:
        return
    if flown not in STREAMING_STATES and not _may_stream(after):
        return
    if after.state is State.STALE and after.grace_until_ns is None:
        return
    judged: object = None
    if flown is State.MOVING and after.goal is not None:
        judged = verifier.goal(after.goal.pos_ned, None, pos_ned, v_ned, _flown(after))
    elif after.hold is not None:
        judged = verifier.hold_point(after.hold.pos_ned, STANDING, floor_applies=True)
    if isinstance(judged, Refusal):
        yield f"{after.state.name} goes on in a fence that refuses it: {judged.code}"


def flies_the_mission_that_was_verified(edge: Edge) -> Iterator[str]:
    """2: no mission goes on where none that was verified is on board any more."""
    assert isinstance(edge.given, MissionLoaded)
    after = edge.after
    goes_on = after.flown_state is State.FLYING_MISSION and after.state is not State.NO_VEHICLE
    if goes_on and not edge.given.items and after.control is not Control.NONE:
        yield "a mission goes on that is not on board any more"


def holds_when_home_moves(edge: Edge) -> Iterator[str]:
    """2: distances were measured from another home."""
    before, after = edge.before, edge.after
    assert isinstance(edge.given, HomeSeen)
    if before.home_ned is None or before.on_ground:
        return
    far = math.dist(before.home_ned, edge.given.pos_ned) > HOME_MOVED_M
    if far and after.control is not Control.NONE and after.state in BRAKED:
        yield f"home moves and {after.state.name} goes on"


def climbs_to_its_top(edge: Edge) -> Iterator[str]:
    """2: the climb that was verified ends at its top, or where the vehicle itself ends it; the
    rest of it is flown to that top."""
    before, after = edge.before, edge.after
    climbs = before.state is State.TAKING_OFF and isinstance(edge.given, Tick)
    if not climbs or before.pos_ned is None or edge.stale:
        return
    above_m = before.top_ned[2] - before.pos_ned[2]
    radius_m = edge.policy.arrival.radius_m
    if after.state is State.HOVERING:
        if after.hold is None or after.hold.pos_ned != before.top_ned:
            yield "a climb is over, and its top is not held"
        if not -radius_m - before.climb_ends_within_m < above_m < radius_m:
            yield f"a climb is over {above_m:.1f} m above its top"
        elif above_m <= -radius_m and before.mode is not FlightMode.HOLD:
            yield f"a climb is over {-above_m:.1f} m below its top, which the vehicle does not show"
    if after.state is State.TAKING_OFF and above_m > radius_m + OVERSHOOT_M:
        yield f"a climb goes on {above_m:.1f} m above its top"


def ends_a_climb_at_its_top(edge: Edge) -> Iterator[str]:
    """2: a take-off is complete at its top, and on a fresh position."""
    task, pos_ned = edge.before.task, edge.after.pos_ned
    if task is None or not isinstance(task.requested.request, TakeOff):
        return
    for effect in edge.effects:
        if not isinstance(effect, Outcome) or effect.kind is not OutcomeKind.COMPLETE:
            continue
        if effect.request_id != task.requested.request_id:
            continue
        if pos_ned is None or edge.stale:
            yield "a take-off is complete on a position too old"
            continue
        # Sideways the radius is the policy's, or the wider one that the reported accuracy allows.
        radius_m = edge.policy.arrival.radius_m
        beside_m = math.dist(pos_ned[:2], edge.before.top_ned[:2])
        below_m = abs(pos_ned[2] - edge.before.top_ned[2])
        wider = radius_m / (edge.before.arrival_h_m or radius_m)
        if math.hypot(beside_m * wider, below_m) >= radius_m or below_m >= HEIGHT_WITHIN_M:
            yield "a take-off is complete though its top is not reached"


def turns_to_the_heading_asked_for(edge: Edge) -> Iterator[str]:
    """2: a goal with a heading is not complete while the vehicle tells that its nose is elsewhere:
    whoever goes on from there, or leaves, means that heading."""
    task, yaw_rad, within_deg = edge.before.task, edge.after.yaw_rad, edge.policy.arrival.yaw_deg
    asked = None if task is None else task.requested.request
    if task is None or not isinstance(asked, GoTo) or asked.yaw_rad is None:
        return
    complete = any(
        isinstance(effect, Outcome)
        and effect.kind is OutcomeKind.COMPLETE
        and effect.request_id == task.requested.request_id
        for effect in edge.effects
    )
    if not complete or yaw_rad is None or within_deg is None:
        return
    turn_rad = math.acos(max(-1.0, min(1.0, math.cos(asked.yaw_rad - yaw_rad))))
    if math.degrees(turn_rad) > within_deg:
        yield f"a goal is complete with the nose {math.degrees(turn_rad):.0f} deg off"


def brakes_for_a_breach(edge: Edge) -> Iterator[str]:
    """6: a predicted breach is braked in the instant of the sample that predicts it."""
    before, given = edge.before, edge.given
    assert isinstance(given, PositionSeen)
    if before.control is Control.NONE or before.flown_state not in BRAKED:
        return
    if before.verifier is None or edge.overtaken:
        return
    floor = before.landed is LandedState.IN_AIR and before.flown_state not in (
        State.TAKING_OFF,
        State.RETURNING,
    )
    if before.flown_state is State.FLYING_MISSION and not given.reset:
        ground_down_m = before.ground_down_m
        floor &= ground_down_m is None or ground_down_m - given.pos_ned[2] > LIFT_OFF_M
    breach = before.verifier.predicted_stop(
        given.pos_ned, given.v_ned, _flown(before), floor_applies=floor
    )
    if breach is None:
        return
    again_ns = edge.after.hold_again_ns
    slowed = breach.by is StopBy.SETPOINT and breach.brake_pos_ned is not None
    later = slowed and again_ns is not None and again_ns <= edge.now_ns + _slowed_ns(edge, given)
    if CommandKind.HOLD not in edge.commands and not later:
        yield f"a breach is predicted in {before.state.name} and not held"
    if edge.after.state is not State.HOLDING:
        yield f"a breach is predicted and {edge.after.state.name} goes on"
    if breach.brake_pos_ned is not None and not edge.setpoints and not _jumped(edge, given):
        yield f"a breach is predicted in {before.state.name} and not braked"


def _slowed_ns(edge: Edge, given: PositionSeen) -> int:
    """How long setpoints take to stop it, by the policy's figures."""
    approach = edge.policy.approach_of(edge.before.autopilot)
    north, east, down = given.v_ned
    level_s = math.hypot(north, east) / approach.a_brake_h_m_s2
    return round((approach.react_s + max(level_s, abs(down) / approach.a_brake_v_m_s2)) * SECOND_NS)


def learns_nothing_from_the_past(edge: Edge) -> Iterator[str]:
    """7: a position that a newer one has overtaken is neither flown by nor taken for fresh."""
    before, after = edge.before, edge.after
    if edge.overtaken and (before.pos_ned, before.pos_ns) != (after.pos_ned, after.pos_ns):
        yield "a position that was overtaken is taken for the present one"


def _jumped(edge: Edge, given: PositionSeen) -> bool:
    """Told so, or farther from the last position than the policy believes that it flew: what frame
    a setpoint would be in is not known, so a hold is all that can be asked for."""
    before = edge.before
    if given.reset or before.pos_ned is None or before.pos_ns is None:
        return given.reset
    least_s = math.dist(given.pos_ned, before.pos_ned) / edge.policy.jump_speed_m_s
    stamped_ms = given.time_boot_ms - before.boot_ms
    if stamped_ms:
        return stamped_ms / 1000 < least_s
    return (edge.now_ns - before.pos_ns) / SECOND_NS < least_s


def _flown(memory: Memory) -> Path:
    """What the vehicle flies and slows down for by itself."""
    if memory.flown_state is State.FLYING_MISSION:
        return OwnPath(memory.mission_within)
    if memory.flown_state in (State.TAKING_OFF, State.RETURNING):
        return OwnPath()
    if memory.flown_state is State.HOVERING and memory.hold is not None and memory.hold.way_back:
        return OnWayBack(memory.hold.pos_ned)
    if memory.flown_state is State.STREAMING and memory.flown is not None:
        asked = memory.flown.sample
        if asked.pos_ned is None or asked.v_ned is not None:
            return None
        return Setpoints()
    if memory.control is not Control.OURS or memory.flown_state is State.HOLDING:
        return None
    return None if memory.goal is None and memory.hold is None else Setpoints()


def moves_on_fresh_positions(edge: Edge) -> Iterator[str]:
    """7: a position too old, or a severity of HOLD, never permits more."""
    back = edge.before.state is State.STALE and isinstance(edge.given, PositionSeen)
    for effect in edge.effects:
        moved = isinstance(effect, Transition) and effect.after is State.MOVING
        if moved and not back and (edge.stale or edge.severity >= Severity.HOLD):
            yield f"MOVING begins, stale or at severity {edge.severity.name}"
    for effect in edge.effects:
        if isinstance(effect, Outcome) and effect.kind is OutcomeKind.COMPLETE:
            task = edge.before.task
            if task is None or task.requested.request_id != effect.request_id:
                continue
            if isinstance(task.requested.request, GoTo) and edge.stale:
                yield "a goal is complete on a position too old"
    if not isinstance(edge.given, Tick):
        return
    if edge.after.state in FLOWN_BY_US and edge.stale:
        yield f"{edge.after.state.name} goes on with a position too old"
    if not edge.setpoints:
        return
    age_ns = edge.after.position_age_ns(edge.now_ns)
    grace_ns = (edge.policy.position_age_s + edge.policy.stale_grace_s) * SECOND_NS + SLACK_NS
    if age_ns is None or age_ns > grace_ns:
        until_ns = edge.after.grace_until_ns
        if until_ns is None or edge.now_ns >= until_ns:
            yield "setpoints leave though the position is too old for longer than the grace"


def does_what_severity_demands(edge: Edge) -> Iterator[str]:
    """A severity of RETURN or LAND is obeyed when it comes, and when a position comes back."""
    before, after = edge.before, edge.after
    severity = edge.severity
    if severity < Severity.RETURN or before.control is Control.NONE:
        return
    stale = before.state is State.STALE
    comes = severity > severity_of(edge.policy, before) and not stale
    comes_back = stale and isinstance(edge.given, PositionSeen) and not edge.overtaken
    flown = before.flown_state in FLOWN_BY_US or before.flown_state is State.HOLDING
    if not (comes or comes_back) or not flown or before.on_ground:
        return
    obeyed = {CommandKind.LAND} & set(edge.commands)
    if severity is Severity.RETURN and not _return_is_blocked(edge):
        obeyed = {CommandKind.RETURN} & set(edge.commands)
    elif severity is Severity.RETURN:
        return  # the policy says what then
    if not obeyed:
        yield f"severity is {severity.name} and {after.state.name} goes on"


def returns_by_clear_ways(edge: Edge) -> Iterator[str]:
    """2: a return is commanded where the ways to all places where it may end clear, unless the
    policy forwards it."""
    if CommandKind.RETURN not in edge.commands or edge.policy.rtl_blocked == "forward":
        return
    if _return_is_blocked(edge):
        yield f"a return is commanded in {edge.before.state.name} by a way that does not clear"


def _return_is_blocked(edge: Edge) -> bool:
    """Whether the verifier refuses a way back, or cannot be asked."""
    after = edge.after
    verifier, pos_ned, home_ned = after.verifier, after.pos_ned, after.home_ned
    age_ns = after.position_age_ns(edge.now_ns)
    if age_ns is None or age_ns > edge.policy.position_age_s * SECOND_NS:
        return True
    if verifier is None or pos_ned is None or home_ned is None or after.return_up_m is None:
        return True
    if after.return_places is None:
        return True
    return_up_m = after.return_up_m
    ways = [(home_ned, return_up_m)]
    ways += [(to.ground_ned, max(return_up_m, to.over_up_m)) for to in after.return_places]
    return any(isinstance(verifier.return_path(pos_ned, *way), Refusal) for way in ways)
