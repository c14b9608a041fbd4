"""Runs a script of a client that is built on pymavlink's mavutil, and takes its URLs."""

from __future__ import annotations

import re
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.clients.client_script import SCRIPTS, interpreter
from tests.system.patience import until
from tests.system.vehicle_program import free_port, vehicle_sim


def run_script(
    client: str, script: str, *words: str, folder: Path, timeout_s: float = 300.0
) -> list[str]:
    """The lines that it printed; it must end well and say nothing on standard error."""
    done = subprocess.run(
        [interpreter(client), "-B", str(SCRIPTS / script), *words],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=timeout_s,
        check=False,
    )
    told = f"{script} {' '.join(words)}\n{done.stdout}\n{done.stderr}"
    assert done.returncode == 0, told
    assert not done.stderr.strip(), told
    return done.stdout.splitlines()


@contextmanager
def vehicle(autopilot: str, *words: str, waits: bool = False) -> Iterator[tuple[str, list[str]]]:
    """A vehicle on a free port: mavutil's URL for it, and the lines that it says.

    PX4 sends to UDP unasked and ArduPilot listens on TCP, as their own simulations do; with
    `waits` either is on a UDP port until somebody speaks.
    """
    if autopilot == "px4" or waits:
        place = f"127.0.0.1:{free_port()}"
    else:
        place = f"127.0.0.1:{free_port(socket.SOCK_STREAM)}"
    if waits:
        link, url = f"udpin://{place}", f"udpout:{place}"
    elif autopilot == "px4":
        link, url = f"udpout://{place}", f"udpin:{place}"
    else:
        link, url = f"tcpin://{place}", f"tcp:{place}"
    with vehicle_sim("--autopilot", autopilot, "--link", link, *words) as said:
        until(lambda: any("connect with" in line for line in said), "the vehicle is there")
        try:
            yield url, said
        finally:
            print(*said, sep="\n")  # shown where the test fails


def in_order(lines: list[str], *patterns: str) -> None:
    """Each pattern is found in a line of its own, in this order."""
    left = iter(lines)
    for pattern in patterns:
        assert any(re.search(pattern, line) for line in left), (
            f"{pattern!r} is not there, or not in its place:\n" + "\n".join(lines)
        )


def complaints(said: list[str]) -> list[str]:
    """What the vehicle itself warned of; a slow machine is not its fault."""
    return [line for line in said if re.match("(WARNING|ERROR|FATAL) vehicle", line)]
