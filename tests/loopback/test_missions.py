"""Every shipped mission is uploaded and flown; what is no mission for here never leaves."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pymap3d
import pytest

from gcs import ipc
from gcs.gate.effects import Level
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from gcs.report import MissionItem
from tests.loopback.flight import HOMES, MISSIONS, PERSONALITIES, POLICIES, Flight, Personality
from tests.loopback.lossy_link import Weather
from tests.sample_files import SAMPLES, elsewhere

Enu = tuple[float, float, float]
WRONG_ELSEWHERE = (
    "qgroundcontrol_sample_with_survey_wrong_version.plan",
    "qgroundcontrol_sample_wrong_mission_version.plan",
    "qgroundcontrol_sample_wrong_overall_version.plan",
)
WAYPOINT = 16
MISS_M = 1.5

LAB3 = ("lab3/first_step.toml", "lab3/pictures.toml", "lab3/square.toml")
FLOWN: list[tuple[str, Personality, str]] = [
    *((name, personality, "lab") for name in LAB3 for personality in PERSONALITIES),
    *((name, personality, "default") for name in LAB3 for personality in PERSONALITIES),
    *(("demo.toml", personality, "default") for personality in PERSONALITIES),
    *(("square.toml", personality, "default") for personality in PERSONALITIES),
    ("survey.plan", "px4", "default"),
    ("fence.plan", "px4", "default"),
    ("triangle.waypoints", "ardupilot", "default"),
]


def waypoints_of(path: Path, personality: Personality) -> list[Enu]:
    """East, north and up of home of every waypoint, read without our readers."""
    if path.suffix == ".toml":
        wanted = tomllib.loads(path.read_text(encoding="utf-8"))["waypoint"]
        return [(w["east_m"], w["north_m"], w["up_m"]) for w in wanted]
    return [_enu(where, personality) for where in geodetic_waypoints(path.read_text("utf-8"))]


def geodetic_waypoints(text: str) -> list[tuple[float, float, float]]:
    """Latitude, longitude and height above home of every NAV_WAYPOINT of a .plan or .waypoints."""
    if text.startswith("QGC WPL"):
        rows = [line.split("\t") for line in text.splitlines()[2:] if not line.startswith("#")]
        rows = [row for row in rows if len(row) == 12 and row[0] != "0"]
        named = [(int(row[3]), [float(value) for value in row[8:11]]) for row in rows]
    else:
        named = [(item["command"], item["params"][4:7]) for item in _simple_items(json.loads(text))]
    return [(where[0], where[1], where[2]) for command, where in named if command == WAYPOINT]


def _simple_items(node: Any) -> Iterator[dict[str, Any]]:
    if isinstance(node, dict) and node.get("type") == "SimpleItem":
        yield node
    elif isinstance(node, dict):
        for value in node.values():
            yield from _simple_items(value)
    elif isinstance(node, list):
        for value in node:
            yield from _simple_items(value)


def _enu(where: tuple[float, float, float], personality: Personality) -> Enu:
    home = HOMES[personality]
    lat_deg, lon_deg, up_m = where
    east_m, north_m, _ = pymap3d.geodetic2enu(
        lat_deg, lon_deg, home.alt_amsl_m, home.lat_deg, home.lon_deg, home.alt_amsl_m
    )
    return (east_m, north_m, up_m)


def inside(enu: Enu, policy: str) -> bool:
    east_m, north_m, up_m = enu
    if policy == "lab":
        return max(abs(east_m), abs(north_m)) <= 5.0 and -0.1 <= up_m <= 2.0
    return math.hypot(east_m, north_m) <= 150.0 and -0.1 <= up_m <= 50.0


@pytest.mark.parametrize(("name", "personality", "policy"), FLOWN)
def test_a_shipped_mission_is_flown_past_each_waypoint_inside_the_fence(
    name: str, personality: Personality, policy: str
) -> None:
    flight = Flight(personality, policy=POLICIES[policy]).connected()
    flight.do("mission_upload", path=str(MISSIONS / name))
    flight.do("arm")
    ask = flight.say("mission_start")
    way: list[Enu] = []
    while flight.outcome(ask) is None:
        assert flight.elapsed_s < 300.0, flight.told()
        flight.run(0.1)
        way.append(flight.truth_enu())
    assert flight.outcome(ask) == "complete"
    assert flight.state in (State.GROUNDED, State.HOVERING)
    assert all(inside(enu, policy) for enu in way)
    wanted = waypoints_of(MISSIONS / name, personality)
    assert wanted
    missed = {enu: min(math.dist(enu, at) for at in way) for enu in wanted}
    assert max(missed.values()) < MISS_M, missed


@pytest.mark.parametrize(
    ("name", "personality"), [("survey.plan", "px4"), ("triangle.waypoints", "ardupilot")]
)
@pytest.mark.parametrize("seed", [3, 4, 10])
def test_a_mission_gets_through_a_lossy_link_whole(
    name: str, personality: Personality, seed: int
) -> None:
    rough = Weather(loss=0.2, duplicate=0.1, corrupt=0.05, delay_s=(0.001, 0.05))
    flight = Flight(personality, seed=seed, up=rough, down=rough).connected()
    flight.do("mission_upload", path=str(MISSIONS / name))
    clean = Flight(personality).connected()
    clean.do("mission_upload", path=str(MISSIONS / name))
    assert repr(flight.vehicle.plan) == repr(clean.vehicle.plan)  # a NaN equals no NaN
    assert len(flight.vehicle.plan) > 5


def test_a_mission_that_leaves_the_fence_is_refused_before_the_first_frame(tmp_path: Path) -> None:
    text = (MISSIONS / "square.toml").read_text(encoding="utf-8")
    far = tmp_path / "far.toml"
    far.write_text(text.replace("east_m = 10.0", "east_m = 300.0"), encoding="utf-8")
    flight = Flight().connected()
    ask = flight.say("mission_upload", path=str(far))
    flight.run(3.0)
    assert flight.outcome(ask) == "refused OUTSIDE_FENCE"
    [verdict] = flight.verdicts(ask)
    assert verdict.sentence.startswith("item ")
    assert verdict.numbers
    assert not {"MISSION_COUNT", "MISSION_ITEM_INT"} & set(flight.sent_types())


def over_home(path: Path, personality: Personality, *rows: tuple[int, float, float, float]) -> Path:
    """A .waypoints file of items over home: command, its first two numbers, and the height."""
    home = HOMES[personality]
    first = f"0\t1\t0\t16\t0\t0\t0\t0\t{home.lat_deg}\t{home.lon_deg}\t{home.alt_amsl_m}\t1"
    lines = ["QGC WPL 110", first]
    for number, (command, p1, p2, up_m) in enumerate(rows, start=1):
        at = f"{home.lat_deg}\t{home.lon_deg}\t{up_m}"
        lines.append(f"{number}\t0\t3\t{command}\t{p1}\t{p2}\t0\t0\t{at}\t1")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_a_speed_of_every_type_is_brought_on_board(
    personality: Personality, tmp_path: Path
) -> None:
    speeds = ((178, kind, 2.0, 0.0) for kind in (0.0, 1.0, 2.0, 3.0))
    rows = (22, 0.0, 0.0, 5.0), *speeds, (16, 0.0, 0.0, 8.0)
    path = over_home(tmp_path / "a.waypoints", personality, *rows)
    flight = Flight(personality).connected()
    ask = flight.say("mission_upload", path=str(path))
    assert flight.done(ask) == "complete"
    kinds = [item.p1 for item in flight.vehicle.plan if item.command == 178]
    assert kinds == [0.0, 1.0, 2.0, 3.0]


def test_what_a_px4_never_starts_is_refused_before_the_first_frame(tmp_path: Path) -> None:
    rows = (22, 0.0, 0.0, 5.0), (21, 0.0, 0.0, 0.0), (22, 0.0, 0.0, 5.0), (20, 0.0, 0.0, 0.0)
    flight = Flight("px4").connected()
    path = over_home(tmp_path / "a.waypoints", "px4", *rows)
    ask = flight.say("mission_upload", path=str(path))
    assert flight.done(ask) == "refused BAD_MISSION"
    [verdict] = flight.verdicts(ask)
    assert verdict.sentence.startswith("item 3 (NAV_TAKEOFF): this autopilot stores it")
    assert not {"MISSION_COUNT", "MISSION_ITEM_INT"} & set(flight.sent_types())


ROUND_A_TOWER = """
schema = 1
frame = "home"
[fence]
north_m = [-40, 40]
east_m = [-40, 40]
[[fence.exclude]]
name = "tower"
radius_m = 3
north_m = 10
east_m = 10
"""


@pytest.mark.parametrize("choice", ["refuse_exclusions", "warn"])
def test_a_blocked_failsafe_return_is_refused_or_warned_of_and_uploaded(
    choice: str, personality: Personality, tmp_path: Path
) -> None:
    """Every leg goes round the tower; the vehicle's own way home from the far corner does not."""
    path = tmp_path / "round.toml"
    corners = ((0, 20), (20, 20), (20, 0), (0, 0))
    places = [f"[[waypoint]]\nnorth_m = {n}\neast_m = {e}\nup_m = 5\n" for n, e in corners]
    path.write_text(ROUND_A_TOWER + "".join(places), encoding="utf-8")
    policy = parse_policy(f'mission.blocked_return = "{choice}"', "my.toml")
    flight = Flight(personality, policy=policy).connected()
    flight.until(lambda: flight.session.gate.memory.return_up_m is not None)
    ask = flight.say("mission_upload", path=str(path))
    if choice == "refuse_exclusions":
        assert flight.done(ask) == "refused RTL_BLOCKED"
        [verdict] = flight.verdicts(ask)
        assert verdict.zone == "tower"
        assert verdict.sentence.startswith("item 3: a failsafe return from here cannot be stopped")
        assert not {"MISSION_COUNT", "MISSION_ITEM_INT"} & set(flight.sent_types())
        return
    assert flight.done(ask) == "complete"
    [warning] = [line for line in flight.of(ipc.LogEvent) if "failsafe return" in line.text]
    assert (warning.node, warning.level) == ("mission", Level.WARNING)
    assert "after item 3: " in warning.text
    assert "exclusion circle 'tower'" in warning.text
    [verdict] = flight.verdicts(ask)
    assert (verdict.outcome, verdict.numbers["returns_blocked"]) == ("accepted", 1.0)
    assert verdict.numbers["return_blocked_after_item"] == 3.0


