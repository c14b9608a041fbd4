"""The bytes that a terminal sends for a key, and what they mean while a record is played."""

from __future__ import annotations

from collections.abc import Iterator

from gcs.replay.player import Key

KEYS: dict[bytes, Key | None] = {
    b" ": Key.PAUSE,
    b"\x1b[D": Key.BACK,
    b"\x1bOD": Key.BACK,
    b"\x1b[C": Key.ON,
    b"\x1bOC": Key.ON,
    b"\x1b[B": Key.FAR_BACK,
    b"\x1bOB": Key.FAR_BACK,
    b"\x1b[A": Key.FAR_ON,
    b"\x1bOA": Key.FAR_ON,
    b"+": Key.FASTER,
    b"=": Key.FASTER,
    b"-": Key.SLOWER,
    b"0": Key.BEGIN,
    b"q": None,
    b"\x04": None,
}
"""None ends it."""


def keys_of(pressed: bytes) -> Iterator[Key | None]:
    """What was asked for, in order; other keys mean nothing."""
    at = 0
    while at < len(pressed):
        size = 3 if pressed[at : at + 1] == b"\x1b" else 1
        name = pressed[at : at + size]
        if name in KEYS:
            yield KEYS[name]
        at += size
