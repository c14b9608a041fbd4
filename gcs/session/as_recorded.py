"""What an audit knows of bytes that came in, where the record has others for a key's sake."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class AsRecorded:
    """Into what a datagram, or a read of a stream, was split when it was recorded, and the bytes of
    the stream that were in no item yet."""

    parts: tuple[tuple[bytes, str], ...]
    """The bytes of each frame with an empty word, and of garbage with why it is no frame."""
    rest: bytes = b""
