"""What `gcs` tells the shell when it ends.

A station says in its last event (`ipc.Bye`), and with a trouble (`ipc.Trouble`), which of these
its operator's program should exit with.
"""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """The same number means the same thing in every command."""

    DONE = 0
    DIFFERENT = 1  # a check was carried out, and what was looked at is not as it should be
    USAGE = 2
    NO_VEHICLE = 3
    BAD_FILE = 4
    REFUSED_BY_VEHICLE = 5
    REFUSED_BY_GATE = 6
    RECORDER = 7
    NOT_COMPLETED = 8
    ADDRESS_IN_USE = 9
    BUG = 70
    INTERRUPTED = 130
    READER_GONE = 141  # as of a program that SIGPIPE ends: `gcs ... | head -1`
