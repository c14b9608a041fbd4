"""Fault files: what they mean, when it happens, and how a wrong one is refused."""

from __future__ import annotations

import pytest

from vehicle_sim.plant.body import Body
from vehicle_sim.plant.faults import (
    AccelBias,
    BaroFault,
    CellsLost,
    CentreOfMass,
    ClockJump,
    GpsGlitch,
    GpsLost,
    GyroBias,
    InertiaScale,
    MagFault,
    ModelFault,
    MotorFault,
    Payload,
    RcLost,
    Reboot,
    ThrustScale,
    WeakBattery,
    WindChange,
)
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.simulation.fault_script import (
    FaultFileError,
    LinkFault,
    Schedule,
    Timed,
    parse,
)

S = 1_000_000_000


def test_a_file_becomes_what_happens_in_the_order_of_time() -> None:
    text = """
    [[fault]]
    at_s = 20
    for_s = 10.5
    kind = "gps_lost"

    [[fault]]
    at_s = 5
    kind = "link"
    loss = 0.3
    direction = "in"
    vehicle = 2

    [[fault]]
    at_s = 25
    kind = "motor"
    motor = 3
    health = 0.4
    """
    assert parse(text, "f.toml") == (
        Timed(5 * S, 2, LinkFault(direction="in", loss=0.3)),
        Timed(20 * S, None, GpsLost()),
        Timed(25 * S, None, MotorFault(3, 0.4)),
        Timed(30_500_000_000, None, GpsLost(False)),
    )


@pytest.mark.parametrize(
    ("keys", "fault"),
    [
        ('kind = "gps_glitch"\noffset_ned_m = [8, 0, -1]', GpsGlitch((8.0, 0.0, -1.0))),
        ('kind = "battery"\ncells = 1.5', CellsLost(1.5)),
        ('kind = "wind"\nwind_ned_m_s = [0, 8, 0]\ngust_m_s = 2', WindChange((0.0, 8.0, 0.0), 2.0)),
        ('kind = "accel_bias"\noffset_m_s2 = [1, 0, 0]', AccelBias((1.0, 0.0, 0.0))),
        ('kind = "gyro_bias"\noffset_rad_s = [0, 0.1, 0]', GyroBias((0.0, 0.1, 0.0))),
        ('kind = "baro"\noffset_m = -4', BaroFault(-4.0)),
        ('kind = "mag"\nlost = true', MagFault(lost=True)),
        ('kind = "payload"\nmass_kg = 0.4', Payload(0.4)),
        ('kind = "centre_of_mass"\nforward_m = 0.02', CentreOfMass(0.02)),
        ('kind = "weak_battery"\nresistance_scale = 3', WeakBattery(3.0, 1.0)),
        ('kind = "thrust"\nscale = 0.7', ThrustScale(0.7)),
        ('kind = "inertia"\nscale = 2', InertiaScale(2.0)),
        ('kind = "rc_lost"', RcLost()),
        ('kind = "clock_jump"\nby_s = 2.5', ClockJump(2_500_000_000)),
        ('kind = "reboot"', Reboot()),
        ('kind = "link"\nout = true', LinkFault(out=True)),
    ],
)
def test_every_kind(keys: str, fault: object) -> None:
    assert parse(f"[[fault]]\nat_s = 1\n{keys}", "f.toml") == (Timed(S, None, fault),)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[[fault]]\nkind = 'gps_lost'", "f.toml:1: fault 1: at_s: is missing"),
        ("[[fault]]\nat_s = 1", "fault 1: kind: must be one of gps_lost, "),
        ("[[fault]]\nat_s = 1\nkind = 'gps'", "is 'gps'"),
        ("\n[[fault]]\nat_s = 1\nkind = 'gps_los'", "f.toml:4: fault 1: kind: must be one of"),
        ("[[fault]]\nat_s = 1\nkind = 'gps_los'", "is 'gps_los'; did you mean gps_lost?"),
        (
            "[[fault]]\nat_s = 1\nkind = 'reboot'\n\n[[fault]]\n at_s = -1\nkind = 'reboot'",
            "f.toml:6: fault 2: at_s: must be a number",
        ),
        ("[[fault]]\nat_s = -1\nkind = 'reboot'", "at_s: must be a number from 0"),
        ("[[fault]]\nat_s = nan\nkind = 'reboot'", "at_s: must be a number"),
        ("[[fault]]\nat_s = true\nkind = 'reboot'", "at_s: must be a number"),
        ("[[fault]]\nat_s = 1\nkind = 'motor'", "motor: is missing"),
        ("[[fault]]\nat_s = 1\nkind = 'motor'\nmotor = 5", "motor: must be a number from 1 to 4"),
        ("[[fault]]\nat_s = 1\nkind = 'gps_lost'\nloss = 1", "loss: is no key"),
        ("[[fault]]\nat_s = 1\nkind = 'wind'\nwind_ned_m_s = [1, 2]", "must be three numbers"),
        ("[[fault]]\nat_s = 1\nkind = 'link'\nloss = 1.5", "loss: must be a number from 0 to 1"),
        ("[[fault]]\nat_s = 1\nfor_s = 1\nkind = 'reboot'", "for_s: a reboot does not last"),
        ("[fault]\nat_s = 1\nkind = 'reboot'", "two brackets"),
        ("faults = 1", "faults: unknown"),
        ("at = ", "f.toml: "),
    ],
)
def test_a_wrong_file_is_refused_with_entry_and_key(text: str, said: str) -> None:
    with pytest.raises(FaultFileError, match=r"^f\.toml:") as refusal:
        parse(text, "f.toml")
    assert said in str(refusal.value)


def test_the_schedule_hands_out_each_fault_once() -> None:
    early, late = Timed(2 * S, None, Reboot()), Timed(3 * S, None, RcLost())
    schedule = Schedule((early, late))
    assert schedule.due_ns(99 * S) == 2 * S
    assert schedule.due(2 * S - 1) == []
    assert schedule.due(2 * S) == [early]
    assert schedule.due(9 * S) == [late]
    assert schedule.due_ns(99 * S) == 99 * S


FAULTS: tuple[ModelFault, ...] = (
    GpsLost(),
    GpsGlitch((1.0, 2.0, 3.0)),
    MotorFault(2, 0.25),
    CellsLost(1.0),
    Payload(0.5),
    CentreOfMass(0.01, -0.02),
    WeakBattery(2.0, 0.8),
    ThrustScale(0.7),
    InertiaScale(2.0),
    WindChange((1.0, 2.0, 3.0), 0.5),
    AccelBias((0.1, 0.2, 0.3)),
    GyroBias((0.4, 0.5, 0.6)),
    BaroFault(4.0, lost=True),
    MagFault((0.1, 0.2, 0.3), lost=True),
)


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_changes_the_blocks_and_its_end_puts_them_right(fault: ModelFault) -> None:
    body, sensed = Body(), Sensed()
    fault.inject(body, sensed)
    assert (body, sensed) != (Body(), Sensed())
    fault.ended().inject(body, sensed)
    assert (body, sensed) == (Body(), Sensed())


def test_each_motor_has_its_own_health() -> None:
    body = Body()
    for motor in (1, 2, 3, 4):
        MotorFault(motor, motor / 10).inject(body, Sensed())
    assert (body.health_1, body.health_2, body.health_3, body.health_4) == (0.1, 0.2, 0.3, 0.4)
