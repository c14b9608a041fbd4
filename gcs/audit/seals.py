"""Are the messages of a record all there, and as they were written?"""

from __future__ import annotations

from dataclasses import dataclass
from zlib import crc32

from gcs.audit.messages import Stored
from gcs.record.parts import PartBegan, Seal


@dataclass(frozen=True, slots=True)
class Altered:
    """The messages from `since_ns` on, up to the seal at `until_ns`, are not those written."""

    since_ns: int
    until_ns: int


@dataclass(frozen=True, slots=True)
class Missing:
    """Between `since_ns` and `until_ns` there should be so many more messages (or fewer, if
    negative)."""

    since_ns: int
    until_ns: int
    messages: int


class SealCheck:
    """Follows the messages of a session, over all its files."""

    def __init__(self) -> None:
        self._count = 0
        self._repeated_left = 0
        self._checksum = 0
        self._since_ns = 0

    def message(self, message: Stored) -> None:
        """Any message but one that `begins_part`, after `seal` where it is one."""
        if self._repeated_left:
            self._repeated_left -= 1
        else:
            self._count += 1
        self._checksum = crc32(message.data, self._checksum)
        self._since_ns = self._since_ns or message.log_time_ns

    @property
    def repeats(self) -> bool:
        """Whether the next message is but repeated from an earlier file."""
        return self._repeated_left > 0

    def seal(self, seal: Seal, at_ns: int) -> Altered | Missing | None:
        """What is wrong with the messages before it."""
        since_ns, checksum = self._since_ns, self._checksum
        self._checksum, self._since_ns = 0, 0
        if self._count != seal.messages:
            return Missing(since_ns, at_ns, seal.messages - self._count)
        return None if checksum == seal.crc32 else Altered(since_ns, at_ns)

    def begins_part(self, part: PartBegan, message: Stored) -> Missing | None:
        """What is missing between the files before and this one."""
        since_ns, missing = self._since_ns, part.messages - self._count
        self._count += 1
        self._repeated_left = part.repeated
        self._checksum = crc32(message.data)
        self._since_ns = message.log_time_ns
        return Missing(since_ns, message.log_time_ns, missing) if missing else None
