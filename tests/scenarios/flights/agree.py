"""Compare our flight with the real one's: answers, states, texts, kinds, rates, movements."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from math import hypot
from statistics import median
from typing import Final

from tests.scenarios.agree import DATES
from tests.scenarios.flights.facts import Flight, Point, State, Word
from tests.scenarios.flights.script import FIGURES, PHASES, Figure, commands
from vehicle_sim.autopilot.modes import Personality

LATE_S: Final = 1.2
"""A HEARTBEAT may be so late."""
SOON_S: Final = 0.6
"""Texts and first messages that come within so long of each other come together."""
RATE_SHARE: Final = 0.15
RATE_COUNT: Final = 1.5
"""What rates may differ by: a share, or one message in a phase."""
REQUEST_MESSAGE: Final = 512
ALIKE: Final = 0.2
"""Issue 8: step responses within 20 %."""


@dataclass
class Agreement:
    """Of each: how many agree, of how many; what differs, in words without figures; and the
    movements, ours beside the real one's."""

    counted: dict[str, Counter[bool]] = field(default_factory=dict)
    differences: list[str] = field(default_factory=list)
    figures: list[tuple[Figure, float, float]] = field(default_factory=list)

    def count(self, kind: str, agrees: bool, difference: str) -> None:
        self.counted.setdefault(kind, Counter())[agrees] += 1
        if not agrees and difference not in self.differences:
            self.differences.append(difference)

    def share(self, kind: str) -> str:
        counted = self.counted.get(kind, Counter())
        return f"{counted[True]}/{counted[True] + counted[False]}"


def compare(personality: Personality, real: Flight, ours: Flight) -> Agreement:
    found = Agreement()
    _acks(personality, found, real, ours)
    _states(found, real, ours)
    _landed(found, real, ours)
    _texts(found, real, ours)
    _kinds(found, real, ours)
    _rates(personality, found, real, ours)
    for figure in FIGURES[personality]:
        told, own = measured(figure, real), measured(figure, ours)
        found.figures.append((figure, told, own))
        alike = abs(own - told) <= max(ALIKE * abs(told), figure.slack)
        found.count("figures", alike, f"figure: {figure.name}")
    return found


# ------------------------------------------------------------------------- what was answered


def _acks(personality: Personality, found: Agreement, real: Flight, ours: Flight) -> None:
    """Each recorded ack beside the next of ours for that command; the rest of ours is too many."""
    left = list(ours.acks)
    sent = (command for command in commands(personality) if command.acked)
    for ack, command in zip(real.acks, sent, strict=True):
        near = [o for o in left if o.command == ack.command and abs(o.t - ack.t) < SOON_S]
        own = near[0].result if near else None
        if near:
            left.remove(near[0])
        asked = f" of message {command.params[0]:.0f}" if ack.command == REQUEST_MESSAGE else ""
        words = f"ack of {ack.command}{asked}: {ack.result}, ours {own}"
        found.count("acks", own == ack.result, words)
    for extra in left:
        found.count("acks", False, f"ack of {extra.command}: none, ours {extra.result}")


# ---------------------------------------------------------------------------------- states


def _states(found: Agreement, real: Flight, ours: Flight) -> None:
    """Each state that the real one told, beside what ours told within a heartbeat of it."""
    picks: tuple[tuple[str, Callable[[State], object]], ...] = (
        ("mode", lambda state: state.mode),
        ("armed", lambda state: bool(state.base_mode & 128)),
        ("base_mode", lambda state: state.base_mode & ~128),
        ("system_status", lambda state: state.status),
    )
    for kind, pick in picks:
        runs = _runs([(state.t, pick(state)) for state in real.states])
        own = _runs([(state.t, pick(state)) for state in ours.states])
        for start_s, end_s, value in runs:
            told = _during(own, start_s - LATE_S, start_s + LATE_S)
            found.count(kind, value in told, f"{kind} {value}: ours {_listed(told)}")
            if end_s - start_s > 2 * LATE_S:
                later = _during(own, start_s + LATE_S, end_s - LATE_S)
                words = f"{kind} {value} lasts: ours then {_listed(later)}"
                found.count(kind, later == [value], words)


Run = tuple[float, float, object]
ENDLESS_S: Final = 1e9


def _runs(told: Iterable[tuple[float, object]]) -> list[Run]:
    """From, until, value."""
    kept: list[tuple[float, object]] = []
    for t, value in told:
        if not kept or kept[-1][1] != value:
            kept.append((t, value))
    ends = [*(t for t, _ in kept[1:]), ENDLESS_S]
    return [(t, end_s, value) for (t, value), end_s in zip(kept, ends, strict=True)]


def _during(runs: Sequence[Run], from_s: float, to_s: float) -> list[object]:
    return list(dict.fromkeys(v for start, end, v in runs if start < to_s and end > from_s))


def _listed(values: Iterable[object]) -> str:
    return " and ".join(map(str, values)) or "none"


