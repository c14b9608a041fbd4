"""missions/lab3/README.md is done from top to bottom: keys are pressed, commands are typed, and
what it says that they show is looked for.  In what is printed `...` stands for anything.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from gcs.gate.policy.parse import parse_policy
from gcs.resources import policy_path
from gcs.shell.rule_child import Place, judge, load
from gcs.shell.rule_process import rule_policy
from tests.each import each
from tests.system.patience import until
from tests.system.programs import GCS, LONGEST_S, Running, running
from tests.system.terminal import Terminal, terminal

LAB = Path(__file__).parents[2] / "missions" / "lab3"
README = (LAB / "README.md").read_text(encoding="utf-8")
KEYS = {"→": "\x1b[C", "←": "\x1b[D", "↑": "\x1b[A", "↓": "\x1b[B", "Enter": "\r", "Space": " "}
BETWEEN_KEYS_S = 0.25
"""As somebody types: two keys of one tick would be one request that supersedes another."""

BLOCKS = re.compile(
    r"^```(\w+)(?: ([\w.]+))?\n(.*?)^```$|^\|([^\n|]*)\|([^\n|]*)\|$", re.DOTALL | re.MULTILINE
)


def presses(keys: str) -> list[str]:
    """``(arm) `m` `` -> m; ``Enter Enter`` twice."""
    return [KEYS.get(word, word) for span in re.findall(r"`(.+?)`", keys) for word in span.split()]


def commands(block: str) -> Iterator[tuple[str, list[str], int]]:
    """What is typed, the lines that it prints, in order, and its exit code."""
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        command, *lines = part.rstrip().splitlines()
        codes = re.findall(r"^\[exit code (\d+)\]$", "\n".join(lines), re.MULTILINE)
        shown = [line for line in lines if not line.startswith("[exit code")]
        yield command, shown, int(codes[0]) if codes else 0


def regular(line: str) -> str:
    """What a line of the page matches; one that is `...` alone, any number of lines."""
    if line.strip() == "...":
        return r"(?:.*\n)*?.*"
    return ".*".join(map(re.escape, line.split("...")))


class Student:
    """Two terminals in one folder."""

    def __init__(self, opened: ExitStack) -> None:
        self._opened = opened
        self._screen: Terminal | None = None
        self._log: Running | None = None
        self._read = 0

    def start(self, block: str) -> None:
        """The first terminal; what is logged there is listened to."""
        ((command, _, _),) = commands(block)
        words = command.split()
        self._screen = self._opened.enter_context(terminal(GCS, *words[1:]))
        self._log, self._read = None, 0

    def row(self, keys: str, said: str) -> None:
        screen, expected = self._screen, re.findall(r"`(.+?)`", said)
        assert screen is not None
        for key in presses(keys):
            screen.press(key)
            time.sleep(BETWEEN_KEYS_S)
        if expected == ["log: "]:
            assert screen.process.wait(LONGEST_S) == 0
            until(lambda: "log: " in screen.text, "the path of the log")
        elif self._log is None:
            screen.until_text(*expected, timeout_s=LONGEST_S)
            listening = (GCS, "topic", "echo", "/log.text")
            self._log = self._opened.enter_context(running(*listening))
            time.sleep(2.0)
        else:
            for text in expected:
                self._logged(text)

    def _logged(self, text: str) -> None:
        assert self._log is not None
        lines = self._log.out

        def there() -> bool:
            while self._read < len(lines):
                self._read += 1
                if text in lines[self._read - 1]:
                    return True
            return False

        until(there, f"{text!r} in {lines[-12:]}", 60.0)

    def console(self, block: str) -> None:
        """The second terminal."""
        for command, expected, code in commands(block):
            ended = subprocess.run(
                command,
                shell=True,  # as it stands in the page, pipes and quotes
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                timeout=LONGEST_S,
                check=False,
            )
            told = f"$ {command}\n{ended.stdout}{ended.stderr}"
            assert ended.returncode == code, told
            shown = "\n".join(map(regular, expected))
            assert not expected or re.fullmatch(shown, ended.stdout.rstrip("\n")), told


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
def test_the_page_is_done_from_top_to_bottom(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(LAB, tmp_path / "missions" / "lab3")
    monkeypatch.chdir(tmp_path)
    # Stations of other tests are not to be found.
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("PATH", f"{Path(GCS).parent}{os.pathsep}{os.environ['PATH']}")
    with ExitStack() as opened:
        student = Student(opened)
        for found in BLOCKS.finditer(README):
            kind, name, block, keys, said = found.groups()
            if kind == "terminal":
                student.start(block)
            elif kind == "console":
                student.console(block)
            elif kind == "python":
                (tmp_path / name).write_text(block, encoding="utf-8")
            elif "`" in (said or "") and in_a_table_of_keys(found):
                student.row(keys, said)


def in_a_table_of_keys(row: re.Match[str]) -> bool:
    """Whether the head of its table is `| press | ... |`."""
    head = README.rfind("\n\n", 0, row.start())
    return README[head:].lstrip().startswith("| press |")


SOLUTION = LAB / "solutions" / "my_rule.py"
ASKED = [
    ((0.0, 0.0, 1.0), (2.0, 0.0, 1.0), None),
    ((-2.0, 0.0, 1.0), (2.0, 0.0, 1.0), "the leg is 4.0 m long, more than 3 m"),
    ((3.0, 0.0, 1.0), (4.2, 0.0, 1.0), "the goal is 0.80 m from a wall of cage"),
    ((0.0, -3.0, 1.0), (0.0, -4.5, 1.0), "the goal is 0.50 m from a wall of cage"),
]


@each("asked", ASKED)
def test_the_solution_of_the_rule(asked: tuple[tuple[float, ...], tuple[float, ...], str]) -> None:
    start, goal, refusal = asked
    path = policy_path("lab")
    policy = rule_policy(parse_policy(path.read_text(encoding="utf-8"), str(path)))
    verify = load(str(SOLUTION), SOLUTION.read_text(encoding="utf-8"))
    answer = judge(verify, str(SOLUTION), [(Place(*start), Place(*goal))], policy)
    assert (answer.refusal, answer.failed) == (refusal, False)
