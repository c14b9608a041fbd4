"""The start of the `gcs` program, also as `python -m gcs`.

What is loaded takes a second on a busy machine, and a Ctrl-C may come at any moment of it.  So
this comes first, and imports next to nothing before it has said what is to happen then.
"""

from __future__ import annotations

# `signal` itself makes enums first: 15 ms more in which a Ctrl-C is a traceback.
import _signal as signal  # type: ignore[import-not-found]
import os

TYPE_CHECKING = False  # that of `typing`, which takes its time to load
if TYPE_CHECKING:
    from types import FrameType
    from typing import NoReturn

INTERRUPTED = 130
"""`gcs.exit_codes.ExitCode.INTERRUPTED`, which is not loaded yet."""


def end_at_once(_number: int, _frame: FrameType | None) -> NoReturn:
    """On a Ctrl-C before there is anything to leave in good order, or after it has been left.

    `gcs.operator.interrupts.Interrupts` takes its place while a station runs.
    """
    os.write(2, b"gcs: interrupted\n")
    os._exit(INTERRUPTED)


# Here and not in `main`: the script that pip makes still imports after this module.  Nothing but
# a program's start imports it.
signal.signal(signal.SIGINT, end_at_once)


def main() -> NoReturn:
    """The console script."""
    from gcs.cli.main import main as run

    run()


if __name__ == "__main__":
    main()
