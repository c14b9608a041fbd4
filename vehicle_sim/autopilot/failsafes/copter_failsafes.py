"""What strikes an ArduCopter: battery, silence of the station or the sticks, fence, lost position.

By ArduCopter's events.cpp, fence.cpp and ekf_check.cpp, and by AP_BattMonitor.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from vehicle_sim.autopilot.failsafes.failsafe import (
    CAPACITY,
    VOLTAGE,
    Action,
    Cause,
    Charge,
    Choice,
    Failsafe,
    by_capacity,
    by_voltage,
    highest,
)
from vehicle_sim.autopilot.failsafes.failsafe_checks import (
    Cleared,
    FailsafeChecks,
    FailsafeEvent,
    Seen,
)
from vehicle_sim.autopilot.fence.geofence import names
from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import Behaviour
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import Health, position_ok
from vehicle_sim.plant.sensed import Sensed

_GIVE_UP_M = 100.0  # it lands at once when it is further outside than this
_EKF_CHECKS = 10  # of ekf_check: a second of bad ones in a row

_GOES_ON = {
    Behaviour.MISSION: "Continuing Auto Mode",
    Behaviour.GUIDED: "Continuing Guided Mode",
}

# Without a SmartRTL, and without a landing item in the mission, ArduCopter falls back so.
_STATION_LOSS = Choice(
    "FS_GCS_ENABLE",
    {
        1: Action.RETURN,
        3: Action.RETURN,
        4: Action.LAND,
        5: Action.LAND,
        6: Action.RETURN,
        7: Action.BRAKE,
    },
)
_STICKS_LOSS = Choice(
    "FS_THR_ENABLE",
    {
        1: Action.RETURN,
        2: Action.RETURN,
        3: Action.LAND,
        4: Action.RETURN,
        5: Action.LAND,
        6: Action.RETURN,
        7: Action.BRAKE,
    },
)
_BREACH = Choice(
    "FENCE_ACTION",
    {
        0: Action.WARN,
        1: Action.RETURN,
        2: Action.LAND,
        3: Action.RETURN,
        4: Action.BRAKE,
        5: Action.LAND,
    },
)
_EMPTY = {
    1: Action.LAND,
    2: Action.RETURN,
    3: Action.RETURN,
    4: Action.LAND,
    5: Action.TERMINATE,
    6: Action.RETURN,
    7: Action.BRAKE,
}
_BATTERY = {
    Charge.LOW: Choice("BATT_FS_LOW_ACT", _EMPTY),
    Charge.CRITICAL: Choice("BATT_FS_CRT_ACT", _EMPTY),
}


class CopterFailsafes(FailsafeChecks):
    """ArduCopter's."""

    __slots__ = ("_bad_checks", "_low_since_ns", "_ratio_most", "_used_most_mah", "_volt_least")

    back_again = Cleared(Cause.STATION, "GCS Failsafe Cleared", 4)

    def reset(self) -> None:
        super().reset()
        self._low_since_ns: int | None = None
        self._bad_checks = 0

    def _learn(self) -> None:
        get = self._parameters.get
        simulated = get("SIM_BATT_VOLTAGE") != self._parameters.designed("SIM_BATT_VOLTAGE")
        self._volt_least = inf if simulated else highest(self._parameters, VOLTAGE)
        self._used_most_mah = get("BATT_CAPACITY") - highest(self._parameters, CAPACITY)
        self._ratio_most = get("FS_EKF_THRESH")

    def _within_limits(self, sensed: Sensed, est: Estimated) -> bool:
        if self._low_since_ns is not None or sensed.battery_v < self._volt_least:
            return False
        if sensed.battery_used_mah > self._used_most_mah:
            return False
        return self._ratio_most <= 0.0 or (
            self._bad_checks == 0 and self._variances_over(est) == 0 and position_ok(est)
        )

    def _variances_over(self, of: Estimated | Health) -> int:
        """How many of the three that ekf_check looks at reach FS_EKF_THRESH."""
        most = self._ratio_most
        return (of.mag_ratio >= most) + (of.vel_ratio >= most) + (of.pos_ratio >= most)

    def _begin(self, seen: Seen) -> Iterator[FailsafeEvent]:
        """Its own checks before arming have let it pass; forced, it acts at once."""
        return iter(())

    def _station_words(self) -> Iterator[Failsafe]:
        if self._parameters.get("FS_GCS_ENABLE") != 0.0:
            yield Failsafe(Cause.STATION, Action.WARN, "GCS Failsafe", 4)

    def _battery_words(self, power: Power, remaining: float) -> Iterator[Failsafe]:
        return iter(())

    def _battery(self, seen: Seen) -> Iterator[FailsafeEvent]:
        get = self._parameters.get
        charge = by_capacity(self._parameters, seen.power)
        if by_voltage(self._parameters, seen.power) > self._charge:
            since_ns = self._low_since_ns
            self._low_since_ns = since_ns = seen.time_ns if since_ns is None else since_ns
            if seen.time_ns - since_ns >= int(get("BATT_LOW_TIMER") * 1e9):
                charge = max(charge, by_voltage(self._parameters, seen.power))
        else:
            self._low_since_ns = None
        if charge <= self._charge:
            return
        self._charge = charge
        self.battery_failed = True
        self._low_since_ns = None
        action = _BATTERY[charge].of(self._parameters) or Action.WARN
        power = seen.power
        text = f"Battery 1 is {charge.name.lower()} {power.voltage_v:.2f}V used "
        text += f"{power.consumed_mah:.0f} mAh"
        yield Failsafe(Cause.BATTERY, Action.WARN, text, 4)
        yield self._copter("Battery", Cause.BATTERY, action, seen)

    def _station(self, seen: Seen) -> Iterator[FailsafeEvent]:
        action = _STATION_LOSS.of(self._parameters)
        if action is not None and self._station_gone(seen.wall_ns):
            yield self._copter("GCS", Cause.STATION, action, seen)

    def _sticks(self, seen: Seen) -> Iterator[FailsafeEvent]:
        action = _STICKS_LOSS.of(self._parameters)
        was_lost, self.sticks_lost = self.sticks_lost, seen.sticks_lost
        if action is None:
            return
        if self.sticks_lost and not was_lost:
            yield self._copter("Radio", Cause.STICKS, action, seen)
        elif was_lost and not self.sticks_lost:
            yield Cleared(Cause.STICKS, "Radio Failsafe Cleared", 4)

    def _copter(self, who: str, cause: Cause, action: Action, seen: Seen) -> Failsafe:
        """ArduCopter goes on as it does where FS_OPTIONS says so, and disarms on the ground."""
        options = int(self._parameters.get("FS_OPTIONS"))
        behaviour = seen.mode.behaviour
        by_hand = behaviour in (Behaviour.LEVEL, Behaviour.HOLD)
        goes_on = {
            (Behaviour.MISSION, Cause.STICKS): 1,
            (Behaviour.MISSION, Cause.STATION): 2,
            (Behaviour.GUIDED, Cause.STICKS): 4,
        }.get((behaviour, cause), 0)
        if not seen.flying:
            return Failsafe(cause, Action.DISARM, f"{who} Failsafe - Disarming", 4)
        if options & goes_on:
            return Failsafe(cause, Action.WARN, f"{who} Failsafe - {_GOES_ON[behaviour]}", 4)
        if behaviour is Behaviour.LAND and options & 8:
            return Failsafe(cause, Action.WARN, f"{who} Failsafe - Continuing Landing", 4)
        if by_hand and cause is Cause.STATION and options & 16:
            return Failsafe(cause, Action.WARN, f"{who} Failsafe - Continuing Pilot Control", 4)
        return Failsafe(cause, action, f"{who} Failsafe", 4)

    def _fence(self, seen: Seen) -> Iterator[FailsafeEvent]:
        crossing = seen.crossing
        if crossing.cleared:
            yield Cleared(Cause.FENCE, "Fence breach cleared", 5)
        if not crossing.breached:
            return
        action = _BREACH.actions[int(self._parameters.get(_BREACH.parameter))]
        if action is not Action.WARN:
            if not seen.flying:
                action = Action.DISARM
            elif crossing.beyond_m > _GIVE_UP_M:
                action = Action.LAND
        yield Failsafe(Cause.FENCE, action, f"{names(crossing.breached)} breached", 4)

    def _position(self, seen: Seen) -> Iterator[FailsafeEvent]:
        if self._ratio_most <= 0.0:
            return
        bad = self._variances_over(seen.health) >= 2 or not seen.health.position_ok
        step = 1 if bad else -1
        self._bad_checks = min(_EKF_CHECKS, max(0, self._bad_checks + step))
        if self.position_lost:
            if self._bad_checks == 0:
                self.position_lost = False
                yield Cleared(Cause.POSITION, "EKF Failsafe Cleared", 2)
            return
        if self._bad_checks < _EKF_CHECKS:
            return
        self.position_lost = True
        yield Failsafe(Cause.POSITION, Action.WARN, "EKF variance: position lost", 2)
        choice = int(self._parameters.get("FS_EKF_ACTION"))
        if choice == 0 or (not seen.needs_position and choice != 3):
            return
        action, word = (
            (Action.ALTITUDE, "Altitude Hold") if choice == 2 else (Action.DESCEND, "Land")
        )
        yield Failsafe(Cause.POSITION, action, f"EKF Failsafe: changed to {word} Mode", 2)
