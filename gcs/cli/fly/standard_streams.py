"""The standard streams of this process, as the console of `--plain` reads and writes them."""

from __future__ import annotations

import os
import sys

from gcs.operator.console.line_queue import LineQueue


def stdin_input() -> LineQueue:
    return LineQueue(sys.stdin.fileno(), "<stdin>", typed=stdin_is_a_terminal())


def to_stdout(line: str) -> None:
    """Answers are flushed at once: whoever reads the pipe waits for them."""
    print(line, flush=True)


def to_stderr(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def stdin_is_a_terminal() -> bool:
    return os.isatty(sys.stdin.fileno())
