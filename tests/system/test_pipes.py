"""A reader that leaves ends a command without a word, as it ends other programs: 128 + SIGPIPE."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.system.programs import GCS, LONGEST_S

pytestmark = pytest.mark.system


@pytest.mark.parametrize("words", ["mission show demo", "fsa"])
def test_a_pipe_that_closes_ends_it_quietly(words: str, tmp_path: Path) -> None:
    shell = f"set -o pipefail; {GCS} {words} 2>{tmp_path}/err | (exec <&-)"
    ended = subprocess.run(["bash", "-c", shell], timeout=LONGEST_S, check=False)
    assert (ended.returncode, (tmp_path / "err").read_text()) == (141, "")
