"""Work in a forked process: its answer, or that it used up its time."""

from __future__ import annotations

import contextlib
import os
import pickle
import resource
import selectors
import signal
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

MEMORY_BYTES = 6 << 30
"""An endless list ends here, not in the memory of the machine."""

WALL_PER_CPU = 20.0
"""A process that waits for something it will never get is ended after so many times its limit."""

A = TypeVar("A")
J = TypeVar("J")


@dataclass(frozen=True, slots=True)
class Answer(Generic[A]):
    """`value` is None where the process ended without one: it ran out of time, or crashed."""

    value: A | None
    timed_out: bool
    cpu_s: float


@dataclass(slots=True)
class _Child:
    pid: int
    pipe: int
    heard: bytes = b""


def ask(work: Callable[[], A], cpu_limit_s: float = 3600.0) -> A:
    """One answer from a process of its own.  Raises RuntimeError where there is none."""
    for _, answer in ask_all([None], lambda _: work, lambda _: cpu_limit_s, 1):
        if answer.value is not None:
            return answer.value
    raise RuntimeError("the process ended without an answer; its own words are above")


def ask_all(
    jobs: Sequence[J],
    work_of: Callable[[J], Callable[[], A]],
    cpu_limit_s: Callable[[J], float],
    workers: int,
) -> Iterator[tuple[J, Answer[A]]]:
    """Each job in a process of its own, so many at a time; answers as they come."""
    waiting = list(reversed(jobs))
    running: dict[int, tuple[J, _Child]] = {}
    with selectors.DefaultSelector() as selector:
        try:
            while waiting or running:
                while waiting and len(running) < workers:
                    job = waiting.pop()
                    child = _fork(work_of(job), cpu_limit_s(job))
                    running[child.pipe] = (job, child)
                    selector.register(child.pipe, selectors.EVENT_READ)
                for key, _ in selector.select():
                    job, child = running[key.fd]
                    if some := os.read(child.pipe, 1 << 16):
                        child.heard += some
                        continue
                    selector.unregister(child.pipe)
                    del running[child.pipe]
                    yield job, _ended(child)
        finally:
            for _, child in running.values():
                os.kill(child.pid, signal.SIGKILL)
                _ended(child)


def _ended(child: _Child) -> Answer[A]:
    os.close(child.pipe)
    _, status, usage = os.wait4(child.pid, 0)
    ended_by = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
    return Answer(
        pickle.loads(child.heard) if child.heard and not ended_by else None,
        ended_by in (signal.SIGXCPU, signal.SIGALRM),
        usage.ru_utime + usage.ru_stime,
    )


def _fork(work: Callable[[], A], cpu_limit_s: float) -> _Child:
    sys.stdout.flush()
    sys.stderr.flush()
    read, write = os.pipe()
    pid = os.fork()
    if pid:
        os.close(write)
        return _Child(pid, read)
    status = 1
    try:
        os.close(read)
        _limit(cpu_limit_s)
        answer = pickle.dumps(_quietly(work))
        with os.fdopen(write, "wb") as pipe:
            pipe.write(answer)
        status = 0
    except BaseException:  # noqa: BLE001 - nothing may return from here into the parent's code
        traceback.print_exc()
    finally:
        os._exit(status)


def _limit(cpu_limit_s: float) -> None:
    seconds = max(1, round(cpu_limit_s))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(ValueError, OSError):  # macOS knows it and does not have it
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    signal.setitimer(signal.ITIMER_REAL, seconds * WALL_PER_CPU)


def _quietly(work: Callable[[], A]) -> A:
    """Nothing that the work prints is shown; what goes wrong with it is."""
    said, nothing = os.dup(2), os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nothing, stream)
    try:
        return work()
    finally:
        os.dup2(said, 2)
