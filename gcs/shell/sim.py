"""A vehicle of the station's own (`--sim`), started beside it and stopped after it."""

from __future__ import annotations

import subprocess
import sys

from gcs.config import SimConfig
from gcs.shell.pipes import LineSource

STOP_WAIT_S = 3.0
ENDING_S = 0.2
if sys.platform == "win32":
    _CREATION_FLAGS = subprocess.CREATE_NEW_PROCESS_GROUP
else:
    _CREATION_FLAGS = 0


def words_of(sim: SimConfig, port: int) -> list[str]:
    """The command that starts it, to send to a UDP port of ours on loopback."""
    words = [sys.executable, "-m", "vehicle_sim", "--lifeline"]
    words += ["--autopilot", sim.autopilot, "--seed", str(sim.seed)]
    words += ["--speedup", str(sim.speedup), "--link", f"udpout://127.0.0.1:{port}"]
    if sim.count > 1:
        words += ["--count", str(sim.count)]
    if sim.home:
        words += ["--home", sim.home]
    for name, value in sim.params.items():
        words += ["--param", f"{name}={value:g}"]
    return words


class SimProcess:
    """`vehicle-sim` as a child that dies with us: its standard input is its lifeline.

    When this process ends, however it ends, the pipe closes and the vehicle stops by itself.
    """

    def __init__(self, sim: SimConfig, port: int) -> None:
        """`port`: the UDP port of ours, on loopback, that the vehicle is to send to."""
        # In a session of its own: a terminal that closes hangs up on all its programs at once, and
        # would take the vehicle away before it is seen holding.  On Windows a Ctrl-C goes to all
        # programs of a console, but not to other groups.
        self._child = subprocess.Popen(
            words_of(sim, port),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            creationflags=_CREATION_FLAGS,
        )
        assert self._child.stdout is not None
        self.lines = LineSource(self._child.stdout.fileno())

    def ended(self) -> int:
        """Its exit code, once its output has ended: then it is about to end itself."""
        try:
            return self._child.wait(ENDING_S)
        except subprocess.TimeoutExpired:
            return 0

    def stop(self) -> None:
        """Close the lifeline and see it go; the vehicle must have been seen safe before."""
        assert self._child.stdin is not None
        self._child.stdin.close()
        self._child.terminate()
        try:
            self._child.wait(STOP_WAIT_S)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.wait()
        assert self._child.stdout is not None
        self._child.stdout.close()
