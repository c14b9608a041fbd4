"""PREFLIGHT_CALIBRATION and what belongs to it."""

from __future__ import annotations

from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.effects import Send
from vehicle_sim.services.commands.orders import Answer, Order
from vehicle_sim.services.commands.ports import CommandContext, CommandEntry, RefusedError
from vehicle_sim.services.texts import status_text
from vehicle_sim.wire.ids import Cmd

MOTOR_TEST_LONGEST_S: Final = 600.0


def _calibrate(context: CommandContext, order: Order) -> Answer:
    asked = (order.p1, order.p2, order.p3, order.p4, order.p5, order.p6, order.p7)
    result = context.vehicle.calibrate(asked)
    if result is None:
        return Answer(Result.UNSUPPORTED, acked=False)
    # ArduPilot, which calibrates before it answers, sends its one ack at the end.
    return Answer(result, acked=result is not Result.IN_PROGRESS)


def _lies_so(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.calibration_position(order.p1))


def _motor_test(context: CommandContext, order: Order) -> Answer:
    """Motor, throttle type, throttle, seconds."""
    if not 0.0 <= order.p4 <= MOTOR_TEST_LONGEST_S:
        raise RefusedError(Result.DENIED, f"{order.p4} s is no time for a motor test")
    return Answer(context.vehicle.test_motor(order.p4))


def _compass_by_yaw(context: CommandContext, order: Order) -> Answer:
    """FIXED_MAG_CAL_YAW: the compass is as good as before."""
    result = context.vehicle.calibrate_compass_by_yaw()
    texts = context.profile.compass_by_yaw_texts
    return Answer(result, tuple(Send(None, status_text(context.profile, *each)) for each in texts))


def _compass_calibration(context: CommandContext, order: Order) -> Answer:
    """DO_START_MAG_CAL and DO_CANCEL_MAG_CAL: nobody turns the vehicle, so none ever ends."""
    return Answer(Result.ACCEPTED)


def _accept_compass(context: CommandContext, order: Order) -> Answer:
    return Answer(Result.FAILED)


CALIBRATION: Final[dict[Cmd, CommandEntry]] = {
    Cmd.PREFLIGHT_CALIBRATION: CommandEntry(_calibrate),
    Cmd.ACCELCAL_VEHICLE_POS: CommandEntry(_lies_so, only="ardupilot"),
    Cmd.DO_START_MAG_CAL: CommandEntry(_compass_calibration, only="ardupilot"),
    Cmd.DO_ACCEPT_MAG_CAL: CommandEntry(_accept_compass, only="ardupilot"),
    Cmd.DO_CANCEL_MAG_CAL: CommandEntry(_compass_calibration, only="ardupilot"),
    Cmd.DO_MOTOR_TEST: CommandEntry(_motor_test, only="ardupilot"),
    Cmd.FIXED_MAG_CAL_YAW: CommandEntry(_compass_by_yaw),
}
