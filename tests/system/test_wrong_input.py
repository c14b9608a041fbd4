"""What users and networks get wrong: a clear error, the right exit code, and no traceback."""

from __future__ import annotations

import random
import socket
from pathlib import Path

import pytest

from gcs.config import SimConfig, StationConfig
from gcs.operator.errors import ExitError
from gcs.report import Direction
from tests.system.flight_log import frames, readings, whole, wire
from tests.system.programs import gcs
from tests.system.station import station, tapped
from tests.system.vehicle_program import free_port

pytestmark = pytest.mark.system

FAR_POLYGON = """[[fence]]
name = "elsewhere"
kind = "polygon"
frame = "geographic"
corners = [[10.0, 10.0], [10.0, 10.01], [10.01, 10.01]]
"""
WITH_A_PIT = """[[fence]]
name = "home"
kind = "circle"
radius_m = 50

[[fence]]
name = "pit"
kind = "circle"
inclusion = false
radius_m = 8
"""
FAR_FENCE = """\
name = "elsewhere"
[[fence]]
name = "there"
kind = "circle"
frame = "local"
centre = [200.0, 0.0]
radius_m = 50.0
"""


def refused(*words: str, stdin: str = "") -> tuple[int, str]:
    """Exit code and output of a command that must fail as a user's error."""
    ended = gcs(*words, stdin=stdin)
    assert "Traceback" not in ended.stdout + ended.stderr
    assert "internal error" not in ended.stderr
    return ended.returncode, ended.stdout + ended.stderr


def test_no_vehicle(tmp_path: Path) -> None:
    link = f"udpin://127.0.0.1:{free_port()}"
    code, told = refused("status", "--link", link, "--timeout", "0.5", "--log-dir", str(tmp_path))
    assert code == 3
    assert "no vehicle heard within 0.5 s" in told
    assert "hint: start one with `vehicle-sim`" in told


@pytest.mark.parametrize(
    ("words", "exit_code", "told"),
    [
        (("--link", "udpout://no-such-host.invalid:14550"), 2, "hint: is the name of the host"),
        (("--link", "serial:///dev/ttyNONE:57600"), 2, "serial:///dev/ttyNONE:57600"),
        (("--policy", "missing-fence.toml"), 4, "missing-fence.toml:3: fence[1].path"),
    ],
    ids=["unknown host", "no serial line", "bad policy"],
)
def test_what_keeps_a_station_from_starting_is_told_however_short_the_time(
    words: tuple[str, ...],
    exit_code: int,
    told: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    fence = '[[fence]]\nkind = "file"\npath = "nowhere.plan"\n'
    (tmp_path / "missing-fence.toml").write_text(fence)
    code, output = refused("status", "--timeout", "0.001", *words)
    assert code == exit_code
    assert told in output
    assert "no vehicle heard" not in output


def test_a_port_in_use(tmp_path: Path) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        link = f"udpin://127.0.0.1:{other.getsockname()[1]}"
        code, told = refused(
            "status", "--link", link, "--timeout", "0.001", "--log-dir", str(tmp_path)
        )
    assert code == 9
    assert f"{link} is in use by another program" in told
    assert "choose another port with --link" in told
    assert not list(tmp_path.iterdir())


def test_a_link_that_is_no_url(tmp_path: Path) -> None:
    code, told = refused("goto", "1", "0", "2", "--link", "pigeon://x", "--log-dir", str(tmp_path))
    assert code == 2
    assert "pigeon://x: no known kind of endpoint" in told
    assert "hint: such as udpin://" in told


def test_a_policy_with_an_unknown_key(tmp_path: Path) -> None:
    policy = tmp_path / "mine.toml"
    policy.write_text('name = "mine"\n\n[arrival]\nradius = 3\n')
    code, told = refused("fly", "--sim", "--plain", "--policy", str(policy))
    assert code == 4
    assert f"{policy}:4: arrival.radius: unknown key" in told
    assert "hint: did you mean radius_m?" in told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (b"margin_h_m = nan", ":1: margin_h_m: nan is not finite"),
        (b"margin_h_m = 1e308", ":1: margin_h_m: 1e+308 is impossible"),
        (b"margin_h_m = 200", ":1: margin_h_m: the margin of 200 m leaves nothing"),
        (b"margin_h_m = 2\nmargin_h_m = 3", ":2: not TOML: Cannot overwrite a value"),
        (b"\x7fELF\x00\xff", ": is no text"),
        (
            b"[[fence]]\nname = 'a'\nkind = 'polygon'\nframe = 'geographic'\n"
            b"corners = [[47.39, 8.54], [47.40, 8.55], [47.40, 8.54], [47.39, 8.55]]",
            ":5: fence[1].corners: edge 1 and edge 3 meet: the polygon intersects itself",
        ),
        (
            b"[[fence]]\nname = 'a'\ninclusion = false\nradius_m = 9",
            ":1: fence: has no inclusion zone",
        ),
        (
            b"[[fence]]\nname = 'a'\nradius_m = 9\ncentre = [20, 0]",
            ":4: fence[1].centre: home is outside this zone",
        ),
    ],
    ids=["nan", "huge", "margin", "twice", "binary", "crossing", "exclusion alone", "home"],
)
def test_a_bad_policy_starts_nothing(text: bytes, told: str, tmp_path: Path) -> None:
    policy = tmp_path / "mine.toml"
    policy.write_bytes(text)
    code, output = refused("fly", "--sim", "--plain", "--policy", str(policy))
    assert code == 4
    assert f"{policy}{told}" in output
    assert "hint: " in output


