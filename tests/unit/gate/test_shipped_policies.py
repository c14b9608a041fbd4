"""What the shipped policies say, seen in what is refused and braked: `default` and `lab`.

The lab's numbers are those of its own rules: nothing is braked for until half a metre outside.
"""

from __future__ import annotations

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.stopping import Path, Setpoints
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.condition import Condition
from gcs.gate.effects import Ruling
from gcs.gate.inputs import ConditionChanged
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import Braking
from gcs.gate.refusal import Code
from gcs.gate.requests import Arm
from tests.unit.gate.airspace import HOME, LAB, STILL, at, flying, go
from tests.unit.gate.script import Script, policy

AUTOPILOTS = pytest.mark.parametrize("autopilot", ["px4", "ardupilot", "another"])


def breached(verifier: Verifier, pos_ned: Vec3, v_ned: Vec3 = STILL, path: Path = None) -> bool:
    return verifier.predicted_stop(pos_ned, v_ned, path, floor_applies=True) is not None


class TestDefault:
    def test_near_the_fence_it_may_creep_a_tenth_of_a_metre(self) -> None:
        """0.06 m/s east lead to 0.085 m, 0.08 m/s to 0.113 m: px4 takes v 1.4 s + v^2 / 6.7.  One
        that is sent to a goal may fly on by the margin less the error of the position, to 149.5."""
        near = at(149.2, 0, 2)
        assert not breached(flying(), near, at(0.06, 0, 0))
        assert breached(flying(), near, at(0.08, 0, 0))
        assert not breached(flying(), near, at(0.75, 0, 0), Setpoints())
        assert breached(flying(), near, at(0.85, 0, 0), Setpoints())

    def test_it_arms_though_nothing_is_recorded(self) -> None:
        script = Script(policy("default")).connect()
        script.feed(ConditionChanged(Condition.RECORDER_FAILED, True))
        assert script.verdict(script.ask(Arm())).ruling is Ruling.ACCEPTED

    def test_a_policy_that_wants_a_recording_does_not(self) -> None:
        script = Script(parse_policy("arm_requires_recording = true", "my.toml")).connect()
        script.feed(ConditionChanged(Condition.RECORDER_FAILED, True))
        assert script.refusal(script.ask(Arm())) is Code.RECORDER_DOWN


class TestArdupilot:
    """It takes longer than px4, and brakes harder: 1.9 s, 9.8 m/s2; errors of 0.5 and 0.2 m.

    A stop is asked to keep the error and the margin less the slack: 1 m beside, 0.2 m above.
    """

    def test_the_numbers(self) -> None:
        assert DEFAULT.braking_of("ardupilot") == Braking(1.9, 9.8, 9.8, 0.5, 0.2)

    def test_beside(self) -> None:
        """10 m/s: 19 m of reaction and 5.102 m of braking; the fence is 150 m from home."""
        verifier = verifier_for(DEFAULT, "ardupilot", HOME, None)
        dash = at(10, 0, 0)
        assert go(verifier, at(0, 0, 2), at(124.85, 0, 2), dash) is None
        assert go(verifier, at(0, 0, 2), at(124.95, 0, 2), dash) is Code.CANNOT_STOP

    def test_above(self) -> None:
        """6 m/s: 11.4 m of reaction and 1.837 m of braking; the ceiling is 50 m above home."""
        verifier = verifier_for(DEFAULT, "ardupilot", HOME, None)
        climb = at(0, 0, 6)
        assert go(verifier, at(0, 0, 2), at(0, 0, 36.51), climb) is None
        assert go(verifier, at(0, 0, 2), at(0, 0, 36.61), climb) is Code.CANNOT_STOP


class TestLab:
    """The cage is 5 m to each side and 2 m high."""

    @AUTOPILOTS
    @pytest.mark.parametrize(
        ("within", "beyond"),
        [
            (at(5.45, 0, 1), at(5.55, 0, 1)),
            (at(-5.45, 0, 1), at(-5.55, 0, 1)),
            (at(0, 5.45, 1), at(0, 5.55, 1)),
            (at(0, -5.45, 1), at(0, -5.55, 1)),
            (at(0, 0, 2.45), at(0, 0, 2.55)),
            (at(0, 0, -0.45), at(0, 0, -0.55)),
        ],
        ids=["east", "west", "north", "south", "up", "down"],
    )
    def test_it_brakes_from_half_a_metre_outside(
        self, autopilot: str, within: Vec3, beyond: Vec3
    ) -> None:
        verifier = verifier_for(LAB, autopilot, HOME, None)
        assert not breached(verifier, within)
        assert breached(verifier, beyond)

    def test_low_goals_are_the_fences_affair_down_to_a_kilometre(self) -> None:
        lab = flying(LAB, fence_on=False)
        assert go(lab, at(0, 0, -1000), at(0, 0, 1)) is None
        assert go(lab, at(0, 0, -1001), at(0, 0, 1)) is Code.TOO_LOW
