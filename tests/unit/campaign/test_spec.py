"""A campaign's file is strict, and its plan needs no file more."""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs.campaign.case import Task
from gcs.campaign.plan import Choice, Range, decode, encode
from gcs.campaign.spec import read_plan
from gcs.toml import TomlError
from tests.each import each
from tests.unit.campaign.campaigns import TEXT, planned, written

WRONG: list[tuple[str, str, int, str]] = [
    ("flights = 40\n", "", 1, "flights: is missing"),
    ('"latin"', '"lattin"', 2, "sample: "),
    ('"latin"', '"grid"', 16, "vary.wind_m_s: a grid has no end of a range's values"),
    ("seed = 3", "sed = 3", 4, "sed: unknown key"),
    ("takeoff 2", "takeof 2", 9, "task[1].lines[2]: takeof: not a word of ours"),
    ("square.toml", "no.toml", 13, "task[2].mission: no.toml: no such mission file"),
    ('mission = "square.toml"\n', "", 11, "task[2]: has either lines or a mission"),
    ('name = "square"', 'name = "up"', 7, "task: two tasks have one name"),
    ("to = 8", "to = 0", 16, "vary.wind_m_s.to: is not above `from`"),
    ("to = 8", "too = 8", 16, "vary.wind_m_s.to: is missing"),
    ("to = 8", "to = 80", 16, "vary.wind_m_s: 80.0 is not a number from 0 to 60"),
    ("gust_m_s", "gusts_m_s", 17, "vary.gusts_m_s: unknown; known are start_ns"),
    ('"ardupilot"]', '"px5"]', 18, "vary.autopilot: 'px5' is none of px4, ardupilot"),
    ('"ardupilot"]', '"px4"]', 18, "vary.autopilot: has a value twice"),
    ('"ardupilot"]', "4]", 18, "vary.autopilot: has values of two kinds"),
    ('["px4", "ardupilot"]', "[]", 18, "vary.autopilot: is empty"),
    ("autopilot =", 'policy = ["no.toml"]\nautopilot =', 18, "vary.policy: "),
    ("autopilot =", 'fault = ["no.toml"]\nautopilot =', 18, "vary.fault: "),
    ("autopilot =", 'task = "up"\nautopilot =', 18, "vary.task: unknown key"),
    ("timeout_s", 'simulator = "none"\ntimeout_s', 5, "simulator: simulator none: none of that"),
]


@each("wrong", WRONG)
def test_what_is_wrong_is_told_with_its_line(
    wrong: tuple[str, str, int, str], tmp_path: Path
) -> None:
    good, bad, line, what = wrong
    assert good in TEXT
    file = written(tmp_path, TEXT.replace(good, bad, 1))
    with pytest.raises(TomlError) as caught:
        read_plan(file)
    assert str(caught.value).startswith(f"{file}:{line}: {what}")


def test_a_plan_has_all_that_its_flights_need_and_survives_being_sent(tmp_path: Path) -> None:
    (tmp_path / "lost.toml").write_text('[[fault]]\nat_s = 9\nkind = "gps_lost"\n')
    plan = planned(tmp_path, TEXT + 'fault = ["", "lost.toml"]\nseed = [7, 8]\npayload_kg = 0.2\n')
    (tmp_path / "lost.toml").unlink()
    assert decode(encode(plan)) == plan
    assert decode(encode(plan)).digest == plan.digest
    assert plan.axes[2:5] == (
        Range("wind_m_s", 0.0, 8.0),
        Range("gust_m_s", 0.0, 1.5),
        Choice("autopilot", ("px4", "ardupilot")),
    )
    case = plan.case(5, plan.inputs([0.9, 0.0, 0.5, 0.5, 0.0, 0.9, 0.6, 0.0]))
    assert case.task.lines == ("arm", 'mission fly "square.toml"')
    assert list(case.task.files) == ["square.toml"]
    assert "gps_lost" in str(case.table["faults"])
    assert case.table["wind_m_s"] == 4.0
    assert (case.table["seed"], case.table["payload_kg"]) == (8, 0.2)
    assert plan.tasks[0] == Task("up", ("arm", "takeoff 2", "land"), {})


def test_each_flight_has_a_seed_of_its_own_where_no_axis_says_it(tmp_path: Path) -> None:
    plan = planned(tmp_path)
    inputs = plan.inputs([0.5] * len(plan.axes))
    seeds = {plan.case(number, inputs).table["seed"] for number in range(50)}
    assert len(seeds) == 50


def test_the_campaign_of_the_page_is_one(tmp_path: Path) -> None:
    text = (Path(__file__).parents[3] / "docs" / "campaign.md").read_text(encoding="utf-8")
    _, _, rest = text.partition("<!-- example: campaign -->\n```toml\n")
    plan = planned(tmp_path, rest.partition("```")[0])
    table = text.partition("| key of `[vary]` | |")[2].partition("\n\n")[0]
    for axis in plan.axes[1:]:
        assert f"`{axis.name}`" in table
