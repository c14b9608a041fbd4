"""The conditions that can go wrong, and how severe they are."""

from __future__ import annotations

from enum import IntEnum, StrEnum


class Severity(IntEnum):
    """How bad a condition is, in ascending order; of all active conditions the worst counts."""

    NOMINAL = 0
    CAUTION = 1
    HOLD = 2
    RETURN = 3
    LAND = 4
    TERMINATE = 5


class Condition(StrEnum):
    """What can be wrong.  The policy gives each condition its severity."""

    RECORDER_FAILED = "recorder_failed"
    BATTERY_LOW = "battery_low"
    BATTERY_CRITICAL = "battery_critical"
    ORIGIN_MISMATCH = "origin_mismatch"
    ORIGIN_MISSING = "origin_missing"
    OTHER_STATION = "other_station"
    LINK_POOR = "link_poor"
    GPS_LOST = "gps_lost"
    GPS_POOR = "gps_poor"
    ESTIMATOR_UNRELIABLE = "estimator_unreliable"
    FENCE_BREACHED = "fence_breached"
    VEHICLE_FENCE_BREACHED = "vehicle_fence_breached"
    TOO_CLOSE = "too_close"
    VEHICLE_FAILSAFE_WEAK = "vehicle_failsafe_weak"
    VEHICLE_FAILSAFE_ACTIVE = "vehicle_failsafe_active"
    TICK_LATE = "tick_late"
    PREFLIGHT_FAILED = "preflight_failed"
