"""Loss of control as the autopilots see it themselves: attitude, thrust, motors.

PX4: the failure detector (attitude, and motors by their ESCs' telemetry).  ArduCopter: the crash
check and the thrust loss check.  All at 10 Hz in simulated time.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, degrees, radians

from vehicle_sim.autopilot.failsafes.failsafe import (
    MOTOR_FAILURE,
    RANK,
    Action,
    Cause,
    Failsafe,
    activated,
)
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters

_TAKE_OFF_NS = 3_000_000_000  # PX4: so soon after arming an upset is a bad take-off
_BREAKER = 121212  # CBRK_FLIGHTTERM: no flight termination
_DEAD_THRUST = 0.1  # of what was asked for
_UPSETS = (("roll", "FD_FAIL_R"), ("pitch", "FD_FAIL_P"))

_CRASH_DEG = 30.0
_CRASH_M_S2 = 3.0
_CRASH_NS = 2_000_000_000
_ACCEL_GAIN = 0.386  # one step of a 1 Hz low-pass at 10 Hz
_THRUST_LOSS_NS = 1_000_000_000
_LEVEL_DEG = 15.0
_FULL_THRUST = 0.9


@dataclass(frozen=True, slots=True)
class Posture:
    """How the vehicle hangs in the air, and what it asks for.

    `off_rad` is the angle between wanted and estimated thrust direction, `lean_rad` the wanted
    lean; `accel_m_s2` the size of the acceleration, `climb_m_s` upwards positive; `thrust` and
    `asked` are 0..1 for each motor: what comes (as an ESC's telemetry tells) and what was asked.
    """

    roll_rad: float
    pitch_rad: float
    off_rad: float
    lean_rad: float
    accel_m_s2: float
    climb_m_s: float
    asked: tuple[float, float, float, float]
    thrust: tuple[float, float, float, float]


class FailureDetector(ABC):
    """Remembers what was triggered since arming."""

    __slots__ = ("_armed_ns", "_nominal_cos", "_parameters", "_timers", "_triggered", "_version")

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self._version = -1
        self._nominal_cos = 1.0
        self.reset()

    def reset(self) -> None:
        """Disarmed."""
        self._armed_ns: int | None = None
        self._timers: dict[str, int] = {}  # since when something has been so
        self._triggered: set[str] = set()

    def nominal(
        self, upright: float, wanted: float, asked_most: float, thrust_least: float
    ) -> bool:
        """Whether nothing can be wrong, so that there is nothing to look at more closely.

        Cosines of the lean and of the wanted lean; the hardest motor's command, and what the
        weakest gives.  Nearly always so, and much cheaper than to check.
        """
        if self._timers or self._armed_ns is None:
            return False
        if self._version != self._parameters.version:
            self._version = self._parameters.version
            self._nominal_cos = cos(radians(self._least_lean_deg()))
        return (
            upright > self._nominal_cos
            and wanted > self._nominal_cos
            and asked_most < _FULL_THRUST
            and thrust_least >= _DEAD_THRUST * asked_most
        )

    @abstractmethod
    def _least_lean_deg(self) -> float:
        """No upset counts below this lean."""

    def check(self, posture: Posture, flying: bool, by_rates: bool, now_ns: int) -> list[Failsafe]:
        """What is triggered now.  `by_rates`: flown by body rates, where any attitude is wanted."""
        if self._armed_ns is None:
            self._armed_ns = now_ns
        return self._find(posture, flying, by_rates, now_ns)

    @abstractmethod
    def _find(
        self, posture: Posture, flying: bool, by_rates: bool, now_ns: int
    ) -> list[Failsafe]: ...

    def _once(self, name: str, is_so: bool, now_ns: int, limit_ns: int) -> bool:
        """Whether `is_so` has now lasted for the limit, said once until it ends."""
        if not is_so:
            self._timers.pop(name, None)
            self._triggered.discard(name)
            return False
        if now_ns - self._timers.setdefault(name, now_ns) < limit_ns:
            return False
        new = name not in self._triggered
        self._triggered.add(name)
        return new


class Px4FailureDetector(FailureDetector):
    """PX4's failure detector."""

    __slots__ = ("_motors",)

    def reset(self) -> None:
        super().reset()
        self._motors: set[int] = set()

    def _least_lean_deg(self) -> float:
        limits = [self._parameters.get(name) for _, name in _UPSETS]
        return min([limit for limit in limits if limit > 0.0], default=90.0)

    def _find(self, posture: Posture, flying: bool, by_rates: bool, now_ns: int) -> list[Failsafe]:
        struck = [] if by_rates else [*self._attitude(posture, now_ns)]
        return [*struck, *self._dead_motors(posture, now_ns)]

    def _attitude(self, posture: Posture, now_ns: int) -> Iterator[Failsafe]:
        get = self._parameters.get
        for (axis, name), angle_rad in zip(
            _UPSETS, (posture.roll_rad, posture.pitch_rad), strict=True
        ):
            limit_deg = get(name)
            upset = limit_deg > 0.0 and abs(degrees(angle_rad)) > limit_deg
            if not self._once(axis, upset, now_ns, int(get(name + "_TTRI") * 1e9)):
                continue
            action = Action.TERMINATE
            if self._armed_ns is not None and now_ns - self._armed_ns < _TAKE_OFF_NS:
                action = Action.DISARM
            elif get("CBRK_FLIGHTTERM") == _BREAKER:
                action = Action.WARN
            yield Failsafe(Cause.ATTITUDE, action, f"Attitude failure ({axis})", 2)

    def _dead_motors(self, posture: Posture, now_ns: int) -> Iterator[Failsafe]:
        get = self._parameters.get
        if get("FD_ACT_EN") == 0:
            return
        limit_ns = int(get("FD_ACT_MOT_TOUT") * 1e6)
        for number, (asked, thrust) in enumerate(zip(posture.asked, posture.thrust, strict=True)):
            dead = asked > get("FD_ACT_MOT_THR") and thrust < _DEAD_THRUST * asked
            if not self._once(f"motor {number}", dead, now_ns, limit_ns):
                continue
            if number in self._motors:
                continue
            self._motors.add(number)
            action = MOTOR_FAILURE[int(get("COM_ACT_FAIL_ACT"))]
            yield Failsafe(Cause.MOTOR, Action.WARN, f"Motor {number + 1} failure detected", 2)
            if RANK[action] > RANK[Action.WARN]:
                delayed = action is not Action.TERMINATE
                yield Failsafe(Cause.MOTOR, action, activated(action), 2, delayed)


class CopterFailureDetector(FailureDetector):
    """ArduCopter's crash check and thrust loss check."""

    __slots__ = ("_accel",)

    def reset(self) -> None:
        super().reset()
        self._accel = 0.0

    def _least_lean_deg(self) -> float:
        return 0.5 * _CRASH_DEG

    def _find(self, posture: Posture, flying: bool, by_rates: bool, now_ns: int) -> list[Failsafe]:
        if not flying:
            self._timers.clear()
            return []
        self._accel += _ACCEL_GAIN * (posture.accel_m_s2 - self._accel)
        struck = [] if by_rates else [*self._crash(posture, now_ns)]
        return [*struck, *self._thrust_loss(posture, now_ns)]

    def _crash(self, posture: Posture, now_ns: int) -> Iterator[Failsafe]:
        off_deg = degrees(posture.off_rad)
        crashed = (
            self._parameters.get("FS_CRASH_CHECK") != 0
            and off_deg > _CRASH_DEG
            and self._accel < _CRASH_M_S2
        )
        if self._once("crash", crashed, now_ns, _CRASH_NS):
            text = f"Crash: Disarming: AngErr={off_deg:.0f}>{_CRASH_DEG:.0f}, "
            text += f"Accel={self._accel:.1f}<{_CRASH_M_S2:.1f}"
            yield Failsafe(Cause.ATTITUDE, Action.DISARM, text, 0)

    def _thrust_loss(self, posture: Posture, now_ns: int) -> Iterator[Failsafe]:
        """Told only: the motors' own thrust boost is what ArduCopter does about it."""
        lost = (
            degrees(posture.lean_rad) <= _LEVEL_DEG
            and degrees(posture.off_rad) < _CRASH_DEG
            and max(posture.asked) >= _FULL_THRUST
            and posture.climb_m_s < 0.0
        )
        if self._once("thrust", lost, now_ns, _THRUST_LOSS_NS):
            motor = max(range(4), key=lambda number: posture.asked[number])
            text = f"Potential Thrust Loss ({motor + 1})"
            yield Failsafe(Cause.MOTOR, Action.WARN, text, 0)


FAILURE_DETECTORS: dict[Personality, type[Px4FailureDetector | CopterFailureDetector]] = {
    "px4": Px4FailureDetector,
    "ardupilot": CopterFailureDetector,
}
