"""MAV_CMD_INJECT_FAILURE: what the message calls a failure, as faults of the model.

PX4 takes it only with SYS_FAILURE_EN set.  ArduCopter has no such command (its simulator has SIM_
parameters); a vehicle that can fail is worth more than the likeness, so both personalities take
it.  What the model cannot do is UNSUPPORTED, never accepted and ignored.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import Final, TypeAlias

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.plant.faults import (
    AccelBias,
    BaroFault,
    CellsLost,
    Fault,
    GpsGlitch,
    GpsLost,
    GyroBias,
    MagFault,
    MotorFault,
    RcLost,
)
from vehicle_sim.services.commands.orders import Answer, Order
from vehicle_sim.services.commands.ports import CommandContext, CommandEntry, RefusedError
from vehicle_sim.wire.ids import Cmd


class Unit(IntEnum):
    """FAILURE_UNIT."""

    GYRO = 0
    ACCEL = 1
    MAG = 2
    BARO = 3
    GPS = 4
    BATTERY = 100
    MOTOR = 101
    RC_SIGNAL = 104


class Type(IntEnum):
    """FAILURE_TYPE."""

    OK = 0
    OFF = 1
    STUCK = 2
    GARBAGE = 3
    WRONG = 4


_WRONG_ACCEL: Final = (0.8, 0.0, 0.0)  # m/s^2
_WRONG_GYRO: Final = (0.05, 0.05, 0.0)  # rad/s
_WRONG_MAG: Final = (0.0, 0.1, 0.0)  # gauss: half of the field that shows north
_WRONG_BARO_M: Final = 10.0
_WRONG_GPS_M: Final = (15.0, 15.0, 0.0)
_WEAK_MOTOR: Final = 0.6
_FLAT_CELLS: Final = 4.0

Maker: TypeAlias = Callable[[int], tuple[Fault, ...]]
"""From the instance: 1 .. n."""

FAILURES: Final[dict[tuple[Unit, Type], Maker]] = {
    (Unit.GYRO, Type.OK): lambda _: (GyroBias(),),
    (Unit.GYRO, Type.WRONG): lambda _: (GyroBias(_WRONG_GYRO),),
    (Unit.ACCEL, Type.OK): lambda _: (AccelBias(),),
    (Unit.ACCEL, Type.WRONG): lambda _: (AccelBias(_WRONG_ACCEL),),
    (Unit.MAG, Type.OK): lambda _: (MagFault(),),
    (Unit.MAG, Type.OFF): lambda _: (MagFault(lost=True),),
    (Unit.MAG, Type.STUCK): lambda _: (MagFault(lost=True),),
    (Unit.MAG, Type.WRONG): lambda _: (MagFault(_WRONG_MAG),),
    (Unit.BARO, Type.OK): lambda _: (BaroFault(),),
    (Unit.BARO, Type.OFF): lambda _: (BaroFault(lost=True),),
    (Unit.BARO, Type.STUCK): lambda _: (BaroFault(lost=True),),
    (Unit.BARO, Type.WRONG): lambda _: (BaroFault(_WRONG_BARO_M),),
    (Unit.GPS, Type.OK): lambda _: (GpsLost(False), GpsGlitch()),
    (Unit.GPS, Type.OFF): lambda _: (GpsLost(),),
    (Unit.GPS, Type.WRONG): lambda _: (GpsLost(False), GpsGlitch(_WRONG_GPS_M)),
    (Unit.BATTERY, Type.OK): lambda _: (CellsLost(0.0),),
    (Unit.BATTERY, Type.WRONG): lambda _: (CellsLost(1.0),),
    (Unit.BATTERY, Type.OFF): lambda _: (CellsLost(_FLAT_CELLS),),
    (Unit.MOTOR, Type.OK): lambda motor: (MotorFault(motor, 1.0),),
    (Unit.MOTOR, Type.OFF): lambda motor: (MotorFault(motor, 0.0),),
    (Unit.MOTOR, Type.WRONG): lambda motor: (MotorFault(motor, _WEAK_MOTOR),),
    (Unit.RC_SIGNAL, Type.OK): lambda _: (RcLost(False),),
    (Unit.RC_SIGNAL, Type.OFF): lambda _: (RcLost(),),
}
"""A unit has one failure at a time: each cell says all that holds of the unit from then on."""

_MOTORS: Final = 4


def _inject(context: CommandContext, order: Order) -> Answer:
    if not context.vehicle.takes_failures:
        return Answer(Result.UNSUPPORTED, acked=False)  # as in life nobody is there to answer
    unit, kind, instance = (order.whole(value) for value in (order.p1, order.p2, order.p3))
    if unit is None or kind is None:
        raise RefusedError(Result.DENIED, "unit or type of the failure is no number")
    try:
        maker = FAILURES[Unit(unit), Type(kind)]
    except (ValueError, KeyError):
        raise RefusedError(Result.UNSUPPORTED, f"unit {unit} cannot fail by type {kind}") from None
    number = instance or 0
    if not 0 <= number <= (_MOTORS if unit == Unit.MOTOR else 1):
        raise RefusedError(Result.DENIED, f"there is no instance {number}")
    every = range(1, _MOTORS + 1) if unit == Unit.MOTOR and number == 0 else (number,)
    for each in every:
        for fault in maker(each):
            context.vehicle.inject(fault)
    return Answer(Result.ACCEPTED)


FAILURE: Final[dict[Cmd, CommandEntry]] = {Cmd.INJECT_FAILURE: CommandEntry(_inject)}
