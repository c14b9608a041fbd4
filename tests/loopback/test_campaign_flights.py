"""A campaign's flight: the whole station on a virtual clock, judged by where the vehicle was."""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs import __version__
from gcs.audit.audit import audit
from gcs.audit.files import sessions
from gcs.campaign.case import LANDED, LATE, Case
from gcs.campaign.flight import fly
from gcs.campaign.plan import Plan
from gcs.campaign.spec import read_plan
from gcs.flight_report.scan import scan
from gcs.shell.environment import environment

YARD = """\
name = "yard"
[[fence]]
name = "yard"
kind = "box"
east_m = [-9, 9]
north_m = [-9, 9]
ceiling_up_m = 12
"""
DRIFT = "".join(
    f'[[fault]]\nat_s = {10 + 0.5 * step}\nkind = "gps_glitch"\n'
    f"offset_ned_m = [0, {-0.5 * step}, 0]\n"
    for step in range(1, 25)
)
"""Slowly, as no jump: an estimator follows it."""
CAMPAIGN = """\
name = "two flights"
sample = "grid"
timeout_s = 120
[[task]]
name = "across"
lines = ["arm", "takeoff 3", "goto 2 0 3", "goto 50 0 3", "wait 12", "land"]
[vary]
policy = "yard.toml"
autopilot = ["px4", "ardupilot"]
fault = ["", "drift.toml"]
wind_m_s = 3
gust_m_s = 0.5
loss = 0.02
"""


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    for name, text in (("yard", YARD), ("drift", DRIFT), ("campaign", CAMPAIGN)):
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    return read_plan(tmp_path / "campaign.toml")


def case(plan: Plan, number: int, **other: str) -> Case:
    inputs = plan.inputs([0.0] * len(plan.axes))
    return plan.case(number, {**inputs, **other})


def test_a_flight_is_judged_and_recorded_and_flown_again_it_is_the_same(
    plan: Plan, personality: str, tmp_path: Path
) -> None:
    flight = case(plan, 1, autopilot=personality)
    row = fly(flight)
    assert (row.error, row.outcome, row.breach) == ("", LANDED, False)
    assert (row.accepted, row.refused, row.undone) == (4, 1, 0)
    assert "goto 50 0 3: refused OUTSIDE_FENCE" in row.answers
    assert row.closest_m == pytest.approx(9.0 - 2.0, abs=1.0)
    assert row.closest_of == "outside inclusion polygon 'yard'"
    assert row.max_up_m == pytest.approx(3.0, abs=0.7)
    assert row.landed_east_m == pytest.approx(2.0, abs=1.0)
    assert 0.3 < row.touchdown_m_s < 1.2
    assert row.energy_wh is not None
    assert 0.5 < row.energy_wh < 5.0

    record = tmp_path / "again.mcap"
    assert fly(flight, record) == row
    [session] = sessions((record,))
    result = audit(session.messages(), session.attachments(), __version__, environment())
    assert result.good, result.first[:5]
    assert scan(record).vehicles[1].totals.take_offs == 1
    assert fly(case(plan, 2, autopilot=personality)).digest != row.digest


def test_a_breach_is_seen_that_the_station_cannot_see(plan: Plan, personality: str) -> None:
    """The GPS drifts by 12 m: the vehicle flies out of its fence, and reports itself inside."""
    row = fly(case(plan, 1, autopilot=personality, fault="drift.toml"))
    assert row.breach
    assert row.closest_m is not None
    assert row.closest_m < -0.5


def test_who_does_not_end_in_time_is_held_and_late(plan: Plan) -> None:
    whole = case(plan, 1)
    short = Case(1, whole.task, whole.rules, whole.simulator, whole.table, 20.0, whole.inputs)
    row = fly(short)
    assert row.outcome == LATE
    assert row.failed
    assert row.error == ""
