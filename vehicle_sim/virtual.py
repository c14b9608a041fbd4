"""One vehicle on whoever's clock, in plain types: the factory of the entry point `vehicle-sim`.

Another program flies the vehicle without a socket and without real time.  It finds `make` in the
group `mavgate.simulators` of the entry points, gives it a table of plain values, and gets an object
of three members:

    deadline_ns            when `handle` wants to be called again at the latest
    handle(now_ns, data)   live up to `now_ns`, then take these datagrams; the datagrams it sends
    truth()                what really is, whatever is told by MAVLink

Times are nanoseconds of the caller's clock.  Equal tables and equal datagrams at equal times give
equal answers.  `KEYS` are the keys of the table, `truth` says those of its answer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import cos, isfinite, radians, sin
from typing import Final

from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.firmware import firmware_of
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.engine.choose_engine import engine_for
from vehicle_sim.engine.step import Seat, VehicleSpec
from vehicle_sim.plant.airframe import load, shipped
from vehicle_sim.plant.faults import Payload, WindChange
from vehicle_sim.plant.sensors import GRADES
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.fault_script import LinkFault, Timed, parse
from vehicle_sim.simulation.world import Datagram, LinkSpec, Transmit, Wake, World

PEER: Final = "caller"
HOMES: Final[Mapping[Personality, Geodetic]] = {
    "px4": Geodetic(47.397742, 8.545594, 488.0),
    "ardupilot": Geodetic(-35.363262, 149.165237, 584.0),
}

KEYS: Final[Mapping[str, object]] = {
    "start_ns": 0,  # the caller's clock at the vehicle's switching on
    "seed": 1,  # of all noise, and of the link's accidents
    "autopilot": "px4",  # or ardupilot
    "firmware": "",  # its generation; empty: the usual one
    "airframe": "s500",
    "sensors": "good",  # or real
    "wind_m_s": 0.0,
    "wind_from_deg": 0.0,
    "gust_m_s": 0.0,  # standard deviation
    "payload_kg": 0.0,
    "loss": 0.0,  # of datagrams, each way, 0 to 1
    "delay_s": 0.0,
    "jitter_s": 0.0,
    "faults": "",  # the text of a fault file
    "faults_file": "",  # what errors call it
    "params": {},  # parameters that are set at the start, by name
}
"""Every key with its default."""


class SetupError(ValueError):
    """A table that no vehicle can be made of: says which key, and what would do."""


def make(table: Mapping[str, object]) -> VirtualVehicle:
    """Raises ValueError: a key or a value that is unknown, or a fault file that cannot be used."""
    if unknown := sorted(set(table) - set(KEYS)):
        raise SetupError(f"{unknown[0]}: unknown; known are {', '.join(KEYS)}")
    return VirtualVehicle(_Table({**KEYS, **table}))


class _Table:
    """The values, each checked as it is taken."""

    def __init__(self, values: Mapping[str, object]) -> None:
        self._values = values

    def whole(self, key: str) -> int:
        value = self._values[key]
        if not isinstance(value, int) or isinstance(value, bool) or value < 0:
            raise SetupError(f"{key}: {value!r} is not a whole number from 0")
        return value

    def number(self, key: str, low: float, high: float) -> float:
        value = self._values[key]
        good = isinstance(value, int | float) and not isinstance(value, bool)
        if not good or not isfinite(value) or not low <= value <= high:  # type: ignore[arg-type,operator]
            raise SetupError(f"{key}: {value!r} is not a number from {low:g} to {high:g}")
        return float(value)  # type: ignore[arg-type]

    def text(self, key: str) -> str:
        return str(self._values[key])

    def word(self, key: str, words: Sequence[str]) -> str:
        value = self._values[key]
        if value not in words:
            raise SetupError(f"{key}: {value!r} is none of {', '.join(words)}")
        return str(value)

    def autopilot(self) -> Personality:
        word = self.word("autopilot", tuple(HOMES))
        return next(each for each in HOMES if each == word)

    def parameters(self) -> dict[str, float]:
        value = self._values["params"]
        if not isinstance(value, Mapping):
            raise SetupError("params: is a table of names and numbers")
        return {str(name): float(each) for name, each in value.items()}


class VirtualVehicle:
    """See the module."""

    def __init__(self, table: _Table) -> None:
        autopilot = table.autopilot()
        firmware = firmware_of(autopilot, table.text("firmware") or None)
        parameters = Parameters(autopilot, firmware)
        for name, value in table.parameters().items():
            parameters.start_with(name, value)
        home, seed, start_ns = HOMES[autopilot], table.whole("seed"), table.whole("start_ns")
        airframe = load(table.word("airframe", shipped()))
        grade = GRADES[table.word("sensors", tuple(GRADES))]
        engine = engine_for([VehicleSpec(seed, 0, home.lat_deg)], airframe, grade)
        self._vehicle = Autopilot(autopilot, home, seed, 0, parameters, Seat(engine, 0))
        speed, from_rad = (
            table.number("wind_m_s", 0.0, 60.0),
            radians(table.number("wind_from_deg", -360.0, 360.0)),
        )
        wind = (-speed * cos(from_rad), -speed * sin(from_rad), 0.0)
        self._vehicle.inject(WindChange(wind, table.number("gust_m_s", 0.0, 20.0)))
        payload_kg = table.number("payload_kg", -10.0, 50.0)
        if payload_kg:
            self._vehicle.inject(Payload(payload_kg))
        server = VehicleServer(
            self._vehicle,
            profile_of(autopilot, firmware),
            parameters,
            1,
            unix_start_ns=start_ns,
            logging=False,
        )
        link = LinkFault(
            loss=table.number("loss", 0.0, 1.0),
            delay_s=table.number("delay_s", 0.0, 60.0),
            jitter_s=table.number("jitter_s", 0.0, 60.0),
        )
        faults = parse(table.text("faults"), table.text("faults_file") or "faults")
        self._world = World(
            [server],
            [LinkSpec((PEER,))],
            Fraction(1),
            start_ns,
            unix_start_ns=start_ns,
            seed=seed,
            faults=(Timed(0, None, link), *faults),
        )
        self._start_ns = start_ns
        self._consumed_mah = 0.0
        self._energy_j = 0.0

    @property
    def deadline_ns(self) -> int:
        return self._world.deadline_ns

    def handle(self, now_ns: int, datagrams: Sequence[bytes] = ()) -> list[bytes]:
        outputs = self._world.handle(Wake(), now_ns)
        for data in datagrams:
            outputs += self._world.handle(Datagram(0, PEER, data), now_ns)
        self._count_energy()
        return [each.data for each in outputs if isinstance(each, Transmit)]

    def truth(self) -> dict[str, object]:
        """`pos_ned` [m] counts from where the vehicle stood at its start, which is `home` (degrees,
        metres above sea level); `v_ned` [m/s]; `energy_j` is what the battery has given."""
        truth, home = self._vehicle.truth, HOMES[self._vehicle.personality]
        return {
            "pos_ned": truth.pos_ned,
            "v_ned": truth.v_ned,
            "home": (home.lat_deg, home.lon_deg, home.alt_amsl_m),
            "armed": truth.armed,
            "landed": truth.landed,
            "energy_j": self._energy_j,
        }

    def _count_energy(self) -> None:
        body = self._vehicle.blocks.body
        drawn_mah = body.consumed_mah - self._consumed_mah
        if drawn_mah:
            self._consumed_mah = body.consumed_mah
            self._energy_j += 3.6 * drawn_mah * body.voltage_v
