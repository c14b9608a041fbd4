"""Habits of a good program: a reader that leaves ends it quietly (128 + SIGPIPE), NO_COLOR."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.system.patience import PATIENT_S
from tests.system.programs import GCS, LONGEST_S

pytestmark = pytest.mark.system


@pytest.mark.parametrize("words", ["mission show demo", "fsa"])
def test_a_pipe_that_closes_ends_it_quietly(words: str, tmp_path: Path) -> None:
    shell = f"set -o pipefail; {GCS} {words} 2>{tmp_path}/err | (exec <&-)"
    ended = subprocess.run(["bash", "-c", shell], timeout=LONGEST_S, check=False)
    assert (ended.returncode, (tmp_path / "err").read_text()) == (141, "")


@pytest.mark.skipif(sys.platform == "win32", reason="a pty")
def test_no_color_takes_the_colours_off_the_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.system.terminal import terminal

    monkeypatch.setenv("NO_COLOR", "1")
    with terminal(GCS, "fly", "--link", "udpin://127.0.0.1:0") as screen:
        screen.until_text("start one: vehicle-sim")
        screen.press("q")
        assert screen.process.wait(PATIENT_S) == 3
    codes = re.findall(rb"\x1b\[([0-9;]*)m", bytes(screen.seen))
    colours = [re.findall(rb"[34]8;2;(\d+);(\d+);(\d+)", code) for code in codes]
    assert all(len(set(colour)) == 1 for found in colours for colour in found), "not grey"
    assert not any(re.search(rb"(?<![\d;])(3[1-6]|4[1-6]|9[1-6])(?![\d;])", code) for code in codes)
