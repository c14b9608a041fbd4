"""One MAVLink client: who it is, what it has sent, and what it has asked of which vehicle.

A client that sends more than it may is told so.  The shell counts what it drops of each client
unread, and the log has that once a second.  The client itself reads it as a STATUSTEXT in a
vehicle's name: within a second of the first that was dropped, and while it goes on at most once in
`TOLD_NS`, each time with all since the last text.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Final

from gcs import ipc
from gcs.bridge.conversation.answers import texts
from gcs.bridge.conversation.dialogue import Dialogue
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import AboutVehicle, BridgeEffect, ClientRequest, LogLine
from gcs.bridge.plans.server import PlanServer
from gcs.bridge.translate.chosen_before_arming import (
    KEPT_NS,
    MISSION_MODE,
    Chosen,
    ChosenMission,
    ChosenTakeoff,
    ends_choice,
    mission_may_be_chosen,
    takeoff_may_be_chosen,
    with_chosen,
)
from gcs.bridge.translate.meaning import Meaning, Seen, Settled, Sticks, Words
from gcs.bridge.translate.settling import Pace, StickStream
from gcs.gate.effects import Level
from gcs.protocol.transfers.transfer import Timing
from gcs.wire.messages import Statustext

SPAN_NS = 2_000_000_000
"""Rates are of the last whole span of this length."""
TOLD_NS: Final = 5_000_000_000
"""Between two texts of what was dropped."""
TEXT_ID: Final = 1
"""Joins the pieces, where a large number makes the text longer than one."""


@dataclass(slots=True)
class DroppedMessages:
    """Datagrams of one client that were dropped."""

    count: int = 0
    """Since it came."""
    _told: int = 0
    _told_ns: int | None = None

    def due_text(self, rate_hz: float, now_ns: int) -> Sequence[Statustext]:
        """What it is to be told now; `rate_hz` is what it may send."""
        new = self.count - self._told
        if not new or (self._told_ns is not None and now_ns - self._told_ns < TOLD_NS):
            return ()
        self._told, self._told_ns = self.count, now_ns
        text = f"gate: {new} dropped: more than {rate_hz:g} messages/s"
        return texts(Level.WARNING, text, TEXT_ID)


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

    def __init__(
        self, link: int, name: str, timing: Timing, deadman_ns: int, *, named: bool = False
    ) -> None:
        """`name` is where it is; `timing` is of the plans that it sends; one sample of its
        setpoint streams counts for `deadman_ns`.  `named`: it is sent to before it is heard."""
        self.link = link
        self.name = name
        self.named = named
        self.timing = timing
        self.deadman_ns = deadman_ns
        self.joined = False
        self.heard_ns = 0
        self.received = Rate()
        self.sent = Rate()
        self.refused = 0
        self.dropped = DroppedMessages()
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
        self._back_ns: int | None = None
        """When the mode of a mission that this client set is taken back."""
        self._back_latest_ns = 0
        """The same, however many armings are asked for meanwhile."""
        self.plan_ask = 0
        """The number of the plan request that is not over; 0: none."""

    def settle(self, meaning: Meaning, seen: Seen, now_ns: int) -> Settled:
        """What a message of this client asks for, after those before it."""
        if isinstance(meaning, Sticks):
            return self.sticks.settle(meaning, seen, now_ns)
        return self.pace.settle(meaning, now_ns)

    # ------------------------------------------------------- take-off or mission, then arming

    @property
    def chosen_until_ns(self) -> int | None:
        """When `wake` is due: what was chosen is forgotten, or its mode is taken back; None: there
        is nothing."""
        times = [self._back_ns, None if self._chosen is None else self._chosen.until_ns]
        return min((time for time in times if time is not None), default=None)

    def wake(self, now_ns: int) -> list[BridgeEffect]:
        """`chosen_until_ns` has passed."""
        done: list[BridgeEffect] = []
        if self._chosen is not None and self._chosen.until_ns <= now_ns:
            done += self.forget_choice("not armed in time", now_ns)
        if self._back_ns is not None and self._back_ns <= now_ns:
            done += self.take_mode_back()
        return done

    def chooses_takeoff(
        self, meaning: Settled, seen: Seen, by: From, now_ns: int
    ) -> list[BridgeEffect] | None:
        """Keep a take-off until this client arms; None where it cannot be chosen."""
        if self.dialogue.arming or not takeoff_may_be_chosen(meaning, seen):
            return None
        assert isinstance(meaning, Words)
        (ask,) = meaning.asks
        chosen = ChosenTakeoff(ask, seen.takeoff_up_m, now_ns + KEPT_NS)
        return self._choose(chosen, f"to {ask.up_m:.1f} m", by, now_ns)

    def chooses_mission(
        self, meaning: Settled, seen: Seen, by: From, now_ns: int
    ) -> list[BridgeEffect] | None:
        """Start the mission when this client arms; None where that cannot be chosen."""
        if self.dialogue.arming or not mission_may_be_chosen(meaning, seen):
            return None
        self._back_ns, self._back_latest_ns = now_ns + KEPT_NS, now_ns + 2 * KEPT_NS
        return self._choose(ChosenMission(now_ns + KEPT_NS), "begins", by, now_ns)

    def _choose(self, chosen: Chosen, what: str, by: From, now_ns: int) -> list[BridgeEffect]:
        self._chosen, self._chosen_by = chosen, by
        text = f"{chosen.name}: {what} when you arm, within {KEPT_NS / 1e9:.0f} s"
        note = LogLine(Level.INFO, f"{self.name}: {text}")
        return [note, *self.dialogue.text(by, Level.INFO, text, now_ns)]

    def joined_with_choice(
        self, meaning: Settled, seen: Seen, now_ns: int
    ) -> tuple[Settled, list[BridgeEffect]]:
        """An arming with what was chosen; anything else ends the choice."""
        chosen = self._chosen
        if chosen is None or not ends_choice(meaning):
            return meaning, []
        both = with_chosen(chosen, meaning, seen, now_ns)
        if both is None:
            return meaning, self.forget_choice("something else was asked for", now_ns)
        self._chosen = None
        self.keep_mode_for_now(now_ns)
        return both, []

    def forget_choice(self, why: str, now_ns: int) -> list[BridgeEffect]:
        """What was chosen is not flown; told once."""
        if self._chosen is None or self._chosen_by is None:
            return []
        text = f"{self._chosen.name}: forgotten: {why}"
        self._chosen = None
        note = LogLine(Level.INFO, f"{self.name}: {text}")
        return [note, *self.dialogue.text(self._chosen_by, Level.INFO, text, now_ns)]

    def control_lost(self, why: str, now_ns: int) -> list[BridgeEffect]:
        """Another one is in control, or nobody: what was chosen is not flown, and what was answered
        is not answered from memory."""
        self.dialogue.control_lost()
        return self.forget_choice(why, now_ns)

    def keep_mode_for_now(self, now_ns: int) -> None:
        """An arming is asked for: if it is refused, the mode is taken back later."""
        if self._back_ns is not None:
            self._back_ns = min(now_ns + KEPT_NS, self._back_latest_ns)

    def keep_mode(self) -> None:
        """The vehicle is armed: its mode is not taken back any more."""
        self._back_ns = None

    def take_mode_back(self) -> list[BridgeEffect]:
        """The mode of a mission that was set, and not followed by a start, gives way to hold:
        whoever arms the vehicle past this station would start the mission."""
        if self._back_ns is None:
            return []
        self._back_ns = None
        hold = ipc.Ask(self.dialogue.number(), "hold", vehicle=self.vehicle)
        text = f"{self.name}: {MISSION_MODE} is taken back: the mission was not started"
        return [LogLine(Level.INFO, text), ClientRequest(self.number, hold)]


def of_vehicle(exchange: Exchange, effects: Sequence[BridgeEffect]) -> list[BridgeEffect]:
    """What an exchange leads to, as its vehicle's."""
    return [AboutVehicle(exchange.vehicle, tuple(effects))] if effects else []