def test_a_mission_is_verified_anew_from_where_it_starts() -> None:
    """The lab's square brings a cage of its own; from outside of it there is no way in."""
    flight = Flight().hovering(1.5)
    flight.do("mission_upload", path=str(MISSIONS / "lab3" / "square.toml"))
    assert flight.done(flight.goto(10.0, 0.0, 1.5)) == "complete"
    ask = flight.say("mission_start")
    assert flight.done(ask).startswith("refused")
    [verdict] = flight.verdicts(ask)
    assert verdict.zone == "cage"
    assert flight.done(flight.goto(3.0, 0.0, 1.5)) == "complete"
    assert flight.done(flight.say("mission_start")) == "complete"


def test_a_mission_that_was_stopped_is_flown_from_where_it_was_verified(
    personality: Personality,
) -> None:
    """Its first item.  An autopilot of itself flies on to the item that it had left, on a leg from
    where it is now that nobody verified."""
    flight = Flight(personality).hovering(5.0)
    flight.do("mission_upload", path=str(MISSIONS / "square.toml"))
    first = next(item.seq for item in flight.vehicle.plan if item.command == WAYPOINT and item.seq)
    telemetry = flight.session.telemetry
    assert telemetry is not None
    flight.say("mission_start")
    flight.until(lambda: telemetry.mission_seq is not None and telemetry.mission_seq >= first + 2)
    flight.do("hold")
    flight.do("resume")
    assert flight.done(flight.goto(0.0, 5.0, 5.0)) == "complete"
    start = flight.say("mission_start")
    flight.until(lambda: flight.is_in(State.FLYING_MISSION))
    flight.run(1.5)
    assert telemetry.mission_seq is not None
    assert telemetry.mission_seq <= first
    assert flight.done(start, 120.0) == "complete"