def _landed(found: Agreement, real: Flight, ours: Flight) -> None:
    own = _runs([(word.t, word.text) for word in ours.landed])
    for word in real.landed:
        told = _during(own, word.t - LATE_S, word.t + LATE_S)
        found.count("landed", word.text in told, f"landed {word.text}: ours {_listed(told)}")


# ------------------------------------------------------------------------ texts and kinds


def _texts(found: Agreement, real: Flight, ours: Flight) -> None:
    left = [Word(word.t, DATES.sub("<date>", word.text)) for word in ours.texts]
    for word in real.texts:
        text = DATES.sub("<date>", word.text)
        same = [other for other in left if other.text == text]
        near = min(same, key=lambda other: abs(other.t - word.t), default=None)
        if near is not None:
            left.remove(near)
        when = "never" if near is None else "sooner" if near.t < word.t else "later"
        alike = near is not None and abs(near.t - word.t) <= LATE_S
        found.count("texts", alike, f"text {text!r}: ours {when}")
    for word in left:
        found.count("texts", False, f"text {word.text!r}: ours only")


def _kinds(found: Agreement, real: Flight, ours: Flight) -> None:
    """Which there are, and which came first."""
    told = {kind.name: kind.first_s for kind in real.kinds}
    own = {kind.name: kind.first_s for kind in ours.kinds}
    for name in told:
        found.count("kinds", name in own, f"kind {name}: the real one only")
    for name in own.keys() - told.keys():
        found.count("kinds", False, f"kind {name}: ours only")
    both = sorted(told.keys() & own.keys(), key=lambda name: told[name])
    for name in both:
        when = "sooner" if own[name] < told[name] else "later"
        alike = abs(own[name] - told[name]) <= LATE_S
        found.count("first of a kind", alike, f"first {name}: ours {when}")
    for number, name in enumerate(both):
        for after in (other for other in both[number + 1 :] if told[other] > told[name] + SOON_S):
            found.counted.setdefault("order of two kinds", Counter())[own[after] > own[name]] += 1


def _rates(personality: Personality, found: Agreement, real: Flight, ours: Flight) -> None:
    both = {kind.name for kind in real.kinds} & {kind.name for kind in ours.kinds}
    for (phase, from_s, to_s), rates_hz in zip(
        ((each.name, each.from_s, each.to_s) for each in PHASES[personality]),
        real.rates_hz.values(),
        strict=True,
    ):
        own_hz = ours.rates_hz[phase]
        for name in sorted(both & (rates_hz.keys() | own_hz.keys())):
            told, own = rates_hz.get(name, 0.0), own_hz.get(name, 0.0)
            alike = abs(own - told) <= max(RATE_SHARE * told, RATE_COUNT / (to_s - from_s))
            more = "more" if own > told else "fewer"
            found.count("rates", alike, f"rate {phase}, {name}: ours {more}")


# ------------------------------------------------------------------------------ movements


def measured(figure: Figure, flight: Flight) -> float:
    """The figure of this flight; NaN-free: 0 where it has none."""
    points = [p for p in flight.track if figure.from_s <= p.t <= figure.to_s]
    match figure.what:
        case "up":
            return round(max((p.v_up for p in points), default=0.0), 2)
        case "down":
            return round(max((-p.v_up for p in points), default=0.0), 2)
        case "mean down":
            return round(-median(p.v_up for p in points), 2) if points else 0.0
        case "height":
            return round(median(p.up for p in points), 2) if points else 0.0
        case "horizontal":
            return round(max((hypot(p.v_north, p.v_east) for p in points), default=0.0), 2)
        case "mean horizontal":
            return round(median(hypot(p.v_north, p.v_east) for p in points), 2) if points else 0.0
        case "time to 90 %":
            return _time_to_90(points)
        case "until landed state":
            return _until(figure, ((w.t, w.text) for w in flight.landed))
        case "until disarmed":
            armed = ((s.t, str(bool(s.base_mode & 128))) for s in flight.states)
            return _until(figure, armed)
    raise ValueError(figure.what)


def _time_to_90(points: Sequence[Point]) -> float:
    if not points:
        return 0.0
    start, end = points[0], points[-1]
    far = hypot(end.north - start.north, end.east - start.east)
    for p in points:
        if hypot(p.north - start.north, p.east - start.east) >= 0.9 * far:
            return round(p.t - start.t, 2)
    return 0.0


def _until(figure: Figure, told: Iterable[tuple[float, str]]) -> float:
    """From the window's begin to the first such word in it."""
    when = (t for t, text in told if text == figure.word and figure.from_s <= t <= figure.to_s)
    return round(next(when, figure.from_s) - figure.from_s, 2)


def lines(found: Agreement) -> Iterator[str]:
    """The table, side by side, then what differs."""
    for kind in found.counted:
        yield f"  {kind:<20} {found.share(kind)}"
    yield f"  {'':<44} {'real':>8} {'ours':>8}"
    for figure, real, ours in found.figures:
        yield f"  {figure.name + ' [' + figure.unit + ']':<44} {real:>8.2f} {ours:>8.2f}"
