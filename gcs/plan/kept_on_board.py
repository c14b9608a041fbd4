"""What of the policy's fence a vehicle can keep by itself, by its parameters and zones."""

from __future__ import annotations

from collections.abc import Iterator

from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import HOME_EN, CircleSpec, ZoneSpec


def is_cylinder(spec: ZoneSpec) -> bool:
    """About home, and to stay in: the vehicle's circle by parameter."""
    circle = isinstance(spec, CircleSpec) and spec.inclusion and spec.centre == HOME_EN
    return circle and spec.frame == "home"


def has_end(spec: ZoneSpec) -> bool:
    """To stay out of, and it ends somewhere above or below: where the gate lets the vehicle fly
    over it, a vehicle's zone, which has no heights, would stop it."""
    return not spec.inclusion and (spec.floor_up_m, spec.ceiling_up_m) != (None, None)


def as_zones(policy: Policy) -> tuple[ZoneSpec, ...]:
    """Those that are uploaded."""
    return tuple(spec for spec in policy.fence if not is_cylinder(spec) and not has_end(spec))


def not_kept(policy: Policy, autopilot: str) -> Iterator[str]:
    """A sentence each."""
    for spec in policy.fence:
        if has_end(spec):
            yield f"zone '{spec.name}', to stay out of up to a height: its zones have no heights"
        elif spec.inclusion and spec.floor_up_m is not None and spec.floor_up_m > 0.0:
            yield f"the floor of zone '{spec.name}' at {spec.floor_up_m:g} m"
    if policy.min_up_m > 0.0:
        yield f"min_up_m = {policy.min_up_m:g}"
    if autopilot == "px4" and sum(spec.inclusion for spec in as_zones(policy)) > 1:
        yield "that it stays in every zone: a PX4 before 1.15 is content with one of them"
    terminates = policy.severities[Condition.FENCE_BREACHED] is Severity.TERMINATE
    if terminates and autopilot == "ardupilot":
        yield "fence_breached = terminate: it lands"
