"""What the protocol machines are told and what they answer: frozen values, closed unions.

Every machine is `handle(input, now_ns) -> list[effect]` and a `deadline_ns` without side effects:
at that time at the latest it wants a `Wake`.  None means that it waits for nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.wire.ids import MissionType
from gcs.wire.messages import CommandInt, CommandLong, Message, MissionItemInt


@dataclass(frozen=True, slots=True)
class Address:
    """A component on the network.  0 means everybody."""

    sysid: int
    compid: int

    def includes(self, sysid: int, compid: int) -> bool:
        """Whether what comes from there can be an answer to what went here."""
        return self.sysid in (0, sysid) and self.compid in (0, compid)


# ----------------------------------------------------------------------------- inputs


@dataclass(frozen=True, slots=True)
class Heard:
    """A message came from `sysid`/`compid`."""

    sysid: int
    compid: int
    message: Message


@dataclass(frozen=True, slots=True)
class Wake:
    """`deadline_ns` has passed (or not yet: a machine looks at `now_ns`)."""


@dataclass(frozen=True, slots=True)
class Cancel:
    """The transfer is not wanted any more, because of `why`."""

    why: str = "cancelled"


@dataclass(frozen=True, slots=True)
class Submit:
    """Send a command.  `token` comes back in `Finished`.

    No try leaves after `deadline_ns` (a late arm or take-off is dangerous); `tries` is 1 for what
    must not be done twice, and None for what is repeated until its deadline.  `urgent` takes the
    place of one with the same id that is in flight, instead of waiting behind it: a hold must not
    wait for the answer to a mode change.
    """

    token: int
    command: CommandLong | CommandInt
    deadline_ns: int
    tries: int | None = 4
    urgent: bool = False


@dataclass(frozen=True, slots=True)
class Withdraw:
    """The command of `token` is not wanted any more: no further try of it leaves."""

    token: int


# ---------------------------------------------------------------------------- effects


@dataclass(frozen=True, slots=True)
class Send:
    """Put this message on the wire."""

    message: Message


@dataclass(frozen=True, slots=True)
class Finished:
    """A command ended, exactly once: with MAV_RESULT `result`, or None and the reason in `text`."""

    token: int
    command: int
    result: int | None
    text: str = ""


@dataclass(frozen=True, slots=True)
class InProgress:
    """The vehicle works on it; `percent` None = it does not say."""

    token: int
    command: int
    percent: int | None


@dataclass(frozen=True, slots=True)
class LateAck:
    """An answer to a command that had ended, and another one than it ended with.  Only news."""

    token: int
    command: int
    result: int
    ended_with: int | None


@dataclass(frozen=True, slots=True)
class TransferProgress:
    """`done` of `total` items have crossed."""

    done: int
    total: int


@dataclass(frozen=True, slots=True)
class TransferDone:
    """The plan is on board (upload), here (download) or gone (clear: no items)."""

    mission_type: MissionType
    items: tuple[MissionItemInt, ...]


@dataclass(frozen=True, slots=True)
class TransferFailed:
    """MAV_MISSION_RESULT `result`, or None for no answer and for a transfer that we cancelled."""

    mission_type: MissionType
    result: int | None
    text: str


CommandEffect: TypeAlias = Send | Finished | InProgress | LateAck
TransferEffect: TypeAlias = Send | TransferProgress | TransferDone | TransferFailed
