"""How a flight ends when a program is killed, told to go, or left by its operator."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from tests.shares import one_in
from tests.system.flight_log import assert_held, only_log
from tests.system.killed_station import kill_and_recover
from tests.system.patience import PATIENT_POLICY, until
from tests.system.programs import GCS, Running, all_gone, children, descendants, running

pytestmark = pytest.mark.system


@pytest.mark.parametrize("recorded_s", one_in(3, [1.0, 1.3, 1.7]))
def test_a_killed_station_loses_at_most_a_second_and_recover_makes_its_record_whole(
    recorded_s: float, tmp_path: Path
) -> None:
    loss = kill_and_recover(tmp_path, recorded_s)
    assert max(loss.received_s, loss.sent_s) <= 1.0 + loss.kept_waiting_s


def in_mid_flight(log_dir: Path) -> tuple[str, ...]:
    words = ("--policy", PATIENT_POLICY, "--log-dir", str(log_dir))
    return (GCS, "fly", "--sim", "--plain", "--speedup", "2", *words)


def take_off_and_go(program: Running) -> tuple[int, int]:
    """Flies; the process ids of the station and of its vehicle."""
    program.type("arm", "takeoff 2", "goto 40 0 2")
    program.until_out("goto 40 0 2: accepted")
    (station,) = children(program.pid)
    (vehicle,) = children(station)
    return station, vehicle


@pytest.mark.parametrize(
    ("number", "exit_code"),
    one_in(
        2,
        [
            pytest.param(signal.SIGKILL, -9, id="SIGKILL"),
            pytest.param(signal.SIGINT, 130, id="SIGINT"),
            pytest.param(signal.SIGTERM, 130, id="SIGTERM"),
            pytest.param(signal.SIGHUP, 130, id="SIGHUP"),
        ],
    ),
)
def test_when_the_operators_program_goes_the_station_holds_the_vehicle_and_closes_the_log(
    number: signal.Signals, exit_code: int, tmp_path: Path
) -> None:
    with running(*in_mid_flight(tmp_path)) as program:
        family = take_off_and_go(program)
        if number is signal.SIGINT:
            os.killpg(program.pid, number)  # a Ctrl-C reaches all of them
        else:
            os.kill(program.pid, number)
        assert program.ended() == exit_code
        until(lambda: all_gone(family), "the end of station and vehicle")

    assert_held(only_log(tmp_path))


def test_a_station_that_is_told_to_go_holds_the_vehicle_and_closes_the_log(tmp_path: Path) -> None:
    with running(*in_mid_flight(tmp_path)) as program:
        family = take_off_and_go(program)
        os.kill(family[0], signal.SIGTERM)
        program.ended()
        until(lambda: all_gone(family), "the end of station and vehicle")

    assert_held(only_log(tmp_path))
    assert "Traceback" not in "".join(program.err)


def test_a_vehicle_of_our_own_does_not_survive_a_killed_station(tmp_path: Path) -> None:
    with running(*in_mid_flight(tmp_path)) as program:
        station, vehicle = take_off_and_go(program)
        os.kill(station, signal.SIGKILL)
        program.ended()
        until(lambda: all_gone([station, vehicle]), "the end of the vehicle")

    assert program.process.returncode == 70
    assert any("the link process died" in line for line in program.err)
    assert "Traceback" not in "".join(program.err)


def test_an_end_of_input_in_mid_flight_leaves_in_good_order(tmp_path: Path) -> None:
    with running(*in_mid_flight(tmp_path)) as program:
        program.type("arm", "takeoff 2", "goto 40 0 2 &")
        program.until_out("goto 40 0 2: accepted")
        family = descendants(program.pid)
        assert program.process.stdin is not None
        program.process.stdin.close()
        assert program.ended() == 0
        until(lambda: all_gone(family), "the end of station and vehicle")

    assert_held(only_log(tmp_path))
    assert any("in AUTO.LOITER" in line for line in program.err)
