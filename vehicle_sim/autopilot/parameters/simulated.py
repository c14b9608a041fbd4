"""The parameters of the autopilots' own simulations, as faults of the model.

ArduPilot's SIM_* (SITL.cpp) and those of PX4's sensor_*_sim modules.  A group of them acts when
one of it changes, so that faults from elsewhere are left alone by what nobody has touched.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import cos, radians, sin

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.plant.faults import (
    AccelBias,
    BaroFault,
    CellsLost,
    GpsGlitch,
    GpsLost,
    GyroBias,
    MagFault,
    ModelFault,
    MotorFault,
    WindChange,
)

FIX_SATELLITES = 4
_PA_PER_M = 12.01  # of air at sea level: density times gravity
_M_PER_DEG = 111_318.84502145034  # as ArduPilot reckons places
_MOTORS = (1, 2, 3, 4)
_LOAD_DROP = 0.1 / 0.45
_CELLS = 4.0  # of the airframe
_FULL_V = 12.6  # of SITL's three cells: with these its motors are as strong as they get


@dataclass(frozen=True, slots=True)
class _Group:
    """Parameters that make faults together; `make` is given where it is and what they say."""

    names: tuple[str, ...]
    make: Callable[[float, tuple[float, ...]], tuple[ModelFault, ...]]


def _wind(from_deg: float, speed_m_s: float, gust_m_s: float) -> WindChange:
    towards = radians(from_deg + 180.0)
    return WindChange((speed_m_s * cos(towards), speed_m_s * sin(towards), 0.0), gust_m_s)


def _weakened(full_v: float) -> CellsLost:
    """Motors as weak as SITL's are with that voltage of its own battery."""
    return CellsLost(_CELLS * max(0.0, 1.0 - full_v / _FULL_V))


def _engines(failed: float, left: float) -> tuple[ModelFault, ...]:
    mask = int(failed)
    return tuple(MotorFault(motor, left if mask >> motor - 1 & 1 else 1.0) for motor in _MOTORS)


def _xyz(prefix: str) -> tuple[str, str, str]:
    return (prefix + "X", prefix + "Y", prefix + "Z")


_GROUPS: dict[Personality, tuple[_Group, ...]] = {
    "px4": (
        _Group(("SIM_BARO_OFF_P",), lambda _, v: (BaroFault(-v[0] / _PA_PER_M),)),
        _Group(("SIM_GPS_USED",), lambda _, v: (GpsLost(v[0] < FIX_SATELLITES),)),
        _Group(_xyz("SIM_MAG_OFFSET_"), lambda _, v: (MagFault((v[0], v[1], v[2])),)),
    ),
    "ardupilot": (
        _Group(_xyz("SIM_ACC1_BIAS_"), lambda _, v: (AccelBias((v[0], v[1], v[2])),)),
        _Group(_xyz("SIM_GYR1_BIAS_"), lambda _, v: (GyroBias((v[0], v[1], v[2])),)),
        _Group(
            ("SIM_BARO_GLITCH", "SIM_BARO_DISABLE"), lambda _, v: (BaroFault(v[0], v[1] != 0.0),)
        ),
        _Group(("SIM_BATT_VOLTAGE",), lambda _, v: (_weakened(v[0]),)),
        _Group(("SIM_ENGINE_FAIL", "SIM_ENGINE_MUL"), lambda _, v: _engines(v[0], v[1])),
        _Group(("SIM_GPS_DISABLE",), lambda _, v: (GpsLost(v[0] != 0.0),)),
        _Group(
            _xyz("SIM_GPS_GLITCH_"),
            lambda lat_deg, v: (
                GpsGlitch((v[0] * _M_PER_DEG, v[1] * _M_PER_DEG * cos(radians(lat_deg)), -v[2])),
            ),
        ),
        _Group(("SIM_MAG1_FAIL",), lambda _, v: (MagFault(lost=v[0] != 0.0),)),
        _Group(("SIM_WIND_DIR", "SIM_WIND_SPD", "SIM_WIND_TURB"), lambda _, v: (_wind(*v),)),
    ),
}


_DRAIN: dict[Personality, tuple[str, ...]] = {
    "px4": ("SIM_BAT_DRAIN", "SIM_BAT_MIN_PCT"),
    "ardupilot": (),
}
"""What the simulated battery drains by, where the autopilot's simulation has such a battery."""
_VOLTAGE: dict[Personality, str | None] = {"px4": None, "ardupilot": "SIM_BATT_VOLTAGE"}
"""What sets the measured voltage."""


class SimulatedBattery:
    """PX4's own simulated battery: by SIM_BAT_DRAIN seconds from full to empty while armed, and not
    below SIM_BAT_MIN_PCT; full again when disarmed.

    It takes the airframe's place in what is measured once one of the two was changed; the motors'
    strength stays what it is.  As its voltage does not sag, the share that PX4 adds for the load
    (0.1 V of the 0.45 V between BAT1_V_EMPTY and BAT1_V_CHARGED) makes it look fuller than it is.
    """

    __slots__ = ("_left", "_parameters")

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self._left = 1.0

    def update(self, armed: bool, dt_s: float) -> None:
        """Of `dt_s` more seconds."""
        if not _DRAIN[self._parameters.personality]:
            return
        get = self._parameters.get
        least = 0.01 * get("SIM_BAT_MIN_PCT")
        self._left = max(least, self._left - dt_s / get("SIM_BAT_DRAIN")) if armed else 1.0

    def charge(self, throttle: float) -> float | None:
        """0..1 as it is estimated under that throttle (0..1); None = the airframe's counts."""
        if not self.measured(self._parameters):
            return None
        return min(1.0, self._left + throttle * _LOAD_DROP)

    def volts(self, airframe_v: float) -> float:
        """What is measured: ArduCopter's SIM_BATT_VOLTAGE if it was changed; no load lowers it."""
        name = _VOLTAGE[self._parameters.personality]
        if name is None:
            return airframe_v
        set_v = self._parameters.get(name)
        return airframe_v if set_v == self._parameters.designed(name) else set_v

    @staticmethod
    def measured(parameters: Parameters) -> bool:
        """Whether it has taken the airframe's place."""
        names = _DRAIN[parameters.personality]
        return any(parameters.get(name) != parameters.designed(name) for name in names)


class Simulated:
    """Remembers what the parameters said, and makes faults of what they newly say."""

    __slots__ = ("_lat_deg", "_parameters", "_said", "_version")

    def __init__(self, parameters: Parameters, lat_deg: float) -> None:
        """`lat_deg` is the latitude of the vehicle's start."""
        self._parameters = parameters
        self._lat_deg = lat_deg
        self._version = -1
        groups = _GROUPS[parameters.personality]
        self._said = [tuple(map(parameters.designed, group.names)) for group in groups]

    def news(self) -> Iterator[ModelFault]:
        """What has changed since it was asked last; at first, since the defaults."""
        if self._version == self._parameters.version:
            return
        self._version = self._parameters.version
        for number, group in enumerate(_GROUPS[self._parameters.personality]):
            says = tuple(self._parameters.get(name) for name in group.names)
            if says != self._said[number]:
                self._said[number] = says
                yield from group.make(self._lat_deg, says)
