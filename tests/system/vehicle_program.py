"""Starts `vehicle-sim` as a user would, and ends it by its own process id."""

from __future__ import annotations

import random
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from tests.system.patience import PATIENT_S

PORTS = range(20_000, 32_000)
"""Linux, macOS and Windows give none of these to who leaves the choice to them."""


def free_port(kind: socket.SocketKind = socket.SOCK_DGRAM) -> int:
    """A port that nobody had a moment ago, and that nobody is given by chance meanwhile."""
    while True:
        port = _random.choice(PORTS)
        with socket.socket(socket.AF_INET, kind) as probe, suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port


_random = random.SystemRandom()


class Lines(list[str]):
    """What a program has printed so far."""

    def __init__(self, pid: int) -> None:
        super().__init__()
        self.pid = pid


@contextmanager
def vehicle_sim(*arguments: str) -> Iterator[Lines]:
    """The lines that it prints, as they come."""
    process = subprocess.Popen(
        [sys.executable, "-m", "vehicle_sim", "--lifeline", *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    lines = Lines(process.pid)
    reader = threading.Thread(target=lines.extend, args=(process.stdout,))
    reader.start()
    try:
        yield lines
    finally:
        process.stdin.close()
        try:
            code = process.wait(PATIENT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            raise
        finally:
            reader.join()
            process.stdout.close()
    assert code == 0, "\n".join(lines)
