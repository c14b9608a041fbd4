"""What `gcs fence check` tells of a fence: sizes, heights, and where home lies in it.

The policy's fence is told beside that of a file, with what of it a vehicle can keep on board.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

from gcs.cli.mission.check import Checked
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.zones import Zone, build_zones
from gcs.gate.geometry import Circle
from gcs.gate.policy.zonespec import ZoneSpec, geographic_points
from gcs.gate.refusal import Refusal
from gcs.plan.kept_on_board import not_kept
from gcs.plan.model import AutopilotName, Geodetic
from gcs.plan.zones import zone_specs

HOME_EN = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ZoneFacts:
    """`frame` is what it counts from; heights are metres above home, None for none; `home_inside`
    None: where home is in it is not known; `to_edge_m` is how far home is from its edge."""

    name: str
    inclusion: bool
    frame: str
    size: str
    floor_up_m: float | None
    ceiling_up_m: float | None
    home_inside: bool | None
    to_edge_m: float | None

    @property
    def words(self) -> str:
        stay = "to stay inside" if self.inclusion else "to stay out of"
        return f"zone '{self.name}', {stay}: {self.size}, {self._heights}{self._home}"

    @property
    def _heights(self) -> str:
        low, high = self.floor_up_m, self.ceiling_up_m
        if low is None and high is None:
            return "at all heights"
        from_ = "from any height" if low is None else f"from {low:g} m"
        to = "up without end" if high is None else f"to {high:g} m"
        return f"{from_} {to} above home"

    @property
    def _home(self) -> str:
        if self.frame == "local":
            return "; counted from the vehicle's local origin"
        if self.home_inside is None or self.to_edge_m is None:
            return ""
        right = self.home_inside is self.inclusion
        where = "inside" if self.home_inside else "outside"
        told = where if right else where.upper()
        return f"; home is {told}, {self.to_edge_m:.1f} m from its edge"


def zones_of_file(checked: Checked) -> list[ZoneFacts]:
    return _facts(zone_specs(checked.plan.fence), checked.home, checked.autopilot)


def zones_of_policy(checked: Checked) -> list[ZoneFacts]:
    return _facts(checked.policy.fence, checked.home, checked.autopilot)


def lines(checked: Checked) -> Iterator[str]:
    """Zones of the file, then the policy's fence, and what a vehicle can keep of that."""
    yield from (f"  {zone.words}" for zone in zones_of_file(checked))
    zones = (*zones_of_file(checked), *zones_of_policy(checked))
    if checked.home is None and any(zone.frame == "geographic" for zone in zones):
        yield "note: where home is in the zones is not known: give --home LAT,LON,ALT"
    policy = checked.policy
    yield (
        f"policy {policy.name}: at most {policy.max_distance_m:g} m from home, {policy.min_up_m:g} "
        f"to {policy.max_up_m:g} m above it; margins {policy.margin_h_m:g} m beside, "
        f"{policy.margin_v_m:g} m above and below"
    )
    yield from (f"  {zone.words}" for zone in zones_of_policy(checked))
    missing = [*not_kept(policy, checked.autopilot)]
    kept = "all of that" if not missing else "all of that but: " + "; ".join(missing)
    yield f"  on board of a {checked.autopilot}, by gcs fence put: {kept}"


def facts_json(checked: Checked) -> dict[str, object]:
    return {
        "fence": [asdict(zone) for zone in zones_of_file(checked)],
        "policy_fence": [asdict(zone) for zone in zones_of_policy(checked)],
        "not_kept_on_board": [*not_kept(checked.policy, checked.autopilot)],
    }


def _facts(
    specs: Sequence[ZoneSpec], home: Geodetic | None, autopilot: AutopilotName
) -> list[ZoneFacts]:
    """Zones in degrees are measured about home, or about a point of their own."""
    found = []
    for spec in specs:
        at = home
        if at is None:
            at = next((Geodetic(*point, 0.0) for point in geographic_points(spec)), None)
        lat_deg, lon_deg = (0.0, 0.0) if at is None else (at.lat_deg, at.lon_deg)
        projection = Projection(Origin(lat_deg, lon_deg, 0.0), autopilot)
        placed = build_zones([spec], (0.0, 0.0, 0.0), projection)
        if isinstance(placed, Refusal):
            continue  # no simple polygon, which is a finding
        known = spec.frame == "home" or (spec.frame == "geographic" and home is not None)
        found.append(_fact(spec, placed[0], known=known))
    return found


def _fact(spec: ZoneSpec, placed: Zone, *, known: bool) -> ZoneFacts:
    inside_m = placed.shape.clearance(HOME_EN)
    return ZoneFacts(
        spec.name,
        spec.inclusion,
        spec.frame,
        _size(placed),
        spec.floor_up_m,
        spec.ceiling_up_m,
        inside_m >= 0.0 if known else None,
        abs(inside_m) if known else None,
    )


def _size(zone: Zone) -> str:
    if isinstance(zone.shape, Circle):
        return f"circle of {zone.shape.radius_m:g} m"
    easts, norths = zip(*zone.shape.corners_en, strict=True)
    corners = zone.shape.corners_en
    twice_m2 = sum(
        a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    )
    wide_m, high_m = max(easts) - min(easts), max(norths) - min(norths)
    return (
        f"polygon of {len(corners)} corners, {wide_m:.1f} m east by {high_m:.1f} m north, "
        f"{math.fabs(twice_m2) / 2:.0f} m2"
    )
