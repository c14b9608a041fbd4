"""What all message classes have in common."""

from __future__ import annotations

from typing import ClassVar

import msgspec

from gcs.wire.ids import MsgId


class Message(msgspec.Struct, frozen=True, gc=False):
    """A MAVLink message with a class of its own.  Two are equal only if their classes are."""

    MSG_ID: ClassVar[MsgId]
