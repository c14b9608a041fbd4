"""INJECT_FAILURE cell by cell: what is accepted changes the flight, all else is UNSUPPORTED."""

from __future__ import annotations

from math import nan

import pytest

from tests.unit.faults.stage import INJECT, Stage, aloft, far
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.services.commands.failures import FAILURES, Type, Unit
from vehicle_sim.wire import messages as m

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)

UNITS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 100, 101, 102, 103, 104, 105, 999)  # FAILURE_UNIT, and no unit
TYPES = (0, 1, 2, 3, 4, 5, 6, 7, 99)  # FAILURE_TYPE, and no type


TAKES_FAILURES: dict[Personality, dict[str, float]] = {
    "px4": {"SYS_FAILURE_EN": 1.0},
    "ardupilot": {},
}


def ready(personality: Personality) -> Stage:
    return Stage(personality, parameters=TAKES_FAILURES[personality])


@either
def test_every_pair_of_unit_and_type_is_answered_as_the_table_says(
    personality: Personality,
) -> None:
    stage = ready(personality)
    stage.run(2.0)
    for unit in UNITS:
        for kind in TYPES:
            known = unit in set(Unit) and kind in set(Type)
            accepted = known and (Unit(unit), Type(kind)) in FAILURES
            expected = Result.ACCEPTED if accepted else Result.UNSUPPORTED
            assert stage.command(INJECT, unit, kind) == expected, (unit, kind)


def test_px4_takes_failures_only_with_sys_failure_en() -> None:
    stage = Stage("px4", parameters={"SYS_FAILURE_EN": 0})
    stage.run(2.0)
    assert stage.answers(INJECT, Unit.GPS, Type.OFF) == [], "PX4 does not answer"
    stage.run(0.5)
    assert stage.last(m.GpsRawInt).fix_type == 3
    stage.vehicle.parameters.set("SYS_FAILURE_EN", 1)
    assert stage.command(INJECT, Unit.GPS, Type.OFF) == Result.ACCEPTED
    stage.run(0.5)
    assert stage.last(m.GpsRawInt).fix_type == 1


@pytest.mark.parametrize(
    "params",
    [(nan, 0.0, 0.0), (4.0, nan, 0.0), (4.5, 1.0, 0.0), (101.0, 1.0, 5.0), (4.0, 1.0, 2.0)],
)
def test_what_is_no_unit_type_or_instance_is_denied(params: tuple[float, float, float]) -> None:
    stage = ready("px4")
    stage.run(2.0)
    assert stage.command(INJECT, *params) == Result.DENIED


@pytest.mark.parametrize(("unit", "kind"), [pair for pair in FAILURES if pair[1] is not Type.OK])
def test_each_failure_shows_in_the_vehicle_and_ok_ends_it(unit: Unit, kind: Type) -> None:
    stage = ready("ardupilot")
    stage.run(1.0)

    def wrong() -> object:
        body, sensed = stage.vehicle.blocks.body, stage.vehicle.blocks.sensed
        return (
            tuple(getattr(sensed, name) for name in sensed.__slots__ if "_off_" in name),
            (sensed.mag_lost, sensed.baro_lost, sensed.gps_lost, body.cells_lost),
            (body.health_1, body.health_2, body.health_3, body.health_4),
            stage.vehicle.parts.radio.deaf,
        )

    sound = wrong()
    assert stage.command(INJECT, unit, kind) == Result.ACCEPTED
    assert wrong() != sound
    assert stage.command(INJECT, unit, Type.OK) == Result.ACCEPTED
    assert wrong() == sound


@either
def test_a_unit_has_one_failure_and_leaves_the_others_theirs(personality: Personality) -> None:
    stage = ready(personality)
    stage.run(1.0)
    sensed = stage.vehicle.blocks.sensed
    for unit, kind in ((Unit.ACCEL, Type.WRONG), (Unit.GYRO, Type.WRONG), (Unit.GPS, Type.OFF)):
        assert stage.command(INJECT, unit, kind) == Result.ACCEPTED
    assert stage.command(INJECT, Unit.GYRO, Type.OK) == Result.ACCEPTED
    assert sensed.gyro_off_x == 0.0
    assert sensed.accel_off_x != 0.0, "the accelerometer is still ill"
    assert stage.command(INJECT, Unit.GPS, Type.WRONG) == Result.ACCEPTED
    assert (sensed.gps_lost, sensed.gps_off_n != 0.0) == (False, True)


def test_one_motor_or_all_of_them() -> None:
    stage = ready("px4")
    stage.run(1.0)
    body = stage.vehicle.blocks.body
    assert stage.command(INJECT, Unit.MOTOR, Type.OFF, 3) == Result.ACCEPTED
    assert (body.health_1, body.health_2, body.health_3, body.health_4) == (1.0, 1.0, 0.0, 1.0)
    assert stage.command(INJECT, Unit.MOTOR, Type.WRONG, 0) == Result.ACCEPTED
    assert {body.health_1, body.health_2, body.health_3, body.health_4} == {0.6}


# ------------------------------------------------------------------------------- in flight


@either
def test_a_motor_off_is_a_crash(personality: Personality) -> None:
    stage = aloft(personality, parameters=TAKES_FAILURES[personality])
    assert stage.command(INJECT, Unit.MOTOR, Type.OFF, 2) == Result.ACCEPTED
    assert stage.until(lambda: stage.up_m < 0.2, 8.0) < 6.0


@either
@pytest.mark.parametrize(
    ("unit", "kind"),
    [
        (Unit.GYRO, Type.WRONG),
        (Unit.ACCEL, Type.WRONG),
        (Unit.MAG, Type.OFF),
        (Unit.MAG, Type.WRONG),
        (Unit.BARO, Type.OFF),
        (Unit.BARO, Type.WRONG),
        (Unit.MOTOR, Type.WRONG),
        (Unit.BATTERY, Type.WRONG),
        (Unit.RC_SIGNAL, Type.OFF),
    ],
)
def test_it_flies_through_the_others_and_home_when_they_end(
    personality: Personality, unit: Unit, kind: Type
) -> None:
    told_only = {"COM_LOW_BAT_ACT": 0} if personality == "px4" else {}
    stage = aloft(personality, parameters={**TAKES_FAILURES[personality], **told_only})
    at = stage.truth.pos_ned
    assert stage.command(INJECT, unit, kind) == Result.ACCEPTED
    stage.run(12.0)
    assert stage.armed
    assert stage.up_m > 7.0
    assert far(stage.truth, at) < 6.0
    assert stage.command(INJECT, unit, Type.OK) == Result.ACCEPTED
    stage.run(1.0)
    assert stage.command(21) == Result.ACCEPTED
    stage.until(lambda: not stage.armed, 40.0)
    assert stage.up_m < 0.1


@either
def test_a_battery_that_is_gone_is_a_fall(personality: Personality) -> None:
    stage = aloft(personality, parameters=TAKES_FAILURES[personality])
    assert stage.command(INJECT, Unit.BATTERY, Type.OFF) == Result.ACCEPTED
    assert 1.2 < stage.until(lambda: stage.up_m < 0.2, 8.0) < 3.0
