"""Ctrl-C at 45 moments of the first 3 s of `gcs fly`: no traceback, no process left, exit 130.

Run: python -m tests.system.measure_ctrl_c [MOMENTS]
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass

from tests.system.patience import until
from tests.system.programs import alive, descendants

MOMENTS = 45
SPAN_S = 3.0
ENDS_WITHIN_S = 60.0


@dataclass(frozen=True, slots=True)
class Interrupted:
    """What became of a program that was interrupted `at_s` after its start.

    `before_us`: Python itself had not come to our first line; the signal ended it, or it said so.
    """

    at_s: float
    exit_code: int
    told: str
    left: list[int]

    @property
    def before_us(self) -> bool:
        unhandled = self.exit_code == -signal.SIGINT or "KeyboardInterrupt" in self.told
        return unhandled and "/gcs/" not in self.told and not self.left

    @property
    def good(self) -> bool:
        return self.exit_code == 130 and "Traceback" not in self.told and not self.left


def interrupt(at_s: float, *words: str) -> Interrupted:
    """A Ctrl-C reaches the whole group of processes, as from a terminal."""
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen(
            [sys.executable, "-m", "gcs", "fly", "--sim", *words, "--log-dir", folder],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        time.sleep(at_s)
        started = descendants(process.pid)
        os.killpg(process.pid, signal.SIGINT)
        try:
            told, _ = process.communicate(timeout=ENDS_WITHIN_S)
        except subprocess.TimeoutExpired:
            process.kill()
            told, _ = process.communicate()
        with suppress(AssertionError):
            until(lambda: not any(map(alive, started)), "the end of its processes")
        return Interrupted(at_s, process.returncode, told, [pid for pid in started if alive(pid)])


def moments(count: int) -> list[float]:
    return [SPAN_S * number / count for number in range(count)]


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else MOMENTS
    found = [interrupt(at_s, "--plain") for at_s in moments(count)]
    for each in found:
        if not each.good:
            print(f"{each.at_s:.2f} s: exit {each.exit_code}, left {each.left}\n{each.told}")
    print(
        f"{sum(each.good for each in found)} of {count} good, "
        f"{sum(each.before_us for each in found)} within the start of Python itself, "
        f"load {os.getloadavg()[0]:.1f}"
    )


if __name__ == "__main__":
    main()
