"""What a recording's steps do not tell, and its texts and times do.

The recorder sent some messages by itself, or tells of them in its figures: the take-off before a
scenario's first step, an arming at the end, the mode HOLD at the start, requests for logs and
rates; and it let its heartbeat stop in places where the step says no more than `silent`, or
nothing.
"""

from __future__ import annotations

from typing import Final

from tests.scenarios.facts import Step
from vehicle_sim.autopilot.modes import Personality


def _long(t: float, command: str, *params: float | None) -> Step:
    values = (*params, *(0.0,) * (7 - len(params)))
    return Step(t, f"COMMAND_LONG MAV_CMD_{command}", params=values)


def _hold(t: float) -> Step:
    return _long(t, "DO_SET_MODE", 1.0, 4.0, 3.0)


def _arm(t: float) -> Step:
    return _long(t, "COMPONENT_ARM_DISARM", 1.0)


UNTOLD: Final[dict[tuple[Personality, str], tuple[Step, ...]]] = {
    ("px4", "C9d_jump_and_delay_flown"): (_hold(0.4),),
    ("px4", "F5_px4_gf_actions"): (_hold(0.4),),
    ("px4", "G5_arm_without_station"): (Step(13.3, "beats again"),),
    ("px4", "H1_change_speed"): (
        _hold(0.4),
        _arm(0.75),
        _long(0.85, "NAV_TAKEOFF", 0.0, 0.0, 0.0, None, None, None, 38.2),
    ),
    ("px4", "K1_small_services"): (_arm(49.15),),
    ("px4", "L2_events_not_armable"): (Step(0.03, "silent"), Step(15.05, "beats again")),
    ("ardupilot", "C1_items_at_zero_position"): (_long(0.55, "MISSION_START"),),
    ("ardupilot", "C2_do_items_before_takeoff"): (_long(0.5, "MISSION_START"),),
    ("ardupilot", "G10_gcs_failsafe_never_heard"): (
        Step(0.25, "silent"),
        Step(11.2, "beats again"),
    ),
    ("ardupilot", "G9_gcs_failsafe_in_auto_and_loiter"): (Step(34.7, "beats again"),),
    ("ardupilot", "H1_change_speed"): (
        _long(0.35, "DO_SET_MODE", 1.0, 4.0),
        _arm(0.7),
        _long(0.8, "NAV_TAKEOFF", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 6.0),
    ),
    ("ardupilot", "J2_logs"): (
        Step(5.1, "LOG_REQUEST_LIST"),
        Step(12.4, "LOG_REQUEST_LIST"),
        *(Step(12.6 + 0.3 * k, "LOG_REQUEST_DATA") for k in range(28)),  # the real log took 8 s
        Step(33.6, "LOG_REQUEST_LIST"),
    ),
    ("ardupilot", "K1_small_services"): (
        _long(28.5, "SET_MESSAGE_INTERVAL", 24.0, 100.0),
        _long(39.25, "SET_MESSAGE_INTERVAL", 9999.0, 1e6),
        _long(43.55, "SET_MESSAGE_INTERVAL", 4.0, 1e6),
        _long(50.2, "DO_SET_MODE", 1.0, 4.0),
        _arm(50.3),
    ),
}
"""By autopilot and scenario; they are sent with the others, and nothing of them is compared."""

SHAKEN: Final[dict[str, tuple[float, float]]] = {
    "D1_preflight_calibration_kinds": (0.0, 4.6),
    "D2_calibration_wrong_state": (0.0, 60.0),
    "D5_calibrations_alone": (2.0, 18.0),
}
"""From when to when PX4's simulated gyroscope was too noisy for a calibration: ours is shaken."""
