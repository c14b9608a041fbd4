"""`gcs fly` on a terminal: real keys, a look at the screen, and three ways to leave in flight."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.shares import one_in
from tests.system.flight_log import assert_held, only_log, readings
from tests.system.patience import PATIENT_POLICY, PATIENT_S, until
from tests.system.programs import GCS, all_gone, descendants
from tests.system.terminal import COLUMNS, ROWS, Terminal, environment, terminal
from tests.system.typed_flight import TOO_EARLY, UP, take_off, until_state

pytestmark = [
    pytest.mark.system,
    pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal"),
]


FLY = (GCS, "fly", "--sim", "--policy", PATIENT_POLICY)


def take_off_and_go(screen: Terminal) -> None:
    """Up, and off from the hover point towards a goal so far east that it is not reached here."""
    take_off(screen)
    until_state(screen, "HOVERING")
    screen.press("xx" + 10 * "d")  # a step of 10 m
    screen.press("\r")
    until_state(screen, "MOVING")


def test_ctrl_c_in_mid_flight_holds_closes_the_log_and_restores_the_terminal(
    tmp_path: Path,
) -> None:
    with terminal(*FLY, "--log-dir", str(tmp_path)) as screen:
        take_off_and_go(screen)
        assert screen.settings != screen.settings_before
        family = descendants(screen.process.pid)
        screen.press("\x03")
        assert screen.process.wait(PATIENT_S) == 0
        screen.until_text("in AUTO.LOITER", "log: ")
        assert screen.settings == screen.settings_before
        assert screen.seen.rfind(b"\x1b[?1049l") > screen.seen.rfind(b"\x1b[?1049h")
        assert screen.seen.rfind(b"\x1b[?25h") > screen.seen.rfind(b"\x1b[?25l")
        assert all_gone(family)

    path = only_log(tmp_path)
    assert_held(path)
    asked = [d for _, d in readings(path, "/gate/decision") if d["phase"] == "verdict"]
    # Where the vehicle's home came late, it was armed and asked to take off once more.
    accepted = dict.fromkeys(d["word"] for d in asked if d["outcome"] == "accepted")
    assert list(accepted) == ["arm", "takeoff", "goto"]


@pytest.mark.parametrize(
    "number", one_in(3, [signal.SIGKILL, signal.SIGTERM, signal.SIGHUP]), ids=lambda n: n.name
)
def test_when_the_station_goes_the_link_holds_the_vehicle_and_closes_the_log(
    number: signal.Signals, tmp_path: Path
) -> None:
    with terminal(*FLY, "--log-dir", str(tmp_path)) as screen:
        take_off_and_go(screen)
        family = descendants(screen.process.pid)
        os.kill(screen.process.pid, number)
        screen.process.wait(PATIENT_S)
        until(lambda: all_gone(family), "the end of link and vehicle")
        if number is not signal.SIGKILL:
            assert screen.settings == screen.settings_before

    assert_held(only_log(tmp_path))


@pytest.mark.parametrize(
    "told",
    one_in(
        2, [pytest.param(True, id="told by a signal"), pytest.param(False, id="told by nobody")]
    ),
)
def test_a_terminal_that_closes_in_mid_flight_leaves_a_held_vehicle_and_no_process(
    told: bool, tmp_path: Path
) -> None:
    """Whatever is written to it then fails or waits for ever, at the end of the screen too."""
    with terminal(*FLY, "--log-dir", str(tmp_path), controlling=told) as screen:
        take_off_and_go(screen)
        family = [screen.process.pid, *descendants(screen.process.pid)]
        screen.hang_up()
        screen.process.wait(PATIENT_S)
        until(lambda: all_gone(family), "the end of screen, link and vehicle")

    assert_held(only_log(tmp_path))


@pytest.mark.parametrize(
    ("words", "key", "exit_code"),
    [((), "q", 3), ((), "\x03", 130), (("--timeout", "0.5"), "", 3)],
    ids=["quit", "Ctrl-C", "timeout"],
)
def test_without_a_vehicle_it_says_so_and_exits_accordingly(
    words: tuple[str, ...], key: str, exit_code: int, tmp_path: Path
) -> None:
    link = ("--link", "udpin://127.0.0.1:0", "--log-dir", str(tmp_path))
    with terminal(GCS, "fly", *link, *words) as screen:
        if key:
            screen.until_text("start one: vehicle-sim")
            screen.press(key)
        assert screen.process.wait(PATIENT_S) == exit_code
        screen.until_text("gcs: no vehicle was heard")
        assert ("hint: start one" in screen.text) == (exit_code == 3)


class Tmux:
    """A tmux server of our own with one window, in which a shell runs."""

    def __init__(self) -> None:
        self._socket = f"mavgate-test-{os.getpid()}"
        size = ("-x", str(COLUMNS), "-y", str(ROWS))
        self("-f", os.devnull, "new-session", "-d", *size, "env PS1=ready: sh")

    def __call__(self, *words: str) -> str:
        done = subprocess.run(
            ["tmux", "-L", self._socket, *words],
            capture_output=True,
            text=True,
            check=True,
            env=environment(),
        )
        return done.stdout

    def type(self, *keys: str) -> None:
        self("send-keys", *keys)

    @property
    def lines(self) -> list[str]:
        return self("capture-pane", "-p").splitlines()

    def until(self, text: str) -> None:
        until(lambda: self.shows(text), f"{text!r} on screen")

    def hover_point(self) -> tuple[float, float, float]:
        """What is pending once a take-off is complete: where the vehicle hovers, E N U."""
        until(lambda: "pending E +0.00 N +0.00 U +0.50" not in self.pending, "hover")
        east, north, up = re.findall(r"[+-]\d+\.\d\d", self.pending)[:3]
        return float(east), float(north), float(up)

    def take_off(self) -> None:
        """Again once a second, while the vehicle's home is not known."""

        def up() -> bool:
            self.type("m")
            self.until("arm: complete")
            self.type("t")
            until(lambda: self.shows(UP) or self.shows(TOO_EARLY), "a verdict")
            if not self.shows(UP):
                time.sleep(1.0)
            return self.shows(UP)

        until(up, UP)

    def shows(self, text: str) -> bool:
        return any(text in line for line in self.lines)

    @property
    def pending(self) -> str:
        return next(line for line in self.lines if "◇ pending E" in line)

    def until_state(self, state: str) -> None:
        """The state is what the first line shows, beside the vehicle."""
        until(lambda: f"px4 quadrotor   {state} " in self.lines[0], state)


