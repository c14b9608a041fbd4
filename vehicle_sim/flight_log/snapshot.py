"""What a flight log is made of, whatever its format: the vehicle at one moment, and a format."""

from __future__ import annotations

from typing import NamedTuple, Protocol, TypeAlias

from vehicle_sim.autopilot.interface import (
    AttitudeGoal,
    Estimate,
    Geodetic,
    Landed,
    Power,
    Readings,
    Target,
)
from vehicle_sim.estimation.estimator import Health
from vehicle_sim.numerics.vectors import Vec3

Values: TypeAlias = tuple[float | bytes, ...]
"""The fields of one record, as `struct` packs them."""


class VehicleStatus(NamedTuple):
    """What changes seldom, and is written at once when it does."""

    armed: bool
    custom_mode: int
    landed: Landed
    system_status: int  # MAV_STATE
    origin: Geodetic | None
    home: Geodetic | None


class Snapshot(NamedTuple):
    """The vehicle at one moment, as it reports itself; never the truth."""

    time_us: int  # since boot
    unix_us: int  # 0 if the vehicle knows no date
    armed_us: int  # since boot, when this flight was armed
    status: VehicleStatus
    home_pos_ned: Vec3 | None
    estimate: Estimate
    health: Health
    readings: Readings
    target: Target
    attitude_goal: AttitudeGoal | None
    power: Power
    motor_outputs: tuple[float, float, float, float]  # 0..1


class Parameter(NamedTuple):
    name: str
    value: float
    default: float
    integer: bool


class Head(NamedTuple):
    """What stands at the beginning of a log."""

    system: int
    flight_sw_version: int  # AUTOPILOT_VERSION's
    dt_us: int  # between two steps of the vehicle
    parameters: tuple[Parameter, ...]


class Format(Protocol):
    """A log's format: every method answers the bytes to append."""

    def head(self, head: Head, now: Snapshot) -> bytes: ...
    def sample(self, now: Snapshot, turn: int) -> bytes:
        """`turn` counts the samples of this log from 0."""
        ...

    def change(self, now: Snapshot, before: VehicleStatus) -> bytes:
        """`now.status` is no longer what it was."""
        ...

    def text(self, time_us: int, severity: int, text: str) -> bytes:
        """A STATUSTEXT; `severity` is MAV_SEVERITY."""
        ...

    def parameter(self, time_us: int, parameter: Parameter) -> bytes:
        """A parameter that was set during the flight."""
        ...
