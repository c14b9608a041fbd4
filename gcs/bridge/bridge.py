"""The bridge: what comes from MAVLink clients is judged, what is for them is sent on.

The composition: who is there (`client.py`), where frames go (`routing.py`), what each is
(`classes/`), what it asks for (`meaning/`), plans (`plans/`) and settings (`guard/`), and what is
answered (`dialogue.py`).  Frames of the vehicle's side are not decoded here.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from gcs import ipc
from gcs.bridge.classes import Kind, Row, command_row, message_row
from gcs.bridge.client import Client
from gcs.bridge.dialogue import From
from gcs.bridge.effects import (
    Answers,
    BridgeEffect,
    Joined,
    Lost,
    Notes,
    Says,
    ToLink,
    ToVehicle,
)
from gcs.bridge.meaning import Forward, Reject, Sample, Seen, Words, meaning_of
from gcs.bridge.routing import Routes, target_of
from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Component, MsgId
from gcs.wire.messages import CommandInt, CommandLong, Message

FIRST_NUMBER: Final = 1000
"""MAVLink clients have numbers from here up; operators of the local socket have smaller ones."""

SERIOUS: Final = Level.WARNING
"""Lines of the gate from this level up are sent to all clients as STATUSTEXT."""
GATE_NODE: Final = "state_and_safety"


class Bridge:
    """All MAVLink clients of one station, and its vehicle, whose system id is `vehicle.sysid`."""

    def __init__(self, own: Address, silent_ns: int) -> None:
        """`own` is what the station calls itself; a client that is silent for `silent_ns` is lost."""
        self._own = own
        self._silent_ns = silent_ns
        self._routes = Routes()
        self._by_link: dict[int, Client] = {}
        self._by_number: dict[int, Client] = {}
        self._next_number = FIRST_NUMBER
        self._loops_told: set[int] = set()

    # --------------------------------------------------------------------- come and go

    def came(self, link: int, name: str) -> list[BridgeEffect]:
        """A peer is there; it is a client with its first good frame."""
        self._routes.open(link)
        self._by_link[link] = Client(link, 0, name)
        return [Notes(Level.INFO, f"{name} has connected, on link {link}")]

    def gone(self, link: int, reason: str) -> list[BridgeEffect]:
        """It has gone, and its link's number is free."""
        self._routes.close(link)
        client = self._by_link.pop(link, None)
        if client is None:
            return []
        note = Notes(Level.INFO, f"{client.name} has gone: {reason}")
        return [*self._lose(client, reason), note]

    def flooded(self, link: int, dropped: int) -> list[BridgeEffect]:
        """It sends more than it may; so many datagrams were not looked at."""
        client = self._by_link.get(link)
        if client is None:
            return []
        client.dropped += dropped
        text = f"{client.name} sends too much: {dropped} datagrams dropped"
        return [Notes(Level.WARNING, text)]

    def second(self, now_ns: int) -> list[BridgeEffect]:
        """Once a second: whoever says nothing any more is lost."""
        effects: list[BridgeEffect] = []
        for client in self._by_link.values():
            client.received.count(0, now_ns)
            client.sent.count(0, now_ns)
            if client.joined and now_ns - client.heard_ns > self._silent_ns:
                effects += self._lose(client, f"silent for {self._silent_ns / 1e9:.0f} s")
        return effects

    def _lose(self, client: Client, reason: str) -> list[BridgeEffect]:
        if not client.joined:
            return []
        client.joined = False
        del self._by_number[client.number]
        return [Lost(client.number, reason)]

    def _meet(self, client: Client, frame: Frame) -> list[BridgeEffect]:
        client.number, self._next_number = self._next_number, self._next_number + 1
        client.__post_init__()  # what it asked for before it was lost is over
        client.joined = True
        self._by_number[client.number] = client
        return [Joined(client.number, f"MAVLink {frame.sysid}/{frame.compid}, {client.name}")]

    # -------------------------------------------------------------------- from clients

    def why_not_from(self, link: int, frame: Frame, vehicle: Address | None) -> str:
        """Why no frame of this sender may come from a client's side; empty where it may."""
        if (frame.sysid, frame.compid) == (self._own.sysid, self._own.compid):
            return f"it calls itself {frame.sysid}/{frame.compid}, as this station does"
        if vehicle is not None and frame.sysid == vehicle.sysid and frame.compid == vehicle.compid:
            return f"it calls itself {frame.sysid}/{frame.compid}, as the vehicle does"
        return ""
