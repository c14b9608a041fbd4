"""Every script in missions/scripts runs as it stands, from a folder that is not its own."""

from __future__ import annotations

import math
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from tests.system.flight_log import decoded, only_log, times_ns, whole
from tests.system.station import simulated
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = pytest.mark.system

SETPOINT = "SET_POSITION_TARGET_LOCAL_NED"
SCRIPTS = Path(__file__).parents[2] / "missions" / "scripts"
TESTED = {
    "square.py",
    "fly_plan.py",
    "photo_survey.py",
    "stop.py",
    "velocity.py",
    "watch_async.py",
    "watch_battery.py",
}


def run(name: str, *arguments: str, folder: Path) -> list[str]:
    """The lines that it prints; its log is in `folder`."""
    ended = subprocess.run(
        [sys.executable, str(SCRIPTS / name), *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=180,
        check=False,
    )
    assert (ended.returncode, ended.stderr) == (0, "")
    return ended.stdout.splitlines()


def test_each_script_has_its_test_and_its_line_in_the_table() -> None:
    assert {path.name for path in SCRIPTS.glob("*.py")} == TESTED
    table = (SCRIPTS / "README.md").read_text()
    assert all(f"| [{name}]({name}) |" in table for name in TESTED)


@pytest.mark.thorough
def test_the_readmes_example_of_the_library_runs_as_it_stands(tmp_path: Path) -> None:
    readme = (SCRIPTS.parents[1] / "README.md").read_text(encoding="utf-8")
    _, begin, rest = readme.partition("<!-- example: library -->\n```python\n")
    code, end, _ = rest.partition("```\n<!-- end of example -->")
    assert begin
    assert end
    (tmp_path / "example.py").write_text(code, encoding="utf-8")
    refusal, place = run(str(tmp_path / "example.py"), folder=tmp_path)
    assert refusal.startswith("OUTSIDE_FENCE {'outside_m': 350.")
    assert place.endswith((" 100", " 99"))


def test_the_square_flies_its_corners_and_is_refused_the_fifth(tmp_path: Path) -> None:
    *corners, refusal, end = run("square.py", folder=tmp_path)
    assert len(corners) == 4
    assert refusal.startswith("OUTSIDE_FENCE {'outside_m': 350.")
    assert end.startswith("GROUNDED logs/")
    assert whole(only_log(tmp_path / "logs")).states[-1].state == "GROUNDED"


@pytest.mark.thorough
def test_the_square_flies_on_a_vehicle_of_others(tmp_path: Path) -> None:
    port = free_port()
    with vehicle_sim("--link", f"udpout://127.0.0.1:{port}"):
        *_, end = run("square.py", f"udpin://127.0.0.1:{port}", folder=tmp_path)
    assert end.startswith("GROUNDED ")


@pytest.mark.thorough
def test_velocities_are_flown_refused_and_streamed(tmp_path: Path) -> None:
    """2 s at 1 m/s are 2 m; a circle of 1 m about the place north of where it began takes 6.3 s.

    Of a script or a vehicle that the machine stops meanwhile the gate refuses samples, or holds for
    want of them: it flies as far as the velocities that were sent, and by no more than was asked.
    """
    lines = run("velocity.py", folder=tmp_path)
    after, refusal, round_, end = (line for line in lines if not line.startswith("held: "))
    asked = "'asked_v_east_m_s': 50.0, 'asked_v_north_m_s': 0.0, 'asked_v_up_m_s': 0.0"
    assert refusal == f"POLICY {{{asked}, 'asked': 50.0, 'max_speed_h_m_s': 10.0}}"
    east_m, north_m, _ = place_of(after)
    assert 0.0 < east_m < 3.0
    assert north_m == pytest.approx(0.0, abs=0.7)
    path = only_log(tmp_path / "logs")
    assert math.dist(place_of(round_)[:2], sent_m(path)) < 1.5
    assert end.startswith("GROUNDED logs/")
    states = [state.state for state in whole(path).states]
    assert states.count("STREAMING") >= 3


def sent_m(path: Path) -> tuple[float, float]:
    """How far east and north the velocities that were sent led, each until the next setpoint."""
    times_s = [at_ns / 1e9 for at_ns in times_ns(path, SETPOINT)]
    flown = [message for topic, message in decoded(path) if topic.endswith(SETPOINT)]
    steps_s = [after - before for before, after in pairwise(times_s)]
    velocities = [(each.vy, each.vx) for each in flown[:-1]]
    east_m = math.fsum(v * s for (v, _), s in zip(velocities, steps_s, strict=True))
    north_m = math.fsum(v * s for (_, v), s in zip(velocities, steps_s, strict=True))
    return east_m, north_m


def place_of(line: str) -> tuple[float, ...]:
    """Of a line such as `at (2.0, 0.0, 3.0)`."""
    return tuple(float(metres) for metres in line.removeprefix("at (").rstrip(")").split(", "))


def test_with_asyncio_it_is_flown_while_another_task_watches(tmp_path: Path) -> None:
    place, end = run("watch_async.py", folder=tmp_path)
    east_m, north_m, up_m = place_of(place)
    assert math.hypot(east_m - 3.0, north_m - 2.0) == pytest.approx(2.0, abs=1.0)
    assert up_m == pytest.approx(4.0, abs=0.7)
    assert end.startswith("GROUNDED logs/")


@pytest.mark.thorough
def test_a_survey_on_the_map_takes_a_picture_at_each_corner(tmp_path: Path) -> None:
    lines = run("photo_survey.py", folder=tmp_path)
    pictures, places = zip(*(line.split(" at ") for line in lines), strict=True)
    assert pictures == tuple(f"picture {number}" for number in range(4))
    corners = [place_of(f"at {place}")[:2] for place in places]
    for (east_m, north_m), (east, north) in zip(
        corners, ((0, 0), (0, 1), (1, 1), (1, 0)), strict=True
    ):
        assert (east_m, north_m) == pytest.approx((9.78 * east, 10.0 * north), abs=0.05)


@pytest.mark.thorough
def test_a_plan_is_flown_with_its_events(tmp_path: Path) -> None:
    lines = run("fly_plan.py", "square", folder=tmp_path)
    assert "state GROUNDED -> FLYING_MISSION" in lines
    assert any(line.startswith("mission_upload ") for line in lines)
    assert whole(only_log(tmp_path / "logs")).states[-1].state == "GROUNDED"


@pytest.mark.thorough
def test_a_goto_is_stopped_by_what_telemetry_says(tmp_path: Path) -> None:
    lines = run("watch_battery.py", "101", folder=tmp_path)
    assert lines[0].startswith("100 % left at ")
    assert lines[-1] == "turning round"


@pytest.mark.thorough
def test_another_program_stops_what_a_station_flies(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator:
        operator.fly("arm", "takeoff 3")
        goto = operator.send("goto 100 0 3")
        before, after = run("stop.py", folder=tmp_path)
        assert before.startswith("MOVING at ")
        assert after.startswith("HOLDING at ")
        operator.until(lambda: goto.settled, "its ending")
        assert goto.outcome is not None
        assert (goto.outcome.ended, goto.outcome.code) == ("aborted", "OPERATOR")
        operator.leave()
