"""A bridge with several vehicles behind it and MAVLink clients before it, on a virtual clock.

Every vehicle has a system id from 1 up, and all start beside one another at one place.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction

import msgspec

from gcs import ipc
from gcs.config import StationConfig
from gcs.frames import Vec3
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.states import Control, State
from gcs.session import effects, inputs
from gcs.session.setup import Setup
from gcs.station.session import Session
from gcs.vehicle.vehicle import Vehicle
from gcs.wire.frame import Frame, split
from tests.loopback.bridged import BRIDGE, BridgedFlight, Client, Heard
from tests.loopback.copies import fly_or_copy, never_copied
from tests.loopback.flight import HOMES, PEER, Personality
from tests.loopback.lossy_link import CLEAR, Air
from tests.loopback.observed import START_NS, Sent
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram as Inbound
from vehicle_sim.simulation.world import LinkSpec, Transmit, World
from vehicle_sim.simulation.world import Wake as WorldWake

never_copied(Heard)

METRES_PER_DEGREE = 111_194.93
"""Of latitude, on a sphere of 6,371 km."""
APART_M = 30.0
"""From each vehicle's place at the start to the next one's, to the east."""
ARM, DISARM = (400, 1), (400, 0)
"""MAV_CMD_COMPONENT_ARM_DISARM and its first parameter."""
TAKE_OFF, LAND, REPOSITION = 22, 21, 192
ACCEPTED, REJECTED, DENIED, IN_PROGRESS = 0, 1, 2, 5


def beside(home: Geodetic, east_m: float) -> Geodetic:
    """A place so far east of `home`."""
    per_degree_m = METRES_PER_DEGREE * math.cos(math.radians(home.lat_deg))
    return Geodetic(home.lat_deg, home.lon_deg + east_m / per_degree_m, home.alt_amsl_m)


class Fleet(BridgedFlight):
    """One vehicle for each personality that is named; `vehicles` by system id."""

    def __init__(
        self,
        personalities: Sequence[Personality] = ("px4", "ardupilot"),
        *,
        policy: Policy = DEFAULT,
        config: StationConfig = BRIDGE,
        links: int = 1,
        apart_m: float = APART_M,
    ) -> None:
        """`links`: 1, or one for each vehicle."""
        super().__init__(policy=policy, config=config)
        self.vehicles: dict[int, Autopilot] = {}
        servers = []
        for number, personality in enumerate(personalities):
            parameters = Parameters(personality, None)
            home = beside(HOMES["px4"], number * apart_m)
            sysid = number + 1
            vehicle = Autopilot(personality, home, sysid, params=parameters)
            profile = profile_of(personality, parameters.firmware)
            servers.append(VehicleServer(vehicle, profile, parameters, sysid))
            self.vehicles[sysid] = vehicle
        self.vehicle = self.vehicles[1]
        self._made_of = (personalities, policy, config, links, apart_m)
        self.link_count = links
        self.apart_m = apart_m
        specs = [LinkSpec((PEER,))]
        if links > 1:
            specs = [LinkSpec((PEER,), vehicle=number) for number in range(links)]
        self.world = World(servers, specs, Fraction(1), START_NS, unix_start_ns=START_NS)
        endpoints = [f"test {number}" for number in range(links)]
        config = msgspec.structs.replace(config, endpoints=endpoints)
        setup = Setup(config, "test", policy, "", tuple(endpoints), "")
        self.session = Session(setup, START_NS)
        self.ups = [Air(CLEAR, 2 * number) for number in range(links)]
        self.downs = [Air(CLEAR, 2 * number + 1) for number in range(links)]
        self.silent: set[int] = set()
        """System ids of vehicles of which nothing is heard."""
        self.without_positions: set[int] = set()

    # ------------------------------------------------------------------------------- time

    def _step(self, limit_ns: int) -> bool:
        session_ns, world_ns = self.session.deadline_ns, self.world.deadline_ns
        airs = (air.next_ns for air in (*self.ups, *self.downs))
        next_ns = max(self.now_ns, min(session_ns, world_ns, *airs))
        if next_ns > limit_ns:
            self.now_ns = limit_ns
            return False
        self.now_ns = next_ns
        for link, up in enumerate(self.ups):
            for data in up.arrived(next_ns):
                self._vehicle(Inbound(link, PEER, data))
        for link, down in enumerate(self.downs):
            for data in down.arrived(next_ns):
                self.feed(inputs.Datagram(link, data))
        if world_ns <= next_ns:
            self._vehicle(WorldWake())
        if session_ns <= next_ns:
            self.feed(inputs.Wake())
        return True

    def _vehicle(self, given: Inbound | WorldWake) -> None:
        for output in self.world.handle(given, self.now_ns):
            if isinstance(output, Transmit) and output.peer == PEER:
                data = b"".join(
                    frame.raw
                    for frame in split(output.data)
                    if isinstance(frame, Frame) and self._is_heard(frame)
                )
                if data:
                    self.received.append(Sent(self.now_ns, data))
                    self.downs[output.link].send(data, self.now_ns)

    def _is_heard(self, frame: Frame) -> bool:
        position = frame.name == "LOCAL_POSITION_NED" and frame.sysid in self.without_positions
        return frame.sysid not in self.silent and not position

    def _carry_out(self, effect: effects.Effect) -> list[inputs.Input]:
        if isinstance(effect, effects.Transmit) and effect.link < self.link_count:
            self.sent.append(Sent(self.now_ns, effect.data))
            self.ups[effect.link].send(effect.data, self.now_ns)
            return []
        if isinstance(effect, effects.Transmit):
            self.to_client(effect.link, effect.data)
            return []
        return super()._carry_out(effect)

    # ---------------------------------------------------------------------------- clients

    def join(self, sysid: int = 245, compid: int = 190) -> Client:
        """A client connects and says that it is there."""
        link = self.link_count + len(self.clients)
        client = self.clients[link] = Client(self, link, sysid, compid)
        self.feed(inputs.ClientCame(link, f"udp 127.0.0.1:{40000 + link}", stream=False))
        client.beat()
        return client

    # ------------------------------------------------------------------------------ looks

    def met(self, sysid: int) -> Vehicle:
        """What the station knows of a vehicle."""
        found = self.session.vehicles.of_sysid(sysid)
        assert found is not None, f"vehicle {sysid} was not met: {self.told()}"
        return found

    def gate(self, sysid: int) -> Gate:
        return self.met(sysid).gate

    def state_of(self, sysid: int) -> State:
        return self.gate(sysid).state

    def each(self, true: Callable[[int], bool]) -> Callable[[], bool]:
        """Whether it is so of every vehicle, for `until`."""
        return lambda: all(true(sysid) for sysid in self.vehicles)

    def place_enu(self, sysid: int) -> Vec3:
        """Where a vehicle really is, from its own start."""
        north, east, down = self.vehicles[sysid].truth.pos_ned
        return (east, north, -down)

    # ----------------------------------------------------------------------------- script

    def all_connected(self) -> Fleet:
        """All were met, stand on the ground with a fence, and are ready to arm."""
        self.until(lambda: len(self.session.vehicles) == len(self.vehicles))
        self.until(
            self.each(
                lambda n: (
                    self.state_of(n) is State.GROUNDED
                    and self.vehicles[n].armable
                    and bool(self.met(n).port.fence_shapes)
                )
            )
        )
        self.run(1.0)
        return self

    def ask(self, client: Client, sysid: int, command: int, *params: float) -> int:
        """COMMAND_LONG to one vehicle; the MAV_RESULT of its answer in that vehicle's name."""
        before = len(client.heard)
        client.command(command, *params, target=(sysid, 1))
        found: list[int] = []

        def answered() -> bool:
            found[:] = [
                heard.message.result
                for heard in client.heard[before:]
                if heard.message.get_type() == "COMMAND_ACK"
                and heard.message.get_srcSystem() == sysid
                and heard.message.command == command
                and heard.message.result != IN_PROGRESS
            ]
            return bool(found)

        self.until(answered, 15)
        return found[0]

    def take_off(self, client: Client, sysid: int, up_m: float = 5.0) -> None:
        """Armed and up, and flown by the station."""
        assert self.ask(client, sysid, *ARM) == ACCEPTED, client.texts()
        telemetry = self.met(sysid).telemetry
        assert telemetry is not None
        assert telemetry.home is not None
        px4 = telemetry.autopilot.name == "px4"  # its p7 is above sea level
        height_m = telemetry.home[2] + up_m if px4 else up_m
        nan = math.nan
        assert self.ask(client, sysid, TAKE_OFF, 0, 0, 0, nan, nan, nan, height_m) == ACCEPTED
        self.until(
            lambda: (
                self.state_of(sysid) is State.HOVERING and self.gate(sysid).control is Control.OURS
            )
        )

    def all_flying(self) -> Client:
        """A client has taken all of them off; it has sent its heartbeat just now."""
        assert self.now_ns == START_NS, "it is the beginning of a flight"
        fly_or_copy(self, self._made_of, self._all_take_off)
        return self.clients[self.link_count]

    def _all_take_off(self) -> None:
        client = self.join()
        self.all_connected()
        for sysid in self.vehicles:
            self.take_off(client, sysid)
            client.beat()

    def send_to(
        self, client: Client, sysid: int, east_m: float, north_m: float, up_m: float
    ) -> None:
        """A go-to on the map, so far from where that vehicle started."""
        telemetry = self.met(sysid).telemetry
        assert telemetry is not None
        assert telemetry.home is not None
        lat, lon, alt = telemetry.home
        lon += east_m / (METRES_PER_DEGREE * math.cos(math.radians(lat)))
        client.fly_to(lat + north_m / METRES_PER_DEGREE, lon, alt + up_m, target=(sysid, 1))

    def reaches(self, sysid: int, state: State, within_s: float = 30.0) -> None:
        """Let time pass until the gate of that vehicle is in that state."""
        self.until(lambda: self.state_of(sysid) is state, within_s)

    def say_leave(self) -> None:
        """Whoever started the bridge ends it."""
        self.feed(inputs.OperatorLine(1, ipc.Leave("Ctrl-C")))
