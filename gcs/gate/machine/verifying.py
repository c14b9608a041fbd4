"""Questions to the verifier about what is asked for and what is flown.

`position`, `climb`, `top`, `goal` and `return_path` return None where the verifier clears, else its
refusal.  Each leaves the numbers of the answer in the step: as evidence where it clears, as the
reason where it refuses; the verdict then carries them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.airspace.attitude_samples import BeforeThis, lean_of
from gcs.gate.airspace.bounds import STANDING, Cleared
from gcs.gate.airspace.pace import why_not_speed
from gcs.gate.airspace.questions.back_inside import WayBack
from gcs.gate.airspace.stream_samples import TICK_S, StreamSample
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.airspace.zones import Zone
from gcs.gate.attitude import Attitude
from gcs.gate.geometry import Circle
from gcs.gate.inputs import StreamSeen
from gcs.gate.machine.memory import HOME_MOVED_M, SECOND_NS, Memory
from gcs.gate.machine.pacing import may_have
from gcs.gate.machine.sentences import no_fresh_position
from gcs.gate.machine.step_context import StepContext
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo, TakeOff
from gcs.gate.states import State


def position(step: StepContext, gained_ned: tuple[Vec3, ...] = ()) -> Refusal | None:
    """May the vehicle stay where it is?  Refused where the position is too old.

    `gained_ned`: velocities that it may have beside the reported one.
    """
    memory = step.memory
    if memory.verifier is None:
        return _keep(step, home_or_fence_unknown())
    if step.stale or memory.pos_ned is None or memory.v_ned is None:
        return _keep(step, no_fresh_position(memory, step.policy, step.now_ns))
    judged = memory.verifier.hold_point(
        memory.pos_ned, memory.v_ned, gained_ned, floor_applies=True
    )
    if isinstance(judged, Refusal) and memory.state in (State.HOLDING, State.EXTERNAL):
        judged = replace(judged, sentence=f"{judged.sentence}; {_ways_out(step, memory.pos_ned)}")
    return _keep(step, judged)


def way_back(step: StepContext) -> WayBack | None:
    """The way back inside of a vehicle that flies where it may not stay; None where none clears, or
    its position is too old."""
    memory = step.memory
    if memory.verifier is None or step.stale or memory.pos_ned is None or memory.v_ned is None:
        return None
    at, v_ned = memory.pos_ned, memory.v_ned
    if isinstance(memory.verifier.hold_point(at, v_ned, (), floor_applies=True), Cleared):
        return None
    judged = memory.verifier.way_back(at, v_ned)
    return judged if isinstance(judged, WayBack) else None


def _ways_out(step: StepContext, pos_ned: Vec3) -> str:
    """What is left to a vehicle that flies where it may not hover."""
    memory, ways = step.memory, ["land"]
    back = way_back(step)
    if back is not None:
        ways.insert(0, f"resume (it flies back to {place(back.to_ned)})")
    if memory.verifier is not None and memory.returns_to and memory.return_up_m is not None:
        judged = memory.verifier.return_paths(pos_ned, memory.returns_to, memory.return_up_m)
        ways += [] if isinstance(judged, Refusal) else ["rtl"]
    ways += ["fence off"] if step.policy.fence_switchable else []
    return f"possible: {', '.join(ways)}"


def climb(step: StepContext) -> Refusal | None:
    """May the vehicle climb straight up to the height of the take-off that is asked for?"""
    memory = step.memory
    assert step.requested is not None
    assert isinstance(step.requested.request, TakeOff)
    if memory.verifier is None:
        return _keep(step, home_or_fence_unknown())
    if step.stale or memory.pos_ned is None:
        return _keep(step, no_fresh_position(memory, step.policy, step.now_ns))
    return _keep(step, memory.verifier.takeoff(step.requested.request.up_m, memory.pos_ned))


def top(step: StepContext) -> Refusal | None:
    """May the vehicle fly from where its climb ended to the top that was verified?"""
    memory = step.memory
    if memory.verifier is None:
        return _keep(step, home_or_fence_unknown())
    if step.stale or memory.pos_ned is None or memory.v_ned is None:
        return _keep(step, no_fresh_position(memory, step.policy, step.now_ns))
    return _keep(step, memory.verifier.goal(memory.top_ned, None, memory.pos_ned, memory.v_ned))


def goal(step: StepContext, request: GoTo) -> Refusal | None:
    """May the vehicle fly straight from where it is to the goal of `request`?"""
    memory = step.memory
    if memory.verifier is None or memory.pos_ned is None or memory.v_ned is None:
        return _keep(step, home_or_fence_unknown())
    if memory.comes_back:
        return _keep(step, Refusal(Code.OUTSIDE_FENCE, "it is still on its way back inside"))
    if request.speed_m_s is not None:
        too_fast = why_not_speed(step.policy, memory.autopilot, request.speed_m_s)
        if too_fast is not None:
            return _keep(step, too_fast)
    return _keep(
        step,
        memory.verifier.goal(
            request.goal_ned,
            request.yaw_rad,
            memory.pos_ned,
            memory.v_ned,
            gained_ned=may_have(step, request.goal_ned),
        ),
    )


AGES: Final = 4
"""A sample is judged by the next of so many ages up to the oldest that a position may have."""


def sample_of(seen: StreamSeen) -> StreamSample:
    return StreamSample(
        seen.pos_ned, seen.v_ned, seen.a_ned, seen.yaw_rad, seen.yaw_rate_rad_s, seen.attitude
    )


def given_sample(step: StepContext) -> Refusal | None:
    """May the sample of a stream that came be flown?"""
    assert step.streamed is not None
    return _sample(step, sample_of(step.streamed))


def flown_sample(step: StepContext) -> Refusal | None:
    """May the sample that is flown be flown on?"""
    assert step.memory.flown is not None
    return _sample(step, step.memory.flown.sample)


def _sample(step: StepContext, sample: StreamSample) -> Refusal | None:
    memory, age_s = step.memory, _position_age_s(step)
    if memory.verifier is None:
        return _keep(step, home_or_fence_unknown())
    if age_s is None or step.stale or memory.pos_ned is None or memory.v_ned is None:
        return _keep(step, no_fresh_position(memory, step.policy, step.now_ns))
    before = leans_before(step, sample, age_s)
    gained = may_have(step, sample.pos_ned)
    judged = memory.verifier.stream_sample(
        sample, memory.pos_ned, memory.v_ned, age_s, before, gained
    )
    return _keep(step, judged)


def leans_before(step: StepContext, sample: StreamSample, age_s: float) -> tuple[BeforeThis, ...]:
    """How the vehicle leant for what it flew since its position, and just before that.

    Of attitudes also the one that was flown on until then and had come earlier.  A vehicle that
    flies to a position or at a velocity when an attitude comes leans as it may.
    """
    otherwise = sample.attitude is not None and _flies_otherwise(step.memory)
    found: list[BeforeThis] = [None] if otherwise else []
    if not step.memory.leant:
        return tuple(found)
    rules = step.policy.stream
    since_ns = step.now_ns - round((age_s + rules.attitude_settle_s) * SECOND_NS)
    for came_ns, lean in reversed(step.memory.leant):
        if came_ns <= since_ns - round((rules.deadman_s + TICK_S) * SECOND_NS):
            break
        found.append(lean)
        if came_ns <= since_ns:
            break
    return tuple(found)


def leaning_on(step: StepContext, attitude: Attitude) -> tuple[tuple[int, BeforeThis], ...]:
    """What of the vehicle's leans may still count from now on, when this one is flown."""
    memory, rules, now_ns = step.memory, step.policy.stream, step.now_ns
    longest_s = rules.position_age_s + rules.attitude_settle_s + rules.deadman_s + TICK_S
    kept = [each for each in memory.leant if each[0] > now_ns - round(longest_s * SECOND_NS)]
    if _flies_otherwise(memory):
        kept.append((now_ns, None))
    return (*kept, (now_ns, lean_of(attitude, rules)))


