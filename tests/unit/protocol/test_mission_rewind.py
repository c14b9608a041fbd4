"""To an item of the mission: told again until the vehicle shows it."""

from __future__ import annotations

from gcs.protocol.effects import Address, Heard, Send, TransferDone, TransferFailed, Wake
from gcs.protocol.mission_rewind import MissionRewind
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionCurrent, MissionSetCurrent

OWN, VEHICLE = Address(255, 190), Address(1, 1)
S = 1_000_000_000
FIRST = MissionSetCurrent(1, 1, 1)


def current(seq: int, sysid: int = 1) -> Heard:
    return Heard(sysid, 1, MissionCurrent(seq, 0, 0, 0, 0, 0, 0))


def test_it_is_done_when_the_vehicle_shows_an_item_no_later_than_the_first_that_is_flown() -> None:
    rewind = MissionRewind(OWN, VEHICLE, 1, range(3))
    assert rewind.start(0) == [Send(FIRST)]
    assert rewind.handle(current(7), S) == [], "the item it was left at"
    assert rewind.handle(current(1, sysid=2), S) == [], "another vehicle's"
    assert rewind.handle(current(2), S) == [TransferDone(MissionType.MISSION, ())]
    assert rewind.ended


def test_what_was_lost_is_sent_again_and_a_vehicle_that_never_shows_it_is_given_up() -> None:
    rewind = MissionRewind(OWN, VEHICLE, 1, range(2))
    rewind.start(0)
    assert rewind.handle(Wake(), 1 * S) == []
    assert rewind.handle(Wake(), 2 * S) == [Send(FIRST)]
    effects = [effect for second in range(3, 40) for effect in rewind.handle(Wake(), second * S)]
    assert isinstance(effects[-1], TransferFailed)
    assert effects.count(Send(FIRST)) == len(effects) - 1


def test_a_vehicle_that_is_to_go_on_to_a_later_item_is_not_there_before_it() -> None:
    onward = MissionRewind(OWN, VEHICLE, 4, range(4, 6))
    assert onward.start(0) == [Send(MissionSetCurrent(4, 1, 1))]
    assert onward.handle(current(3), S) == []
    assert onward.handle(current(5), S) == [TransferDone(MissionType.MISSION, ())]
