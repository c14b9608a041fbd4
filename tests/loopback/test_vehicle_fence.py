"""The vehicle's own fence: there and back, put from the policy, kept in the air, and audited."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from gcs import ipc
from gcs.gate.condition import Condition
from gcs.gate.policy.parse import parse_policy
from gcs.plan.formats.reader import read
from gcs.record.writer import Recorder
from tests.audits import audited
from tests.audits import read as read_record
from tests.loopback.flight import HOMES, Flight, Personality
from tests.loopback.observed import START_NS
from tests.loopback.plan_clients import NORTH_DEG
from tests.unit.plan.samples import plan_document, waypoint

YARD = parse_policy(
    """
[[fence]]
name = "field"
kind = "circle"
radius_m = 100.0
ceiling_up_m = 40.0
[[fence]]
name = "yard"
kind = "box"
east_m = [-60.0, 60.0]
north_m = [-60.0, 60.0]
[[fence]]
name = "mast"
kind = "circle"
inclusion = false
radius_m = 5.0
centre = [20.0, 20.0]
""",
    "yard.toml",
)


def guarded(personality: Personality, folder: Path) -> Path:
    """A flight 10 m north and back; a square of 100 m to stay in, a mast, two rally points."""
    home = HOMES[personality]
    lat, lon = home.lat_deg, home.lon_deg
    east_deg = NORTH_DEG / math.cos(math.radians(lat))

    def at(north_m: float, east_m: float) -> list[float]:
        return [round(lat + north_m * NORTH_DEG, 7), round(lon + east_m * east_deg, 7)]

    document = plan_document(
        waypoint(1, lat, lon, 5, 22),
        waypoint(2, lat + 10 * NORTH_DEG, lon, 5),
        waypoint(3, lat, lon, 0, 21),
    )
    square = [at(n, e) for n, e in ((50, 50), (50, -50), (-50, -50), (-50, 50))]
    document["geoFence"]["polygons"] = [{"inclusion": True, "polygon": square, "version": 1}]
    mast = {"center": at(0, 25), "radius": 5.0}
    document["geoFence"]["circles"] = [{"inclusion": False, "circle": mast, "version": 1}]
    document["rallyPoints"]["points"] = [[*at(20, 0), 5.0], [*at(-20, 0), 8.0]]
    document["mission"]["firmwareType"] = 12 if personality == "px4" else 3
    path = folder / "guarded.plan"
    path.write_text(json.dumps(document))
    return path


def told(flight: Flight, ask_id: int) -> str:
    """The sentence of its ending."""
    (ending,) = flight.endings(ask_id)
    return ending.sentence


@pytest.mark.parametrize("suffix", [".plan", ".waypoints"])
def test_mission_fence_and_rally_points_come_back_equal_in_meaning(
    personality: Personality, suffix: str, tmp_path: Path
) -> None:
    flight = Flight(personality).connected()
    path = guarded(personality, tmp_path)
    flight.do("mission_upload", path=str(path))
    back = f"back{suffix}"
    ask = flight.say("mission_download", path=back)
    assert flight.done(ask) == "complete"
    sent, came = (
        read(name, data, personality)
        for name, data in ((str(path), path.read_bytes()), (back, flight.files[back]))
    )
    assert len(came.items) == len(sent.items)
    shapes = [{(zone.inclusion, repr(zone.shape)) for zone in p.fence.zones} for p in (sent, came)]
    assert shapes[0] == shapes[1]
    assert [
        (round(p.lat_deg, 7), round(p.lon_deg, 7), round(p.alt_above_home_m, 2)) for p in came.rally
    ] == [(p.lat_deg, p.lon_deg, p.alt_above_home_m) for p in sent.rally]
    assert ("home is not kept" in told(flight, ask)) is (
        personality == "px4" and suffix == ".waypoints"
    )
    if suffix == ".plan":
        assert came.home is not None
        assert came.home.lat_deg == pytest.approx(HOMES[personality].lat_deg, abs=1e-6)


def test_a_cleared_mission_names_what_stays_until_that_is_cleared(
    personality: Personality, tmp_path: Path
) -> None:
    flight = Flight(personality).connected()
    flight.do("mission_upload", path=str(guarded(personality, tmp_path)))
    flight.run(2.0)
    ask = flight.say("mission_clear")
    assert flight.done(ask) == "complete"
    for name in ("fence", "rally"):
        assert f"`gcs {name} clear`" in told(flight, ask)
        flight.do(f"{name}_clear")
        flight.run(1.0)
    again = flight.say("mission_clear")
    assert flight.done(again) == "complete"
    assert told(flight, again) == "no mission is on board"
    nothing = flight.say("mission_download", path="none.plan")
    assert flight.done(nothing) == "aborted NO_MISSION"
    for name in ("fence", "rally"):
        nothing = flight.say(f"{name}_download", path="none.plan")
        assert flight.done(nothing) == "aborted NOT_ON_BOARD"


def test_what_is_put_counts_for_the_vehicle_and_stays_in_the_air(personality: Personality) -> None:
    """The condition about its failsafes has no word about its fence any more."""
    flight = Flight(personality, policy=YARD).connected()

    def weak() -> str:
        """What its failsafes are, as they were logged last."""
        return [e.text for e in flight.of(ipc.LogEvent) if "geofence: " in e.text][-1]

    flight.until(lambda: any("geofence: " in e.text for e in flight.of(ipc.LogEvent)))
    assert "policy's is" in weak() or "off (FENCE_ENABLE" in weak()
    ask = flight.say("fence_put")
    assert flight.done(ask) == "complete"
    assert "a fence of 2 zones" in told(flight, ask)
    flight.run(3.0)
    assert "policy's is" not in weak()
    assert "off (FENCE_ENABLE" not in weak()
    flight.hovering(5.0)
    for word in ("fence_clear", "fence_put"):
        assert flight.done(flight.say(word)) == "refused IN_AIR"
    assert Condition.VEHICLE_FENCE_BREACHED not in flight.conditions
    flight.done(flight.goto(55.0, 0.0, 5.0))
    assert Condition.VEHICLE_FENCE_BREACHED not in flight.conditions


def test_a_fence_put_and_cleared_is_in_the_record_and_audited(tmp_path: Path) -> None:
    recorder = Recorder.open(tmp_path, "fence", "20260101-000000", START_NS, sealed=True)
    flight = Flight("px4", policy=YARD)
    flight.recorder = recorder
    flight.connected()
    flight.do("fence_put")
    flight.do("fence_upload", path=str(guarded("px4", tmp_path)))
    flight.do("fence_download", path="f.plan")
    flight.do("fence_clear")
    flight.do("rally_upload", path=str(guarded("px4", tmp_path)))
    flight.do("arm")
    assert flight.done(flight.say("fence_put")) in ("complete", "refused IN_AIR")
    assert recorder.close(flight.now_ns)
    messages, attachments = read_record(recorder.path)
    result = audited(messages, attachments)
    assert (result.first, result.good) == ([], True)
