"""Commands that ask for messages and set their rates."""

from __future__ import annotations

import math
from typing import Final

from vehicle_sim.autopilot.interface import Result, StatusText
from vehicle_sim.effects import Send
from vehicle_sim.services.commands.orders import Answer, Order
from vehicle_sim.services.commands.ports import CommandContext, CommandEntry, Handler, RefusedError
from vehicle_sim.services.texts import in_chunks, status_text
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

MONITOR_US: Final = 5_000_000
FASTEST_US: Final = 3125
"""A stream at 0.8 of SCHED_LOOP_RATE's 400 Hz, by memory; recorded: 5000 us taken, 100 us not."""


def _send(context: CommandContext, order: Order, number: int, index: float = 0) -> Answer:
    requests = context.profile.requests
    if number in requests.accepted:
        return Answer(Result.ACCEPTED)
    if number in requests.never or not context.info.answers(number):
        raise RefusedError(requests.unknown, f"there is no message {number} to be had")
    built = context.info.requested(number, index)
    if not built and requests.nothing_yet is not Result.ACCEPTED:
        raise RefusedError(requests.nothing_yet, f"message {number} has nothing to say yet")
    return Answer(Result.ACCEPTED, tuple(Send(order.client.channel, message) for message in built))


def _number(order: Order) -> int:
    number = order.whole(order.p1)
    if number is None or number < 0:
        raise RefusedError(Result.DENIED, f"{order.p1} is no message number")
    return number


def _request_message(context: CommandContext, order: Order) -> Answer:
    number = _number(order)
    known = number not in context.profile.requests.never
    if number == m.IDS[m.MessageInterval] and known:
        wanted = order.whole(order.p2)
        return _interval(context, order, wanted if wanted is not None else -1)
    if number == m.IDS[m.AvailableModes] and known:
        # As recorded: who asks for the modes hears from then on whether they have changed.
        streams = context.streams[order.client.channel]
        streams.begin(m.IDS[m.AvailableModesMonitor], MONITOR_US, context.vehicle.time_ns)
    return _send(context, order, number, order.p2)


def _interval(context: CommandContext, order: Order, number: int) -> Answer:
    """MESSAGE_INTERVAL: 0 stands for a message that there is not."""
    interval_us = context.streams[order.client.channel].interval_us(number)
    if interval_us is None and context.profile.names_unknown_message:
        raise RefusedError(Result.FAILED, f"there is no message {number} to be had")
    message = m.MessageInterval(
        interval_us=interval_us if interval_us is not None else 0, message_id=number & 0xFFFF
    )
    return Answer(Result.ACCEPTED, (Send(order.client.channel, message),))


def _get_interval(context: CommandContext, order: Order) -> Answer:
    return _interval(context, order, _number(order))


def _set_interval(context: CommandContext, order: Order) -> Answer:
    """PX4's HEARTBEAT cannot be set; ArduPilot names a message that it does not have."""
    number = _number(order)
    if not (math.isfinite(order.p2) and order.p2 >= -1):
        raise RefusedError(Result.DENIED, f"{order.p2} us is no interval")
    streams = context.streams[order.client.channel]
    known = streams.interval_us(number) is not None
    if known and context.profile.refuses_fast_streams and 0 < order.p2 < FASTEST_US:
        return _too_fast(context, number)
    if streams.set_interval(number, order.p2, context.vehicle.time_ns):
        return Answer(Result.ACCEPTED)
    if not context.profile.names_unknown_message:
        raise RefusedError(Result.FAILED, f"message {number} cannot be had at a rate")
    text = status_text(context.profile, 6, f"No ap_message for mavlink id ({number})")
    return Answer(Result.DENIED, (Send(None, text),))


def _too_fast(context: CommandContext, number: int) -> Answer:
    text = f"Requested rate for message ID {number} too fast. Increase SCHED_LOOP_RATE"
    texts = in_chunks(context.profile, StatusText(6, text), context.vehicle.time_ns)
    return Answer(Result.DENIED, tuple(Send(None, each) for each in texts))


def _sends(kind: type[m.Message]) -> Handler:
    """A command of its own for one message, older than REQUEST_MESSAGE."""

    def handler(context: CommandContext, order: Order) -> Answer:
        return _send(context, order, m.IDS[kind])

    return handler


def _protocol_version(context: CommandContext, order: Order) -> Answer:
    """REQUEST_PROTOCOL_VERSION: PX4 takes it, and sends the message to REQUEST_MESSAGE alone."""
    if not context.profile.protocol_version_command:
        raise RefusedError(Result.UNSUPPORTED, "ArduPilot does not know the command")
    return Answer(Result.ACCEPTED)


INFO: Final[dict[Cmd, CommandEntry]] = {
    Cmd.REQUEST_MESSAGE: CommandEntry(_request_message),
    Cmd.SET_MESSAGE_INTERVAL: CommandEntry(_set_interval),
    Cmd.GET_MESSAGE_INTERVAL: CommandEntry(_get_interval),
    Cmd.GET_HOME_POSITION: CommandEntry(_sends(m.HomePosition)),
    Cmd.REQUEST_PROTOCOL_VERSION: CommandEntry(_protocol_version),
    Cmd.REQUEST_AUTOPILOT_CAPABILITIES: CommandEntry(_sends(m.AutopilotVersion)),
    Cmd.REQUEST_CAMERA_INFORMATION: CommandEntry(_sends(m.CameraInformation)),
    Cmd.REQUEST_STORAGE_INFORMATION: CommandEntry(_sends(m.StorageInformation)),
    Cmd.REQUEST_CAMERA_CAPTURE_STATUS: CommandEntry(_sends(m.CameraCaptureStatus)),
}
