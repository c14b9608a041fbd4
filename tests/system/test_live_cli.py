"""`gcs live` and `--live` as a user types them."""

from __future__ import annotations

import re
import signal
from pathlib import Path

import pytest

from gcs.exit_codes import ExitCode
from tests.system.patience import PATIENT_POLICY, until
from tests.system.programs import GCS, Running, gcs, running
from tests.system.station import simulated
from tests.system.viewer import Viewer, viewer

pytestmark = pytest.mark.system

PATIENT = ("--policy", PATIENT_POLICY)
STATE = "/vehicle/1/state"


@pytest.fixture(autouse=True)
def runtime(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stations of this test alone."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("run")))


def told(lines: list[str]) -> tuple[str, str]:
    """URL and code, as they are printed."""
    text = "\n".join(lines)
    url, code = re.search(r"ws://\S+", text), re.search(r'"code": "(\w+)"', text)
    assert url is not None
    assert code is not None, text
    return url[0], code[1]


def interrupt(program: Running) -> int:
    program.process.send_signal(signal.SIGINT)
    return program.ended()


def test_live_of_a_station_that_runs_is_told_and_goes_without_it_noticing(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator, running(GCS, "live") as live:
        live.until_out("take_control")
        url, code = told(live.out)
        with viewer(url) as looker:
            looker.subscribe(STATE)
            assert looker.call("take_control", code=code)["accepted"]
        assert interrupt(live) == ExitCode.DONE
        operator.fly("arm", "takeoff 2")
        operator.leave()


def test_live_ends_with_the_station(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator, running(GCS, "live") as live:
        live.until_out("take_control")
        operator.leave()
        assert live.ended() == ExitCode.DONE
        assert "the vehicle is on the ground" in "\n".join(live.err)


def climbed(looker: Viewer) -> bool:
    """Of the states heard so far, none before the first, and the first of them without a height."""
    return any(state.json.get("up_m", 0.0) > 1.0 for state in looker.of(STATE))


@pytest.mark.thorough
def test_live_of_a_new_station_flies_by_services_alone(tmp_path: Path) -> None:
    with running(GCS, "live", "--sim", *PATIENT, "--log-dir", str(tmp_path)) as live:
        live.until_out("take_control")
        url, code = told(live.out)
        until(lambda: "Current State: GROUNDED" in "\n".join(live.err), "a vehicle")
        with viewer(url) as looker:
            looker.subscribe(STATE)
            assert looker.call("take_control", code=code)["accepted"]
            assert looker.call("arm")["accepted"]
            until(lambda: any("Armed" in line for line in live.err), "armed")
            assert looker.call("takeoff", up_m=2.0)["accepted"]
            looker.until(lambda: climbed(looker), "the climb")
        # The viewer in control has gone: the vehicle is held.
        until(lambda: any("HOLDING" in line for line in live.err), "HOLDING")
        assert interrupt(live) == ExitCode.DONE
    (log_path,) = tmp_path.glob("*_live.mcap")
    assert str(log_path) in "\n".join(live.err)


def test_fly_with_a_live_view_tells_the_address_and_ends_with_it(tmp_path: Path) -> None:
    words = ("fly", "--sim", "--plain", "--live", *PATIENT, "--log-dir", str(tmp_path))
    ended = gcs(*words, stdin="arm\n")
    assert ended.returncode == ExitCode.DONE, ended.stderr
    url, _ = told(ended.stderr.splitlines())
    assert "arm: complete" in ended.stdout
    with pytest.raises(OSError, match="refused"), viewer(url):
        pass


@pytest.mark.thorough
def test_a_live_view_that_cannot_be_opened_ends_what_was_started(tmp_path: Path) -> None:
    with simulated(tmp_path / "first") as operator, running(GCS, "live") as live:
        live.until_out("take_control")
        port = told(live.out)[0].rpartition(":")[2]
        folder = tmp_path / "second"
        words = ("fly", "--sim", "--plain", "--live", port, "--log-dir", str(folder))
        ended = gcs(*words, stdin="arm\n")
        assert ended.returncode == ExitCode.ADDRESS_IN_USE
        assert "is taken by another program" in ended.stderr
        assert "hint: " in ended.stderr
        assert "arm" not in ended.stdout
        operator.leave()
