"""What can go wrong with a vehicle's body and sensors, and how it shows in their blocks.

A fault is a state, not an event: the same kind with its sound values ends it (`sound`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias, assert_never

from vehicle_sim.plant.body import Body
from vehicle_sim.plant.sensed import Sensed

Vec3: TypeAlias = tuple[float, float, float]

NOTHING: Vec3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class GpsLost:
    """No fix, no samples."""

    lost: bool = True


@dataclass(frozen=True, slots=True)
class GpsGlitch:
    """Every fix is off by this [m, NED]."""

    offset_ned: Vec3 = NOTHING


@dataclass(frozen=True, slots=True)
class MotorFault:
    """What is left of the thrust of one motor (1 to 4, the autopilots' order): 0 dead, 1 sound."""

    motor: int
    health: float = 0.0


@dataclass(frozen=True, slots=True)
class CellsLost:
    """The battery's voltage falls by that many cells (a part of one is a weak one)."""

    cells: float = 1.0


@dataclass(frozen=True, slots=True)
class Payload:
    """It carries so much more [kg], or so much less, than its data sheet says."""

    mass_kg: float = 0.0


@dataclass(frozen=True, slots=True)
class CentreOfMass:
    """The centre of mass is off the rotors' centre by this, forward and right [m]."""

    forward_m: float = 0.0
    right_m: float = 0.0


@dataclass(frozen=True, slots=True)
class WeakBattery:
    """Internal resistance and capacity as multiples of the data sheet's."""

    resistance_scale: float = 1.0
    capacity_scale: float = 1.0


@dataclass(frozen=True, slots=True)
class ThrustScale:
    """Every motor lifts this multiple of what the data sheet says."""

    scale: float = 1.0


@dataclass(frozen=True, slots=True)
class InertiaScale:
    """All three moments of inertia are this multiple of the data sheet's."""

    scale: float = 1.0


@dataclass(frozen=True, slots=True)
class WindChange:
    """The air's velocity [m/s, NED] from now on, and the standard deviation of its gusts."""

    wind_ned: Vec3 = NOTHING
    gust_m_s: float = 0.0


@dataclass(frozen=True, slots=True)
class AccelBias:
    """A constant error of the accelerometer [m/s^2, FRD]."""

    off_frd: Vec3 = NOTHING


@dataclass(frozen=True, slots=True)
class GyroBias:
    """A constant error of the gyroscope [rad/s, FRD]."""

    off_frd: Vec3 = NOTHING


@dataclass(frozen=True, slots=True)
class BaroFault:
    """The height by air pressure is off by this [m, up], or is no longer told."""

    offset_m: float = 0.0
    lost: bool = False


@dataclass(frozen=True, slots=True)
class MagFault:
    """The magnetic field is off by this [gauss, FRD], or is no longer told."""

    offset_frd: Vec3 = NOTHING
    lost: bool = False


ModelFault: TypeAlias = (
    GpsLost
    | GpsGlitch
    | MotorFault
    | CellsLost
    | Payload
    | CentreOfMass
    | WeakBattery
    | ThrustScale
    | InertiaScale
    | WindChange
    | AccelBias
    | GyroBias
    | BaroFault
    | MagFault
)


@dataclass(frozen=True, slots=True)
class RcLost:
    """The receiver hears no sticks, whatever is sent."""

    lost: bool = True


@dataclass(frozen=True, slots=True)
class ClockJump:
    """The vehicle's own clock is wrong by so much more, as its messages tell it."""

    by_ns: int = 0


@dataclass(frozen=True, slots=True)
class Reboot:
    """The autopilot starts anew, wherever the vehicle is; motors stop."""


Fault: TypeAlias = ModelFault | RcLost | ClockJump | Reboot


def sound(fault: ModelFault | RcLost) -> ModelFault | RcLost:
    """The same thing as it is when nothing is wrong."""
    match fault:
        case MotorFault(motor):
            return MotorFault(motor, 1.0)
        case GpsLost():
            return GpsLost(False)
        case RcLost():
            return RcLost(False)
        case CellsLost():
            return CellsLost(0.0)
        case GpsGlitch() | WindChange() | AccelBias() | GyroBias() | BaroFault() | MagFault():
            return type(fault)()
        case Payload() | CentreOfMass() | WeakBattery() | ThrustScale() | InertiaScale():
            return type(fault)()
        case _:
            assert_never(fault)


def inject(fault: ModelFault, body: Body, sensed: Sensed) -> None:
    """Write the fault into the blocks, where physics and sensors find it."""
    match fault:
        case GpsLost(lost):
            sensed.gps_lost = lost
        case GpsGlitch((north, east, down)):
            sensed.gps_off_n, sensed.gps_off_e, sensed.gps_off_d = north, east, down
        case MotorFault(motor, health):
            setattr(body, f"health_{motor}", health)
        case CellsLost(cells):
            body.cells_lost = cells
        case Payload(mass_kg):
            body.payload_kg = mass_kg
        case CentreOfMass(forward_m, right_m):
            body.mass_off_x, body.mass_off_y = forward_m, right_m
        case WeakBattery(resistance_scale, capacity_scale):
            body.resistance_scale, body.capacity_scale = resistance_scale, capacity_scale
        case ThrustScale(scale):
            body.thrust_scale = scale
        case InertiaScale(scale):
            body.inertia_scale = scale
        case WindChange((north, east, down), gust_m_s):
            body.wind_n, body.wind_e, body.wind_d = north, east, down
            body.gust_m_s = gust_m_s
        case AccelBias((x, y, z)):
            sensed.accel_off_x, sensed.accel_off_y, sensed.accel_off_z = x, y, z
        case GyroBias((x, y, z)):
            sensed.gyro_off_x, sensed.gyro_off_y, sensed.gyro_off_z = x, y, z
        case BaroFault(offset_m, lost):
            sensed.baro_off_m, sensed.baro_lost = offset_m, lost
        case MagFault((x, y, z), lost):
            sensed.mag_off_x, sensed.mag_off_y, sensed.mag_off_z = x, y, z
            sensed.mag_lost = lost
        case _:
            assert_never(fault)
