"""The bridge: what comes from MAVLink clients is judged, what is for them is sent on.

The composition: who is there (`client.py`), where frames go (`routing.py`), what each is
(`classes/`), what it asks for (`meaning/`), plans (`plans/`) and settings (`guard/`), and what is
answered (`dialogue.py`).  Frames of the vehicle's side are not decoded here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs import ipc
from gcs.bridge.classes import Kind, Row, command_row, message_row
from gcs.bridge.client import Client
from gcs.bridge.dialogue import From
from gcs.bridge.effects import (
    BridgeEffect,
    Joined,
    Lost,
    Notes,
    Says,
    ToLink,
    ToVehicle,
)
from gcs.bridge.meaning.meaning import Forward, Reject, Sample, Seen, Words
from gcs.bridge.meaning.translate import meaning_of
from gcs.bridge.routing import Routes, target_of
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Component, MsgId
from gcs.wire.messages import CommandInt, CommandLong, Message

FIRST_NUMBER: Final = 1000
"""MAVLink clients have numbers from here up; operators of the local socket have smaller ones."""

Look: TypeAlias = Callable[[], Seen | None]
"""How the vehicle is at this moment; None before one is heard."""


@dataclass(frozen=True, slots=True)
class Judged:
    """`refused`: the frame goes nowhere, and is recorded as refused."""

    refused: bool
    effects: list[BridgeEffect]


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
        self._told_once: set[tuple[int, str]] = set()
        self._in_control = 0

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

    def from_client(
        self, link: int, frame: Frame, vehicle: Address | None, look: Look, now_ns: int
    ) -> Judged:
        """A good frame on a client's link; `vehicle` is None before one is heard."""
        client = self._by_link[link]
        client.received.count(1, now_ns)
        reason = self._why_not_from(frame, vehicle)
        if reason:
            client.refused += 1
            return Judged(True, self._once(client, reason))
        client.heard_ns = now_ns
        effects = [] if client.joined else self._meet(client, frame)
        self._routes.heard(link, frame.sysid, frame.compid)
        sysid, compid = target_of(frame)
        at_vehicle = vehicle is not None and sysid in (0, vehicle.sysid)
        component = compid or (vehicle.compid if vehicle else Component.AUTOPILOT1)
        addressed = Address(vehicle.sysid if vehicle else sysid, component)
        asked_by = From(link, Address(frame.sysid, frame.compid), addressed)
        if not at_vehicle and (vehicle is not None or sysid):
            judged = self._elsewhere(client, asked_by, frame, sysid)
        else:
            judged = self._judge(client, asked_by, frame, look, now_ns)
        client.refused += judged.refused
        return Judged(judged.refused, [*effects, *judged.effects])

    def _why_not_from(self, frame: Frame, vehicle: Address | None) -> str:
        """Why no frame of this sender may come from a client; empty where it may.

        A frame of the vehicle on a client's link is a loop of links, or somebody who plays it.
        """
        if (frame.sysid, frame.compid) == (self._own.sysid, self._own.compid):
            return f"it calls itself {frame.sysid}/{frame.compid}, as this station does"
        if vehicle is not None and frame.sysid == vehicle.sysid and frame.compid == vehicle.compid:
            return f"it calls itself {frame.sysid}/{frame.compid}, as the vehicle does"
        return ""

    def _elsewhere(self, client: Client, asked_by: From, frame: Frame, sysid: int) -> Judged:
        """A frame for a system that is not our vehicle: another client, or nobody."""
        links = self._routes.between_clients(frame, asked_by.link)
        if links and message_row(frame.msgid).kind is not Kind.DENIED:
            return Judged(False, [ToLink(link, frame.raw) for link in links])
        if sysid == self._own.sysid:
            return Judged(False, [])
        return Judged(True, self._once(client, f"there is no system {sysid} here"))

    def _judge(
        self, client: Client, asked_by: From, frame: Frame, look: Look, now_ns: int
    ) -> Judged:
        """A frame for the vehicle, or for everybody."""
        row, message = message_row(frame.msgid), None
        if row.kind is not Kind.HARMLESS:
            message = decode(frame)
            if isinstance(message, CommandLong | CommandInt):
                row = command_row(message.command)
        match row.kind:
            case Kind.HARMLESS:
                return Judged(False, [ToVehicle(frame.raw)])
            case Kind.LOCAL:
                return self._local(frame, asked_by.link)
            case Kind.DENIED | Kind.CARRIER:
                refusal = Refusal(Code.POLICY, f"{row.name}: {row.why}")
                return self._refuse(client, asked_by, message, row, refusal, now_ns)
            case Kind.MOTION:
                return self._motion(client, asked_by, frame, message, row, look(), now_ns)
            case Kind.CONFIGURATION:
                refusal = Refusal(Code.POLICY, f"{row.name}: {row.why}")
                return self._refuse(client, asked_by, message, row, refusal, now_ns)

    def _local(self, frame: Frame, link: int) -> Judged:
        """What stays on this side: a heartbeat is for the other clients too."""
        if frame.msgid != MsgId.HEARTBEAT:
            return Judged(False, [])
        others = self._routes.between_clients(frame, link)
        return Judged(False, [ToLink(other, frame.raw) for other in others])

    def _motion(
        self,
        client: Client,
        asked_by: From,
        frame: Frame,
        message: Message | None,
        row: Row,
        seen: Seen | None,
        now_ns: int,
    ) -> Judged:
        """What would move the vehicle becomes a request to the gate."""
        if seen is None or message is None:
            what = "no vehicle is heard" if seen is None else f"{row.name} cannot be judged"
            code = Code.NO_VEHICLE if seen is None else Code.UNSUPPORTED
            return self._refuse(client, asked_by, message, row, Refusal(code, what), now_ns)
        dialogue = client.dialogue
        match meaning_of(message, seen):
            case Words(asks, note, _):
                told = dialogue.text(asked_by, Level.INFO, note, now_ns) if note else []
                return Judged(False, [*told, *dialogue.ask(asked_by, message, asks, now_ns)])
            case Sample() as sample:
                return Judged(False, [Says(client.number, _stream(sample))])
            case Forward():
                return Judged(False, [ToVehicle(frame.raw)])
            case Reject(refusal):
                return self._refuse(client, asked_by, message, row, refusal, now_ns)

    def _refuse(
        self,
        client: Client,
        asked_by: From,
        message: Message | None,
        row: Row,
        refusal: Refusal,
        now_ns: int,
    ) -> Judged:
        return Judged(True, client.dialogue.refuse(asked_by, message, row.name, refusal, now_ns))

    def _once(self, client: Client, reason: str) -> list[BridgeEffect]:
        """A frame that nobody can be answered about: told once for each client and reason."""
        if (client.link, reason) in self._told_once:
            return []
        self._told_once.add((client.link, reason))
        return [Notes(Level.WARNING, f"frames of {client.name} are refused: {reason}")]

    # --------------------------------------------------------------------- for clients

    def from_vehicle(self, frame: Frame, now_ns: int) -> list[int]:
        """The client links that a frame of the vehicle's side is sent on to, as it is."""
        links = self._routes.to_clients(frame)
        for link in links:
            self._by_link[link].sent.count(1, now_ns)
        return links

    def told(self, number: int, event: ipc.Event, now_ns: int) -> list[BridgeEffect]:
        """What the station tells a client as an operator."""
        client = self._by_number.get(number)
        return [] if client is None else client.dialogue.told(event, now_ns)

    def command_answered(self, operation: int, result: int, now_ns: int) -> list[BridgeEffect]:
        """The vehicle answered a command that the gate sent; `operation` is the request's."""
        effects: list[BridgeEffect] = []
        for client in self._by_number.values():
            effects += client.dialogue.command_answered(operation, result, now_ns)
        return effects

    def warn(self, level: Level, text: str, vehicle: Address, now_ns: int) -> list[BridgeEffect]:
        """Tell all clients what the gate warns of, in the vehicle's name."""
        return self._to_all(vehicle, level, f"gate: {text}", now_ns)

    def control_changed(
        self, number: int, name: str, vehicle: Address, now_ns: int
    ) -> list[BridgeEffect]:
        """Who is in control, all clients read; `number` is 0 for nobody."""
        self._in_control = number
        who = f"in control: {name}" if number else "nobody is in control"
        return self._to_all(vehicle, Level.INFO, f"gate: {who}", now_ns)

    def _to_all(self, vehicle: Address, level: Level, text: str, now_ns: int) -> list[BridgeEffect]:
        effects: list[BridgeEffect] = []
        for client in self._by_number.values():
            to = From(client.link, Address(0, 0), vehicle)
            effects += client.dialogue.text(to, level, text, now_ns)
        return effects

    def name(self, number: int) -> str:
        """Of a client that is there; else empty."""
        client = self._by_number.get(number)
        return client.name if client else ""

    def status(self, now_ns: int) -> list[ipc.BridgeClient]:
        """Every client, for a person to look at."""
        return [
            ipc.BridgeClient(
                client=client.number,
                link=client.link,
                name=client.name,
                ids=[f"{s}/{c}" for s, c in self._routes.components(client.link)],
                rx_hz=client.received.hz,
                tx_hz=client.sent.hz,
                refused=client.refused,
                dropped=client.dropped,
                in_control=client.joined and client.number == self._in_control,
                silent_s=(now_ns - client.heard_ns) / 1e9 if client.heard_ns else 0.0,
            )
            for client in self._by_link.values()
        ]


def _stream(sample: Sample) -> ipc.Stream:
    """A sample in the operator's frame."""
    return ipc.Stream(
        pos_enu=_enu(sample.pos_ned),
        v_enu=_enu(sample.v_ned),
        a_enu=_enu(sample.a_ned),
        yaw_deg=_degrees(sample.yaw_rad),
        yaw_rate_deg_s=_degrees(sample.yaw_rate_rad_s),
    )


def _enu(triple_ned: Vec3 | None) -> ipc.Maybe3 | None:
    """East, north, up; an axis that was left out (NaN) is None."""
    if triple_ned is None:
        return None
    east, north, up = (None if math.isnan(x) else x for x in enu_from_ned(triple_ned))
    return (east, north, up)


def _degrees(angle_rad: float | None) -> float | None:
    return None if angle_rad is None else math.degrees(angle_rad)
