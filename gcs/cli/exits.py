"""What `gcs` tells the shell when it ends, and the one error that commands raise for users."""

from __future__ import annotations

from enum import IntEnum
from typing import IO, Any

import click


class Exit(IntEnum):
    """Exit codes.  The same number means the same thing in every command."""

    DONE = 0
    USAGE = 2
    NO_LINK = 3
    BAD_FILE = 4
    REFUSED_BY_VEHICLE = 5
    REFUSED_BY_GATE = 6
    RECORDER = 7
    NOT_COMPLETED = 8
    ADDRESS_IN_USE = 9
    BUG = 70
    INTERRUPTED = 130


class Fail(click.ClickException):
    """The command cannot go on: one sentence, perhaps a hint, and what to exit with."""

    def __init__(self, exit_code: int, sentence: str, hint: str = "") -> None:
        super().__init__(sentence)
        # click declares a class variable since 8.5, and reads it from the instance as ever.
        self.exit_code = exit_code  # type: ignore[misc]
        self.hint = hint

    def show(self, file: IO[Any] | None = None) -> None:
        click.echo(f"gcs: {self.message}", file=file, err=file is None)
        if self.hint:
            click.echo(f"  hint: {self.hint}", file=file, err=file is None)
