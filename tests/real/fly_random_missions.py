"""Random missions that the verifier clears are flown on a real autopilot; truth against the zones.

`python -m tests.real.fly_random_missions ardupilot 0 30 --autopilot START --wind 5`: of the seeds
from 0 on the first 30 that clear, each from a fresh start; START as for `record_missions`.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from dataclasses import replace

from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.verifier import verifier_for
from gcs.plan.formats.reader import read
from gcs.plan.legs import Ground
from gcs.plan.model import AutopilotName
from gcs.plan.settings import USUAL
from gcs.plan.verify import verify
from tests.loopback.drawn_missions import Mission, mission_of, room_m, shape_of
from tests.loopback.flight import HOMES
from tests.real.mission_catalogue import Flight, Item
from tests.real.record_missions import FailedError, Track, Vehicle, fly, ready

RETURN_UP_M = 30.0
RETURN_UP: dict[AutopilotName, str] = {"px4": "RTL_RETURN_ALT", "ardupilot": "RTL_ALT_M"}
JUMP, NO_PLACE = 177, 2


def drawn(seed: int, who: AutopilotName) -> Mission:
    """Without rally points."""
    mission = mission_of(seed, who)
    mission.document["rallyPoints"] = {"points": [], "version": 2}
    return mission


def refusal_of(mission: Mission, who: AutopilotName) -> str | None:
    home = HOMES[who]
    origin = Origin(home.lat_deg, home.lon_deg, home.alt_amsl_m)
    settings = replace(USUAL[who], accept_m=_radius_m(mission, who))
    here = (0.0, 0.0, 0.0)
    north_east = Projection(origin, who).north_east
    ground = Ground(
        who, here, here, north_east, home.alt_amsl_m, RETURN_UP_M, settings, on_ground=True
    )
    plan = read("random.plan", json.dumps(mission.document).encode(), who)
    verifier = verifier_for(mission.policy, who, here, origin, mission.zones)
    refusal = verify(plan, ground, verifier).refusal
    return None if refusal is None else refusal.sentence


def _radius_m(mission: Mission, who: AutopilotName) -> float:
    if who == "px4":
        return mission.params["NAV_ACC_RAD"]
    return mission.params["WPNAV_RADIUS"] / 100.0


def flight_of(seed: int, mission: Mission, who: AutopilotName, wind_m_s: float) -> Flight:
    home = HOMES[who]
    projection = Projection(Origin(home.lat_deg, home.lon_deg, home.alt_amsl_m), who)
    items: list[Item] = []
    content = mission.document["mission"]
    assert isinstance(content, dict)
    for entry in content["items"]:
        p1, p2, p3, p4, lat, lon, up = (0.0 if p is None else p for p in entry["params"])
        if entry["frame"] == NO_PLACE:
            p1 -= 1.0 if entry["command"] == JUMP and who == "px4" else 0.0
            items.append(Item(entry["command"], params=(p1, p2, p3, p4)))
            continue
        north, east = projection.north_east(lat, lon)
        items.append(Item(entry["command"], north, east, up, (p1, p2, p3, p4)))
    radius = "NAV_ACC_RAD" if who == "px4" else "WP_RADIUS_M"
    params = {radius: _radius_m(mission, who), RETURN_UP[who]: RETURN_UP_M}
    return Flight(f"random {seed}", tuple(items), params, wind_m_s)


def nearest_m(mission: Mission, track: Track) -> float:
    """To a forbidden place, by the truth; below zero: outside."""
    shapes = [(zone, shape_of(zone)) for zone in mission.zones]
    return min(
        room_m(zone, shape, (east, north, -down))
        for _, north, east, down, *_ in track
        for zone, shape in shapes
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("kind", choices=("px4", "ardupilot"))
    parser.add_argument("first", type=int)
    parser.add_argument("many", type=int)
    parser.add_argument("--autopilot", required=True, help="the program that starts it")
    parser.add_argument("--instance", type=int, default=0)
    parser.add_argument("--wind", type=float, default=0.0, help="m/s; ArduCopter's alone")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if not asked.inside:
        words = ("-m", "tests.real.fly_random_missions", *sys.argv[1:], "--inside")
        inside = ('ip link set lo up; exec "$@"', "sh", sys.executable, *words)
        os.execvp("unshare", ("unshare", "-n", "sh", "-c", *inside))
    flown: list[float] = []
    seed = asked.first
    while len(flown) < asked.many:
        mission = drawn(seed, asked.kind)
        refusal = refusal_of(mission, asked.kind)
        if refusal is not None:
            print(f"{seed}: refused: {refusal}", flush=True)
            seed += 1
            continue
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            vehicle = Vehicle(asked.kind, asked.autopilot, folder, asked.instance)
            try:
                ready(vehicle)
                track = fly(vehicle, flight_of(seed, mission, asked.kind, asked.wind))
                flown.append(nearest_m(mission, track))
                print(f"{seed}: flown, {track[-1][0] - track[0][0]:.0f} s, {flown[-1]:.2f} m")
            except FailedError as error:
                print(f"{seed}: not flown: {error}")
            finally:
                vehicle.close()
        sys.stdout.flush()
        seed += 1
    outside = sum(one < 0.0 for one in flown)
    print(f"{len(flown)} flown, nearest {min(flown):.2f} m, outside {outside}")


if __name__ == "__main__":
    main()
