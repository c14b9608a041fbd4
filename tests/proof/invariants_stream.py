"""A client's setpoint stream: what of it is sent, and whose it is (invariants 1, 4, 7 and 8)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from operator import sub
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.stream_samples import StreamSample
from gcs.gate.condition import Severity
from gcs.gate.effects import SendSetpoint, StreamVerdict, Transition
from gcs.gate.inputs import StreamSeen, Tick
from gcs.gate.machine.memory import SECOND_NS
from gcs.gate.permit import Permit
from gcs.gate.refusal import Refusal
from gcs.gate.states import Control, State
from tests.proof.edge import Edge, same

EXACT_M: Final = 1e-6
DEADMAN_NS: Final = SECOND_NS // 2
"""So long a sample counts: the default policy's dead-man's time, which every world here has."""


def on_the_way(edge: Edge, sent_ned: Vec3, goal_ned: Vec3) -> bool:
    """Straight between the vehicle and the goal, level and up or down apart; or so far behind the
    vehicle as it may be asked to fly back; or as it was before, where the position is too old."""
    here_ned, last = edge.after.pos_ned, edge.before.paced
    if here_ned is None or sent_ned == goal_ned:
        return sent_ned == goal_ned
    if edge.stale and last is not None and sent_ned == last.target_ned:
        return goal_ned == last.goal_ned
    north_m, east_m, down_m = map(sub, goal_ned, here_ned)
    n_m, e_m, d_m = map(sub, sent_ned, here_ned)
    away_m, beside_m2 = math.hypot(north_m, east_m), abs(north_m * e_m - east_m * n_m)
    ahead_m = (n_m * north_m + e_m * east_m) / away_m if away_m > 0.0 else math.hypot(n_m, e_m)
    pace = edge.policy.pace_of(edge.after.autopilot).level
    speed_m_s = math.hypot(*(edge.after.v_ned or (0.0, 0.0))[:2])
    back_m = min(pace.back_m_s, speed_m_s) / pace.follow_per_s
    level = -back_m - EXACT_M <= ahead_m <= away_m + EXACT_M and beside_m2 <= EXACT_M * away_m
    return level and min(0.0, down_m) - EXACT_M <= d_m <= max(0.0, down_m) + EXACT_M


def is_sample(edge: Edge, sent: SendSetpoint) -> bool:
    """It is the client's sample that is sent, and no goal of the gate's."""
    flown = edge.after.flown
    return (
        edge.after.state is State.STREAMING
        and flown is not None
        and _asks(edge, sent.permit, flown.sample) == flown.sample
    )


def _asks(edge: Edge, permit: Permit, sample: StreamSample) -> StreamSample:
    """What is sent, with the position that it is on the way to."""
    sent_ned, to_ned = permit.pos_ned, sample.pos_ned
    if sent_ned is not None and to_ned is not None and on_the_way(edge, sent_ned, to_ned):
        sent_ned = to_ned
    return StreamSample(
        sent_ned,
        permit.v_ned,
        permit.a_ned,
        permit.yaw_rad,
        permit.yaw_rate_rad_s,
        permit.attitude,
    )


def sends_samples_that_clear(edge: Edge) -> Iterator[str]:
    """1 and 8: a sample leaves at a tick, if it clears then by a fresh position, and only as long
    as it counts; velocities and accelerations are sent of no other."""
    after = edge.after
    for sent in edge.setpoints:
        permit = sent.permit
        if not is_sample(edge, sent):
            moves = (permit.v_ned, permit.a_ned, permit.yaw_rate_rad_s, permit.attitude)
            if moves != (None, None, None, None):
                yield f"a velocity leaves in {after.state.name}, which is no sample that is flown"
            continue
        if not isinstance(edge.given, Tick):
            yield "a sample leaves between the ticks"
        if edge.now_ns - after.sample_ns >= DEADMAN_NS:
            yield "a sample of a source that has gone silent is sent on"
        age_ns = after.position_age_ns(edge.now_ns)
        if age_ns is None or age_ns > DEADMAN_NS:
            yield "a sample is sent by a position too old"
        assert after.flown is not None
        yield from _refused(edge, after.flown.sample)


def _refused(edge: Edge, sample: StreamSample) -> Iterator[str]:
    """By the position that is known, as if it were of this moment."""
    after = edge.after
    if after.verifier is None or after.pos_ned is None or after.v_ned is None:
        yield "a sample is flown in a fence or from a place that is not known"
        return
    judged = after.verifier.stream_sample(sample, after.pos_ned, after.v_ned, 0.0)
    if isinstance(judged, Refusal):
        yield f"a sample is flown that is refused: {judged.code}"


def takes_samples_of_one_client(edge: Edge) -> Iterator[str]:
    """4 and 8: what is flown is the sample that came, of the one client whose stream it is, from
    where a goal could be flown; and it clears."""
    before, after, given = edge.before, edge.after, edge.given
    assert isinstance(given, StreamSeen)
    if same(before, after, "flown") or after.flown is None:
        return
    came = StreamSample(
        given.pos_ned,
        given.v_ned,
        given.a_ned,
        given.yaw_rad,
        given.yaw_rate_rad_s,
        given.attitude,
    )
    if after.flown.sample != came or after.sample_ns != edge.now_ns:
        yield "a sample is flown that did not come"
    if after.state is not State.STREAMING or after.control is not Control.OURS:
        yield f"a sample is flown in {after.state.name}"
    task = before.task
    owner = None if task is None else task.requested.source
    replaces = edge.policy.retarget == "replace" and owner == given.source
    # What was due by then, such as the end of a picture's time, is done before the sample is.
    entered = (each for each in edge.effects if isinstance(each, Transition))
    begins_in = next((e.before for e in entered if e.after is State.STREAMING), before.state)
    if before.state is State.STREAMING:
        if given.source != before.streamer:
            yield f"a sample of {given.source} is flown in the stream of another"
    elif begins_in is not State.HOVERING and not (begins_in is State.MOVING and replaces):
        yield f"a stream begins in {begins_in.name}"
    elif before.state is State.HOVERING and before.control is not Control.OURS:
        yield "a stream begins while control is being taken"
    if edge.stale or edge.severity >= Severity.HOLD or before.operator_lost:
        yield "a sample is flown on a stale position, at a severity, or without an operator"
    yield from _refused(edge, came)


def lets_no_refused_sample_go_on(edge: Edge) -> Iterator[str]:
    """1: where the stream is told to be refused, it is not flown."""
    after = edge.after
    for told in edge.effects:
        if not isinstance(told, StreamVerdict) or told.refusal is None:
            continue
        if after.state is State.STREAMING and told.source == after.streamer and after.flown:
            yield "a stream is refused, and flown on"


def keeps_what_it_flies(edge: Edge) -> Iterator[str]:
    """1: nothing but a sample changes what is flown to another sample."""
    if isinstance(edge.given, StreamSeen) or same(edge.before, edge.after, "flown"):
        return
    if edge.after.flown is not None:
        yield "what is flown of a stream changes without a sample"
