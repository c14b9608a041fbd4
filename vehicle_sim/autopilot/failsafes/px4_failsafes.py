"""What strikes a PX4: battery, silence of the station or the sticks, fence, lost position.

By commander's failsafe.cpp of PX4 1.14 and its parameters.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from vehicle_sim.autopilot.control.battery_charge import resting_v, voltage_of
from vehicle_sim.autopilot.failsafes.failsafe import (
    BATTERY,
    BREACH,
    STATION_LOSS,
    STICKS_LOSS,
    Action,
    Cause,
    Charge,
    Failsafe,
    activated,
    charge_of,
)
from vehicle_sim.autopilot.failsafes.failsafe_checks import Cleared, FailsafeChecks, Seen, Strike
from vehicle_sim.autopilot.fence.geofence import BreachKind
from vehicle_sim.autopilot.modes import Behaviour, StickLaw
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import position_ok
from vehicle_sim.plant.sensed import Sensed

_BATTERY_ADVICE = {
    Charge.LOW: ("Low battery level, return advised", 4),
    Charge.CRITICAL: ("Critical battery level, land now", 2),
    Charge.EMERGENCY: ("Emergency battery level, land immediately", 0),
}

# COM_RCL_EXCEPT: 1 mission, 2 every other mode that flies by itself, 4 offboard.
_RC_EXCEPTION = {Behaviour.MISSION: 1, Behaviour.GUIDED: 4}

_ROUNDING_V = 1e-6

_VIOLATIONS = {
    BreachKind.CIRCLE: "exceeding maximum distance to Home",
    BreachKind.ALT_MAX: "exceeding maximum altitude above Home",
    BreachKind.POLYGON: "approaching or outside geofence",
}


def violation(kinds: BreachKind) -> str:
    """PX4's words for a breach (geofenceCheck)."""
    return "Geofence violation: " + next(
        (text for kind, text in _VIOLATIONS.items() if kind in kinds), "outside geofence"
    )


class Px4Failsafes(FailsafeChecks):
    """PX4's."""

    __slots__ = ("_eph_most_m", "_resting_least_v", "_without_sticks")

    back_again = Cleared(Cause.STATION, "GCS connection regained")

    def _learn(self) -> None:
        get = self._parameters.get
        names = ("BAT_LOW_THR", "BAT_CRIT_THR", "BAT_EMERGEN_THR")
        # With a capacity of its own it goes by the charge that was drawn, and not by the voltage.
        counted = get("BAT1_CAPACITY") > 0.0
        least = max(get(name) for name in names)
        self._resting_least_v = inf if counted else voltage_of(least) + _ROUNDING_V
        worst_m = get("COM_POS_FS_EPH")
        self._eph_most_m = worst_m if worst_m >= 0.0 else inf

    def _well(self, sensed: Sensed, est: Estimated) -> bool:
        return (
            not self._without_sticks
            and resting_v(sensed, self._believed) >= self._resting_least_v
            and est.accuracy_m <= self._eph_most_m
            and position_ok(est)
        )

    def _begin(self, seen: Seen) -> None:
        self._without_sticks = seen.sticks_lost
        self._charge = charge_of(self._parameters, seen.power, seen.remaining)

    def _battery(self, seen: Seen) -> Iterator[Strike]:
        charge = charge_of(self._parameters, seen.power, seen.remaining)
        if charge <= self._charge:
            return
        self._charge = charge
        name, actions = BATTERY["px4"][charge]
        action = actions.get(int(self._parameters.get(name)), Action.WARN)
        if action is Action.WARN:
            advice, severity = _BATTERY_ADVICE[charge]
            yield Failsafe(Cause.BATTERY, action, advice, severity)
        else:
            text = activated(action, f"{charge.name.lower()} battery level")
            yield Failsafe(Cause.BATTERY, action, text, 2, delayed=True)

    def _station(self, seen: Seen) -> Iterator[Strike]:
        if not self._station_gone(seen):
            return
        yield Failsafe(Cause.STATION, Action.WARN, "Connection to ground station lost", 6)
        name, actions = STATION_LOSS["px4"]
        action = actions.get(int(self._parameters.get(name)))
        if action is not None and seen.mode.behaviour is not Behaviour.LAND:
            text = activated(action, "GCS connection loss")
            yield Failsafe(Cause.STATION, action, text, 2, delayed=True)

    def _sticks(self, seen: Seen) -> Iterator[Strike]:
        self._without_sticks = self._without_sticks and seen.sticks_lost
        bit = _RC_EXCEPTION.get(seen.mode.behaviour, 2)
        bit = 0 if seen.mode.law is not None else bit
        excepted = int(self._parameters.get("COM_RCL_EXCEPT")) & bit
        lost = seen.sticks_lost and not self._without_sticks and not excepted
        struck, self.sticks_lost = lost and not self.sticks_lost, lost
        name, actions = STICKS_LOSS["px4"]
        action = actions.get(int(self._parameters.get(name)))
        if struck and action is not None:
            text = activated(action, "manual control loss")
            yield Failsafe(Cause.STICKS, action, text, 2, delayed=True)

    def _fence(self, seen: Seen) -> Iterator[Strike]:
        name, actions = BREACH["px4"]
        action = actions.get(int(self._parameters.get(name)))
        if seen.crossing.cleared:
            yield Cleared(Cause.FENCE)
        if not seen.crossing.struck or action is None:
            return
        yield Failsafe(Cause.FENCE, Action.WARN, violation(seen.crossing.struck), 2)
        if action is not Action.WARN:
            delayed = action is not Action.HOLD
            yield Failsafe(Cause.FENCE, action, activated(action), 2, delayed)

    def _position(self, seen: Seen) -> Iterator[Strike]:
        worst_m = self._parameters.get("COM_POS_FS_EPH")
        health = seen.health
        bad = not health.position_ok or 0.0 <= worst_m < health.accuracy_m
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
