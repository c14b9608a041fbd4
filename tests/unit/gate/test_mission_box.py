"""On a mission: by its approach inside the box round its path, by its braking outside."""

from __future__ import annotations

from gcs.gate.airspace.mission_box import BESIDE_M, MissionBox, box_round
from gcs.gate.airspace.stopping import OwnPath, StopBy, stop_point, ways_to_stop
from gcs.gate.policy.parse import DEFAULT

EASTWARD = (0.0, 10.0, 0.0)
BOX = MissionBox((0.0, -20.0, -10.0), (40.0, 30.0, 0.0))


def test_a_box_is_round_all_points() -> None:
    assert box_round([(0.0, 30.0, -10.0), (40.0, -20.0, 0.0), (3.0, 3.0, -3.0)]) == BOX


def test_a_little_beside_its_path_counts_as_on_it() -> None:
    assert BOX.holds((40.0 + BESIDE_M, 30.0 + BESIDE_M, -10.0 - BESIDE_M))
    assert not BOX.holds((40.0, 30.1 + BESIDE_M, -5.0))
    assert not BOX.holds((-0.1 - BESIDE_M, 0.0, -5.0))
    assert not BOX.holds((0.0, 0.0, -10.1 - BESIDE_M))


def test_outside_the_box_it_slows_down_for_nothing() -> None:
    inside, outside = (10.0, 30.0, -5.0), (10.0, 40.0, -5.0)
    braking, approach = DEFAULT.braking_of("ardupilot"), DEFAULT.approach_of("ardupilot")
    own = ways_to_stop(inside, EASTWARD, OwnPath(BOX), DEFAULT, "ardupilot")
    assert own == ((StopBy.ITSELF, stop_point(inside, EASTWARD, approach)),)
    held = ways_to_stop(outside, EASTWARD, OwnPath(BOX), DEFAULT, "ardupilot")
    assert held == ((StopBy.HOLD, stop_point(outside, EASTWARD, braking)),)
    nowhere = ways_to_stop(outside, EASTWARD, OwnPath(), DEFAULT, "ardupilot")
    assert nowhere == ((StopBy.ITSELF, stop_point(outside, EASTWARD, approach)),)