def _flies_otherwise(memory: Memory) -> bool:
    """To a goal, or by samples that are no attitudes."""
    flown = memory.flown
    return memory.goal is not None or (flown is not None and flown.sample.attitude is None)


def hold_ahead(step: StepContext) -> Vec3 | None:
    """Where to hold the vehicle that a stream flew; None where no place clears."""
    memory, age_s = step.memory, _position_age_s(step)
    if memory.verifier is None or memory.pos_ned is None or memory.v_ned is None:
        return None
    at_most_s = step.policy.position_age_s if age_s is None else age_s
    return memory.verifier.hold_ahead(memory.pos_ned, memory.v_ned, at_most_s)


def _position_age_s(step: StepContext) -> float | None:
    """How old the position is at most; None where it is older than a sample is judged by."""
    age_ns, oldest_s = step.memory.position_age_ns(step.now_ns), step.policy.stream.position_age_s
    if age_ns is None:
        return None
    ages_s = (oldest_s * step / AGES for step in range(1, AGES + 1))
    return next((age_s for age_s in ages_s if age_ns <= round(age_s * SECOND_NS)), None)


def return_path(step: StepContext) -> Refusal | None:
    """Is the vehicle's own way home clear, and that to every other place where its return may end?

    Every refusal has the code RTL_BLOCKED and offers landing instead.
    """
    memory = step.memory
    if memory.verifier is None or memory.home_ned is None:
        return _keep(step, Refusal(Code.RTL_BLOCKED, "home or fence is not known: land instead"))
    if memory.return_up_m is None:
        return _keep(
            step,
            Refusal(Code.RTL_BLOCKED, "the vehicle's return height is not known: land instead"),
        )
    if memory.return_places is None:
        why = memory.return_unknown or "where its return may end is not known"
        return _keep(step, Refusal(Code.RTL_BLOCKED, f"{why}: land instead"))
    if step.stale or memory.pos_ned is None:
        return _keep(step, Refusal(Code.RTL_BLOCKED, "the position is too old: land instead"))
    judged = memory.verifier.return_paths(memory.pos_ned, memory.returns_to, memory.return_up_m)
    if isinstance(judged, Refusal):
        sentence = f"{judged.sentence}: land instead"
        judged = Refusal(Code.RTL_BLOCKED, sentence, judged.numbers, judged.zone)
    return _keep(step, judged)


