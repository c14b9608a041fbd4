"""ArduCopter acts again on a vehicle that goes on outwards through its fence."""

from __future__ import annotations

from vehicle_sim.autopilot.fence.geofence import BreachKind, Geofence
from vehicle_sim.autopilot.parameters.parameters import Parameters

RADIUS_M = 50.0
HOME_NED = (0.0, 0.0, 0.0)


def test_the_next_limit_lies_20_m_beyond_the_one_that_was_crossed() -> None:
    """AC_FENCE_CIRCLE_RADIUS_BACKUP_DISTANCE, 20 m (AC_Fence.h)."""
    parameters = Parameters("ardupilot")
    for name, value in (("FENCE_ENABLE", 1), ("FENCE_TYPE", 2), ("FENCE_RADIUS", RADIUS_M)):
        parameters.set(name, value)
    fence = Geofence(parameters)

    def struck(away_m: float) -> bool:
        at = (away_m, 0.0, -10.0)
        return fence.check(at, at, HOME_NED, False, 0).breached is BreachKind.CIRCLE

    assert not struck(49.0)
    assert struck(51.0)
    assert not struck(60.0)
    assert not struck(70.9)
    assert struck(71.1)
    assert not struck(90.0)
    assert struck(91.2)
