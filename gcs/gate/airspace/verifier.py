"""The verifier: may the vehicle fly to a goal, stay, take off, return, and can it still stop?

A `Verifier` is immutable: a new home, origin, fence or autopilot makes a new one.  Every question
is answered from its arguments alone; the state machine makes sure before it asks that the position
is fresh.  Numbers that are not finite, not known or too large to compute with are refused, whether
the fence is on or off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.gate.airspace import pace
from gcs.gate.airspace.bounds import Bounds
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.questions import (
    back_inside,
    braking,
    goals,
    missions,
    positions,
    returns,
    streams,
)
from gcs.gate.airspace.zones import build_zones
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import ZoneSpec
from gcs.gate.refusal import Refusal


@dataclass(frozen=True)
class Verifier(Bounds):
    """Answers for one fence, home and autopilot.  Positions and velocities are local NED, in metres
    and metres per second.

    Each question is a function of the bounds, in a file of `questions/` by its subject; here it is
    a method.
    """

    goal = goals.goal
    takeoff = goals.takeoff

    hold_point = positions.hold_point
    start = positions.start
    outside = positions.outside

    way_back = back_inside.way_back
    leaves_way_back = back_inside.leaves_way_back

    stream_sample = streams.stream_sample

    predicted_stop = braking.predicted_stop
    hold_ahead = braking.hold_ahead
    paced = pace.paced
    speed_there = pace.speed_there

    return_paths = returns.return_paths
    return_path = returns.return_path
    return_refusal = returns.return_refusal

    mission_leg = missions.mission_leg
    mission_region = missions.mission_region
    mission_circle = missions.mission_circle
    mission_take_off = missions.mission_take_off


def verifier_for(
    policy: Policy,
    autopilot: str,
    home_ned: Vec3 | None,
    origin: Origin | None,
    plan_zones: Sequence[ZoneSpec] = (),
    *,
    fence_on: bool = True,
) -> Verifier:
    """A verifier for the policy's fence and the fence of a plan file, from what is known now.

    `plan_zones` are the zones of a mission's own fence.  Where one zone cannot be placed in the
    local frame yet, none is, and everything that moves is refused for that reason.
    """
    projection = None if origin is None else Projection(origin, autopilot)
    built = build_zones((*policy.fence, *plan_zones), home_ned, projection)
    zones, unplaced = ((), built) if isinstance(built, Refusal) else (built, None)
    known = origin is not None
    return Verifier(policy, zones, autopilot, home_ned, known, fence_on, unplaced)


def check_start(verifier: Verifier, pos_ned: Vec3) -> Refusal | None:
    """Is the vehicle inside the fence where it starts?  Neither floor nor margin applies."""
    return verifier.start(pos_ned)
