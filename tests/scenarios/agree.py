"""Compare what our vehicle did with what the real one did, step by step."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Final

from tests.scenarios.facts import Event, Scenario
from tests.scenarios.play import Played

DATES: Final = re.compile(r"\d{4}-\d\d-\d\d/\d\d_\d\d_\d\d")
KINDS: Final = ("acks", "modes", "armed", "landed", "texts")
TOLD_S: Final = 1.2
"""The real ones' modes were seen in heartbeats, which are up to a second late."""


@dataclass
class Agreement:
    """Of each: how many agree, of how many; and what differs, in words."""

    acks: Counter[bool] = field(default_factory=Counter)
    modes: Counter[bool] = field(default_factory=Counter)
    armed: Counter[bool] = field(default_factory=Counter)
    landed: Counter[bool] = field(default_factory=Counter)
    texts: Counter[bool] = field(default_factory=Counter)
    differences: list[str] = field(default_factory=list)

    def __add__(self, other: Agreement) -> Agreement:
        both = Agreement(differences=[*self.differences, *other.differences])
        for name in KINDS:
            mine, theirs = getattr(self, name), getattr(other, name)
            setattr(both, name, Counter({k: mine[k] + theirs[k] for k in (True, False)}))
        return both

    def __str__(self) -> str:
        return ", ".join(f"{kind} {self._share(getattr(self, kind))}" for kind in KINDS)

    @staticmethod
    def _share(counted: Counter[bool]) -> str:
        total = counted[True] + counted[False]
        return f"{counted[True]}/{total}"


def compare(scenario: Scenario, played: Played) -> Agreement:
    """Answers of every step, then the states just before the next step, then all texts."""
    found = Agreement()
    name = scenario.scenario
    steps = scenario.steps
    for number, (step, ours) in enumerate(zip(steps, played.acks, strict=True)):
        if step.sent.startswith(("COMMAND_", "mission", "MISSION_")):
            agree = ours == step.ack
            found.acks[agree] += 1
            if not agree:
                found.differences.append(f"{name} {number} {step.sent}: {step.ack}, ours {ours}")
        later = [other.t for other in steps[number + 1 :]]
        until_s = later[0] if later else scenario.end_s
        for kind, counted, real, own in _states(scenario, played, until_s, found):
            agree = own in real
            counted[agree] += 1
            if not agree:
                words = " or ".join(sorted(map(str, real)))
                found.differences.append(f"{name} {number} {kind}: {words}, ours {own}")
    told = Counter(_words(text) for text in played.texts)
    for event in scenario.events:
        if event.kind == "STATUSTEXT" and event.text is not None:
            text = _words(event.text)
            found.texts[told[text] > 0] += 1
            if told[text] == 0:
                found.differences.append(f"{name} text: {text}")
            told[text] -= 1
    return found


def _words(text: str) -> str:
    """Without PX4's closing tab, and without the date in a log's name."""
    return DATES.sub("<date>", text.strip())


Row = tuple[str, Counter[bool], set[object], object]


def _states(scenario: Scenario, played: Played, at_s: float, found: Agreement) -> Iterator[Row]:
    """What the real one may have been in at `at_s`, and what ours was, of each kind."""
    ours = [seen for seen in played.seen if seen.t <= at_s][-1]

    def known(pick: Callable[[Event], object]) -> set[object]:
        told = [(e.t, pick(e)) for e in scenario.events if pick(e) is not None]
        before = [value for t, value in told if t <= at_s][-1:]
        soon = [value for t, value in told if at_s < t <= at_s + TOLD_S]
        return {*before, *soon}

    if modes := known(lambda event: event.mode):
        yield "mode", found.modes, modes, ours.mode
    if armed := known(lambda event: event.armed):
        yield "armed", found.armed, armed, ours.armed
    if landed := known(lambda event: event.state):
        yield "landed", found.landed, landed, ours.landed
