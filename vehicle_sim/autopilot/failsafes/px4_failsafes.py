"""What strikes a PX4: battery, silence of the station or the sticks, fence, lost position.

By commander's failsafe.cpp of PX4 1.14 and its parameters.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from vehicle_sim.autopilot.control.battery_charge import resting_v, voltage_of
from vehicle_sim.autopilot.failsafes.failsafe import (
    REMAINING,
    Action,
    Cause,
    Charge,
    Choice,
    Failsafe,
    activated,
    charge_of,
    highest,
)
from vehicle_sim.autopilot.failsafes.failsafe_checks import (
    Cleared,
    FailsafeChecks,
    FailsafeEvent,
    Seen,
)
from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import Behaviour, StickLaw
from vehicle_sim.autopilot.parameters.simulated import SimulatedBattery
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import position_ok
from vehicle_sim.plant.sensed import Sensed

# COM_RCL_EXCEPT: 1 mission, 2 every other mode that flies by itself, 4 offboard.
_RC_EXCEPTION = {Behaviour.MISSION: 1, Behaviour.GUIDED: 4}

_ROUNDING_V = 1e-6

_LOSS = {
    1: Action.HOLD,
    2: Action.RETURN,
    3: Action.LAND,
    5: Action.TERMINATE,
    6: Action.DISARM,
}
_STATION_LOSS = Choice("NAV_DLL_ACT", _LOSS)
_STICKS_LOSS = Choice("NAV_RCL_ACT", _LOSS)
_BREACH = Choice(
    "GF_ACTION",
    {1: Action.WARN, 2: Action.HOLD, 3: Action.RETURN, 4: Action.TERMINATE, 5: Action.LAND},
)
_BATTERY = {
    Charge.LOW: Choice("COM_LOW_BAT_ACT", {}),
    Charge.CRITICAL: Choice(
        "COM_LOW_BAT_ACT", {1: Action.RETURN, 2: Action.LAND, 3: Action.RETURN}
    ),
    Charge.EMERGENCY: Choice("COM_LOW_BAT_ACT", {1: Action.RETURN, 2: Action.LAND, 3: Action.LAND}),
}

NO_STATION = "Preflight Fail: No connection to the ground control station"
_LOW = Failsafe(Cause.BATTERY, Action.WARN, "Preflight Fail: low battery", 0)
_EMPTY = (
    Failsafe(Cause.BATTERY, Action.WARN, "Transition denied: Armed to Shutdown", 2),
    Failsafe(Cause.BATTERY, Action.WARN, "System does not support shutdown", 2),
)
"""An empty battery makes it ask for a shutdown, which a simulation has not."""


def violation() -> str:
    """PX4's words for a breach of any kind (geofenceCheck)."""
    return "Preflight Fail: Geofence violation"


