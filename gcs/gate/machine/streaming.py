"""The guards and actions of a client's setpoint stream.

In STREAMING either the client's last sample is sent at every tick, or the hold goal in its place:
where the samples are refused, where none came for the dead-man's time, and before the first one.
A sample is verified when it comes, and again at every tick that sends it.
"""

from __future__ import annotations

import math

from gcs.gate.effects import Level, OutcomeKind, StreamVerdict
from gcs.gate.machine import verifying
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import SECOND_NS, FlownSample, Goal
from gcs.gate.machine.sentences import no_fresh_position
from gcs.gate.machine.step_context import End, StepContext
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State

# ----------------------------------------------------------------------------------- guards


def own_stream(step: StepContext) -> bool:
    return step.source == step.memory.streamer


def interrupted_stream(step: StepContext) -> bool:
    """A position too old has interrupted it; its client goes on."""
    return step.memory.back_to is State.STREAMING and own_stream(step)


def samples_good_again(step: StepContext) -> bool:
    """The sample clears, and so did all before it for the policy's time, where one was refused."""
    memory, rules = step.memory, step.policy.stream
    if verifying.given_sample(step) is not None:
        return False
    if not memory.stream_refused:
        return True
    if memory.good_since_ns is None or _gap(step):
        return False
    return step.now_ns - memory.good_since_ns >= round(rules.good_again_s * SECOND_NS)


def clears_no_more(step: StepContext) -> bool:
    return step.memory.flown is not None and verifying.flown_sample(step) is not None


def silent(step: StepContext) -> bool:
    """Its last sample counts no more."""
    deadman_s = step.policy.stream.deadman_s
    memory = step.memory
    if memory.flown is None or step.now_ns - memory.sample_ns < round(deadman_s * SECOND_NS):
        return False
    step.why = _nothing_came_for(deadman_s)
    return True


def over(step: StepContext) -> bool:
    ends_after_s = step.policy.stream.ends_after_s
    if step.now_ns - step.memory.streamed_ns < round(ends_after_s * SECOND_NS):
        return False
    step.why = _nothing_came_for(ends_after_s)
    return True


def _nothing_came_for(seconds: float) -> Refusal:
    sentence = f"no sample of the stream came for {seconds:g} s"
    return Refusal(Code.DEADLINE, sentence, (("silent_s", seconds),))


def _gap(step: StepContext) -> bool:
    """The sample before this one counted no more when this one came."""
    deadman_ns = round(step.policy.stream.deadman_s * SECOND_NS)
    return step.now_ns - step.memory.streamed_ns > deadman_ns


# ---------------------------------------------------------------------------------- actions


def begin(step: StepContext) -> None:
    """From now on the stream is this client's.  A vehicle that flies to a goal is held in place."""
    memory = step.memory
    memory.streamer, memory.streamed_ns = step.source, step.now_ns
    memory.flown, memory.stream_refused, memory.good_since_ns = None, False, None
    memory.refused_elsewhere = ()
    if memory.goal is not None:
        memory.goal = None
        if step.policy.stream.tilt_deg > 0.0:
            memory.leant = ((step.now_ns, None),)
        _hold_ahead(step)


def fly(step: StepContext) -> None:
    """Send the sample that came, and nothing else, from the next tick on."""
    memory = step.memory
    assert step.streamed is not None
    if memory.flown is None:
        step.out.append(StreamVerdict(memory.streamer, None, step.evidence))
        step.say(Level.INFO, f"The stream of {memory.streamer} is flown")
    sample = verifying.sample_of(step.streamed)
    if sample.attitude is not None:
        memory.leant = verifying.leaning_on(step, sample.attitude)
    memory.flown = FlownSample(sample, step.evidence)
    memory.sample_ns = memory.streamed_ns = step.now_ns
    memory.stream_refused, memory.good_since_ns = False, None
    memory.hold = None


def note(step: StepContext) -> None:
    step.memory.streamed_ns = step.now_ns


def note_good(step: StepContext) -> None:
    """It clears; but samples before it were refused, and it waits for more that clear."""
    memory = step.memory
    if memory.good_since_ns is None or _gap(step):
        memory.good_since_ns = step.now_ns
    memory.streamed_ns = step.now_ns


def hold_in_place(step: StepContext) -> None:
    """Hold where the vehicle is, and tell the client why its samples are not flown."""
    memory = step.memory
    step.refuse_stream(step.why or no_fresh_position(memory, step.policy, step.now_ns))
    if memory.flown is not None:
        memory.flown = None
        _hold_ahead(step)


def end(step: StepContext) -> None:
    """The stream is over, in good order: the vehicle hovers where it is."""
    memory = step.memory
    step.say(Level.INFO, f"The stream of {memory.streamer} is over")
    step.end(End(OutcomeKind.COMPLETE))
    if memory.flown is not None:
        memory.flown = None
        _hold_ahead(step)


def _hold_ahead(step: StepContext) -> None:
    """The hold goal is where the vehicle is when it hears of it.  Where no such place clears, what
    is flown clears no more, and only hold mode is left."""
    memory = step.memory
    assert memory.pos_ned is not None
    hold_ned = verifying.hold_ahead(step)
    if hold_ned is None:
        memory.hold = None
        step.why = Refusal(Code.CANNOT_STOP, "no place to hold the vehicle at clears")
        step.raised.append(Event.CLEARS_NO_MORE)
        return
    evidence = (("ahead_m", math.dist(memory.pos_ned, hold_ned)),)
    memory.hold = Goal(hold_ned, None, evidence)
