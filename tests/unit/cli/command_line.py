"""`gcs` with its arguments, run in this process as the console script runs it."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from typing import NamedTuple, TypeVar

import pytest

from gcs.cli import main, oneshot_session
from gcs.cli.param import talk
from gcs.config import StationConfig
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts

Fake = TypeVar("Fake", bound=FakeStation)


class Ended(NamedTuple):
    """`output` is what the command wrote to standard output and to standard error, in order."""

    exit_code: int
    output: str


def gcs(*args: object) -> Ended:
    """Run one command line to its end."""
    written = io.StringIO()
    with redirect_stdout(written), redirect_stderr(written):
        exit_code = main.run([str(arg) for arg in args])
    return Ended(exit_code, written.getvalue())


def in_place_of_one(fake: Fake, monkeypatch: pytest.MonkeyPatch) -> Fake:
    """The commands that read of a vehicle talk with `fake`, in place of a process of their own."""

    def run(
        _: StationConfig, how: oneshot_session.OneShotConfig, task: oneshot_session.Task
    ) -> int:
        fake.done = False
        return oneshot_session.run_over(FakeConnection(fake), NoInterrupts(), how, task)

    monkeypatch.setattr(talk, "run", run)
    return fake