def refusal_of_what_is_flown(
    memory: Memory, verifier: Verifier, was: Verifier | None
) -> Refusal | None:
    """Why `verifier`, which replaces `was`, refuses what is flown now; None where it clears it.

    Of a mission only its fence is known here, not its legs: a mission that flies is refused
    where the fence is on and is not the one that the mission was verified by.
    """
    if memory.pos_ned is None or memory.v_ned is None:
        return None
    judged: Cleared | Refusal | None = None
    if memory.flown_state is State.TAKING_OFF:
        judged = verifier.hold_point(memory.top_ned, STANDING, floor_applies=True)
    elif memory.flown_state is State.FLYING_MISSION:
        if verifier.fence_on and not (was is not None and _same_fence(was, verifier)):
            return Refusal(Code.BAD_MISSION, "the mission was not verified by this fence")
    elif memory.goal is not None:
        judged = verifier.goal(
            memory.goal.pos_ned, memory.goal.yaw_rad, memory.pos_ned, memory.v_ned, memory.path
        )
    elif memory.hold is not None:
        judged = verifier.hold_point(memory.hold.pos_ned, STANDING, floor_applies=True)
    return judged if isinstance(judged, Refusal) else None


def home_or_fence_unknown() -> Refusal:
    return Refusal(Code.NO_ORIGIN, "home and fence are not known yet")


def _same_fence(was: Verifier, now: Verifier) -> bool:
    """Both on, with the same zones in the same places: a home that moves by less than
    `HOME_MOVED_M`, as it does when the vehicle arms, moves them by as little."""
    return (
        was.fence_on
        and len(was.zones) == len(now.zones)
        and all(map(_same_zone, was.zones, now.zones))
    )


def _same_zone(was: Zone, now: Zone) -> bool:
    numbers, others = _numbers(was), _numbers(now)
    return (was.name, was.inclusion, type(was.shape), len(numbers)) == (
        now.name,
        now.inclusion,
        type(now.shape),
        len(others),
    ) and all(a == b or abs(a - b) <= HOME_MOVED_M for a, b in zip(numbers, others, strict=True))


def _numbers(zone: Zone) -> tuple[float, ...]:
    bounds = (zone.floor_up_m, zone.ceiling_up_m)
    if isinstance(zone.shape, Circle):
        return (*zone.shape.centre_en, zone.shape.radius_m, *bounds)
    return (*(x for corner in zone.shape.corners_en for x in corner), *bounds)


def _keep(step: StepContext, judged: Cleared | Refusal) -> Refusal | None:
    """Leave the answer's numbers in the step."""
    if isinstance(judged, Refusal):
        step.why = judged
        return judged
    step.evidence = judged.evidence
    return None
