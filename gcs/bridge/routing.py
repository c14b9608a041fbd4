"""Which link a frame goes to, as MAVLink's routing rules say, without decoding it.

https://mavlink.io/en/guide/routing.html: a message without a target, or with target system 0, goes
to every link but the one that it came from; one for a system goes to the links on which that system
was heard.  Nothing goes back to where it came from, and what one side says does not come in on the
other: a system of the vehicle's side that is heard on a client's link is a loop, or a lie.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import repeat
from typing import Final

from gcs.wire.codec import FrameWriter
from gcs.wire.dialect import MESSAGES, MessageDef
from gcs.wire.frame import Frame, msgid_of, raw_of

EVERYBODY: Final = (0, 0)
MOST_COMPONENTS: Final = 255
"""Of one client's link; a router with more behind it, or a client that makes up names, is sent what
is for the others only where it is for everybody."""


def _offsets(definition: MessageDef) -> tuple[int, int] | None:
    """Where target_system and target_component stand in the payload; -1: the message has none."""
    at = {field.name: field.offset for field in definition.fields}
    system = "target" if definition.name == "MANUAL_CONTROL" else "target_system"
    if system not in at:
        return None
    return at[system], at.get("target_component", -1)


TARGETS: Final = {
    msgid: offsets
    for msgid, definition in MESSAGES.items()
    if (offsets := _offsets(definition)) is not None
}
"""Message id -> offsets of the target; a message that is not here is for everybody."""

_TARGETED: Final = frozenset(TARGETS)


def target_of(frame: Frame) -> tuple[int, int]:
    """Target system and component, 0 for all.  MAVLink 2 cuts zeros at the end of a payload."""
    offsets = TARGETS.get(frame.msgid)
    if offsets is None:
        return EVERYBODY
    payload = frame.payload
    return _byte(payload, offsets[0]), _byte(payload, offsets[1])


def _byte(payload: bytes, at: int) -> int:
    return payload[at] if 0 <= at < len(payload) else 0


def readdressed(frame: Frame, sysid: int) -> Frame:
    """A frame for all systems as one for that system: all else of it is the same.

    A message without a target is as it was.
    """
    offsets = TARGETS.get(frame.msgid)
    if offsets is None:
        return frame
    payload = bytearray(frame.payload.ljust(offsets[0] + 1, b"\0"))
    payload[offsets[0]] = sysid
    writer = FrameWriter(frame.sysid, frame.compid)
    writer.seq = frame.seq
    raw = writer.write_payload(frame.msgid, bytes(payload))
    return frame._replace(raw=raw, payload=bytes(payload), signature=b"")


class Routes:
    """Who was heard where."""

    def __init__(self) -> None:
        self._of_system: dict[int, set[int]] = {}
        self._of_link: dict[int, set[tuple[int, int]]] = {}

    def open(self, link: int) -> None:
        """A client's link is there; nobody was heard on it yet."""
        self._of_link[link] = set()

    def close(self, link: int) -> None:
        """It is gone, and so is whoever was heard on it alone."""
        self._of_link.pop(link, None)
        for links in self._of_system.values():
            links.discard(link)

    @property
    def links(self) -> list[int]:
        """The links of clients to which anything goes."""
        return list(self._of_link)

    def heard(self, link: int, sysid: int, compid: int) -> None:
        """A good frame of that component came in on a client's link."""
        here = self._of_link.get(link)
        if here is None:
            return
        if (sysid, compid) not in here and len(here) < MOST_COMPONENTS:
            here.add((sysid, compid))
            self._of_system.setdefault(sysid, set()).add(link)

    def was_heard(self, link: int, sysid: int, compid: int) -> bool:
        """Whether that component has ever spoken on a client's link."""
        return (sysid, compid) in self._of_link.get(link, ())

    def components(self, link: int) -> list[tuple[int, int]]:
        """Systems and components that were heard on a client's link."""
        return sorted(self._of_link.get(link, ()))

    def to_clients(self, frame: Frame) -> list[int]:
        """The client links that a frame of the vehicle's side goes to."""
        offsets = TARGETS.get(frame.msgid)
        if offsets is None:
            return list(self._of_link)
        sysid = _byte(frame.payload, offsets[0])
        if sysid == 0:
            return list(self._of_link)
        compid = _byte(frame.payload, offsets[1])
        return [
            link
            for link in sorted(self._of_system.get(sysid, ()))
            if compid == 0 or (sysid, compid) in self._of_link[link]
        ]

    def shares(self, frames: Sequence[Frame]) -> Iterable[tuple[int, Sequence[bytes]]]:
        """The same of frames that came together: client links, and what goes to each, in order."""
        if not self._of_link:
            return ()
        if _TARGETED.isdisjoint(map(msgid_of, frames)):
            everything = [*map(raw_of, frames)]
            return [*zip(self._of_link, repeat(everything))] if frames else ()
        shares: dict[int, list[bytes]] = {}
        for frame in frames:
            for link in self.to_clients(frame):
                shares.setdefault(link, []).append(frame.raw)
        return shares.items()

    def between_clients(self, frame: Frame, came_from: int) -> list[int]:
        """The other client links that a client's frame goes to."""
        return [link for link in self.to_clients(frame) if link != came_from]
