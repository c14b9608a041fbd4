"""An arm or a take-off whose answer is lost, late or doubled never takes effect after its end.

Only the vehicle's answers are played with: everything else arrives.  What is looked at is the
vehicle itself and the bytes that left for it.
"""

from __future__ import annotations

import heapq
import random
from dataclasses import dataclass, replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gcs.protocol.command import CommandClient, Input
from gcs.protocol.effects import CommandEffect, Submit, Withdraw
from gcs.session import inputs
from gcs.wire.frame import Frame, split
from tests.loopback import pymavlink_decoder
from tests.loopback.flight import PERSONALITIES, Flight, Personality
from tests.shares import examples
from tests.soaking import SOAKING

ARM, TAKE_OFF = 400, 22
ON_ITS_WAY_S = 0.1
"""A frame that left just before the end arrives this much later at the most."""


@dataclass(frozen=True, slots=True)
class Answers:
    """What becomes of each answer: how late it is in seconds, and how often it comes."""

    late_s: float
    most_copies: int
    lost: float


class LateFlight(Flight):
    """The vehicle's COMMAND_ACKs take ways of their own."""

    def __init__(self, personality: Personality, seed: int, answers: Answers) -> None:
        self.dice, self.answers = random.Random(seed), answers
        self.held: list[tuple[int, int, bytes]] = []
        self.began: dict[str, int] = {}
        self.asked: list[tuple[int, str]] = []
        super().__init__(personality, seed=seed + 1)

    def feed(self, given: inputs.Input) -> None:
        if not isinstance(given, inputs.Datagram):
            super().feed(given)
            return
        frames = [item for item in split(given.data) if isinstance(item, Frame)]
        rest = b"".join(frame.raw for frame in frames if frame.name != "COMMAND_ACK")
        for frame in frames:
            if frame.name != "COMMAND_ACK" or self.dice.random() < self.answers.lost:
                continue
            for _ in range(self.dice.randint(1, self.answers.most_copies)):
                late_ns = round(self.dice.uniform(0.0, self.answers.late_s) * 1e9)
                heapq.heappush(self.held, (self.now_ns + late_ns, len(self.held), frame.raw))
        if rest:
            super().feed(inputs.Datagram(given.link, rest))

    def passes(self, seconds: float) -> None:
        """Time, in which answers come and the vehicle is watched."""
        until_ns = self.now_ns + round(seconds * 1e9)
        while self.now_ns < until_ns:
            self.run(min(0.05, (until_ns - self.now_ns) / 1e9))
            while self.held and self.held[0][0] <= self.now_ns:
                super().feed(inputs.Datagram(0, heapq.heappop(self.held)[2]))
            self.watch()

    def watch(self) -> None:
        """When it is armed, and when it is in the air, for the first time since it was not."""
        for what, so in (("arm", self.vehicle.armed), ("takeoff", self.truth_enu()[2] > 0.3)):
            if not so:
                self.began.pop(what, None)
            elif what not in self.began:
                self.began[what] = self.now_ns
                self.not_late(what)

    def not_late(self, what: str) -> None:
        """Some request for it has not ended, or has just now."""
        ends = [self.ended_ns(ask) for ask, word in self.asked if word == what]
        late_ns = self.now_ns - round((ON_ITS_WAY_S + (3.0 if what == "takeoff" else 0.0)) * 1e9)
        assert any(end is None or end >= late_ns for end in ends), f"{what} takes effect late"

    def asks(self, word: str, up_m: float | None = None) -> None:
        self.asked.append((self.say(word, up_m=up_m), word))

    def ended_ns(self, ask_id: int) -> int | None:
        """When its ending was told, or its refusal."""
        for event, time_ns in zip(self.events, self.event_times_ns, strict=True):
            if getattr(event, "id", None) == ask_id and (
                getattr(event, "outcome", "") == "refused" or getattr(event, "ended", "")
            ):
                return time_ns
        return None

    def sent_late(self) -> list[str]:
        """Commands that left after the last request for them had ended."""
        found = []
        for sent in self.sent:
            message = pymavlink_decoder.read(sent.data)
            for word, command in (("arm", ARM), ("takeoff", TAKE_OFF)):
                if message.get_type() != "COMMAND_LONG" or message.command != command:
                    continue
                if command == ARM and message.param1 == 0.0:
                    continue
                ends = [self.ended_ns(ask) for ask, asked in self.asked if asked == word]
                if not any(end is None or end >= sent.time_ns for end in ends):
                    late_ns = sent.time_ns - max(end or 0 for end in ends)
                    found.append(f"{word} left {late_ns / 1e9} s late")
        return found


answers = st.builds(
    Answers,
    late_s=st.sampled_from([0.0, 0.5, 3.0, 8.0, 70.0]),
    most_copies=st.integers(1, 3),
    lost=st.sampled_from([0.0, 0.3, 1.0]),
)
waits_s = st.sampled_from([0.0, 0.3, 1.0, 3.0, 6.0, 12.0])
steps = st.lists(
    st.tuples(st.sampled_from(["arm", "takeoff", "abort", "disarm", "land"]), waits_s),
    min_size=1,
    max_size=5,
)


def fly(personality: Personality, seed: int, how: Answers, script: list[tuple[str, float]]) -> None:
    flight = LateFlight(personality, seed, how)
    flight.connected()
    for word, wait_s in [("arm", 1.0), *script]:
        if word == "takeoff":
            flight.asks(word, up_m=2.0)
        else:
            flight.asks(word)
        flight.passes(wait_s)
    flight.passes(20.0)
    assert flight.sent_late() == []


@pytest.mark.parametrize("personality", PERSONALITIES)
@settings(
    max_examples=300 if SOAKING else examples(12),
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
@given(seed=st.integers(0, 1000), how=answers, script=steps)
def test_what_is_not_answered_in_time_takes_no_effect_later(
    personality: Personality, seed: int, how: Answers, script: list[tuple[str, float]]
) -> None:
    fly(personality, seed, how, script)


@pytest.mark.parametrize("wait_s", [0.0, 0.3, 6.0])
def test_a_take_off_that_was_cancelled_is_not_begun_when_it_is_armed_again(wait_s: float) -> None:
    """An ArduCopter keeps it until it leaves GUIDED."""
    fly("ardupilot", 0, Answers(0.0, 1, 0.0), [("takeoff", 1.0), ("disarm", 6.0), ("arm", wait_s)])


def test_a_station_that_goes_on_asking_is_found(
    personality: Personality, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An arm is sent until it is answered, whatever has become of its request."""
    handle, arms = CommandClient.handle, set[int]()

    def stubborn(protocol: CommandClient, event: Input, now_ns: int) -> list[CommandEffect]:
        if isinstance(event, Withdraw) and event.token in arms:
            return []
        if isinstance(event, Submit) and event.command.command == ARM:
            arms.add(event.token)
            event = replace(event, tries=200, deadline_ns=event.deadline_ns + 10**11)
        return handle(protocol, event, now_ns)

    monkeypatch.setattr(CommandClient, "handle", stubborn)
    with pytest.raises(AssertionError, match=r"left .* s late|takes effect late"):
        fly(personality, 1, Answers(late_s=0.0, most_copies=1, lost=1.0), [("disarm", 1.0)])
