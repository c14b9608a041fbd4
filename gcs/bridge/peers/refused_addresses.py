"""Frames of clients that are refused for an address: their sender's, or that of nobody here.

People are told, once for each client and reason.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, TypeAlias

from gcs.bridge.conversation.answers import acknowledgement, texts
from gcs.bridge.effects import BridgeEffect, LogLine, Reply
from gcs.bridge.peers.client import Client
from gcs.bridge.routing import target_of
from gcs.gate.effects import Level
from gcs.gate.refusal import Code
from gcs.protocol.effects import Address
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Component, MsgId, Result
from gcs.wire.messages import CommandInt, CommandLong

NAMESAKE_TOLD_NS: Final = 2_000_000_000
"""Between two texts to another bridge of our address."""


WhyNotOurs: TypeAlias = Callable[[int], str]
"""Of a system that is heard on a vehicle's link and is not flown here, why not; else empty."""


def nobody_else(_sysid: int) -> str:
    """Where nobody but the vehicles is heard."""
    return ""


class RefusedAddresses:
    """What the clients of one station were told of addresses."""

    def __init__(self, own: Address) -> None:
        """`own` is what the station calls itself."""
        self._own = own
        self._told_once: set[tuple[int, str]] = set()
        self._namesakes: dict[int, int] = {}
        """When a link was told that its sender's address is ours."""

    def gone(self, link: int) -> None:
        """Whoever was on that link has gone: the next one there was told nothing."""
        self._told_once = {told for told in self._told_once if told[0] != link}
        self._namesakes.pop(link, None)

    def of_sender(
        self, client: Client, frame: Frame, vehicles: Sequence[Address], now_ns: int
    ) -> list[BridgeEffect] | None:
        """What is told of a frame whose sender may not be a client; None where it may.

        A frame of a vehicle on a client's link is a loop of links, or somebody who plays it.
        """
        sender = Address(frame.sysid, frame.compid)
        if sender == self._own:
            reason = (
                f"it calls itself {frame.sysid}/{frame.compid}, as this station does; "
                "start one of the two with another --sysid"
            )
        elif sender in vehicles:
            reason = f"it calls itself {frame.sysid}/{frame.compid}, as the vehicle does"
        else:
            return None
        return [*self._once(client, reason), *self._namesake(client.link, frame, now_ns)]

    def of_target(
        self, client: Client, frame: Frame, vehicles: Sequence[Address], why_not_ours: str
    ) -> list[BridgeEffect]:
        """What is told of a frame for a system that is no vehicle of this station.

        One for nobody gets no answer of the protocol's, because that would be in the name of a
        component that is not there.  Where `why_not_ours` says why a vehicle that clients see is
        not flown here, a command for it is acknowledged.
        """
        sysid, compid = target_of(frame)
        here = ", ".join(str(each.sysid) for each in vehicles)
        heard = f"heard: system {here}" if here else "no vehicle's heartbeat was heard yet"
        reason = why_not_ours or f"there is no system {sysid} here ({heard})"
        told = self._once(client, reason)
        if told:
            # In a vehicle's name: QGroundControl shows no text of anybody else (from memory).
            speaker = vehicles[0] if vehicles else self._own
            messages = texts(Level.WARNING, f"refused: {reason}", sysid)
            told += [Reply(client.link, speaker, message) for message in messages]
        message = decode(frame) if why_not_ours else None
        if isinstance(message, CommandLong | CommandInt):
            asked = Address(sysid, compid or Component.AUTOPILOT1)
            sender = Address(frame.sysid, frame.compid)
            denied = acknowledgement(message.command, Result.DENIED, sender, Code.POLICY)
            told.append(Reply(client.link, asked, denied))
        return told

    def of_own(self, client: Client, frame: Frame) -> list[BridgeEffect]:
        """What is answered to a frame for this station itself: a command is not supported, also one
        for all components of its system.  Control is asked for of the vehicle (`control.py`)."""
        message = decode(frame)
        if not isinstance(message, CommandLong | CommandInt):
            return []
        if message.target_component not in (0, self._own.compid):
            return []
        sender = Address(frame.sysid, frame.compid)
        unsupported = Result.UNSUPPORTED, sender, Code.UNSUPPORTED
        return [Reply(client.link, self._own, acknowledgement(message.command, *unsupported))]

    def _namesake(self, link: int, frame: Frame, now_ns: int) -> list[BridgeEffect]:
        """Another bridge before this one, with the same address, is answered in our own name: it
        finds a second station of its address on its vehicle's link, and tells its people."""
        own = self._own
        if (frame.sysid, frame.compid) != (own.sysid, own.compid) or frame.msgid != MsgId.HEARTBEAT:
            return []
        last_ns = self._namesakes.get(link)
        if last_ns is not None and now_ns - last_ns < NAMESAKE_TOLD_NS:
            return []
        self._namesakes[link] = now_ns
        text = f"refused: {own.sysid}/{own.compid} is this station's address, too: use --sysid"
        return [Reply(link, own, message) for message in texts(Level.ERROR, text, 1)]

    def _once(self, client: Client, reason: str) -> list[BridgeEffect]:
        """A frame that nobody can be answered about: told once for each client and reason."""
        if (client.link, reason) in self._told_once:
            return []
        self._told_once.add((client.link, reason))
        return [LogLine(Level.WARNING, f"frames of {client.name} are refused: {reason}")]