def test_a_fence_file_with_exclusion_zones_only(tmp_path: Path) -> None:
    circle = '{"center": [47.398, 8.546], "radius": 5}'
    zone = f'{{"version": 1, "inclusion": false, "circle": {circle}}}'
    fence = f'{{"version": 2, "polygons": [], "circles": [{zone}]}}'
    (tmp_path / "yard.plan").write_text(
        f'{{"fileType": "Plan", "version": 1, "geoFence": {fence}}}'
    )
    policy = tmp_path / "mine.toml"
    policy.write_text('[[fence]]\nkind = "file"\npath = "yard.plan"\n')
    code, told = refused("fly", "--sim", "--plain", "--policy", str(policy))
    assert code == 4
    assert f"{policy}:1: fence: has no inclusion zone" in told
    assert "hint: yard.plan only says where it may not be" in told


def test_a_home_outside_a_fence_in_the_local_frame(tmp_path: Path) -> None:
    policy = tmp_path / "elsewhere.toml"
    policy.write_text(FAR_FENCE)
    logs = str(tmp_path / "logs")
    code, told = refused("fly", "--sim", "--plain", "--policy", str(policy), "--log-dir", logs)
    assert code == 4
    assert "outside inclusion circle 'there'" in told
    assert f"{policy}:2: fence[1]: home is outside: " in told
    assert "hint: the vehicle returns and lands there" in told


@pytest.mark.parametrize(
    ("zones", "where", "why"),
    [
        (FAR_POLYGON, ":1: fence[1]: ", "corner 1 is not a place within 1000 km"),
        (WITH_A_PIT, ":6: fence[2]: ", "inside exclusion circle 'pit'"),
    ],
)
def test_a_home_that_turns_out_to_be_outside(
    tmp_path: Path, zones: str, where: str, why: str
) -> None:
    """Only once the vehicle tells its origin, or because the zone is one to keep out of."""
    policy = tmp_path / "mine.toml"
    policy.write_text(zones)
    logs = str(tmp_path / "logs")
    code, told = refused("fly", "--sim", "--plain", "--policy", str(policy), "--log-dir", logs)
    assert code == 4
    assert f"{policy}{where}home is outside: " in told
    assert why in told
    assert "hint: the vehicle returns and lands there" in told


def test_a_log_folder_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    logs = tmp_path / "file" / "logs"
    code, told = refused("fly", "--sim", "--plain", "--log-dir", str(logs))
    assert code == 7
    assert f"{logs}: cannot record: " in told
    assert "hint: choose a folder that can be written with --log-dir" in told


@pytest.mark.parametrize("home", ["47.4,8.5", "here", "91,0,0", "nan,8.5,488"])
def test_a_home_that_is_no_place(home: str) -> None:
    code, told = refused("fly", "--sim", "--plain", "--home", home)
    assert code == 2
    assert "Invalid value for '--home'" in told


def test_a_vehicle_of_our_own_that_does_not_start_is_told_at_once(tmp_path: Path) -> None:
    config = StationConfig(sim=SimConfig(home="nowhere"), log_dir=str(tmp_path))
    with station(config) as operator, pytest.raises(ExitError, match="exit code 2") as failed:
        operator.connect()
    assert failed.value.exit_code == 3
    assert operator.said("'nowhere' is not LAT,LON,ALT")


def test_missions_that_are_none(tmp_path: Path) -> None:
    bad = tmp_path / "bad.plan"
    bad.write_text('{"fileType": "Plan",\n "mission" 3}\n')
    code, told = refused("mission", "check", str(bad))
    assert code == 4
    assert f"{bad}:2:12: JSON: " in told

    sim = ("fly", "--sim", "--plain", "--strict", "--log-dir", str(tmp_path))
    code, told = refused(*sim, stdin=f"mission upload {bad}\n")
    assert code == 4
    assert f"{bad}:2:12: JSON: " in told

    code, told = refused(*sim, stdin="arm\nmission start\n")
    assert code == 6
    assert "NO_MISSION" in told


def test_garbage_and_oversize_datagrams_at_both_programs_change_nothing(tmp_path: Path) -> None:
    rng = random.Random(7)
    with tapped(tmp_path, speedup=2.0) as (operator, tap):
        whole_frame = tap.to_station[-1].data
        nasty = [
            b"",
            b"\xfd",
            b"\xfe" * 400,
            b"hello, is anybody there?\n",
            whole_frame[:-1],
            whole_frame[:-2] + bytes(2),
            b"\xfd" + whole_frame,
            rng.randbytes(65_507),
            b"\xfd\xff" * 32_000,
            *(rng.randbytes(rng.randrange(300)) for _ in range(300)),
        ]
        for data in nasty:
            tap.say_to_station(data)
            tap.say_to_vehicle(data)
        operator.fly("arm", "takeoff 1.5", "land")
        tap.silence_vehicle()
        operator.leave()
        path = operator.log_path

    info = whole(path)
    assert info.states[-1].state == "GROUNDED"
    garbage = {topic.topic: topic.messages for topic in info.topics}["/link/0/garbage"]
    assert garbage >= 300
    # A whole frame behind a stray magic byte is not swallowed with it.
    received = wire(frames(path), Direction.RECEIVED)
    assert received.count(whole_frame) >= 2
    assert [d["outcome"] for _, d in readings(path, "/gate/decision")].count("refused") == 0