def test_without_arming_or_without_a_mission_none_is_started() -> None:
    flight = Flight(policy=POLICIES["lab"]).connected()
    assert flight.done(flight.say("mission_start")) == "refused NOT_ARMED"
    flight.do("arm")
    assert flight.done(flight.say("mission_start")) == "refused NO_MISSION"
    too_large = str(MISSIONS / "square.toml")
    assert flight.done(flight.say("mission_upload", path=too_large)).startswith("refused")


def test_a_cleared_mission_is_not_drawn_and_not_started() -> None:
    flight = Flight().connected()
    flight.do("mission_upload", path=str(MISSIONS / "square.toml"))
    flight.run(0.2)
    flight.do("mission_clear")
    flight.run(0.2)
    shown = [item for _, item in flight.records if isinstance(item, MissionItem)]
    assert [bool(item.path_ned) for item in shown] == [True, False]
    assert flight.vehicle.plan == ()
    flight.do("arm")
    assert flight.done(flight.say("mission_start")) == "refused NO_MISSION"


def up_and_down(path: Path) -> None:
    """Uploads the file, downloads it, and compares the places."""
    flight = Flight().connected()
    flight.do("mission_upload", path=str(path))
    flight.do("mission_download", path="down.plan")
    up = geodetic_waypoints(path.read_text("utf-8"))
    down = geodetic_waypoints(flight.files["down.plan"].decode())
    assert len(up) == len(down) > 0
    for a, b in zip(up, down, strict=True):
        assert b == pytest.approx(a, abs=1e-6)


