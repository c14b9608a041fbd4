"""Runs a script in another client's environment against a vehicle: what both said."""

from __future__ import annotations

import os
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.system.vehicle_program import free_port, vehicle_sim

SCRIPTS = Path(__file__).parent / "scripts"
CLIENTS = Path(__file__).parents[2] / ".clients"
TIMEOUT_S = 120.0


@dataclass(frozen=True, slots=True)
class Flown:
    """`said` by the script, `vehicle` by the vehicle; without what a test expects in any case."""

    said: list[str]
    vehicle: list[str]

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
    with vehicle_sim("--autopilot", personality, "--link", f"udpout://{url}", *vehicle) as lines:
        process = start(client, script, f"udpin://{url}", personality, *arguments)
        try:
            output, _ = process.communicate(timeout=TIMEOUT_S)
        except subprocess.TimeoutExpired:
            end(process)
            output = f"{process.communicate()[0]}\nstill flying after {TIMEOUT_S:g} s"
        finally:
            end(process)
    assert process.returncode == 0, output + "\n".join(("", *lines))
    said = output.splitlines()
    warned = [line for line in said if line.startswith(("WARN", "ERROR", "CRITICAL"))]
    assert not warned, "\n".join((*said, *lines))
    return Flown(said, [line.rstrip() for line in lines])
