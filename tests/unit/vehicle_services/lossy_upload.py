"""An upload over a bad link: a client with its own patience, the air, the mission server."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from tests.unit.vehicle_services.fake_vehicle import FakeVehicle
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.effects import Client, Send
from vehicle_sim.services.missions.mission import MissionServer
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.simulation.impairment import Air, Direction, Impairment
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MissionResult

MS = 1_000_000
STATION = Client(0, 255, 190)
BAD_LINK = Impairment(loss=0.3, duplicate=0.2, reorder=0.1, delay_ns=250 * MS, jitter_ns=20 * MS)
"""Each way: 500 ms there and back."""
NEVER = 1 << 62

Said: TypeAlias = m.MissionCount | m.MissionItem | m.MissionItemInt


@dataclass(frozen=True, slots=True)
class Patience:
    """How a client waits: `repeats_item` = it sends its last item again when nothing comes."""

    wait_ns: int
    tries: int
    repeats_item: bool
    floats: bool = False


PATIENCE = {
    "mavsdk": Patience(500 * MS, 20, repeats_item=True),
    "mavlink spec": Patience(1500 * MS, 5, repeats_item=True),
    "qgroundcontrol": Patience(1500 * MS, 5, repeats_item=False),
    "mavwp": Patience(2000 * MS, 60, repeats_item=False, floats=True),
    "dogged": Patience(700 * MS, 1000, repeats_item=True),
}


class Uploader:
    """Answers requests; gives up after so many silences in a row."""

    def __init__(self, items: list[m.MissionItemInt], patience: Patience) -> None:
        self._items = items
        self._patience = patience
        self._last: Said = m.MissionCount(len(items), 1, 1, 0)
        self._tries = 0
        self.deadline_ns = 0
        self.result: int | None = None  # MAV_MISSION_RESULT
        self.gave_up = False
        self.sent = 0

    @property
    def over(self) -> bool:
        return self.gave_up or self.result is not None

    def hear(self, message: m.Message, now_ns: int) -> list[Said]:
        if self.over:
            return []
        if isinstance(message, m.MissionAck):
            self.result = message.type
            return []
        if isinstance(message, m.MissionRequest | m.MissionRequestInt):
            self._tries = 0
            self._last = self._item(message.seq)
            return self._say(now_ns)
        return []

    def tick(self, now_ns: int) -> list[Said]:
        if self.over or now_ns < self.deadline_ns:
            return []
        self._tries += 1
        if self._tries > self._patience.tries:
            self.gave_up = True
            return []
        if isinstance(self._last, m.MissionCount) or self._patience.repeats_item:
            return self._say(now_ns)
        self.deadline_ns = now_ns + self._patience.wait_ns
        return []

    def _say(self, now_ns: int) -> list[Said]:
        self.deadline_ns = now_ns + self._patience.wait_ns
        self.sent += 1
        return [self._last]

    def _item(self, seq: int) -> Said:
        item = self._items[seq]
        if not self._patience.floats:
            return item
        return m.MissionItem._make((*item[:4], item.x * 1e-7, item.y * 1e-7, *item[6:]))


@dataclass(frozen=True, slots=True)
class Outcome:
    """`asked` and `sent`: messages of either side; `busy`: the vehicle still receives."""

    stored: int
    result: int | None
    gave_up: bool
    busy: bool
    seconds: float
    asked: int
    sent: int


def waypoints(count: int, up_m: float = 20.0) -> list[m.MissionItemInt]:
    return [
        m.MissionItemInt(
            *(0.0, 0.0, 0.0, 0.0, 473977420 + 100 * seq, 85455940, up_m),
            *(seq, 16, 1, 1, 6, 0, 1, 0),
        )
        for seq in range(count)
    ]


def upload(
    personality: Personality,
    patience: Patience,
    seed: int,
    items: list[m.MissionItemInt],
    link: Impairment = BAD_LINK,
    vehicle: FakeVehicle | None = None,
) -> Outcome:
    """To the end: until both sides are idle and nothing is under way."""
    vehicle = vehicle if vehicle is not None else FakeVehicle()
    server = MissionServer(vehicle, PROFILES[personality])
    client = Uploader(items, patience)
    up: Air[tuple[int, Said]] = Air(seed, Direction.TO_VEHICLE, (False,))
    down: Air[m.Message] = Air(seed, Direction.FROM_VEHICLE, (False,))
    up.impair(0, link)
    down.impair(0, link)
    now_ns, frames, asked = 0, 0, 0

    while True:
        for effect in server.tick(now_ns):
            asked += 1
            if isinstance(effect, Send):
                down.handle(0, "client", effect.message, now_ns)
        said: list[Said] = list(client.tick(now_ns))
        for message in down.arrived(now_ns):
            said += client.hear(message, now_ns)
        for each in said:
            frames += 1
            up.handle(0, "client", (frames & 0xFF, each), now_ns)
        for sequence, each in up.arrived(now_ns):
            if isinstance(each, m.MissionCount):
                effects = server.count(STATION, each, now_ns, sequence)
            else:
                effects = server.item(STATION, each, now_ns)
            for effect in effects:
                asked += 1
                if isinstance(effect, Send):
                    down.handle(0, "client", effect.message, now_ns)
        waits_ns = NEVER if client.over else client.deadline_ns
        next_ns = min(server.deadline_ns, waits_ns, up.deadline_ns, down.deadline_ns)
        if next_ns >= NEVER:
            break
        now_ns = max(next_ns, now_ns + 1)
    return Outcome(
        stored=len(vehicle.plan),
        result=client.result,
        gave_up=client.gave_up,
        busy=server.deadline_ns < NEVER,
        seconds=now_ns / 1e9,
        asked=asked,
        sent=client.sent,
    )


ACCEPTED = MissionResult.ACCEPTED