@pytest.fixture
def tmux() -> Iterator[Tmux]:
    if shutil.which("tmux") is None:
        pytest.skip("tmux is not installed")
    server = Tmux()
    try:
        yield server
    finally:
        shell = int(server("display-message", "-p", "#{pane_pid}"))
        started = [shell, *descendants(shell)]
        server("kill-server")
        until(lambda: all_gone(started), "the end of what ran in tmux")


def test_a_flight_typed_in_tmux_looks_right_and_ends_with_a_prompt(
    tmux: Tmux, tmp_path: Path
) -> None:
    tmux.until("ready:")
    tmux.type(f"cd {tmp_path} && stty -g > before && {' '.join(FLY)}; stty -g > after", "Enter")
    tmux.until_state("GROUNDED")
    tmux.take_off()
    tmux.until_state("HOVERING")
    east, north, up = tmux.hover_point()
    tmux.type("PageUp", "Right", "Right", "Up")
    east, north, up = round(east + 2, 1), round(north + 1, 1), round(up + 1, 1)
    tmux.until(f"◇ pending E {east:+.2f} N {north:+.2f} U {up:+.2f}")
    tmux.type("Enter")
    tmux.until(f"goto {east:g} {north:g} {up:g}: complete")
    tmux.type("x", "x", *6 * ["Left"], "Enter")
    tmux.until_state("MOVING")
    tmux.until(f"◉ active E {east - 60:+.2f} N {north:+.2f} U {up:+.2f}")
    flown = tmux.lines
    tmux.type("C-c")
    tmux.until("gcs: the vehicle is STILL FLYING in AUTO.LOITER")
    tmux.type("echo back $((40 + 2))", "Enter")
    tmux.until("back 42")

    for shown in ("map", "state", "OFFBOARD ARMED", "OURS", "batt", "ABORT", "state_and_safety"):
        assert any(shown in line for line in flown), "\n".join(flown)
    assert (tmp_path / "after").read_text() == (tmp_path / "before").read_text()
    assert_held(only_log(tmp_path / "logs"))
