"""Peers that a client port with a key took in, before their first frame with a good signature.

Whoever reaches the port can make such a peer, as many as there are places for, over and over.  So
one is sent the heartbeats of the vehicles' autopilots alone: many clients say nothing before they
have heard one, and one whose signing clock is behind needs our timestamps.  Nothing of it is taken,
and the log has a few lines of all of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from gcs.bridge.effects import LogLine
from gcs.gate.effects import Level
from gcs.wire.frame import Frame
from gcs.wire.ids import Component, MsgId

TOLD_A_SECOND: Final = 5
"""Peers whose coming and going is told one by one; of more a second, how many they are."""


class Unverified:
    """Their links."""

    def __init__(self) -> None:
        self._told: dict[int, bool] = {}
        """By link: whether its coming was told, so that its going is, too."""
        self._came = 0
        """Since `second`."""

    def __contains__(self, link: int) -> bool:
        return link in self._told

    def __len__(self) -> int:
        return len(self._told)

    def come(self, link: int, name: str) -> list[LogLine]:
        """A peer is there, of whom nothing is known."""
        self._came += 1
        told = self._told[link] = self._came <= TOLD_A_SECOND
        text = f"{name} has connected, on link {link}, not verified: it is sent heartbeats alone "
        return [LogLine(Level.INFO, f"{text}until it signs with the clients' key")] if told else []

    def verify(self, link: int, name: str) -> list[LogLine]:
        """A frame of it was rightly signed: it is a client like others."""
        del self._told[link]
        return [
            LogLine(Level.INFO, f"{name}, on link {link}, is verified: it has the clients' key")
        ]

    def go(self, link: int, name: str, reason: str) -> list[LogLine]:
        """It is not there any more."""
        told = self._told.pop(link)
        return [LogLine(Level.INFO, f"{name}, not verified, has gone: {reason}")] if told else []

    def second(self) -> list[LogLine]:
        """Once a second: how many were not told."""
        more, self._came = self._came - TOLD_A_SECOND, 0
        if more <= 0:
            return []
        text = f"{more} more peers have connected within a second, not verified"
        return [LogLine(Level.WARNING, text)]

    def shares(self, frames: Sequence[Frame]) -> Iterable[tuple[int, Sequence[bytes]]]:
        """What each of them is sent of frames that came from the vehicle's side."""
        beats = [
            frame.raw
            for frame in frames
            if frame.msgid == MsgId.HEARTBEAT and frame.compid == Component.AUTOPILOT1
        ]
        return [(link, beats) for link in self._told] if beats else ()
