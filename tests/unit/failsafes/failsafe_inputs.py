"""Inputs of failsafes, made by hand: a good flight, and what a test changes of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

from vehicle_sim.autopilot.failsafes.copter_failsafes import CopterFailsafes
from vehicle_sim.autopilot.failsafes.failsafe import Action, Cause, Failsafe
from vehicle_sim.autopilot.failsafes.failsafe_checks import (
    Cleared,
    FailsafeChecks,
    FailsafeEvent,
    Seen,
)
from vehicle_sim.autopilot.failsafes.px4_failsafes import Px4Failsafes
from vehicle_sim.autopilot.fence.geofence import NOTHING
from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import MODES, Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.control_loops.believed import believed_of
from vehicle_sim.estimation.estimator import Health
from vehicle_sim.plant.airframe import load

S: Final = 1_000_000_000
MS: Final = 1_000_000
AS_DELIVERED: Final[Mapping[str, float]] = {}

WELL: Final = Health(
    attitude_ok=True, velocity_ok=True, position_ok=True, height_ok=True, gps_ok=True,
    mag_ok=True, baro_ok=True, gps_fix=3, satellites=12, eph_m=0.6, epv_m=0.9, accuracy_m=0.4,
    dead_s=0.0, resets=0, vel_ratio=0.05, pos_ratio=0.05, height_ratio=0.05, mag_ratio=0.05,
)  # fmt: skip
FULL: Final = Power(16.6, 12.0, 100.0, 98)
LOW_V: Final = replace(FULL, voltage_v=13.9)
VOLTAGES: Final[dict[str, float]] = {"BATT_LOW_VOLT": 14.0, "BATT_CRT_VOLT": 13.0}
CHARGES: Final[dict[str, float]] = {
    "BATT_CAPACITY": 5000, "BATT_LOW_MAH": 1000, "BATT_CRT_MAH": 400,
}  # fmt: skip
"""ArduPilot's thresholds, of which `LOW_V` is below the first."""
EKF_LIMIT: Final = Parameters("ardupilot").get("FS_EKF_THRESH")  # 0.8 as a float32
BAD: Final = replace(WELL, mag_ratio=EKF_LIMIT, vel_ratio=EKF_LIMIT)

_FAILSAFES: Final[dict[Personality, type[FailsafeChecks]]] = {
    "px4": Px4Failsafes,
    "ardupilot": CopterFailsafes,
}
_FLOWN: Final[dict[Personality, str]] = {"px4": "AUTO.LOITER", "ardupilot": "AUTO"}


def parameters_of(
    personality: Personality, values: Mapping[str, float] = AS_DELIVERED
) -> Parameters:
    parameters = Parameters(personality)
    for name, value in values.items():
        parameters.set(name, value)
    return parameters


class Look:
    """One vehicle's failsafes, looked at when a test says so; `seen` is what they see."""

    def __init__(
        self, personality: Personality, values: Mapping[str, float] = AS_DELIVERED
    ) -> None:
        self.parameters = parameters_of(personality, values)
        self.believed = believed_of(load(), 0.004)
        self.checks = _FAILSAFES[personality](self.parameters, self.believed)
        self.modes = MODES[personality]
        self.seen = Seen(
            time_ns=100 * S,
            wall_ns=500 * S,
            mode=self.modes[_FLOWN[personality]],
            flying=True,
            needs_position=True,
            power=FULL,
            remaining=0.98,
            health=WELL,
            sticks=False,
            sticks_lost=False,
            crossing=NOTHING,
        )

    def position_lost(self) -> bool:
        return self.checks.position_lost

    def station_lost(self) -> bool:
        return self.checks.station_lost

    def sees(self, **changes: object) -> list[FailsafeEvent]:
        """What is triggered and cleared once these have changed; they stay."""
        self.seen = replace(self.seen, **changes)  # type: ignore[arg-type]  # as the test says
        return self.checks.check(self.seen)

    def after(self, time_ns: int, **changes: object) -> list[FailsafeEvent]:
        """The same so much later, on both clocks."""
        later = {"time_ns": self.seen.time_ns + time_ns, "wall_ns": self.seen.wall_ns + time_ns}
        return self.sees(**later, **changes)


def acts(events: Iterable[FailsafeEvent], cause: Cause) -> list[Action]:
    """The actions for this cause, telling aside."""
    return [
        event.action
        for event in events
        if isinstance(event, Failsafe) and event.cause is cause and event.action is not Action.WARN
    ]


def warns(events: Iterable[FailsafeEvent], cause: Cause) -> bool:
    """Whether something is told of this cause without being done."""
    return any(
        isinstance(event, Failsafe) and event.cause is cause and event.action is Action.WARN
        for event in events
    )


def clears(events: Iterable[FailsafeEvent], cause: Cause) -> bool:
    return any(isinstance(event, Cleared) and event.cause is cause for event in events)


def delays(events: Iterable[FailsafeEvent], cause: Cause) -> list[bool]:
    """Of those that act: whether PX4 holds first."""
    return [
        event.delayed
        for event in events
        if isinstance(event, Failsafe) and event.cause is cause and event.action is not Action.WARN
    ]
