"""Random missions that the gate clears are flown in wind, and the truth is compared with the zones.

`python -m tests.loopback.random_missions px4 0 250` flies those of the seeds 0 to 249 and prints
how many were refused, and how near the nearest came; with `--alone` the vehicle flies what it was
given without the station, which takes a fifth of the time; with `--through-bridge` a client of
pymavlink uploads and starts it through the bridge.  The fence is the policy's, so that the
vehicle has none of its own that could hold it back; shapely says where the truth is.
"""

from __future__ import annotations

import json
import math
import random
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import shapely
from msgspec import structs

from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import CircleSpec, PolygonSpec, ZoneSpec
from tests.loopback.bridged import Client
from tests.loopback.flight import HOMES, Flight, Personality
from tests.loopback.plan_clients import (
    ACCEPTED,
    PlanFlight,
    Pymavlink,
    items_of,
    rally_points,
)
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.simulation.fault_script import fault_of

LONGEST_S = 420.0
SAMPLE_S = 0.1
Item = dict[str, object]


@dataclass(frozen=True, slots=True)
class Flown:
    """`refusal` None: it was flown; `nearest_m` is the least distance to a forbidden place."""

    seed: int
    refusal: str | None
    nearest_m: float = math.inf
    ended: str = ""
    kinds: frozenset[int] = frozenset()


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
            if _room_m(field, _shape(field), (*at, 0.0)) > 3.0:
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
    corners = ((-90, -90), (90, -90), (90, 90), (notch + 20, 90), (notch, 35), (notch - 20, 90))
    return PolygonSpec((*corners, (-90, 90)), name="field", inclusion=True)


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
        if _shape(zone).distance(line) > 2.05 and _shape(zone).distance(shapely.Point(0, 0)) > 4.0:
            yield zone


def _shape(zone: ZoneSpec) -> shapely.Polygon:
    if isinstance(zone, CircleSpec):
        return shapely.Point(zone.centre).buffer(zone.radius_m, quad_segs=64)
    assert isinstance(zone, PolygonSpec)
    return shapely.Polygon(zone.corners)


def _room_m(zone: ZoneSpec, shape: shapely.Polygon, enu: tuple[float, float, float]) -> float:
    """Metres to where the zone forbids to be, negative there."""
    at = shapely.Point(enu[0], enu[1])
    beside_m: float = shape.exterior.distance(at) * (-1.0 if shape.contains(at) else 1.0)
    if zone.inclusion:
        return -beside_m
    above_m = -math.inf if zone.ceiling_up_m is None else enu[2] - zone.ceiling_up_m
    return max(beside_m, above_m)


def fly(
    seed: int, personality: Personality, *, alone: bool = False, through_bridge: bool = False
) -> Flown:
    """Verified by an upload; where it clears, flown to its end, `alone` without the station."""
    mission = mission_of(seed, personality)
    if through_bridge:
        return _fly_through_bridge(seed, personality, mission)
    flight = Flight(personality, seed=seed, policy=mission.policy, params=mission.params)
    flight.connected()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "random.plan"
        path.write_text(json.dumps(mission.document), encoding="utf-8")
        ask = flight.say("mission_upload", path=str(path))
        ended = flight.done(ask)
    if ended != "complete":
        [verdict] = flight.verdicts(ask)
        return Flown(seed, verdict.sentence, kinds=mission.kinds)
    moments = _alone(flight) if alone else _with_station(flight)
    return _flown(seed, mission, flight, moments)


def _flown(seed: int, mission: Mission, flight: Flight, moments: Iterator[str]) -> Flown:
    """In wind, to its end; how near the truth came to a forbidden place."""
    wind = {"wind_ned_m_s": [*mission.wind_ned, 0.0], "gust_m_s": 1.0}
    assert flight.world.inject(fault_of("wind", wind, "script"), 1)
    shapes = [(zone, _shape(zone)) for zone in mission.zones]
    nearest_m, ended = math.inf, ""
    for told in moments:
        ended = told
        truth = flight.truth_enu()
        nearest_m = min(nearest_m, *(_room_m(zone, shape, truth) for zone, shape in shapes))
    return Flown(seed, None, nearest_m, ended, mission.kinds)


