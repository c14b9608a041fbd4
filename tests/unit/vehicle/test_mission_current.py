"""What was found in a mission on board is named as long as the vehicle tells of that one."""

from __future__ import annotations

import pytest

from gcs.session.speedup_waits import Times
from gcs.vehicle.missions.mission_current import MissionTold
from gcs.wire.messages import MissionCurrent

SECOND = 1_000_000_000
ITEMS, NUMBER = 4, 17
FOUND = "item 2: the leg to (20.00 E, 0.00 N, 10.00 U) goes through exclusion box 'mast'"
NOT_VERIFIED = f"the mission on board ({ITEMS} items) was not verified: upload or clear it"


def current(total: int = ITEMS, number: int = NUMBER) -> MissionCurrent:
    return MissionCurrent(0, total, 0, 0, number, 0, 0)


def refused(*told: MissionCurrent) -> MissionTold:
    """One that was read and refused, and what the vehicle has told since, once a second."""
    part = MissionTold(Times())
    part.heard(current(), None, 0, SECOND)
    assert part.unverified(None) == NOT_VERIFIED
    part.refused(ITEMS, FOUND)
    for seconds, message in enumerate(told, start=2):
        part.heard(message, None, 0, seconds * SECOND)
    return part


@pytest.mark.parametrize("told", [(), (current(),), (current(),) * 5])
def test_the_finding_is_named(told: tuple[MissionCurrent, ...]) -> None:
    assert FOUND in refused(*told).unverified(None)


def test_what_was_on_its_way_before_the_finding_changes_nothing() -> None:
    assert FOUND in refused(current(total=2), current()).unverified(None)


@pytest.mark.parametrize("other", [current(total=5), current(number=18)])
def test_another_mission_is_one_that_was_not_verified(other: MissionCurrent) -> None:
    part = refused(current(), other)
    assert "was not verified" in part.unverified(None)
    part.heard(current(), None, 0, 9 * SECOND)
    assert part.unverified(None) == NOT_VERIFIED


def test_a_count_is_told_too_where_nothing_else_is() -> None:
    """A PX4 1.14 without a mission sends no MISSION_CURRENT, and answers with 0 items."""
    part = MissionTold(Times())
    assert "has not told" in part.unverified(None)
    part.counted(0)
    assert not part.unverified(None)
    part.heard(current(), None, 0, SECOND)
    part.counted(0)
    assert part.unverified(None) == NOT_VERIFIED


def test_the_count_stands_while_a_px4_1_14_tells_its_item_alone() -> None:
    """Seen of PX4 1.14.3: with 3 items on board MISSION_CURRENT has a seq, and zeros."""
    part = MissionTold(Times())
    part.heard(MissionCurrent(seq=1), None, 0, SECOND)
    assert not part.known
    part.counted(3)
    part.heard(MissionCurrent(seq=1), None, 0, 2 * SECOND)
    assert "(3 items) was not verified" in part.unverified(None)
    part.changed()
    assert not part.known, "asked anew, once a mission was sent or cleared"
    part.counted(0)
    assert not part.unverified(None)
    part.heard(MissionCurrent(seq=0), None, 0, 3 * SECOND)
    assert not part.known, "it sends none without a mission: somebody has sent it one"


def test_after_an_upload_it_is_not_named() -> None:
    part = refused(current())
    part.forget_refused()
    assert part.unverified(None) == NOT_VERIFIED


def test_of_a_vehicle_that_was_away_nothing_is_known() -> None:
    part = refused(current())
    part.forget()
    part.heard(current(), None, 0, 9 * SECOND)
    assert part.unverified(None) == NOT_VERIFIED
