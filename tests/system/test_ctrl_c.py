"""Ctrl-C while a command starts: no traceback, no process left, exit 130.

`python -m tools.ctrl_c` does this to every command there is.
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

import pytest

from tests.shares import one_in
from tests.system.patience import until
from tests.system.programs import alive, descendants

pytestmark = pytest.mark.system

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
    """`gcs` and these words, in a folder of its own.  A Ctrl-C reaches the whole group of
    processes, as from a terminal."""
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen(
            [sys.executable, "-m", "gcs", *words],
            cwd=folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        time.sleep(at_s)
        started = descendants(process.pid)
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGINT)
        try:
            told, _ = process.communicate(timeout=ENDS_WITHIN_S)
        except subprocess.TimeoutExpired:
            process.kill()
            told, _ = process.communicate()
        with suppress(AssertionError):
            until(lambda: not any(map(alive, started)), "the end of its processes")
        return Interrupted(at_s, process.returncode, told, [pid for pid in started if alive(pid)])


@pytest.mark.parametrize("at_s", one_in(3, [0.2, 0.4, 0.6, 0.9, 1.3, 2.0]))
def test_a_ctrl_c_at_the_start_ends_it_without_a_traceback_or_a_process_left(at_s: float) -> None:
    ended = interrupt(at_s, "fly", "--sim", "--plain")
    assert ended.good or ended.before_us, ended


NOBODY = "--link udpin://127.0.0.1:0"


@pytest.mark.parametrize(
    "line",
    one_in(3, [f"param list {NOBODY}", "mission show demo", f"preflight {NOBODY}"]),
)
def test_any_other_command_ends_so_or_has_ended_before(line: str) -> None:
    ended = interrupt(0.3, *line.split())
    assert ended.good or ended.before_us or ended.exit_code == 0, ended
