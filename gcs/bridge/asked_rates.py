"""How much clients may have the vehicle send: a message, and all that they asked for together.

A vehicle sends one set of streams on a link, and the gate flies by what comes on it.  So what
SET_MESSAGE_INTERVAL and REQUEST_DATA_STREAM ask for is counted: a rate above the policy's
`message_hz` becomes that, and what would bring the sum above `messages_hz` is refused.  A message
that is asked for anew counts with its new rate; what the vehicle sends unasked does not count.
"""

from __future__ import annotations

import math
from typing import Final, TypeAlias

import msgspec

from gcs.bridge.needed_rates import Rates
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
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
TEXT_OF_KEY: Final = "policy: bridge.messages_hz"


class AskedRates:
    """Of one vehicle, by all clients."""

    def __init__(self, rules: BridgeRules, needed_hz: Rates) -> None:
        """`needed_hz`: what the gate itself needs faster than `message_hz`, clients may have."""
        self._message_hz = rules.message_hz
        self._messages_hz = rules.messages_hz
        self._needed_hz = needed_hz
        self._messages: dict[int, float] = {}
        """Message id -> Hz."""
        self._groups: dict[int, float] = {}
        """MAV_DATA_STREAM -> messages a second, about."""

    def command(self, command: Command) -> Command | Refusal:
        """The same; of SET_MESSAGE_INTERVAL with an interval that is long enough."""
        if command.command != Cmd.SET_MESSAGE_INTERVAL:
            return command
        msgid = int(command.param1) if 0.0 <= command.param1 < 1e8 else 0
        most_hz = max(self._message_hz, self._needed_hz.get(msgid, 0.0))
        wanted_hz = 1e6 / command.param2 if command.param2 > 0.0 else 0.0
        hz = min(wanted_hz, most_hz)
        others_hz = self._sum() - self._messages.get(msgid, 0.0)
        if others_hz + hz > self._messages_hz:
            return self._too_much(others_hz, hz)
        self._messages.pop(msgid, None)
        if hz >= SLOWEST_HZ:
            self._messages[msgid] = hz
        if hz == wanted_hz:
            return command
        return msgspec.structs.replace(command, param2=float(math.ceil(1e6 / hz)))

    def group(self, request: RequestDataStream) -> RequestDataStream | Refusal:
        """The same, with a rate that is low enough."""
        rate_hz = min(request.req_message_rate, math.floor(self._message_hz))
        stream = request.req_stream_id
        kinds = KINDS_OF_ALL if stream == ALL_STREAMS else KINDS_OF_GROUP
        hz = float(rate_hz * kinds) if request.start_stop else 0.0
        others_hz = self._sum() - self._groups.get(stream, 0.0)
        if stream == ALL_STREAMS:
            others_hz = 0.0  # it sets the rate of everything
        if others_hz + hz > self._messages_hz:
            return self._too_much(others_hz, hz)
        if stream == ALL_STREAMS:
            self._messages.clear()
            self._groups.clear()
        self._groups[stream] = hz
        if rate_hz == request.req_message_rate:
            return request
        return msgspec.structs.replace(request, req_message_rate=rate_hz)

    def _sum(self) -> float:
        return sum(self._messages.values()) + sum(self._groups.values())

    def _too_much(self, others_hz: float, hz: float) -> Refusal:
        return Refusal(
            Code.POLICY,
            f"{hz:.0f} messages a second more: clients have {others_hz:.0f} of the "
            f"{self._messages_hz:.0f} that they share ({TEXT_OF_KEY})",
            (("asked_hz", hz), ("others_hz", others_hz), ("max_hz", self._messages_hz)),
        )
