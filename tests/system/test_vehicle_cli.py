"""`vehicle-sim` as a program: how it starts, what it says, how it ends."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.system.patience import PATIENT_S, until
from tests.system.terminal import terminal
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = [pytest.mark.system, pytest.mark.skipif(sys.platform == "win32", reason="signals")]

PAGES_S = 2.0
"""A live page would be drawn several times."""
PROGRAM = [sys.executable, "-m", "vehicle_sim"]


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*PROGRAM, *arguments], capture_output=True, text=True, timeout=PATIENT_S, check=False
    )


@pytest.mark.parametrize("scheme", ["udpin", "tcpin"])
def test_a_port_that_is_taken_is_a_clear_error_with_a_hint(scheme: str) -> None:
    kind = socket.SOCK_DGRAM if scheme == "udpin" else socket.SOCK_STREAM
    with socket.socket(socket.AF_INET, kind) as other:
        other.bind(("127.0.0.1", 0))
        if scheme == "tcpin":
            other.listen()
        url = f"{scheme}://127.0.0.1:{other.getsockname()[1]}"
        ended = run("--link", url)
    assert ended.returncode == 9
    assert url in ended.stderr
    assert "Hint:" in ended.stderr
    assert "Traceback" not in ended.stderr


def test_a_fault_file_that_is_not_there_is_an_error_that_names_the_shipped_one() -> None:
    ended = run("--fault", "trouble.toml")
    assert ended.returncode == 4
    assert "trouble.toml: No such file or directory\nHint: " in ended.stderr
    assert "vehicle-sim --fault bad_day.toml" in ended.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ("--home", "47.4,8.5"),
        ("--home", "147.4,8.5,100"),
        ("--home", "nan,8.5,100"),
        ("--link", "carrier-pigeon://home"),
        ("--param", "NO_SUCH=1"),
        ("--param", "NAV_DLL_ACT=1.5"),
        ("--firmware", "4.7"),
        ("--speedup", "0"),
        ("--speedup", "inf"),
        ("--port", "70000"),
        ("--seed", "-1"),
        ("--seed", "1_0"),
        ("--home", "4_7.4,8.5,100"),
        ("--wind", "nan"),
        ("--speedup", "1_0"),
        ("--param", "MIS_TAKEOFF_ALT=\uff13"),
    ],
)
def test_wrong_use_ends_with_2_and_no_traceback(arguments: tuple[str, ...]) -> None:
    ended = run(*arguments)
    assert ended.returncode == 2
    assert ended.stderr
    assert "Traceback" not in ended.stderr


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 0)], ids=["SIGINT", "SIGTERM"]
)
def test_a_signal_ends_it_cleanly(number: signal.Signals, code: int) -> None:
    process = subprocess.Popen(
        [*PROGRAM, "--port", str(free_port())],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    process.stdout.readline()
    process.stdout.readline()
    process.send_signal(number)
    _, errors = process.communicate(timeout=PATIENT_S)
    assert (process.returncode, errors) == (code, "")


def test_it_tells_what_to_connect_to_and_ends_with_its_lifeline() -> None:
    port = free_port()
    with vehicle_sim("--port", str(port)) as lines:
        until(lambda: len(lines) >= 2, "two lines")
        assert lines[0].startswith("INFO vehicle1: px4 quadrotor at 47.397742, 8.545594")
        assert lines[1].endswith(f"connect with udpout://127.0.0.1:{port}\n")


@pytest.mark.parametrize("lifeline", ["</dev/null", "<empty", "<&-"])
def test_it_ends_at_once_with_a_lifeline_that_has_ended(lifeline: str, tmp_path: Path) -> None:
    """`select` takes neither files nor /dev/null; with `<&-` there is no standard input at all."""
    (tmp_path / "empty").touch()
    process = subprocess.run(
        ["sh", "-c", f'exec "$@" {lifeline}', "sh", *PROGRAM, "--port", "0", "--lifeline"],
        capture_output=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
        text=True,
        timeout=PATIENT_S,
        check=False,
    )
    assert (process.returncode, process.stderr) == (0, "")


def test_pymavlinks_mavutil_is_not_loaded() -> None:
    code = (
        "import sys, vehicle_sim.cli\n"
        "import vehicle_sim.simulation.world, vehicle_sim.shell.pacer\n"
        "import vehicle_sim.autopilot.autopilot\n"
        "assert 'pymavlink.mavutil' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=PATIENT_S)


def test_a_viewer_is_sent_where_the_vehicle_is() -> None:
    """--view: HIL_STATE_QUATERNION (115) and HEARTBEAT (0), and nothing else."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as viewer:
        viewer.bind(("127.0.0.1", 0))
        viewer.settimeout(PATIENT_S)
        url = f"udp://127.0.0.1:{viewer.getsockname()[1]}"
        with vehicle_sim("--port", "0", "--view", url):
            first, second = viewer.recv(2048), viewer.recv(2048)
    assert (first[0], first[7:10]) == (0xFD, b"\0\0\0")
    assert second[7] == 115


def test_a_viewers_address_must_be_one() -> None:
    ended = run("--view", "tcp://127.0.0.1:19410")
    assert ended.returncode == 2
    assert "udp://HOST:PORT" in ended.stderr


def test_it_tells_its_version() -> None:
    ended = run("--version")
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout.startswith("vehicle-sim ")


def test_in_the_background_of_a_terminal_it_leaves_the_screen_to_others() -> None:
    program = f"{' '.join(PROGRAM)} --port {free_port()}"
    shell = f"set -m; {program} & read; echo my prompt; kill %1; wait"
    with terminal("/bin/bash", "-c", shell) as screen:
        screen.until_text("listens on UDP port")
        time.sleep(PAGES_S)
        screen.press("\n")
        screen.until_text("my prompt")
        screen.process.wait(PATIENT_S)
    assert b"\x1b" not in screen.seen
    assert "battery" not in screen.text


def test_in_the_foreground_of_a_terminal_it_shows_a_live_page() -> None:
    with terminal(*PROGRAM, "--port", str(free_port())) as screen:
        screen.until_text("battery", "times real time")
