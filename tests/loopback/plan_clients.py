"""Clients that upload a plan through the bridge, each with the manners of a real one.

What they do and for how long they wait is from their sources: MAVSDK's
`mavlink_mission_transfer_client.cpp` (4 tries, 0.5 s), QGroundControl's `PlanManager.cc` (1.5 s, 5
tries of the count), MAVProxy's `mission_item_protocol.py`; DroneKit's `CommandSequence.upload` and
the usual script of pymavlink from memory.  Their bytes are pymavlink's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from pymavlink.dialects.v20 import all as dialect

from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.session import inputs
from tests.loopback.bridged import BRIDGE, VEHICLE, BridgedFlight, Client
from tests.loopback.flight import HOMES, Personality
from tests.loopback.lossy_link import CLEAR, Air, Weather
from vehicle_sim.autopilot.firmware import Firmware

MS = 1_000_000
S = 1_000 * MS
MISSION, FENCE, RALLY = 0, 1, 2
ACCEPTED = 0
UNSUPPORTED = 3
WAYPOINT, RETURN, TAKE_OFF, DO_JUMP, RALLY_POINT = 16, 20, 22, 177, 5100
AMSL, NO_PLACE, ABOVE_HOME = 0, 2, 3
NORTH_DEG = 1.0 / 111_319.5


@dataclass(frozen=True, slots=True)
class PlanItem:
    """What a client has of an item; the place in degrees."""

    command: int
    lat_deg: float = 0.0
    lon_deg: float = 0.0
    alt_m: float = 0.0
    frame: int = ABOVE_HOME
    params: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    kind: int = MISSION


class PlanFlight(BridgedFlight):
    """A bridged flight whose clients have links of their own, with weather, and clocks."""

    def __init__(
        self,
        personality: Personality = "px4",
        *,
        seed: int = 1,
        policy: Policy = DEFAULT,
        firmware: Firmware | None = None,
        vehicle_weather: Weather = CLEAR,
        client_weather: Weather = CLEAR,
        config: StationConfig = BRIDGE,
    ) -> None:
        self.client_weather = client_weather
        self.seed = seed
        self.to_bridge: dict[int, Air] = {}
        self.from_bridge: dict[int, Air] = {}
        self.uploads: list[Upload] = []
        super().__init__(
            personality,
            seed=seed,
            policy=policy,
            up=vehicle_weather,
            down=vehicle_weather,
            firmware=firmware,
            config=config,
        )

    def join(self, sysid: int = 245, compid: int = 190) -> Client:
        link = 1 + len(self.clients)
        self.to_bridge[link] = Air(self.client_weather, 1000 * self.seed + 2 * link)
        self.from_bridge[link] = Air(self.client_weather, 1000 * self.seed + 2 * link + 1)
        return super().join(sysid, compid)

    def to_client(self, link: int, data: bytes) -> None:
        self.from_bridge[link].send(data, self.now_ns)

    def _step(self, limit_ns: int) -> bool:
        due = [air.next_ns for air in (*self.to_bridge.values(), *self.from_bridge.values())]
        waits = (upload.deadline_ns for upload in self.uploads)
        due += [deadline_ns for deadline_ns in waits if deadline_ns is not None]
        next_ns = min(due, default=limit_ns + 1)
        before_ns = max(self.now_ns, min(limit_ns, next_ns - 1))
        if super()._step(before_ns):
            return True
        if next_ns > limit_ns:
            self.now_ns = limit_ns
            return False
        self.now_ns = max(self.now_ns, next_ns)
        for link, air in self.to_bridge.items():
            for data in air.arrived(self.now_ns):
                self.feed(inputs.Datagram(link, data))
        for link, air in self.from_bridge.items():
            for data in air.arrived(self.now_ns):
                self.clients[link].hear(data)
        for upload in self.uploads:
            upload.look(self.now_ns)
        return True


class Upload:
    """One upload of one client; `result` is what it believes in the end."""

    wait_ns: ClassVar[int] = 500 * MS
    as_int: ClassVar[bool] = True
    knows: ClassVar[tuple[str, ...]] = ("MISSION_REQUEST", "MISSION_REQUEST_INT")

    def __init__(self, flight: PlanFlight, client: Client, items: list[PlanItem]) -> None:
        self.flight = flight
        self.client = client
        self.items = items
        self.kind = items[0].kind
        self.result = ""
        self.asked: list[int] = []
        """Every question that it has answered, in order."""
        self.acks: list[int] = []
        """Every MISSION_ACK that it was sent about this kind."""
        self.began_ns = flight.now_ns
        self.ended_ns = 0
        self.deadline_ns: int | None = None
        self._read = len(client.heard)
        flight.uploads.append(self)
        self.begin()

    # ------------------------------------------------------------------------------- time

    def look(self, now_ns: int) -> None:
        """Read what came; then the clock."""
        while self._read < len(self.client.heard):
            message = self.client.heard[self._read].message
            self._read += 1
            if getattr(message, "mission_type", None) != self.kind:
                continue
            if message.get_type() == "MISSION_ACK":
                self.acks.append(message.type)
            if not self.result:
                self.hear(message)
        if self.deadline_ns is not None and now_ns >= self.deadline_ns:
            self.deadline_ns = None
            if not self.result:
                self.late()

    @property
    def took_s(self) -> float:
        return (self.ended_ns - self.began_ns) / 1e9

    def ended(self, within_s: float = 30.0) -> str:
        """Let time pass to its end; what the client believes then."""
        self.flight.until(lambda: bool(self.result), within_s)
        return self.result

    def wait(self, span_ns: int) -> None:
        self.deadline_ns = self.flight.now_ns + span_ns

    def end(self, result: str) -> None:
        self.result, self.deadline_ns, self.ended_ns = result, None, self.flight.now_ns

    # --------------------------------------------------------------------------- messages

    def send_count(self) -> None:
        self._send(dialect.MAVLink_mission_count_message(*VEHICLE, len(self.items), self.kind))

    def send_item(self, seq: int) -> None:
        if seq >= len(self.items):
            return  # a question about another upload
        self.asked.append(seq)
        item = self.items[seq]
        head = (*VEHICLE, seq, item.frame, item.command, int(seq == 0), 1, *item.params)
        if self.as_int:
            scale = 1.0 if item.frame == NO_PLACE else 1e7
            place = (round(item.lat_deg * scale), round(item.lon_deg * scale), item.alt_m)
            self._send(dialect.MAVLink_mission_item_int_message(*head, *place, self.kind))
        else:
            degrees = (item.lat_deg, item.lon_deg, item.alt_m)
            self._send(dialect.MAVLink_mission_item_message(*head, *degrees, self.kind))

    def send_ack(self, result: int) -> None:
        self._send(dialect.MAVLink_mission_ack_message(*VEHICLE, result, self.kind))

    def _send(self, message: Any) -> None:
        data = message.pack(self.client.mav)
        self.flight.to_bridge[self.client.link].send(data, self.flight.now_ns)

    # ---------------------------------------------------------------------- what differs

    def begin(self) -> None:
        self.send_count()
        self.wait(self.wait_ns)

    def hear(self, message: Any) -> None:
        raise NotImplementedError

    def late(self) -> None:
        raise NotImplementedError


class Mavsdk(Upload):
    """Each question for another item than the next one, and each wait, uses up a try of four."""

    retries: ClassVar[int] = 4

    def begin(self) -> None:
        self.next_seq, self.tries, self.items_asked = 0, 0, False
        self.send_count()
        self.tries += 1
        self.wait(self.wait_ns)

    def hear(self, message: Any) -> None:
        match message.get_type():
            case "MISSION_REQUEST" if self.flight.personality == "px4":
                self.send_ack(UNSUPPORTED)
                self.wait(self.wait_ns)
            case "MISSION_REQUEST" | "MISSION_REQUEST_INT":
                self._asked_for(message.seq)
            case "MISSION_ACK":
                whole = self.next_seq == len(self.items)
                if message.type != ACCEPTED:
                    self.end(f"refused {message.type}")
                else:
                    self.end("complete" if whole else "protocol error")

    def _asked_for(self, seq: int) -> None:
        self.items_asked = True
        if self.next_seq < seq:
            return
        if self.next_seq > seq:
            if self.tries >= self.retries:
                self.end("asked too often")
                return
        else:
            self.tries = 0
        self.wait(self.wait_ns)
        self.send_item(seq)
        self.next_seq = seq + 1
        self.tries += 1

    def late(self) -> None:
        if self.tries >= self.retries:
            self.end("timed out")
            return
        self.tries += 1
        if not self.items_asked:
            self.send_count()
        self.wait(self.wait_ns)


class QGroundControl(Upload):
    """It wants a question or the ACK within 1.5 s; only the count is ever sent again."""

    wait_ns: ClassVar[int] = 1500 * MS
    retries: ClassVar[int] = 5

    def begin(self) -> None:
        self.left, self.counts = set(range(len(self.items))), 0
        super().begin()

    def hear(self, message: Any) -> None:
        match message.get_type():
            case "MISSION_REQUEST" | "MISSION_REQUEST_INT":
                self.left.discard(message.seq)
                self.send_item(message.seq)
                self.wait(self.wait_ns)
            case "MISSION_ACK" if message.type != ACCEPTED:
                self.end(f"refused {message.type}")
            case "MISSION_ACK":
                self.end("missing requests" if self.left else "complete")

    def late(self) -> None:
        if 0 in self.left and self.counts <= self.retries:
            self.counts += 1
            self.send_count()
            self.wait(self.wait_ns)
        else:
            self.end("timed out")


class Mavproxy(Upload):
    """It knows MISSION_REQUEST alone, and answers nothing after its last item."""

    def begin(self) -> None:
        self.loading = True
        self.send_count()

    def hear(self, message: Any) -> None:
        if message.get_type() == "MISSION_REQUEST" and self.loading:
            self.send_item(message.seq)
            self.loading = message.seq + 1 < len(self.items)
        elif message.get_type() == "MISSION_ACK":
            self.end("complete" if message.type == ACCEPTED else f"refused {message.type}")


class DroneKit(Mavproxy):
    """The same, with float items; it is done when each was asked for once, and needs no ACK."""

    as_int: ClassVar[bool] = False


class Pymavlink(Upload):
    """A script: it answers whatever is asked for, and sends its count until something is."""

    wait_ns: ClassVar[int] = 1000 * MS

    def hear(self, message: Any) -> None:
        if message.get_type() == "MISSION_ACK":
            self.end("complete" if message.type == ACCEPTED else f"refused {message.type}")
        elif message.get_type() in self.knows:
            self.send_item(message.seq)

    def late(self) -> None:
        if not self.asked:
            self.send_count()
            self.wait(self.wait_ns)


UPLOADS: tuple[type[Upload], ...] = (Mavsdk, QGroundControl, Mavproxy, DroneKit, Pymavlink)


def mission(personality: Personality, *places_m: tuple[float, float, float]) -> list[PlanItem]:
    """A take-off, waypoints at (north, east, up) metres of home, a return.

    ArduPilot's begins with home.
    """
    home = HOMES[personality]

    def at(command: int, north_m: float, east_m: float, up_m: float) -> PlanItem:
        lat_deg = home.lat_deg + north_m * NORTH_DEG
        lon_deg = home.lon_deg + east_m * NORTH_DEG
        return PlanItem(command, lat_deg, lon_deg, up_m)

    first = [PlanItem(WAYPOINT, home.lat_deg, home.lon_deg, home.alt_amsl_m, AMSL)]
    return [
        *(first if personality == "ardupilot" else []),
        at(TAKE_OFF, 0.0, 0.0, 10.0),
        *(at(WAYPOINT, *place_m) for place_m in places_m),
        PlanItem(RETURN, frame=NO_PLACE),
    ]


def items_of(document: dict[str, Any], personality: Personality) -> list[PlanItem]:
    """The mission of a .plan of simple items, as a client sends it."""
    home = HOMES[personality]
    first = [PlanItem(WAYPOINT, home.lat_deg, home.lon_deg, home.alt_amsl_m, AMSL)]
    found = first if personality == "ardupilot" else []
    shift = len(found) - 1
    for entry in document["mission"]["items"]:
        nan = 0.0 if personality == "ardupilot" else math.nan  # which ArduPilot refuses
        p1, p2, p3, p4, x, y, z = (nan if value is None else value for value in entry["params"])
        if entry["command"] == DO_JUMP:
            p1 += shift  # a doJumpId there, a seq here
        found.append(PlanItem(entry["command"], x, y, z, entry["frame"], (p1, p2, p3, p4)))
    return found


def rally_points(document: dict[str, Any]) -> list[PlanItem]:
    """Its rally points, a plan of their own."""
    points = document["rallyPoints"]["points"]
    return [PlanItem(RALLY_POINT, lat, lon, alt_m, kind=RALLY) for lat, lon, alt_m in points]
