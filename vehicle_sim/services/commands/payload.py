"""Commands for what is carried, and for outputs: mostly for equipment that is not there.

As recorded of vehicles that carry nothing: ArduCopter fails what needs a gimbal or a gripper and
accepts what only sets an output; PX4 sends no ack where nobody listens
(`Profile.ignored_commands`).
"""

from __future__ import annotations

from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.effects import Send
from vehicle_sim.services.commands.orders import Answer, Order
from vehicle_sim.services.commands.ports import CommandContext, CommandEntry
from vehicle_sim.services.texts import status_text
from vehicle_sim.wire.ids import Cmd

_ACTUATORS: Final = (range(1, 13), range(33, 41))
"""Of ACTUATOR_OUTPUT_FUNCTION what PX4 1.14 has: motors and servos, how many from memory."""
_PX4_FUNCTIONS: Final = 1000.0  # from here on the parameter is one of PX4's own numbers


def _accept(context: CommandContext, order: Order) -> Answer:
    """An output without anything on it."""
    return Answer(Result.ACCEPTED)


def _fail(context: CommandContext, order: Order) -> Answer:
    return Answer(Result.FAILED)


def _set_servo(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.set_servo(order.p1, order.p2))


def _repeat_servo(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.repeat_servo(order.p1, order.p2, order.p3, order.p4))


def _set_relay(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.set_relay(order.p1, order.p2))


def _repeat_relay(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.repeat_relay(order.p1, order.p2, order.p3))


def _shoot(context: CommandContext, order: Order) -> Answer:
    """DO_DIGICAM_CONTROL: p5 = 1 takes a picture; it is answered alike without one."""
    if order.p5 == 1.0:
        context.vehicle.capture_image(0.0, 1)
    return Answer(Result.ACCEPTED)


def _actuator_test(context: CommandContext, order: Order) -> Answer:
    """PX4 tests no actuator while armed; the motors of this vehicle stand still either way.

    What it has not got is not answered: recorded for p5 of 0, 16, 17, 48, 49 and 101.
    """
    if not (order.p5 >= _PX4_FUNCTIONS or any(order.p5 in known for known in _ACTUATORS)):
        return Answer(Result.UNSUPPORTED, acked=False)
    return Answer(Result.DENIED if context.vehicle.armed else Result.ACCEPTED)


def _autotune(context: CommandContext, order: Order) -> Answer:
    """As recorded on the ground, to start and to stop it; no tuning follows."""
    return Answer(Result.IN_PROGRESS)


def _banner(context: CommandContext, order: Order) -> Answer:
    texts = (Send(None, status_text(context.profile, 6, text)) for text in context.profile.banner)
    return Answer(Result.ACCEPTED, tuple(texts))


_COPTER: Final = {
    Cmd.DO_REPEAT_SERVO: _repeat_servo,
    Cmd.DO_SET_RELAY: _set_relay,
    Cmd.DO_REPEAT_RELAY: _repeat_relay,
    Cmd.DO_SET_SERVO: _set_servo,
    Cmd.DO_SET_CAM_TRIGG_DIST: _accept,
    Cmd.DO_AUX_FUNCTION: _accept,
    Cmd.DO_DIGICAM_CONTROL: _shoot,
    Cmd.NAV_VTOL_TAKEOFF: _fail,
    Cmd.DO_MOUNT_CONTROL: _fail,
    Cmd.DO_GRIPPER: _fail,
    Cmd.DO_WINCH: _fail,  # by memory: there is none (WINCH_TYPE 0)
    Cmd.DO_GIMBAL_MANAGER_PITCHYAW: _fail,
    Cmd.VIDEO_START_CAPTURE: _fail,
    Cmd.DO_SEND_BANNER: _banner,
}

PAYLOAD: Final[dict[Cmd, CommandEntry]] = {
    **{command: CommandEntry(handler, only="ardupilot") for command, handler in _COPTER.items()},
    Cmd.DO_SET_ACTUATOR: CommandEntry(_accept, only="px4"),
    Cmd.ACTUATOR_TEST: CommandEntry(_actuator_test, only="px4"),
    Cmd.DO_AUTOTUNE_ENABLE: CommandEntry(_autotune, only="px4"),
    Cmd.LOGGING_START: CommandEntry(_accept, only="px4"),
}
