"""Operator control by MAVLink's own messages, as clients of the bridge see it.

A client asks for control, or gives it up, by MAV_CMD_REQUEST_OPERATOR_CONTROL (development.xml) or
by CHANGE_OPERATOR_CONTROL; both become the station's own words: its rules hold for everybody.
CONTROL_STATUS tells once a second who is in control, to those who have used that command: others do
not know the message, and count it as a broken frame.
"""

from __future__ import annotations

from typing import Final

from gcs import ipc
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import BridgeEffect, Reply
from gcs.bridge.peers.client import Exchange
from gcs.gate.refusal import Code, Refusal
from gcs.wire.ids import Cmd
from gcs.wire.messages import (
    ChangeOperatorControl,
    ChangeOperatorControlAck,
    CommandInt,
    CommandLong,
    ControlStatus,
    Message,
)

SYSTEM_MANAGER: Final = 1
TAKEOVER_ALLOWED: Final = 2
"""Of GCS_CONTROL_STATUS_FLAGS."""
NO_SECONDARIES: Final = (0,) * 10
NAME: Final = "REQUEST_OPERATOR_CONTROL"

_RELEASE, _REQUEST = 0.0, 1.0
"""MAV_CMD_REQUEST_OPERATOR_CONTROL's first parameter."""
_CHANGE_REQUEST, _CHANGE_RELEASE = 0, 1
"""CHANGE_OPERATOR_CONTROL.control_request: the other way round."""
_ACK, _NACK_IN_CONTROL = 0, 3
"""CHANGE_OPERATOR_CONTROL_ACK.ack."""


class ControlServer:
    """Who is in control, and whether that one lets others take over without being asked.

    As among the station's operators, everybody may take over, unless the client in control has
    said in its request that nobody may.
    """

    def __init__(self) -> None:
        self._owner = 0
        self._sysid = 0
        self._keeps: dict[int, From] = {}
        """Clients that let nobody take over, by number, and whom to ask then."""
        self._speakers: set[int] = set()
        """Clients that have used the command."""

    def handle(
        self, message: Message, client: Exchange, by: From, now_ns: int
    ) -> list[BridgeEffect]:
        """A client's message about control; nothing for any other message."""
        match message:
            case CommandLong() | CommandInt() if message.command == Cmd.REQUEST_OPERATOR_CONTROL:
                return self._command(message, client, by, now_ns)
            case ChangeOperatorControl(control_request=asked):
                return self._change(message, asked, client, by, now_ns)
            case _:
                return []

    def changed(self, number: int, sysid: int) -> None:
        """The operator `number` is in control, who calls itself `sysid`; 0 and 0: nobody is."""
        self._owner, self._sysid = number, sysid
        self._keeps = {n: by for n, by in self._keeps.items() if n == number}

    def forget(self, number: int) -> None:
        """This client is lost; its number is never given again."""
        self._keeps.pop(number, None)
        self._speakers.discard(number)

    @property
    def status(self) -> ControlStatus:
        """For those who understand it, in the vehicle's name."""
        flags = SYSTEM_MANAGER | (0 if self._owner in self._keeps else TAKEOVER_ALLOWED)
        return ControlStatus(flags, self._sysid, NO_SECONDARIES)

    def speaks(self, number: int) -> bool:
        """Whether a client understands CONTROL_STATUS, as far as it has shown."""
        return number in self._speakers

    def _kept(self, client: Exchange) -> bool:
        """Whether another client is in control that lets nobody take over."""
        return self._owner != client.number and self._owner in self._keeps

    def _command(
        self, message: CommandLong | CommandInt, client: Exchange, by: From, now_ns: int
    ) -> list[BridgeEffect]:
        dialogue, wish = client.dialogue, message.param1
        self._speakers.add(client.number)
        if wish == _RELEASE:
            return dialogue.ask(by, message, [ipc.Ask(0, "station_release")], now_ns)
        if wish != _REQUEST:
            text = f"{NAME}: {wish:g} is neither release (0) nor request (1)"
            return dialogue.refuse(by, message, NAME, Refusal(Code.POLICY, text), now_ns)
        if self._kept(client):
            text = f"system {self._sysid} is in control and lets nobody take over; it is asked"
            refusal = Refusal(Code.OTHER_OPERATOR, text)
            refused = dialogue.refuse(by, message, NAME, refusal, now_ns)
            return [*refused, self._to_owner(message, by)]
        if message.param2 == 1.0:
            self._keeps.pop(client.number, None)
        else:
            self._keeps[client.number] = by
        return dialogue.ask(by, message, [ipc.Ask(0, "station_take")], now_ns)

    def _to_owner(self, message: CommandLong | CommandInt, by: From) -> Reply:
        """The one in control is asked by the same command, in the vehicle's name."""
        owner = self._keeps[self._owner]
        request = CommandLong(
            param1=_REQUEST,
            param2=message.param2,
            param3=message.param3,
            param4=float(by.source.sysid),
            param5=0.0,
            param6=0.0,
            param7=0.0,
            command=Cmd.REQUEST_OPERATOR_CONTROL,
            target_system=owner.source.sysid,
            target_component=owner.source.compid,
            confirmation=0,
        )
        return Reply(owner.link, owner.addressed, request)

    def _change(
        self, message: Message, asked: int, client: Exchange, by: From, now_ns: int
    ) -> list[BridgeEffect]:
        """The older protocol: its pass key is not looked at, who may be here is the link's."""
        kept = asked == _CHANGE_REQUEST and self._kept(client)
        ack = ChangeOperatorControlAck(
            gcs_system_id=by.source.sysid,
            control_request=asked,
            ack=_NACK_IN_CONTROL if kept else _ACK,
        )
        told: list[BridgeEffect] = [Reply(by.link, by.addressed, ack)]
        if kept or asked not in (_CHANGE_REQUEST, _CHANGE_RELEASE):
            return told
        word = "station_take" if asked == _CHANGE_REQUEST else "station_release"
        return [*client.dialogue.ask(by, message, [ipc.Ask(0, word)], now_ns), *told]
