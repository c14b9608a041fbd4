"""How long a goal may take, wherever the vehicle is when it sets off."""

from __future__ import annotations

import pytest

from gcs.gate.requests import GoTo
from tests.unit.gate.reactions import ended
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP


class TestTimeOfAGoal:
    """Twice the slowest healthy flight: 2 m/s level, 0.7 m/s up, 0.5 m/s down."""

    @pytest.mark.parametrize(
        ("start", "goal", "seconds"),
        [
            ((20.0, -10.0, UP), (50.0, 30.0, UP), 2.0 * 50.0 / 2.0),
            ((-10.0, 30.0, UP), (-10.0, 70.0, UP), 2.0 * 40.0 / 2.0),
            ((0.0, 0.0, 3.0), (20.0, 0.0, 2.0625), 2.0 * (20.0 / 2.0 + 0.9375 / 0.5)),
        ],
        ids=["both ways", "north", "a little down"],
    )
    def test_it_counts_from_where_the_vehicle_is(
        self,
        start: tuple[float, float, float],
        goal: tuple[float, float, float],
        seconds: float,
    ) -> None:
        script = Script(policy("default")).take_control(start[2])
        script.at(*start)
        script.tick()
        east, north, up = goal
        request_id = script.ask(GoTo((north, east, -up)))
        script.tick()
        script.wait(seconds - 0.05)
        assert not script.ended(request_id)
        script.wait(0.1)
        assert ended(script, request_id) == "timed out DEADLINE"
