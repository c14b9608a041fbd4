"""The policies that hostile runs are flown with: the default, and what opens the rest of the table.

All figures of braking, approach, margins and times are the default's, but those of the lab.
"""

from __future__ import annotations

from typing import Final

from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import Policy

YARD = """
name = "yard"
[[fence]]
name = "yard"
kind = "polygon"
corners = [[-40, -30], [40, -30], [40, 30], [12, 30], [8, 12], [4, 30], [-40, 30]]
floor_up_m = 0.0
ceiling_up_m = 40
[[fence]]
name = "tower"
kind = "circle"
inclusion = false
centre = [-20, 12]
radius_m = 6
ceiling_up_m = 15
"""
"""With a notch and a tower; small, so that edges are near."""

PERMISSIVE = """
name = "permissive"
retarget = "replace"
rtl_blocked = "land"
allow_force_disarm = true
fence_switchable = true
arm_requires_recording = true
[arming]
preflight = "no_fail"
[severities]
battery_critical = "return"
vehicle_failsafe_active = "land"
origin_mismatch = "terminate"
battery_low = "hold"
[[fence]]
name = "home"
radius_m = 40
floor_up_m = 0.0
ceiling_up_m = 40
[[fence]]
name = "wall"
kind = "box"
inclusion = false
east_m = [10, 12]
north_m = [-20, 20]
"""
"""Every permission that opens a branch of the table is given."""

POLICIES: Final[tuple[Policy, ...]] = (
    DEFAULT,
    parse_policy(YARD, "yard.toml"),
    parse_policy(PERMISSIVE, "permissive.toml"),
)


def policy_of(seed: int) -> Policy:
    return POLICIES[seed % len(POLICIES)]
