"""The shell examples of the pages that one begins with, run as they stand, in order, each page in
a folder of its own, on simulated vehicles.  What is not run is in `NOT_RUN`, with the reason.
"""

from __future__ import annotations

import os
import re
import shutil
import socket
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.system.programs import GCS
from tests.system.vehicle_program import free_port, vehicle_sim

ROOT = Path(__file__).parents[2]
LONGEST_S = 400.0
"""A survey is flown, in real time."""

NOT_RUN = {
    "goes on until it is stopped": r"gcs (fly|live|attach|mcp|log replay|topic hz)"
    r"|gcs bridge --(?!explain)",
    "is flown by a test of its own": r"gcs demo\b",
    "needs a station that runs": r"gcs (abort|operations|status --json)|--vehicle 2",
    "needs a device or a server": r"serial:",
    "needs a file of the reader's": r"walk\.gpx|field\.kml|road\.gpx|BEFORE|ONE\.mcap|SOME\*"
    r"|flight\.tlog|my_rule|before\.parm after|get 7|new orbit"
    r"|campaign (run|show) wind",
}
"""By the reason; looked for in the line."""
RUN = {"README.md": 6, "docs/first-vehicle.md": 6, "docs/policy.md": 3, "docs/usage.md": 54}
"""So many lines of each page are run; fewer would be a page that is tried no more."""
MAY_END_WITH = {"gcs preflight": (0, 1)}
"""Other exit codes than 0: something may fail before a take-off, and it says so."""

EXAMPLES = re.compile(r"```sh\n(.*?)```", re.DOTALL)


def lines_of(page: str) -> list[str]:
    """What is typed and ends by itself."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = [line for block in EXAMPLES.findall(text) for line in block.splitlines()]
    commands = [line for line in found if re.match(r"gcs |printf ", line)]
    plain = [line for line in commands if "--plain" in line]
    return [
        line
        for line in commands
        if line in plain or not any(re.search(why, line) for why in NOT_RUN.values())
    ]


FLOWN = "arm\ntakeoff 2\ngoto 3 0 2\ngoto 500 0 2\ngoto 0 0 2\nphoto\nland\n"


def prepared(folder: Path, port: int) -> str:
    """What a page takes for granted: the repository's missions, a policy, a vehicle's link and
    a record, whose name is given."""
    shutil.copytree(ROOT / "missions", folder / "missions")
    shutil.copy(ROOT / "missions" / "fence.plan", folder / "my.plan")
    yard = (ROOT / "docs" / "policy.md").read_text(encoding="utf-8").partition("```toml\n")[2]
    for name in ("yard.toml", "my.toml"):
        (folder / name).write_text(yard.partition("```")[0], encoding="utf-8")
    subprocess.run([GCS, "key", "new", "records.key"], capture_output=True, check=True)
    made = subprocess.run(
        [GCS, "config", "init", "--user"], capture_output=True, text=True, check=True
    )
    (path,) = re.findall(r"\S+\.toml", made.stdout + made.stderr)[:1]
    Path(path).write_text(f'links = ["udpin://127.0.0.1:{port}"]\n', encoding="utf-8")
    flying = [GCS, "fly", "--sim", "--plain", "--speedup", "5", "--name", "some"]
    subprocess.run(flying, input=FLOWN, text=True, capture_output=True, check=True)
    (record,) = folder.glob("logs/*_some.mcap")
    return record.name


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="needs a shell")
@pytest.mark.parametrize("page", RUN)
def test_the_shell_examples_of_a_page(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    for name in ("XDG_RUNTIME_DIR", "XDG_CONFIG_HOME"):
        monkeypatch.setenv(name, str(tmp_path / name))
        (tmp_path / name).mkdir(mode=0o700)
    monkeypatch.setenv("PATH", f"{Path(GCS).parent}{os.pathsep}{os.environ['PATH']}")
    udp, tcp = free_port(), free_port(socket.SOCK_STREAM)
    some = prepared(folder, udp)
    wrong = []
    with ExitStack() as running:
        running.enter_context(vehicle_sim("--link", f"udpout://127.0.0.1:{udp}"))
        running.enter_context(
            vehicle_sim("--autopilot", "ardupilot", "--link", f"tcpin://127.0.0.1:{tcp}")
        )
        for line in lines_of(page):
            typed = line.replace("14540", str(udp)).replace("127.0.0.1:5760", f"127.0.0.1:{tcp}")
            typed = typed.replace("SOME.mcap", some)
            ended = subprocess.run(
                typed,
                shell=True,  # as it stands in the page, pipes and quotes
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                timeout=LONGEST_S,
                check=False,
            )
            codes = next((MAY_END_WITH[it] for it in MAY_END_WITH if typed.startswith(it)), (0,))
            if ended.returncode not in codes:
                wrong.append(f"$ {typed}\n{ended.returncode}: {ended.stdout}{ended.stderr}")
    assert wrong == []


@pytest.mark.parametrize("page", RUN)
def test_no_example_is_left_out_by_chance(page: str) -> None:
    assert len(lines_of(page)) == RUN[page]
