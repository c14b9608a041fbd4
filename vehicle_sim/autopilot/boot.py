"""What an autopilot knows, says and refuses between power-up and readiness.

`--boot quick`, the default, is ready as soon as the estimator is: half a second.  `--boot real` has
the times of the recorded simulations.  They are of the scenarios `boot_to_ready` and
`H7_force_arm_not_ready` and of the flights `px4_1_14_flight.tlog` and `arducopter_4_7_flight.tlog`,
in seconds of the vehicle's own clock.  Two of ArduCopter's are derived: it calls accelerometers
consistent after 10 s, then gyroscopes after another 10 s (AP_Arming, from memory), which fits the
recorded refusals and that it is called healthy after 23 s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

from vehicle_sim.autopilot.modes import Mode, Personality
from vehicle_sim.estimation.estimator import Health

Boot: TypeAlias = Literal["quick", "real"]


@dataclass(frozen=True, slots=True)
class BootStage:
    """What the autopilot has by now."""

    initialised: bool
    sensors: bool  # SYS_STATUS tells which there are
    gps: bool  # a receiver was found
    attitude: bool
    origin: bool
    home: bool
    position: bool  # good enough to fly by


READY: Final = BootStage(
    initialised=True,
    sensors=True,
    gps=True,
    attitude=True,
    origin=True,
    home=True,
    position=True,
)


@dataclass(frozen=True, slots=True)
class _Times:
    """When each part of a `BootStage` is there [s], and what is said of it meanwhile."""

    initialised: float
    sensors: float
    gps: float
    attitude: float
    origin: float
    home: float
    position: float
    armable: float  # nothing refuses any more
    armable_by_force: float
    texts: tuple[tuple[float, str], ...]  # when, and what, in order
    prearm_shown: float | None  # what speaks against arming is said unasked; None = never
    gives_reasons: bool  # says why it cannot be armed yet


_EKF_RUNS_S: Final = 4.4
_ACCELS_CONSISTENT_S: Final = 13.0

_COPTER_TEXTS: Final[tuple[tuple[float, str], ...]] = (
    (2.0, "Barometer 1 calibration complete"),
    (2.0, "Barometer 2 calibration complete"),
    (2.5, "ArduPilot Ready"),
    (2.5, "AHRS: DCM active"),
    (2.7, "RC7: SaveWaypoint LOW"),
    (4.4, "EKF3 IMU0 initialised"),
    (4.4, "EKF3 IMU1 initialised"),
    (4.4, "AHRS: EKF3 active"),
    (5.8, "EKF3 IMU0 tilt alignment complete"),
    (5.8, "EKF3 IMU1 tilt alignment complete"),
    (5.9, "EKF3 IMU0 MAG0 initial yaw alignment complete"),
    (5.9, "EKF3 IMU1 MAG0 initial yaw alignment complete"),
    (9.8, "GPS 1: probing for u-blox at 230400 baud"),
    (9.8, "GPS 1: detected u-blox"),
    (20.0, "EKF3 IMU0 origin set"),
    (20.0, "Field Elevation Set: {alt_amsl_m:.0f}m"),
    (20.2, "EKF3 IMU1 origin set"),
    (41.4, "EKF3 IMU0 is using GPS"),
    (41.6, "EKF3 IMU1 is using GPS"),
)

_TIMES: Final[dict[Personality, _Times]] = {
    "px4": _Times(
        initialised=0.0,
        sensors=2.1,
        gps=0.0,
        attitude=6.4,
        origin=1.1,
        home=2.1,
        position=8.15,
        armable=8.7,
        armable_by_force=8.7,
        texts=(),  # PX4 says all of it by EVENT
        prearm_shown=None,
        gives_reasons=False,
    ),
    "ardupilot": _Times(
        initialised=2.5,
        sensors=0.0,
        gps=9.8,
        attitude=5.9,
        origin=20.0,
        home=20.0,
        position=41.4,
        armable=23.0,
        armable_by_force=_EKF_RUNS_S,
        texts=_COPTER_TEXTS,
        prearm_shown=30.4,  # and then every 30 s
        gives_reasons=True,
    ),
}
_AHRS_TYPE: Final = "AHRS: not using configured AHRS type"


class BootSequence:
    """One vehicle's way from power-up to readiness.  Every time is its age since power-up."""

    __slots__ = ("_said", "_shown", "_times")

    def __init__(self, personality: Personality, boot: Boot) -> None:
        self._times = _TIMES[personality] if boot == "real" else None
        self.restart()

    def restart(self) -> None:
        """Power-up."""
        self._said = 0
        self._shown = False

    @property
    def real(self) -> bool:
        return self._times is not None

    def stage(self, age_ns: int) -> BootStage:
        times = self._times
        if times is None or age_ns >= int(times.position * 1e9):
            return READY
        age_s = age_ns * 1e-9
        return BootStage(
            initialised=age_s >= times.initialised,
            sensors=age_s >= times.sensors,
            gps=age_s >= times.gps,
            attitude=age_s >= times.attitude,
            origin=age_s >= times.origin,
            home=age_s >= times.home,
            position=False,
        )

    def texts(self, age_ns: int, alt_amsl_m: float) -> list[str]:
        """What is said now, at the place's height above mean sea level."""
        said: list[str] = []
        texts = self._times.texts if self._times is not None else ()
        while self._said < len(texts) and texts[self._said][0] * 1e9 <= age_ns:
            said.append(texts[self._said][1].format(alt_amsl_m=alt_amsl_m))
            self._said += 1
        return said

    def shows_prearm(self, age_ns: int) -> bool:
        """Once: whether what speaks against arming is said now though nobody asked."""
        shown_s = self._times.prearm_shown if self._times is not None else None
        if self._shown or shown_s is None or age_ns < int(shown_s * 1e9):
            return False
        self._shown = True
        return True

    def holds(self, age_ns: int) -> bool:
        """Nothing arms it yet, whatever the other checks say."""
        return self._times is not None and age_ns < int(self._times.armable * 1e9)

    def holds_forced(self, age_ns: int) -> bool:
        """Not even by force: PX4 until it is ready, ArduCopter until its EKF runs."""
        return self._times is not None and age_ns < int(self._times.armable_by_force * 1e9)

    def reasons(self, age_ns: int, mode: Mode, forced: bool = False) -> list[str]:
        """While it `holds`: ArduCopter's words for it, without "Arm: ".  PX4 has none."""
        times = self._times
        if times is None or not times.gives_reasons:
            return []
        age_s = age_ns * 1e-9
        if age_s < times.initialised:
            return ["System not initialised"]
        if age_s < _EKF_RUNS_S:
            found = ["Accels inconsistent", "EKF attitude is bad", _AHRS_TYPE]
            return [_AHRS_TYPE, *found] if forced else found
        inertial = "Accels" if age_s < _ACCELS_CONSISTENT_S else "Gyros"
        found = [f"{inertial} inconsistent"]
        if mode.needs_position:
            homeless = age_s < times.home
            found.append("AHRS: waiting for home" if homeless else "Need Position Estimate")
        return found

    def known(self, judged: Health, age_ns: int) -> Health:
        """The estimate's health, without what the autopilot does not have yet."""
        stage = self.stage(age_ns)
        if stage is READY:
            return judged
        return replace(
            judged,
            attitude_ok=judged.attitude_ok and stage.attitude,
            velocity_ok=False,
            position_ok=False,
            gps_fix=judged.gps_fix if stage.gps else 0,
            satellites=judged.satellites if stage.gps else 0,
        )
