"""Missions and zones drawn at random, so that many legs and corners pass a zone closely."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from dataclasses import dataclass

import shapely
from msgspec import structs

from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import CircleSpec, PolygonSpec, ZoneSpec
from tests.loopback.flight import HOMES, Personality

Item = dict[str, object]


@dataclass(frozen=True, slots=True)
class Mission:
    """A plan file, the policy that it is flown under, and the vehicle's radius parameter."""

    document: dict[str, object]
    zones: tuple[ZoneSpec, ...]
    params: dict[str, float]
    wind_ned: tuple[float, float]
    kinds: frozenset[int]

    @property
    def policy(self) -> Policy:
        return structs.replace(DEFAULT, fence=self.zones)


def mission_of(seed: int, personality: Personality) -> Mission:
    """A mission within 90 m round home, and zones that its straight legs pass closely."""
    dice = random.Random(seed)
    home = HOMES[personality]
    projection = Projection(Origin(home.lat_deg, home.lon_deg, home.alt_amsl_m), personality)
    way: list[tuple[float, float]] = [(0.0, 0.0)]
    field = _field(dice)

    def place() -> tuple[float, float]:
        """East and north, inside the field."""
        while True:
            at = (dice.uniform(-75, 75), dice.uniform(-75, 75))
            if room_m(field, shape_of(field), (*at, 0.0)) > 3.0:
                return at

    def degrees(at: tuple[float, float]) -> tuple[float, float]:
        return projection.lat_lon(at[1], at[0])

    items: list[Item] = []

    def add(command: int, params: tuple[float | None, ...], frame: int = 3) -> None:
        entry = {"type": "SimpleItem", "autoContinue": True, "command": command, "frame": frame}
        items.append({**entry, "doJumpId": len(items) + 1, "params": list(params)})

    up_m = dice.uniform(6.0, 20.0)
    add(22, (0.0, 0.0, 0.0, None, home.lat_deg, home.lon_deg, up_m))
    copter = personality == "ardupilot"
    for _ in range(dice.randint(3, 8)):
        at = place()
        up_m = max(4.0, min(30.0, up_m + dice.choice([0.0, 0.0, dice.uniform(-6.0, 6.0)])))
        where = (*degrees(at), up_m)
        kind = dice.random()
        if not 0.45 <= kind < 0.52:
            way.append(at)
        if copter and kind < 0.25:
            add(82, (dice.choice([0.0, 0.0, 1.0]), 0.0, 0.0, 0.0, *where))
        elif copter and kind < 0.35:
            radius_m = dice.choice([-1.0, 1.0]) * dice.randint(4, 20)
            add(18, (dice.choice([1.0, 1.5, 2.0]), 0.0, radius_m, 0.0, *where))
        elif kind < 0.45:
            add(19, (dice.uniform(0.0, 3.0), 0.0, 0.0, 0.0 if copter else None, *where))
        elif kind < 0.52:
            add(178, (1.0, dice.uniform(2.0, 10.0), -1.0, 0.0, 0.0, 0.0, 0.0), 2)
        else:
            own_m = 0.0 if copter else dice.choice([0.0, 0.0, dice.uniform(0.5, 25.0)])
            hold_s = dice.choice([0.0, 0.0, 0.0, 1.0, 3.0])
            add(16, (hold_s, own_m, 0.0, 0.0 if copter else None, *where))
    places = [n for n, item in enumerate(items) if item["command"] != 178]
    if len(places) > 3 and dice.random() < 0.4:
        number = dice.randrange(1, len(places) - 1)
        back = places[number] + 1
        way += [way[number], way[-1]]
        add(177, (float(back), float(dice.randint(1, 2)), 0.0, 0.0, 0.0, 0.0, 0.0), 2)
    ending = dice.random()
    if ending < 0.5:
        way.append((0.0, 0.0))
        add(20, (0.0,) * 7, 2)
    elif ending < 0.8:
        way.append(place())
        add(21, (0.0, 0.0, 0.0, 0.0 if copter else None, *degrees(way[-1]), 0.0))
    rally = [
        [*degrees(place()), dice.choice([0.0, 5.0]) if not copter else dice.uniform(10, 30)]
        for _ in range(dice.choice([0, 0, 1, 2]))
    ]
    document: dict[str, object] = {
        "fileType": "Plan",
        "geoFence": {"circles": [], "polygons": [], "version": 2},
        "groundStation": "a test",
        "mission": {
            "cruiseSpeed": 15,
            "firmwareType": 3 if copter else 12,
            "globalPlanAltitudeMode": 1,
            "hoverSpeed": 5,
            "items": items,
            "plannedHomePosition": [home.lat_deg, home.lon_deg, home.alt_amsl_m],
            "vehicleType": 2,
            "version": 2,
        },
        "rallyPoints": {"points": rally, "version": 2},
        "version": 1,
    }
    radius_m = dice.choice([2.0, dice.uniform(0.5, 10.0)])
    params = {"WPNAV_RADIUS": 100.0 * radius_m} if copter else {"NAV_ACC_RAD": radius_m}
    wind_m_s, heading = dice.uniform(0.0, 8.0), dice.uniform(0.0, 2.0 * math.pi)
    wind = (wind_m_s * math.cos(heading), wind_m_s * math.sin(heading))
    kinds = frozenset(int(str(item["command"])) for item in items) | ({5100} if rally else set())
    zones = (field, *_masts(dice, way))
    return Mission(document, zones, params, wind, frozenset(kinds))


