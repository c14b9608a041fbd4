"""The places, fences and questions that the verifier's tests share, in the operator's frame."""

from __future__ import annotations

from pathlib import Path

import gcs.gate.policy.policy
from gcs.frames import Vec3, ned_from_enu
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal

HOME: Vec3 = (0.0, 0.0, 0.0)
STILL: Vec3 = (0.0, 0.0, 0.0)
LAB_TOML = Path(gcs.gate.policy.__file__).parent / "lab.toml"
LAB = parse_policy(LAB_TOML.read_text(encoding="utf-8"), "lab.toml")

OUTER = Zone("home", True, Circle((0.0, 0.0), 150.0), 0.0, 50.0)
TOWER = Zone(
    "tower", False, Polygon(((20.0, -5.0), (30.0, -5.0), (30.0, 5.0), (20.0, 5.0))), 0.0, 20.0
)


def at(east_m: float, north_m: float, up_m: float) -> Vec3:
    return ned_from_enu((east_m, north_m, up_m))


def flying(policy: Policy = DEFAULT, *, fence_on: bool = True) -> Verifier:
    return verifier_for(policy, "px4", HOME, None, fence_on=fence_on)


def around(*zones: Zone, policy: Policy = DEFAULT) -> Verifier:
    return Verifier(policy, zones, "px4", HOME, origin_known=False)


def go(verifier: Verifier, goal_ned: Vec3, start_ned: Vec3, v_ned: Vec3 = STILL) -> Code | None:
    answer = verifier.goal(goal_ned, None, start_ned, v_ned)
    return answer.code if isinstance(answer, Refusal) else None
