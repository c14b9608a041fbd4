"""A bridge with MAVLink clients before it and the whole vehicle behind it, on a virtual clock.

The clients' bytes are made and read by pymavlink, so that a client here is a stranger to both.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, TypeVar

from pymavlink.dialects.v20 import all as dialect

from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.states import Control, State
from gcs.report import DecisionItem
from gcs.session import inputs
from gcs.wire.frame import Frame, split
from tests.loopback.copies import fly_or_copy
from tests.loopback.flight import Flight, Personality
from tests.loopback.lossy_link import CLEAR, Weather
from vehicle_sim.autopilot.firmware import Firmware

VEHICLE = (1, 1)
STATION = (255, 191)
BRIDGE = StationConfig(
    endpoints=["test"], name="loopback", bridge=True, clients=["test"], compid=STATION[1]
)
COMMAND_PARAMS = 7
ACCEPTED = 0
ARM, TAKE_OFF = 400, 22
METRES_PER_DEGREE = 111_319.5
ARRIVES_M = {"px4": 1.3, "ardupilot": 0.7}
"""How near its goal it has arrived.  A real PX4 flew 0.6 to 1.3 m past goals on legs of 10 to 20 m
in open air; where it turns round it is slow, and the arrival radius is up to 1 m."""


@dataclass(frozen=True, slots=True)
class Heard:
    """A message that a client was sent."""

    time_ns: int
    message: Any  # pymavlink's


class Client:
    """One MAVLink client, on a link of its own."""

    def __init__(self, flight: BridgedFlight, link: int, sysid: int, compid: int) -> None:
        self.flight = flight
        self.link = link
        self.mav = dialect.MAVLink(None, srcSystem=sysid, srcComponent=compid)
        self.mav.robust_parsing = True
        self.heard: list[Heard] = []

    # --------------------------------------------------------------------------- sending

    def send(self, message: Any) -> None:
        """A message of pymavlink."""
        self.send_raw(message.pack(self.mav))

    def send_raw(self, data: bytes) -> None:
        self.flight.feed(inputs.Datagram(self.link, data))

    def beat(self) -> None:
        """HEARTBEAT of a ground station."""
        self.send(dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))

    def command(self, command: int, *params: float, target: tuple[int, int] = VEHICLE) -> None:
        """COMMAND_LONG."""
        filled = params + (0.0,) * (COMMAND_PARAMS - len(params))
        self.send(dialect.MAVLink_command_long_message(*target, command, 0, *filled))

    def ask(self, command: int, *params: float, within_s: float = 5.0) -> int:
        """COMMAND_LONG, and the MAV_RESULT that it is answered with, but for IN_PROGRESS."""
        before = len(self.heard)
        self.command(command, *params)
        found: list[int] = []

        def answered() -> bool:
            found[:] = [
                heard.message.result
                for heard in self.heard[before:]
                if heard.message.get_type() == "COMMAND_ACK"
                and heard.message.command == command
                and heard.message.result != dialect.MAV_RESULT_IN_PROGRESS
            ]
            return bool(found)

        self.flight.until(answered, within_s)
        return found[0]

    def fly_to(
        self,
        lat_deg: float,
        lon_deg: float,
        alt_amsl_m: float,
        yaw_rad: float = math.nan,
        target: tuple[int, int] = VEHICLE,
    ) -> None:
        """DO_REPOSITION, as MAVSDK and QGroundControl send it."""
        self.send(
            dialect.MAVLink_command_int_message(
                *target,
                dialect.MAV_FRAME_GLOBAL,
                dialect.MAV_CMD_DO_REPOSITION,
                0,
                0,
                -1.0,
                1.0,
                0.0,
                yaw_rad,
                round(lat_deg * 1e7),
                round(lon_deg * 1e7),
                alt_amsl_m,
            )
        )

    # --------------------------------------------------------------------------- hearing

    def hear(self, data: bytes) -> None:
        """What the bridge sends to this client."""
        for message in self.mav.parse_buffer(data) or []:
            self.heard.append(Heard(self.flight.now_ns, message))

    def messages(self, name: str) -> list[Any]:
        """Everything of one kind that was heard."""
        return [one.message for one in self.heard if one.message.get_type() == name]

    def acks(self, command: int) -> list[Any]:
        return [ack for ack in self.messages("COMMAND_ACK") if ack.command == command]

    def texts(self) -> str:
        """All that STATUSTEXT said, pieces joined."""
        return "".join(
            text.text + ("" if text.id and len(text.text) == 50 else "\n")
            for text in self.messages("STATUSTEXT")
        )


class BridgedFlight(Flight):
    """A flight of clients; nobody at the station's own keyboard has control."""

    def __init__(
        self,
        personality: Personality = "px4",
        *,
        seed: int = 1,
        policy: Policy = DEFAULT,
        up: Weather = CLEAR,
        down: Weather = CLEAR,
        params: dict[str, float] | None = None,
        firmware: Firmware | None = None,
        config: StationConfig = BRIDGE,
        vehicle_key: bytes | None = None,
        station_key: bytes | None = None,
        client_key: bytes | None = None,
    ) -> None:
        self.clients: dict[int, Client] = {}
        super().__init__(
            personality,
            seed=seed,
            policy=policy,
            up=up,
            down=down,
            params=params,
            firmware=firmware,
            config=config,
            vehicle_key=vehicle_key,
            station_key=station_key,
            client_key=client_key,
        )

    def join(self, sysid: int = 245, compid: int = 190) -> Client:
        """A client connects and says that it is there."""
        link = 1 + len(self.clients)
        client = self.clients[link] = Client(self, link, sysid, compid)
        self.feed(inputs.ClientCame(link, f"udp 127.0.0.1:{40000 + link}", stream=False))
        client.beat()
        return client

    def to_client(self, link: int, data: bytes) -> None:
        self.clients[link].hear(data)

    def beating(self, seconds: float) -> None:
        """Let time pass, while every client sends its heartbeat once a second."""
        until_ns = self.now_ns + round(seconds * 1e9)
        while self.now_ns < until_ns:
            for client in self.clients.values():
                client.beat()
            self.run(min(1.0, (until_ns - self.now_ns) / 1e9))

    def to_vehicle(self, name: str = "") -> list[Frame]:
        """The frames that left for the vehicle, of one kind or of all."""
        frames = [
            item for sent in self.sent for item in split(sent.data) if isinstance(item, Frame)
        ]
        return [frame for frame in frames if not name or frame.name == name]

    def decisions(self, outcome: str = "") -> list[DecisionItem]:
        """Every verdict and ending on the record, with one outcome or with any."""
        items = [item for _, item in self.records if isinstance(item, DecisionItem)]
        return [item for item in items if not outcome or item.outcome == outcome]


