"""How a program of an operator ends before its work is done."""

from __future__ import annotations


class ExitError(Exception):
    """The program cannot go on: one sentence, perhaps a hint, and what to exit with."""

    def __init__(self, exit_code: int, sentence: str, hint: str = "") -> None:
        super().__init__(sentence)
        self.exit_code = exit_code
        self.hint = hint


class Interrupted(Exception):  # noqa: N818  a request to leave, not an error
    """The operator pressed Ctrl-C, or the process was told to end; the text is the signal."""


def error_lines(sentence: str, hint: str) -> list[str]:
    """What a terminal shows of an error: what went wrong, and what to do if that is known."""
    lines = [f"gcs: {sentence}"]
    return [*lines, f"  hint: {hint}"] if hint else lines
