"""What is wrong with a log file."""

from __future__ import annotations

from pathlib import Path


class BadLogError(Exception):
    """The file cannot be used: `path`, what is wrong with it, and what to do if that is known."""

    def __init__(self, path: Path, reason: str, hint: str = "") -> None:
        super().__init__(f"{path}: {reason}")
        self.path = path
        self.reason = reason
        self.hint = hint


class BadRecordError(BadLogError):
    """The file is no MCAP, or none that can be read."""
