"""What a client waits for an answer to, and what it was answered last (`dialogue.py`)."""

from __future__ import annotations

from dataclasses import dataclass

from gcs import ipc
from gcs.bridge.conversation.repeated_requests import GUIDED_ITEM
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd


@dataclass(frozen=True, slots=True)
class From:
    """Who sent a message on which link, and which component it was for."""

    link: int
    source: Address
    addressed: Address


@dataclass(slots=True)
class Pending:
    """A command, or another message that asks, whose answer is not given yet."""

    asked_by: From
    command: int
    """MAV_CMD; GUIDED_ITEM; 0 for what is not acknowledged."""
    key: bytes
    rest: tuple[ipc.Ask, ...]
    """What is to be asked after it."""
    name: str
    """For texts."""
    word: str
    operation: int = 0
    answered: int | None = None
    """MAV_RESULT that the client was told."""
    vehicle_result: int | None = None
    answered_by: str = ""
    """The word whose completion answers the command, the end of the last being told as text; empty:
    the last answers it."""
    note: str = ""  # told when the first of what is asked is accepted

    @property
    def answered_once(self) -> bool:
        """Its sender is not told that it is under way.

        MISSION_ACK has no word for it.  And IN_PROGRESS, which no autopilot answers DO_SET_MODE,
        MAVSDK's `start_mission` takes for the last answer: it raises BUSY while the mission flies.
        After any other command MAVSDK waits for longer than its 2 s once it has read it.
        """
        words = (self.word, *(ask.word for ask in self.rest))
        starts = self.command == Cmd.DO_SET_MODE and "mission_start" in words
        return starts or self.command == GUIDED_ITEM


@dataclass(slots=True)
class Told:
    """The message that was accepted last, and until when its repetition is answered."""

    key: bytes
    until_ns: int
