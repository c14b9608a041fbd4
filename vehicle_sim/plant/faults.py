"""What can go wrong with a vehicle, one class for each fault: what it changes, and how it is told.

A fault is a state, not an event: `ended` is the same kind with the values that put it right.
`described` is a sentence for the log: what is wrong from now on, or that it is right again.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import atan2, degrees, hypot
from typing import TypeAlias

from vehicle_sim.plant.body import Body
from vehicle_sim.plant.sensed import Sensed

Vec3: TypeAlias = tuple[float, float, float]

NOTHING: Vec3 = (0.0, 0.0, 0.0)


def spelled(value: float) -> str:
    """Three digits, and never -0."""
    return f"{round(value, 6) + 0.0:.3g}"


def _vector(values: Vec3) -> str:
    return ", ".join(map(spelled, values))


class ModelFault(ABC):
    """A fault of the body or of a sensor."""

    __slots__ = ()

    @abstractmethod
    def inject(self, body: Body, sensed: Sensed) -> None:
        """Write the fault into the blocks, where physics and sensors find it."""

    @abstractmethod
    def described(self) -> str: ...

    def ended(self) -> ModelFault:
        return type(self)()


@dataclass(frozen=True, slots=True)
class GpsLost(ModelFault):
    """No fix, no samples."""

    lost: bool = True

    def inject(self, body: Body, sensed: Sensed) -> None:
        sensed.gps_lost = self.lost

    def described(self) -> str:
        return "GPS is lost" if self.lost else "GPS is back"

    def ended(self) -> ModelFault:
        return GpsLost(False)


@dataclass(frozen=True, slots=True)
class GpsGlitch(ModelFault):
    """Every fix is off by this [m, NED]."""

    offset_ned: Vec3 = NOTHING

    def inject(self, body: Body, sensed: Sensed) -> None:
        sensed.gps_off_n, sensed.gps_off_e, sensed.gps_off_d = self.offset_ned

    def described(self) -> str:
        if self.offset_ned == NOTHING:
            return "GPS is right again"
        return f"every GPS fix is off by {_vector(self.offset_ned)} m (north, east, down)"


@dataclass(frozen=True, slots=True)
class MotorFault(ModelFault):
    """What is left of the thrust of one motor (1 to 4, the autopilots' order): 0 dead, 1 whole."""

    motor: int
    health: float = 0.0

    def inject(self, body: Body, sensed: Sensed) -> None:
        setattr(body, f"health_{self.motor}", self.health)

    def described(self) -> str:
        if self.health == 1.0:
            return f"motor {self.motor} is sound again"
        return f"motor {self.motor} gives {spelled(100.0 * self.health)} % of its thrust"

    def ended(self) -> ModelFault:
        return MotorFault(self.motor, 1.0)


@dataclass(frozen=True, slots=True)
class CellsLost(ModelFault):
    """The battery's voltage falls by that many cells (a part of one is a weak one)."""

    cells: float = 1.0

    def inject(self, body: Body, sensed: Sensed) -> None:
        body.cells_lost = self.cells

    def described(self) -> str:
        if self.cells == 0.0:
            return "the battery is sound again"
        return f"the battery's voltage falls by {spelled(self.cells)} cells"

    def ended(self) -> ModelFault:
        return CellsLost(0.0)


@dataclass(frozen=True, slots=True)
class Payload(ModelFault):
    """It carries so much more [kg], or so much less, than its data sheet says."""

    mass_kg: float = 0.0

    def inject(self, body: Body, sensed: Sensed) -> None:
        body.payload_kg = self.mass_kg

    def described(self) -> str:
        return f"it carries {spelled(self.mass_kg)} kg more than its data sheet says"


@dataclass(frozen=True, slots=True)
class CentreOfMass(ModelFault):
    """The centre of mass is off the rotors' centre by this, forward and right [m]."""

    forward_m: float = 0.0
    right_m: float = 0.0

    def inject(self, body: Body, sensed: Sensed) -> None:
        body.mass_off_x, body.mass_off_y = self.forward_m, self.right_m

    def described(self) -> str:
        where = f"{spelled(self.forward_m)} m forward and {spelled(self.right_m)} m right"
        return f"the centre of mass is {where} of the rotors' centre"


@dataclass(frozen=True, slots=True)
class WeakBattery(ModelFault):
    """Internal resistance and capacity as multiples of the data sheet's."""

    resistance_scale: float = 1.0
    capacity_scale: float = 1.0

    def inject(self, body: Body, sensed: Sensed) -> None:
        body.resistance_scale, body.capacity_scale = self.resistance_scale, self.capacity_scale

    def described(self) -> str:
        resistance = f"{spelled(self.resistance_scale)} times its resistance"
        return f"the battery has {resistance} and {spelled(self.capacity_scale)} times its capacity"


@dataclass(frozen=True, slots=True)
class ThrustScale(ModelFault):
    """Every motor lifts this multiple of what the data sheet says."""

    scale: float = 1.0

    def inject(self, body: Body, sensed: Sensed) -> None:
        body.thrust_scale = self.scale

    def described(self) -> str:
        return f"the motors give {spelled(self.scale)} times their thrust"


@dataclass(frozen=True, slots=True)
class InertiaScale(ModelFault):
    """All three moments of inertia are this multiple of the data sheet's."""

    scale: float = 1.0

    def inject(self, body: Body, sensed: Sensed) -> None:
        body.inertia_scale = self.scale

    def described(self) -> str:
        return f"the body has {spelled(self.scale)} times its inertia"


@dataclass(frozen=True, slots=True)
class WindChange(ModelFault):
    """The air's velocity [m/s, NED] from now on, and the standard deviation of its gusts."""

    wind_ned: Vec3 = NOTHING
    gust_m_s: float = 0.0

    def inject(self, body: Body, sensed: Sensed) -> None:
        body.wind_n, body.wind_e, body.wind_d = self.wind_ned
        body.gust_m_s = self.gust_m_s

    def described(self) -> str:
        north, east, down = self.wind_ned
        gusts = f", with gusts of {spelled(self.gust_m_s)} m/s" if self.gust_m_s else ""
        if self.wind_ned == NOTHING:
            return f"no wind{gusts}"
        from_deg = degrees(atan2(-east, -north)) % 360.0
        falling = f", {spelled(down)} m/s downwards" if down else ""
        speed = spelled(hypot(north, east))
        return f"the wind is {speed} m/s from {spelled(from_deg)} degrees{falling}{gusts}"


@dataclass(frozen=True, slots=True)
class AccelBias(ModelFault):
    """A constant error of the accelerometer [m/s^2, FRD]."""

    off_frd: Vec3 = NOTHING

    def inject(self, body: Body, sensed: Sensed) -> None:
        sensed.accel_off_x, sensed.accel_off_y, sensed.accel_off_z = self.off_frd

    def described(self) -> str:
        return f"the accelerometer is off by {_vector(self.off_frd)} m/s2 (forward, right, down)"


@dataclass(frozen=True, slots=True)
class GyroBias(ModelFault):
    """A constant error of the gyroscope [rad/s, FRD]."""

    off_frd: Vec3 = NOTHING

    def inject(self, body: Body, sensed: Sensed) -> None:
        sensed.gyro_off_x, sensed.gyro_off_y, sensed.gyro_off_z = self.off_frd

    def described(self) -> str:
        return f"the gyroscope is off by {_vector(self.off_frd)} rad/s (forward, right, down)"


@dataclass(frozen=True, slots=True)
class BaroFault(ModelFault):
    """The height by air pressure is off by this [m, up], or is no longer told."""

    offset_m: float = 0.0
    lost: bool = False

    def inject(self, body: Body, sensed: Sensed) -> None:
        sensed.baro_off_m, sensed.baro_lost = self.offset_m, self.lost

    def described(self) -> str:
        wrong = f"the barometer is off by {spelled(self.offset_m)} m"
        return "the barometer is lost" if self.lost else wrong


@dataclass(frozen=True, slots=True)
class MagFault(ModelFault):
    """The magnetic field is off by this [gauss, FRD], or is no longer told."""

    offset_frd: Vec3 = NOTHING
    lost: bool = False

    def inject(self, body: Body, sensed: Sensed) -> None:
        sensed.mag_off_x, sensed.mag_off_y, sensed.mag_off_z = self.offset_frd
        sensed.mag_lost = self.lost

    def described(self) -> str:
        wrong = f"the compass is off by {_vector(self.offset_frd)} gauss (forward, right, down)"
        return "the compass is lost" if self.lost else wrong


@dataclass(frozen=True, slots=True)
class RcLost:
    """The receiver hears no sticks, whatever is sent."""

    lost: bool = True

    def described(self) -> str:
        return "the sticks are lost" if self.lost else "the sticks are back"

    def ended(self) -> RcLost:
        return RcLost(False)


@dataclass(frozen=True, slots=True)
class ClockJump:
    """The vehicle's own clock is wrong by so much more, as its messages tell it."""

    by_ns: int = 0

    def described(self) -> str:
        return f"the clock jumps by {spelled(self.by_ns / 1e9)} s"

    def ended(self) -> ClockJump:
        return ClockJump(-self.by_ns)


@dataclass(frozen=True, slots=True)
class Reboot:
    """The autopilot starts anew, wherever the vehicle is; motors stop.  Nothing ends it."""

    def described(self) -> str:
        return "it reboots"

    def ended(self) -> None:
        return None


Fault: TypeAlias = ModelFault | RcLost | ClockJump | Reboot
