"""Compare what our vehicle did with what the real one did, step by step."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from math import inf
from typing import Final

from tests.scenarios.facts import Event, Scenario
from tests.scenarios.play import Played

DATES: Final = re.compile(r"\d{4}-\d\d-\d\d/\d\d_\d\d_\d\d")
KINDS: Final = ("acks", "modes", "armed", "landed", "texts")
TOLD_S: Final = 1.2
"""The real ones' modes were seen in heartbeats, which are up to a second late."""
BEFORE_S: Final = 0.02
"""So much before the next step: what it leads to may be seen in the instant in which it is sent."""
MEASURED: Final = {"RTL: ": 1.0, "Battery 1 is ": inf}
"""How far the numbers in texts that begin so may be apart: metres that are rounded up from a noisy
height; volts and mAh of another battery."""
NUMBER: Final = re.compile(r"-?\d+(?:\.\d+)?")


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
        if step.sent.startswith(("COMMAND_", "mission upload", "MISSION_")):
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
    told = [_words(text) for text in played.texts]
    for event in scenario.events:
        if event.kind == "STATUSTEXT" and event.text is not None:
            text = _words(event.text)
            same = next((own for own in told if _same(own, text)), None)
            found.texts[same is not None] += 1
            if same is not None:
                told.remove(same)
            else:
                found.differences.append(f"{name} text: {text}")
    return found


def _words(text: str) -> str:
    """Without PX4's closing tab, and without the date in a log's name."""
    return DATES.sub("<date>", text.strip())


def _same(own: str, real: str) -> bool:
    """Whether two texts say the same; measured numbers may be a little apart."""
    if own == real:
        return True
    apart = next((most for start, most in MEASURED.items() if real.startswith(start)), None)
    if apart is None or NUMBER.sub("#", own) != NUMBER.sub("#", real):
        return False
    pairs = zip(NUMBER.findall(own), NUMBER.findall(real), strict=True)
    return all(abs(float(mine) - float(theirs)) <= apart for mine, theirs in pairs)


Row = tuple[str, Counter[bool], set[object], object]


def _states(scenario: Scenario, played: Played, at_s: float, found: Agreement) -> Iterator[Row]:
    """What the real one may have been in just before `at_s`, and what ours was, of each kind."""
    at_s -= BEFORE_S
    ours = [seen for seen in played.seen if seen.t <= max(0.0, at_s)][-1]

    def known(pick: Callable[[Event], object]) -> set[object]:
        told = [(e.t, pick(e)) for e in scenario.events if pick(e) is not None]
        before = [value for t, value in told if t <= max(0.0, at_s)][-1:]
        soon = [value for t, value in told if at_s < t <= at_s + TOLD_S]
        return {*before, *soon}

    if modes := known(lambda event: event.mode):
        yield "mode", found.modes, modes, ours.mode
    if armed := known(lambda event: event.armed):
        yield "armed", found.armed, armed, ours.armed
    if landed := known(lambda event: event.state or _at_first(scenario, event)):
        yield "landed", found.landed, landed, ours.landed


def _at_first(scenario: Scenario, event: Event) -> str | None:
    """Who is disarmed at the start stands; told where a change is seen later."""
    changes = any(other.state is not None for other in scenario.events)
    return "ON_GROUND" if event is scenario.start and event.armed is False and changes else None