F = TypeVar("F", bound=BridgedFlight)


def north_of_home(
    flight: BridgedFlight, north_m: float, up_m: float = 0.0
) -> tuple[float, float, float]:
    """Degrees, and metres above the sea."""
    telemetry = flight.session.telemetry
    assert telemetry is not None
    assert telemetry.home is not None
    lat, lon, alt = telemetry.home
    return lat + north_m / METRES_PER_DEGREE, lon, alt + up_m


def take_off(flight: BridgedFlight) -> None:
    """A client joins, arms the vehicle and takes off: to PX4's own height, or to 5 m."""
    _, client = joined(flight)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    up_m = math.nan if flight.personality == "px4" else 5.0
    assert client.ask(TAKE_OFF, 0, 0, 0, *[math.nan] * 3, up_m) == ACCEPTED
    flight.until(
        lambda: flight.is_in(State.HOVERING) and flight.session.gate.control is Control.OURS
    )


def joined(flight: F) -> tuple[F, Client]:
    """With one client; the vehicle stands at home, and is known."""
    client = flight.join()
    flight.connected()
    return flight, client


def flying(personality: Personality) -> tuple[BridgedFlight, Client]:
    """Hovering at home, for its one client."""
    flight = BridgedFlight(personality)
    fly_or_copy(flight, (BridgedFlight, personality), lambda: take_off(flight))
    return flight, flight.clients[1]
