"""The keys of an audit: nobody has them, and the record tells whose signatures were right.

All else about signatures is done again: link ids, timestamps, and what comes a second time or too
late.  Only the six bytes of a signature itself cannot be made, and are not compared.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from gcs.audit.messages import Stored
from gcs.config import StationConfig
from gcs.report import Direction
from gcs.station.signatures import Keys
from gcs.wire.frame import SIGNED
from gcs.wire.signing import Reason

SIGNATURE: Final = 6
_DIRECTION, _MAGIC, _FLAGS = 1, 2, 4
"""Where a recorded frame has them (`gcs.record.ros1`)."""


class RecordedKey:
    """In place of a key: knows the frames of a turn that were recorded as signed with another."""

    def __init__(self) -> None:
        self.forged: Collection[bytes] = ()

    def signature(self, stamped: bytes) -> bytes:
        return bytes(SIGNATURE)

    def has_signed(self, stamped: bytes, signature: bytes) -> bool:
        return stamped + signature not in self.forged


def keys_of(config: StationConfig, key: RecordedKey) -> Keys:
    """`key` wherever the recorded station had one."""
    return Keys(
        vehicle=key if config.vehicle_key_path else None,
        client=key if config.client_key_path else None,
    )


def forged(messages: Collection[Stored]) -> list[bytes]:
    """Of the messages of a turn, the frames that were refused as signed with another key."""
    return [m.raw for m in messages if m.is_garbage and m.why == Reason.WRONG_KEY]


def without_signature(message: Stored) -> Stored:
    """A frame that was sent without the six bytes of its signature; all else as it is."""
    data = message.data
    if not message.is_frame or data[_DIRECTION] != Direction.SENT:
        return message
    if data[_MAGIC] != 0xFD or not data[_FLAGS] & SIGNED:
        return message
    return message._replace(data=data[:-SIGNATURE])
