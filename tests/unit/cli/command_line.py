"""`gcs` with its arguments, run in this process as the console script runs it."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from typing import NamedTuple

from gcs.cli import main


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
