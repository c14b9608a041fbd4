"""How much clients may have the vehicle send: a message, and all that they asked for together.

A vehicle sends one set of streams on a link, and the gate flies by what comes on it.  So what
SET_MESSAGE_INTERVAL and REQUEST_DATA_STREAM ask for is counted: a rate above the policy's
`message_hz` becomes that, and what would bring the sum above `messages_hz` is refused.  A message
that is asked for anew counts with its new rate; what the vehicle sends unasked does not count.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple, TypeAlias

import msgspec

from gcs.bridge.needed_rates import Rates
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd
from gcs.wire.messages import CommandInt, CommandLong, RequestDataStream

Command: TypeAlias = CommandLong | CommandInt

SLOWEST_HZ: Final = 0.1
"""What comes more seldom does not count."""
ALL_STREAMS: Final = 0
"""MAV_DATA_STREAM_ALL."""
KINDS_OF_ALL: Final = 25
"""An ArduCopter that was asked for all at 4 Hz sent 101 messages a second (recorded)."""
KINDS_OF_GROUP: Final = 5
"""Messages of one group, about: the other numbers of MAV_DATA_STREAM (from memory)."""
MODEST_HZ: Final = 4
"""As MAVProxy and DroneKit ask for groups."""
TEXT_OF_KEY: Final = "policy: bridge.messages_hz"


class _Asked(NamedTuple):
    """How many a second, and which client asked for it last."""

    hz: float
    client: int = 0


NOT_ASKED: Final = _Asked(0.0)


class AskedRates:
    """Of one vehicle, by all clients."""

    def __init__(self, rules: BridgeRules, needed_hz: Rates) -> None:
        """`needed_hz`: what the gate itself needs faster than `message_hz`, clients may have."""
        self._message_hz = rules.message_hz
        self._messages_hz = rules.messages_hz
        self._needed_hz = needed_hz
        self._messages: dict[int, _Asked] = {}
        """By message id."""
        self._groups: dict[int, _Asked] = {}
        """By MAV_DATA_STREAM; how many messages a second that is, about."""

    def command(self, command: Command, client: int = 0) -> Command | Refusal:
        """The same; of SET_MESSAGE_INTERVAL with an interval that is long enough.

        `client` is the number of the one who asks."""
        if command.command != Cmd.SET_MESSAGE_INTERVAL:
            return command
        msgid = int(command.param1) if 0.0 <= command.param1 < 1e8 else 0
        most_hz = max(self._message_hz, self._needed_hz.get(msgid, 0.0))
        wanted_hz = 1e6 / command.param2 if command.param2 > 0.0 else 0.0
        hz = min(wanted_hz, most_hz)
        others_hz = self._sum() - self._messages.get(msgid, NOT_ASKED).hz
        if others_hz + hz > self._messages_hz:
            return self._too_much(others_hz, hz)
        self._messages.pop(msgid, None)
        if hz >= SLOWEST_HZ:
            self._messages[msgid] = _Asked(hz, client)
        if hz == wanted_hz:
            return command
        return msgspec.structs.replace(command, param2=float(math.ceil(1e6 / hz)))

    def group(self, request: RequestDataStream, client: int = 0) -> RequestDataStream | Refusal:
        """The same, with a rate that is low enough."""
        rate_hz = min(request.req_message_rate, math.floor(self._message_hz))
        stream = request.req_stream_id
        hz = float(rate_hz * _kinds(stream)) if request.start_stop else 0.0
        others_hz = self._sum() - self._groups.get(stream, NOT_ASKED).hz
        if stream == ALL_STREAMS:
            others_hz = 0.0  # it sets the rate of everything
        if others_hz + hz > self._messages_hz:
            return self._too_much(others_hz, hz)
        if stream == ALL_STREAMS:
            self._messages.clear()
            self._groups.clear()
        self._groups[stream] = _Asked(hz, client)
        if rate_hz == request.req_message_rate:
            return request
        return msgspec.structs.replace(request, req_message_rate=rate_hz)

    def client_lost(self, client: int, vehicle: Address) -> list[CommandLong | RequestDataStream]:
        """What to send so that nothing comes any more that only this client had asked for faster.

        A message goes back to the vehicle's own rate, a group to a modest one: other clients may
        look at the same.  What the gate needs goes on.
        """
        sent: list[CommandLong | RequestDataStream] = []
        for msgid in [of for of, asked in self._messages.items() if asked.client == client]:
            del self._messages[msgid]
            if msgid not in self._needed_hz:
                sent.append(_at_its_own_rate(msgid, vehicle))
        for stream in [of for of, asked in self._groups.items() if asked.client == client]:
            modest_hz = float(MODEST_HZ * _kinds(stream))
            if self._groups[stream].hz > modest_hz:
                self._groups[stream] = _Asked(modest_hz)
                sent.append(RequestDataStream(MODEST_HZ, vehicle.sysid, vehicle.compid, stream, 1))
        return sent

    def _sum(self) -> float:
        return sum(asked.hz for kept in (self._messages, self._groups) for asked in kept.values())

    def _too_much(self, others_hz: float, hz: float) -> Refusal:
        return Refusal(
            Code.POLICY,
            f"{hz:.0f} messages a second more: clients have {others_hz:.0f} of the "
            f"{self._messages_hz:.0f} that they share ({TEXT_OF_KEY})",
            (("asked_hz", hz), ("others_hz", others_hz), ("max_hz", self._messages_hz)),
        )


def _kinds(stream: int) -> int:
    return KINDS_OF_ALL if stream == ALL_STREAMS else KINDS_OF_GROUP


def _at_its_own_rate(msgid: int, vehicle: Address) -> CommandLong:
    """SET_MESSAGE_INTERVAL with 0: the vehicle's default (common.xml)."""
    unused = (0.0,) * 5
    return CommandLong(
        float(msgid), 0.0, *unused, Cmd.SET_MESSAGE_INTERVAL, vehicle.sysid, vehicle.compid, 0
    )