class Px4Failsafes(FailsafeChecks):
    """PX4's."""

    __slots__ = ("_eph_most_m", "_low_told", "_resting_least_v", "_without_sticks")

    def reset(self) -> None:
        super().reset()
        self._low_told = False

    back_again = Cleared(Cause.STATION, "GCS connection regained")

    def _learn(self) -> None:
        get = self._parameters.get
        # With a capacity of its own it goes by the charge that was drawn, and not by the voltage.
        counted = get("BAT1_CAPACITY") > 0.0 or SimulatedBattery.measured(self._parameters)
        least = highest(self._parameters, REMAINING)
        self._resting_least_v = inf if counted else voltage_of(least) + _ROUNDING_V
        worst_m = get("COM_POS_FS_EPH")
        self._eph_most_m = worst_m if worst_m >= 0.0 else inf

    def _within_limits(self, sensed: Sensed, est: Estimated) -> bool:
        return (
            not self._without_sticks
            and resting_v(sensed, self._believed) >= self._resting_least_v
            and not self._position_bad(position_ok(est), est.accuracy_m)
        )

    def _position_bad(self, ok: bool, accuracy_m: float) -> bool:
        return not ok or accuracy_m > self._eph_most_m

    def _begin(self, seen: Seen) -> Iterator[FailsafeEvent]:
        self._without_sticks = seen.sticks_lost
        self._charge = charge_of(self._parameters, seen.power, seen.remaining)
        if self._charge > Charge.FINE:
            yield Failsafe(Cause.BATTERY, Action.WARN, activated(Action.WARN), 2)

    def _battery(self, seen: Seen) -> Iterator[FailsafeEvent]:
        charge = charge_of(self._parameters, seen.power, seen.remaining)
        if charge <= self._charge:
            return
        self._charge = charge
        action = _BATTERY[charge].of(self._parameters) or Action.WARN
        yield _LOW
        if charge is Charge.EMERGENCY:
            yield from _EMPTY
        text = activated(action, f"{charge.name.lower()} battery level")
        yield Failsafe(Cause.BATTERY, action, text, 2, delayed=True)

    def _battery_words(self, power: Power, remaining: float) -> Iterator[Failsafe]:
        low = charge_of(self._parameters, power, remaining) > Charge.FINE
        if low and not self._low_told:
            yield _LOW
        self._low_told = low

    def _station(self, seen: Seen) -> Iterator[FailsafeEvent]:
        if not self._station_gone(seen.wall_ns):
            return
        yield from self._station_words()
        action = _STATION_LOSS.of(self._parameters)
        if action is not None and seen.mode.behaviour is not Behaviour.LAND:
            text = activated(action, "GCS connection loss")
            yield Failsafe(Cause.STATION, action, text, 2, delayed=True)

    def _station_words(self) -> Iterator[Failsafe]:
        yield Failsafe(Cause.STATION, Action.WARN, "Connection to ground station lost", 6)
        if self._parameters.get("NAV_DLL_ACT") > 0.0:
            yield Failsafe(Cause.STATION, Action.WARN, NO_STATION, 4)

    def _sticks(self, seen: Seen) -> Iterator[FailsafeEvent]:
        self._without_sticks = self._without_sticks and seen.sticks_lost
        bit = _RC_EXCEPTION.get(seen.mode.behaviour, 2)
        bit = 0 if seen.mode.law is not None else bit
        excepted = int(self._parameters.get("COM_RCL_EXCEPT")) & bit
        lost = seen.sticks_lost and not self._without_sticks and not excepted
        struck, self.sticks_lost = lost and not self.sticks_lost, lost
        action = _STICKS_LOSS.of(self._parameters)
        if struck and action is not None:
            text = activated(action, "manual control loss")
            yield Failsafe(Cause.STICKS, action, text, 2, delayed=True)

    def _fence(self, seen: Seen) -> Iterator[FailsafeEvent]:
        action = _BREACH.of(self._parameters)
        if seen.crossing.cleared:
            yield Cleared(Cause.FENCE)
        if not seen.crossing.breached or action is None:
            return
        yield Failsafe(Cause.FENCE, Action.WARN, violation(), 2)
        delayed = action is not Action.HOLD
        yield Failsafe(Cause.FENCE, action, activated(action), 2, delayed)

    def _position(self, seen: Seen) -> Iterator[FailsafeEvent]:
        bad = self._position_bad(seen.health.position_ok, seen.health.accuracy_m)
        was_lost, self.position_lost = self.position_lost, bad and seen.needs_position
        if was_lost and not bad:
            yield Cleared(Cause.POSITION)
        if was_lost or not self.position_lost:
            # The mode flown meanwhile needs no position: it is still the same failsafe.
            self.position_lost = self.position_lost or (was_lost and bad)
            return
        by_hand = seen.mode.law is StickLaw.POSITION
        keep_height = by_hand and seen.sticks and self._parameters.get("COM_POSCTL_NAVL") == 0
        action = Action.ALTITUDE if keep_height else Action.DESCEND
        yield Failsafe(Cause.POSITION, action, activated(action, "invalid position estimate"), 2)
