"""The worlds that the explorer walks: each autopilot, under choices of the policy of its own."""

from __future__ import annotations

from msgspec.structs import replace

from tests.proof.world import YARD, world

PX4 = world(YARD, "px4", return_up_m=10.0, climb_ends_within_m=0.8)
ARDUPILOT = world(
    replace(
        YARD,
        retarget="replace",
        rtl_blocked="land",
        fence_switchable=False,
        allow_force_disarm=False,
    ),
    "ardupilot",
    return_up_m=90.0,
)
"""The other autopilot, under the other choices of the policy."""

WORLDS = {"px4": PX4, "ardupilot": ARDUPILOT}
