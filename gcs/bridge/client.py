"""One MAVLink client: who it is, what it has sent, and what it has asked of which vehicle."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import count

from gcs.bridge.dialogue import Dialogue, From
from gcs.bridge.effects import BridgeEffect, Notes
from gcs.bridge.meaning.chosen_takeoff import (
    KEPT_NS,
    Chosen,
    ends_choice,
    may_be_chosen,
    with_takeoff,
)
from gcs.bridge.meaning.meaning import Meaning, Seen, Settled, Sticks, Words
from gcs.bridge.meaning.pace import Pace
from gcs.bridge.meaning.stick_stream import StickStream
from gcs.bridge.plans.server import PlanServer
from gcs.gate.effects import Level
from gcs.protocol.transfer import Timing

SPAN_NS = 2_000_000_000
"""Rates are of the last whole span of this length."""


@dataclass(slots=True)
class Rate:
    """How many a second."""

    hz: float = 0.0
    _count: int = 0
    _since_ns: int = 0

    def count(self, many: int, now_ns: int) -> None:
        self._count += many
        span_ns = now_ns - self._since_ns
        if span_ns >= SPAN_NS:
            self.hz = self._count * 1e9 / span_ns if self._since_ns else 0.0
            self._count, self._since_ns = 0, now_ns


class Client:
    """One peer; an operator with a number of its own from its first good frame on."""

    def __init__(self, link: int, name: str, timing: Timing, deadman_ns: int) -> None:
        """`name` is where it is; `timing` is of the plans that it sends; one sample of its
        setpoint streams counts for `deadman_ns`."""
        self.link = link
        self.name = name
        self.timing = timing
        self.deadman_ns = deadman_ns
        self.joined = False
        self.heard_ns = 0
        self.received = Rate()
        self.sent = Rate()
        self.refused = 0
        self.dropped = 0
        self.begin(0)
        self.joined = False

    def begin(self, number: int) -> None:
        """It is an operator, with this number; what it asked for as another one is over."""
        self.number = number
        self.joined = True
        self.numbers = count(1)
        """Of its requests, whichever vehicle they are for."""
        self._exchanges: dict[int, Exchange] = {}

    def at(self, vehicle: int) -> Exchange:
        """What it asks of the vehicle with that system id."""
        found = self._exchanges.get(vehicle)
        if found is None:
            found = Exchange(self, vehicle)
            self._exchanges[vehicle] = found
        return found

    @property
    def exchanges(self) -> Iterable[Exchange]:
        """With every vehicle that it has asked for something, or was told of."""
        return tuple(self._exchanges.values())


class Exchange:
    """What one client asks of one vehicle: commands, plans and streams."""

    def __init__(self, client: Client, vehicle: int) -> None:
        self.vehicle = vehicle
        self.number, self.name = client.number, client.name
        self.dialogue = Dialogue(client.number, vehicle, client.numbers)
        self.plans = PlanServer(client.timing)
        self.pace = Pace(client.deadman_ns)
        self.sticks = StickStream()
        self._chosen: Chosen | None = None
        self._chosen_by: From | None = None
        self.plan_ask = 0
        """The number of the plan request that is not over; 0: none."""

    def settle(self, meaning: Meaning, seen: Seen, now_ns: int) -> Settled:
        """What a message of this client asks for, after those before it."""
        if isinstance(meaning, Sticks):
            return self.sticks.settle(meaning, seen, now_ns)
        return self.pace.settle(meaning, now_ns)

    # ------------------------------------------------------------------ take-off, then arming

    @property
    def chosen_until_ns(self) -> int | None:
        """When the take-off that was chosen is forgotten; None: there is none."""
        return None if self._chosen is None else self._chosen.until_ns

    def chooses(
        self, meaning: Settled, seen: Seen, by: From, now_ns: int
    ) -> list[BridgeEffect] | None:
        """Keep a take-off until this client arms; None where it cannot be chosen."""
        if self.dialogue.arming or not may_be_chosen(meaning, seen):
            return None
        assert isinstance(meaning, Words)
        (ask,) = meaning.asks
        self._chosen = Chosen(ask, seen.takeoff_up_m, now_ns + KEPT_NS)
        self._chosen_by = by
        text = f"takeoff: to {ask.up_m:.1f} m when you arm, within {KEPT_NS / 1e9:.0f} s"
        note = Notes(Level.INFO, f"{self.name}: {text}")
        return [note, *self.dialogue.text(by, Level.INFO, text, now_ns)]

    def joined_with_choice(
        self, meaning: Settled, seen: Seen, now_ns: int
    ) -> tuple[Settled, list[BridgeEffect]]:
        """An arming with the take-off that was chosen; anything else ends the choice."""
        chosen = self._chosen
        if chosen is None or not ends_choice(meaning):
            return meaning, []
        both = with_takeoff(chosen, meaning, seen, now_ns)
        if both is None:
            return meaning, self.forget_choice("something else was asked for", now_ns)
        self._chosen = None
        return both, []

    def forget_choice(self, why: str, now_ns: int) -> list[BridgeEffect]:
        """The take-off that was chosen is not flown; told once."""
        if self._chosen is None or self._chosen_by is None:
            return []
        self._chosen = None
        text = f"takeoff: forgotten: {why}"
        note = Notes(Level.INFO, f"{self.name}: {text}")
        return [note, *self.dialogue.text(self._chosen_by, Level.INFO, text, now_ns)]
