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
from gcs.gate.machine.turn import End, Turn
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State

# ----------------------------------------------------------------------------------- guards


def own_stream(turn: Turn) -> bool:
    return turn.source == turn.memory.streamer


def interrupted_stream(turn: Turn) -> bool:
    """A position too old has interrupted it; its client goes on."""
    return turn.memory.back_to is State.STREAMING and own_stream(turn)


def samples_good_again(turn: Turn) -> bool:
    """The sample clears, and so did all before it for the policy's time, where one was refused."""
    memory, rules = turn.memory, turn.policy.stream
    if verifying.given_sample(turn) is not None:
        return False
    if not memory.stream_refused:
        return True
    if memory.good_since_ns is None or _gap(turn):
        return False
    return turn.now_ns - memory.good_since_ns >= round(rules.good_again_s * SECOND_NS)


def clears_no_more(turn: Turn) -> bool:
    return turn.memory.flown is not None and verifying.flown_sample(turn) is not None


def silent(turn: Turn) -> bool:
    """Its last sample counts no more."""
    deadman_s = turn.policy.stream.deadman_s
    memory = turn.memory
    if memory.flown is None or turn.now_ns - memory.sample_ns < round(deadman_s * SECOND_NS):
        return False
    turn.why = _nothing_came_for(deadman_s)
    return True


def over(turn: Turn) -> bool:
    ends_after_s = turn.policy.stream.ends_after_s
    if turn.now_ns - turn.memory.streamed_ns < round(ends_after_s * SECOND_NS):
        return False
    turn.why = _nothing_came_for(ends_after_s)
    return True


def _nothing_came_for(seconds: float) -> Refusal:
    sentence = f"no sample of the stream came for {seconds:g} s"
    return Refusal(Code.DEADLINE, sentence, (("silent_s", seconds),))


def _gap(turn: Turn) -> bool:
    """The sample before this one counted no more when this one came."""
    deadman_ns = round(turn.policy.stream.deadman_s * SECOND_NS)
    return turn.now_ns - turn.memory.streamed_ns > deadman_ns


# ---------------------------------------------------------------------------------- actions


def begin(turn: Turn) -> None:
    """From now on the stream is this client's.  A vehicle that flies to a goal is held in place."""
    memory = turn.memory
    memory.streamer, memory.streamed_ns = turn.source, turn.now_ns
    memory.flown, memory.stream_refused, memory.good_since_ns = None, False, None
    memory.refused_elsewhere = ()
    if memory.goal is not None:
        memory.goal = None
        if turn.policy.stream.tilt_deg > 0.0:
            memory.leant = ((turn.now_ns, None),)
        _hold_ahead(turn)


def fly(turn: Turn) -> None:
    """Send the sample that came, and nothing else, from the next tick on."""
    memory = turn.memory
    assert turn.streamed is not None
    if memory.flown is None:
        turn.out.append(StreamVerdict(memory.streamer, None, turn.evidence))
        turn.say(Level.INFO, f"The stream of {memory.streamer} is flown")
    sample = verifying.sample_of(turn.streamed)
    if sample.attitude is not None:
        memory.leant = verifying.leaning_on(turn, sample.attitude)
    memory.flown = FlownSample(sample, turn.evidence)
    memory.sample_ns = memory.streamed_ns = turn.now_ns
    memory.stream_refused, memory.good_since_ns = False, None
    memory.hold = None


def note(turn: Turn) -> None:
    turn.memory.streamed_ns = turn.now_ns


def note_good(turn: Turn) -> None:
    """It clears; but samples before it were refused, and it waits for more that clear."""
    memory = turn.memory
    if memory.good_since_ns is None or _gap(turn):
        memory.good_since_ns = turn.now_ns
    memory.streamed_ns = turn.now_ns


def hold_in_place(turn: Turn) -> None:
    """Hold where the vehicle is, and tell the client why its samples are not flown."""
    memory = turn.memory
    turn.refuse_stream(turn.why or no_fresh_position(memory))
    if memory.flown is not None:
        memory.flown = None
        _hold_ahead(turn)


def end(turn: Turn) -> None:
    """The stream is over, in good order: the vehicle hovers where it is."""
    memory = turn.memory
    turn.say(Level.INFO, f"The stream of {memory.streamer} is over")
    turn.end(End(OutcomeKind.COMPLETE))
    if memory.flown is not None:
        memory.flown = None
        _hold_ahead(turn)


def _hold_ahead(turn: Turn) -> None:
    """The hold goal is where the vehicle is when it hears of it.  Where no such place clears, what
    is flown clears no more, and only hold mode is left."""
    memory = turn.memory
    assert memory.pos_ned is not None
    hold_ned = verifying.hold_ahead(turn)
    if hold_ned is None:
        memory.hold = None
        turn.why = Refusal(Code.CANNOT_STOP, "no place to hold the vehicle at clears")
        turn.raised.append(Event.CLEARS_NO_MORE)
        return
    evidence = (("ahead_m", math.dist(memory.pos_ned, hold_ned)),)
    memory.hold = Goal(hold_ned, None, evidence)