def _field(dice: random.Random) -> ZoneSpec:
    if dice.random() < 0.5:
        return CircleSpec(90.0, (0.0, 0.0), name="field", inclusion=True)
    notch = dice.uniform(-40.0, 40.0)  # a field with a notch
    m = 90.0  # floats, as they are read back from a record
    corners = ((-m, -m), (m, -m), (m, m), (notch + 20.0, m), (notch, 35.0), (notch - 20.0, m))
    return PolygonSpec((*corners, (-m, m)), name="field", inclusion=True)


def _masts(dice: random.Random, way: list[tuple[float, float]]) -> Iterator[ZoneSpec]:
    """Exclusion zones beside the legs, mostly near their ends, where corners are cut."""
    line = shapely.LineString(way)
    for number in range(dice.randint(2, 6)):
        corner = dice.randrange(1, len(way))
        here, before = way[corner], way[corner - 1]
        back = dice.uniform(0.0, 0.5)
        at = [h + back * (b - h) for h, b in zip(here, before, strict=True)]
        angle, size_m = dice.uniform(0, 2 * math.pi), dice.uniform(2.0, 12.0)
        away_m = size_m + 2.1 + dice.choice([dice.uniform(0.0, 2.0), dice.uniform(0.0, 12.0)])
        centre = (at[0] + away_m * math.cos(angle), at[1] + away_m * math.sin(angle))
        ceiling = dice.choice([None, None, None, dice.uniform(8.0, 40.0)])
        name = f"mast {number}"
        zone: ZoneSpec
        if dice.random() < 0.6:
            zone = CircleSpec(size_m, centre, name=name, inclusion=False, ceiling_up_m=ceiling)
        else:
            corners = tuple(
                (
                    centre[0] + size_m * math.cos(angle + 0.5 * math.pi * n),
                    centre[1] + size_m * math.sin(angle + 0.5 * math.pi * n),
                )
                for n in range(4)
            )
            zone = PolygonSpec(corners, name=name, inclusion=False, ceiling_up_m=ceiling)
        if (
            shape_of(zone).distance(line) > 2.05
            and shape_of(zone).distance(shapely.Point(0, 0)) > 4.0
        ):
            yield zone


def shape_of(zone: ZoneSpec) -> shapely.Polygon:
    if isinstance(zone, CircleSpec):
        return shapely.Point(zone.centre).buffer(zone.radius_m, quad_segs=64)
    assert isinstance(zone, PolygonSpec)
    return shapely.Polygon(zone.corners)


def room_m(zone: ZoneSpec, shape: shapely.Polygon, enu: tuple[float, float, float]) -> float:
    """Metres to where the zone forbids to be, negative there."""
    at = shapely.Point(enu[0], enu[1])
    beside_m: float = shape.exterior.distance(at) * (-1.0 if shape.contains(at) else 1.0)
    if zone.inclusion:
        return -beside_m
    above_m = -math.inf if zone.ceiling_up_m is None else enu[2] - zone.ceiling_up_m
    return max(beside_m, above_m)