def test_a_box_goes_up_and_comes_down_equal_in_meaning() -> None:
    up_and_down(SAMPLES / "plans" / "box.plan")


def test_px4s_mission_box_goes_up_and_comes_down_equal_in_meaning() -> None:
    up_and_down(elsewhere("plans", "MC_mission_box.plan"))


def refused_in_place(paths: list[Path]) -> None:
    flight = Flight().connected()
    flight.run(4.0)  # until it was asked whether it has a mission, which a PX4 1.14 does not tell
    read = _about_plans(flight)
    for path in paths:
        ask = flight.say("mission_upload", path=str(path))
        flight.run(0.5)
        assert flight.outcome(ask) == "refused BAD_MISSION", path.name
        assert str(path) in flight.verdicts(ask)[0].sentence
    assert _about_plans(flight) == read, "but the rally points, when it was met"


def _about_plans(flight: Flight) -> list[str]:
    return [name for name in flight.sent_types() if name.startswith("MISSION")]


def test_a_wrong_plan_is_refused_with_its_place_in_the_file() -> None:
    wrong = sorted(SAMPLES.rglob("bad_*"))
    assert len(wrong) > 10
    refused_in_place(wrong)


def test_a_wrong_plan_of_qgroundcontrol_is_refused_with_its_place_in_the_file() -> None:
    refused_in_place([elsewhere("plans", name) for name in WRONG_ELSEWHERE])


def test_a_file_that_is_not_there_is_refused() -> None:
    flight = Flight().connected()
    assert flight.done(flight.say("mission_upload", path="no/such.plan")) == "refused BAD_MISSION"
    assert flight.done(flight.say("mission_upload")) == "refused BAD_MISSION"


def test_the_mission_mode_by_its_name_starts_the_mission_on_board(personality: Personality) -> None:
    flight = Flight(personality).hovering(2.0)
    flight.do("mission_upload", path=str(MISSIONS / "square.toml"))
    ask_id = flight.say("mode", mode="AUTO.MISSION" if personality == "px4" else "AUTO")
    flight.until(lambda: flight.is_in(State.FLYING_MISSION), 10.0)
    assert [verdict.outcome for verdict in flight.verdicts(ask_id)] == ["accepted"]
    assert flight.done(ask_id, 240.0) == "complete"


def test_the_mission_mode_by_its_name_is_refused_where_no_mission_is_on_board(
    personality: Personality,
) -> None:
    flight = Flight(personality).hovering(2.0)
    ask_id = flight.say("mode", mode="AUTO.MISSION" if personality == "px4" else "AUTO")
    assert flight.done(ask_id) == "refused NO_MISSION"
