"""Runs a script in another client's environment against a vehicle: what both said."""

from __future__ import annotations

import os
import re
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.system.machine import KeptWaiting
from tests.system.vehicle_program import free_port, vehicle_sim

SCRIPTS = Path(__file__).parent / "scripts"
CLIENTS = Path(__file__).parents[2] / ".clients"
TIMEOUT_S = 300.0
PATIENT = {
    "px4": {"COM_OF_LOSS_T": 60, "COM_RC_LOSS_T": 35, "COM_DISARM_PRFLT": -1},
    "ardupilot": {"GUID_TIMEOUT": 5, "DISARM_DELAY": 0},
}
"""Parameters: a script that the machine stops for a second has not gone, nor forgotten to fly."""
ABOUT_ITSELF = re.compile("User callback queue slow|Callback .*took more than|Ignore: last: ")
"""MAVSDK's words for a script that takes what comes more slowly than it comes, and for the second
answer to a piece of a file that it has asked for twice meanwhile."""
ASKED_AGAIN = re.compile(
    "retr(y|ies)|timed out|timeout|unexpected response on work item", re.IGNORECASE
)
"""And where it meets what was late: PX4 tells a change of a parameter twice, 15 ms apart, and
MAVSDK's own next request, as of the second of several parameters, may come in between."""
ANSWER_S = 0.5
"""MAVSDK asks again after so long: it says so of a vehicle that does not answer, and of one that
the machine kept waiting."""


@dataclass(frozen=True, slots=True)
class Flown:
    """`said` by the script, `vehicle` by the vehicle; without what a test expects in any case."""

    said: list[str]
    vehicle: list[str]
    kept_waiting_s: float
    """The vehicle, by the machine."""

    def modes(self) -> list[str]:
        """The vehicle's modes, in order."""
        return [line.split()[-1] for line in self.vehicle if "vehicle1: mode " in line]


def interpreter(client: str) -> str:
    """Python of that client's environment; the test is skipped where there is none."""
    python = CLIENTS / client / "bin" / "python"
    if not python.exists():
        pytest.skip(f"`make .clients/{client}/.installed` makes the environment of {client}")
    return str(python)


def start(client: str, script: str, *arguments: str) -> subprocess.Popen[str]:
    """The script, in a process group of its own."""
    return subprocess.Popen(
        [interpreter(client), "-B", str(SCRIPTS / script), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


def end(process: subprocess.Popen[str]) -> None:
    """With whatever it started."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def fly(
    client: str, script: str, personality: str, *arguments: str, vehicle: tuple[str, ...]
) -> Flown:
    """One flight: the script is told the URL and the personality; it must end well, unwarned."""
    url = f"127.0.0.1:{free_port()}"
    words = ["--autopilot", personality, "--link", f"udpout://{url}", *vehicle]
    for name, value in PATIENT[personality].items():
        words += ["--param", f"{name}={value}"]
    with vehicle_sim(*words) as lines:
        process = start(client, script, f"udpin://{url}", personality, *arguments)
        kept = KeptWaiting(lines.pid)
        try:
            output, _ = process.communicate(timeout=TIMEOUT_S)
        except subprocess.TimeoutExpired:
            end(process)
            output = f"{process.communicate()[0]}\nstill flying after {TIMEOUT_S:g} s"
        finally:
            kept_waiting_s = kept.seconds
            end(process)
    assert process.returncode == 0, output + "\n".join(("", *lines))
    said = output.splitlines()
    warned = [line for line in said if line.startswith(("WARN", "ERROR", "CRITICAL"))]
    machines = [line for line in warned if ABOUT_ITSELF.search(line)]
    if kept_waiting_s > ANSWER_S:
        machines += [line for line in warned if ASKED_AGAIN.search(line)]
    assert set(warned) <= set(machines), "\n".join((*said, *lines))
    said = [line for line in said if line not in machines]
    return Flown(said, [line.rstrip() for line in lines], kept_waiting_s)