def _fly_through_bridge(seed: int, personality: Personality, mission: Mission) -> Flown:
    """The same, uploaded, armed and started by a MAVLink client."""
    rules = structs.replace(DEFAULT.bridge, rally="forward")
    policy = structs.replace(mission.policy, bridge=rules)
    flight = PlanFlight(personality, seed=seed, policy=policy)
    for name, value in mission.params.items():
        flight.vehicle.parameters.set(name, value)
    client = flight.join()
    flight.connected()
    for items in (rally_points(mission.document), items_of(mission.document, personality)):
        if items:
            upload = Pymavlink(flight, client, items)
            if upload.ended(60.0) != "complete":
                refused = flight.decisions("refused")
                why = refused[-1].sentence if refused else upload.result
                return Flown(seed, why, kinds=mission.kinds)
    return _flown(seed, mission, flight, _with_client(flight, client))


def _with_client(flight: PlanFlight, client: Client) -> Iterator[str]:
    """Armed and started by commands of the client."""
    assert client.ask(400, 1, within_s=20.0) == ACCEPTED
    client.command(300)
    began_s = flight.elapsed_s
    while flight.elapsed_s - began_s < LONGEST_S:
        if round((flight.elapsed_s - began_s) / SAMPLE_S) % 10 == 0:
            client.beat()
        flight.run(SAMPLE_S)
        told = [one for one in flight.decisions() if one.word in ("mission_start", "mode")]
        ended = told[-1].outcome if told else ""
        over = ended not in ("", "requested", "accepted")
        yield ended if over else "still flying"
        if over:
            return


def _with_station(flight: Flight) -> Iterator[str]:
    """Armed and started through the gate; yields ten times a second how it goes."""
    flight.do("arm")
    ask = flight.say("mission_start")
    began_s = flight.elapsed_s
    while flight.outcome(ask) is None and flight.elapsed_s - began_s < LONGEST_S:
        flight.run(SAMPLE_S)
        yield flight.outcome(ask) or "still flying"


def _alone(flight: Flight) -> Iterator[str]:
    """The same by the vehicle itself, until it is disarmed or has stood still for 20 s."""
    vehicle = flight.vehicle
    if flight.personality == "ardupilot":
        assert vehicle.set_mode_kind("guided") is Result.ACCEPTED
    assert vehicle.arm(False) is Result.ACCEPTED
    assert vehicle.mission_start(0, 0) is Result.ACCEPTED
    still_s, was = 0.0, flight.truth_enu()
    for _ in range(round(LONGEST_S / SAMPLE_S)):
        for _ in range(round(250 * SAMPLE_S)):
            vehicle.step()
        here = flight.truth_enu()
        still_s = still_s + SAMPLE_S if math.dist(here, was) < 0.05 else 0.0
        was = here
        yield "still flying" if vehicle.armed else "complete"
        if not vehicle.armed or still_s > 20.0:
            return


def main() -> None:
    personality, first, last = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    flown: list[Flown] = []
    for seed in range(first, last):
        who: Personality = "ardupilot" if personality == "ardupilot" else "px4"
        bridged = "--through-bridge" in sys.argv
        found = fly(seed, who, alone="--alone" in sys.argv, through_bridge=bridged)
        flown.append(found)
        told = found.refusal or f"{found.ended}, nearest {found.nearest_m:.2f} m"
        print(f"{personality} {seed}: {told}", flush=True)
    away = [one for one in flown if one.refusal is None]
    near = [one.nearest_m for one in away]
    inside = sum(nearest_m < 0.0 for nearest_m in near)
    print(
        f"{personality}: {len(flown)} missions, {len(flown) - len(away)} refused, "
        f"{len(away)} flown; nearest {min(near, default=math.inf):.2f} m, inside {inside}"
    )


if __name__ == "__main__":
    main()
