"""`--sensors`: good ones are usual; those as in life when asked for."""

from __future__ import annotations

import pytest

from tests.unit.vehicle_shell.test_firmware_option import options
from vehicle_sim.cli import plan_of
from vehicle_sim.plant.sensors import MEMS, REAL, SensorGrade


@pytest.mark.parametrize(("words", "grade"), [([], MEMS), (["--sensors", "real"], REAL)])
def test_the_grade_of_the_sensors(
    words: list[str], grade: SensorGrade, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert plan_of(options([*words, "--port", "0"], monkeypatch)).grade is grade
