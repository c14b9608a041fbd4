"""How much clients may have the vehicle send: a message, and all that they asked for together.

A vehicle sends one set of streams on a link, and the gate flies by what comes on it.  So what
SET_MESSAGE_INTERVAL and REQUEST_DATA_STREAM ask for is counted: a rate above the policy's
`message_hz` becomes that, and what would bring the sum above `messages_hz` is refused.  A message
that is asked for anew counts with its new rate; what the vehicle sends unasked does not count.

One client may have half of what the others leave it, so that there is always room for the next;
what makes nothing more is never refused.

A stream group does not end the intervals of single messages that are in no group (recorded, see
`OF_ALL`), so these go on counting whatever groups are asked for.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping
from typing import Final, NamedTuple, TypeAlias

import msgspec

from gcs.bridge.rates.needed_rates import Rates
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.dialect import MESSAGES
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
_NAMES_OF_ALL: Final = (
    *("AHRS", "AHRS2", "ATTITUDE", "BATTERY_STATUS", "EKF_STATUS_REPORT", "ESC_TELEMETRY_1_TO_4"),
    *("GLOBAL_POSITION_INT", "GPS_RAW_INT", "LOCAL_POSITION_NED", "MEMINFO", "MISSION_CURRENT"),
    *("NAV_CONTROLLER_OUTPUT", "POWER_STATUS", "RAW_IMU", "RC_CHANNELS", "SCALED_IMU2"),
    *("SCALED_IMU3", "SCALED_PRESSURE", "SCALED_PRESSURE2", "SIMSTATE", "SYSTEM_TIME"),
    *("SYS_STATUS", "TERRAIN_REPORT", "VIBRATION", "WIND"),
)
OF_ALL: Final = frozenset(
    msgid for msgid, message in MESSAGES.items() if message.name in _NAMES_OF_ALL
)
"""What a request for all sets anew on an ArduCopter, whatever interval it had.

Recorded of 4.7 (scenarios_arducopter.json, K1_small_services, "streams after REQUEST_DATA_STREAM"):
after all at 2 Hz these came at 2 Hz, LOCAL_POSITION_NED among them, which had come at 200 before;
POSITION_TARGET_LOCAL_NED, EXTENDED_SYS_STATE and HEARTBEAT kept their own intervals.
"""
OF_WHAT_IS_LEFT: Final = 0.5
"""What one client may have of the policy's `messages_hz` less what the others have asked for."""
TEXT_OF_KEY: Final = "policy: bridge.messages_hz"


class _Asked(NamedTuple):
    """How many a second, and which client asked for it last."""

    hz: float
    client: int = 0


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
        messages = self._but((msgid,))
        refusal = self._too_much(hz, client, messages, self._groups)
        if refusal is not None:
            return refusal
        if hz >= SLOWEST_HZ:
            messages[msgid] = _Asked(hz, client)
        self._messages = messages
        if hz == wanted_hz:
            return command
        return msgspec.structs.replace(command, param2=float(math.ceil(1e6 / hz)))

    def group(
        self, request: RequestDataStream, client: int = 0, *, obeyed: bool = True
    ) -> RequestDataStream | Refusal:
        """The same, with a rate that is low enough.

        `obeyed`: the vehicle acts on it.  A PX4 does not (recorded of 1.14), so there the
        intervals of single messages are as they were; the request counts all the same.
        """
        rate_hz = min(request.req_message_rate, math.floor(self._message_hz))
        stream = request.req_stream_id
        hz = float(rate_hz * _kinds(stream)) if request.start_stop else 0.0
        if stream == ALL_STREAMS:
            groups: dict[int, _Asked] = {}
            messages = self._but(OF_ALL) if obeyed else self._messages
        else:
            groups = {of: asked for of, asked in self._groups.items() if of != stream}
            messages = self._messages
        refusal = self._too_much(hz, client, messages, groups)
        if refusal is not None:
            return refusal
        self._messages, self._groups = dict(messages), {**groups, stream: _Asked(hz, client)}
        if rate_hz == request.req_message_rate:
            return request
        return msgspec.structs.replace(request, req_message_rate=rate_hz)

    def _but(self, left_out: Container[int]) -> dict[int, _Asked]:
        """The single messages without those."""
        return {of: asked for of, asked in self._messages.items() if of not in left_out}

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

    def _too_much(self, hz: float, client: int, *kept: Mapping[int, _Asked]) -> Refusal | None:
        """Why a client may not have so many messages a second more, beside those that are kept."""
        kept_hz = _sum(*kept)
        own_hz = sum(a.hz for each in kept for a in each.values() if a.client == client)
        share_hz = OF_WHAT_IS_LEFT * max(0.0, self._messages_hz - (kept_hz - own_hz))
        no_more = kept_hz + hz <= _sum(self._messages, self._groups)
        if own_hz + hz <= share_hz or no_more:
            return None
        return Refusal(
            Code.POLICY,
            f"{hz:.0f} messages a second more: this client has {own_hz:.0f} of the "
            f"{share_hz:.0f} that it may, half of what the others leave of "
            f"{self._messages_hz:.0f} ({TEXT_OF_KEY})",
            (
                ("asked_hz", hz),
                ("own_hz", own_hz),
                ("share_hz", share_hz),
                ("others_hz", kept_hz - own_hz),
                ("max_hz", self._messages_hz),
            ),
        )


def _sum(*kept: Mapping[int, _Asked]) -> float:
    return sum(asked.hz for each in kept for asked in each.values())


def _kinds(stream: int) -> int:
    return KINDS_OF_ALL if stream == ALL_STREAMS else KINDS_OF_GROUP


def _at_its_own_rate(msgid: int, vehicle: Address) -> CommandLong:
    """SET_MESSAGE_INTERVAL with 0: the vehicle's default (common.xml)."""
    unused = (0.0,) * 5
    return CommandLong(
        float(msgid), 0.0, *unused, Cmd.SET_MESSAGE_INTERVAL, vehicle.sysid, vehicle.compid, 0
    )
