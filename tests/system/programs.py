"""The programs as a user starts them, and what is left of them afterwards."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

from tests.system.patience import PATIENT_S, until

GCS = str(Path(sys.executable).with_name("gcs"))
LONGEST_S = 180.0
"""What a program that is run to its end may take on a slow machine, its flight included."""


def gcs(*words: str, stdin: str = "") -> subprocess.CompletedProcess[str]:
    """Run it to its end."""
    return subprocess.run(
        [GCS, *words], input=stdin, capture_output=True, text=True, timeout=LONGEST_S, check=False
    )


class Running:
    """A program under way; `out` and `err` are its lines so far."""

    def __init__(self, command: Sequence[str]) -> None:
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        self.out: list[str] = []
        self.err: list[str] = []
        self._readers = [
            threading.Thread(target=lines.extend, args=(pipe,))
            for lines, pipe in ((self.out, self.process.stdout), (self.err, self.process.stderr))
        ]
        for reader in self._readers:
            reader.start()

    @property
    def pid(self) -> int:
        return self.process.pid

    def type(self, *lines: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write("".join(f"{line}\n" for line in lines))
        self.process.stdin.flush()

    def until_out(self, text: str, timeout_s: float = PATIENT_S) -> None:
        """Wait for a line of standard output that contains `text`."""
        try:
            until(lambda: any(text in line for line in self.out), repr(text), timeout_s)
        except AssertionError as error:
            raise AssertionError(f"{error}, in {self.out}; {self.err}") from None

    def ended(self) -> int:
        """Waits for its end, and until all that it wrote is read; its exit code."""
        code = self.process.wait(PATIENT_S)
        for reader in self._readers:
            reader.join(PATIENT_S)
            assert not reader.is_alive(), "what it started still holds its output"
        return code

    def close(self) -> None:
        """The end of its input, then of itself, then of whatever it started."""
        started = family(self.pid)
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):
            self.process.stdin.close()
        try:
            self.process.wait(10.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        try:
            until(lambda: all_gone(started), "the end of its processes")
        finally:
            for pid in filter(alive, started):
                os.kill(pid, 9)
            for reader in self._readers:
                reader.join()
            for pipe in (self.process.stdout, self.process.stderr):
                assert pipe is not None
                pipe.close()


@contextmanager
def running(*command: str) -> Iterator[Running]:
    """A program that is gone at the end, and everything that it started with it."""
    program = Running(command)
    try:
        yield program
    finally:
        program.close()


class _Process(NamedTuple):
    parent: int
    group: int
    state: str


def _processes() -> dict[int, _Process]:
    table = subprocess.run(
        ["ps", "-A", "-o", "pid=,ppid=,pgid=,state="], capture_output=True, text=True, check=True
    ).stdout
    rows = (line.split() for line in table.splitlines())
    return {
        int(pid): _Process(int(parent), int(group), state) for pid, parent, group, state in rows
    }


def alive(pid: int) -> bool:
    """Whether it still runs; a zombie that nobody has looked after yet does not."""
    return not all_gone([pid])


def children(pid: int) -> list[int]:
    return sorted(child for child, process in _processes().items() if process.parent == pid)


def descendants(pid: int) -> list[int]:
    """Children before their own."""
    processes = _processes()
    found = [pid]
    for each in found:
        found += sorted(child for child, process in processes.items() if process.parent == each)
    return found[1:]


def family(leader: int) -> list[int]:
    """What a program in a group of its own has started, also once it has ended itself."""
    group = [pid for pid, process in _processes().items() if process.group == leader]
    return sorted({*group, *descendants(leader)} - {leader})


def all_gone(pids: Sequence[int]) -> bool:
    processes = _processes()
    return all(pid not in processes or processes[pid].state.startswith("Z") for pid in pids)
