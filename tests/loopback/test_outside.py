"""A vehicle that is driven out of the fence: what the policy says for that happens."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.flight import PERSONALITIES, Flight, Personality

YARD = """
severities.fence_breached = "{severity}"
[[fence]]
name = "yard"
kind = "circle"
radius_m = 8.0
ceiling_up_m = 20.0
"""


@pytest.mark.parametrize(
    ("severity", "state"),
    [("hold", State.HOLDING), ("return", State.HOLDING), ("land", State.LANDING)],
)
@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_vehicle_that_a_gust_drives_out_does_what_the_policy_says(
    personality: Personality, severity: str, state: State
) -> None:
    """A return is blocked from outside: the way home leads through the fence's edge."""
    policy = parse_policy(YARD.format(severity=severity), "my.toml")
    flight = Flight(personality, policy=policy).hovering(4.0)
    flight.push((25.0, 0.0, 0.0))
    flight.until(lambda: Condition.FENCE_BREACHED in flight.conditions)
    east_m, _, _ = flight.truth_enu()
    assert east_m > 8.0
    flight.run(1.0)
    assert flight.state is state
