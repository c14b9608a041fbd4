"""One reader of a plan at a time, as PX4 answers one at a time."""

from __future__ import annotations

from gcs.bridge.plans.downloads import ASKS_ON_NS, SILENT_NS, Downloads
from gcs.protocol.effects import Address
from gcs.wire.ids import MissionResult
from gcs.wire.messages import MissionAck, MissionCount, MissionRequestInt, MissionRequestList

TO = {"target_system": 1, "target_component": 1}
LIST = MissionRequestList(**TO)
ITEM = MissionRequestInt(seq=0, **TO)
DONE = MissionAck(type=MissionResult.ACCEPTED, **TO)
ONE, TWO = (1, Address(245, 190)), (2, Address(255, 190))
MS = 1_000_000


def test_a_second_reader_waits_until_the_first_has_its_plan() -> None:
    downloads = Downloads()
    assert downloads.holds(LIST, ONE, False, 0) == ""
    assert "another client" in downloads.holds(LIST, TWO, False, 10 * MS)
    assert downloads.holds(ITEM, ONE, False, 20 * MS) == ""
    assert downloads.holds(DONE, ONE, False, 30 * MS) == ""
    assert downloads.holds(LIST, TWO, False, 40 * MS) == ""


def test_a_reader_that_has_fallen_silent_is_waited_for_no_longer() -> None:
    downloads = Downloads()
    downloads.holds(LIST, ONE, False, 0)
    downloads.holds(ITEM, ONE, False, 100 * MS)
    assert downloads.holds(LIST, TWO, False, SILENT_NS + 99 * MS)
    assert downloads.holds(LIST, TWO, False, SILENT_NS + 100 * MS) == ""


def test_the_same_reader_may_begin_again() -> None:
    downloads = Downloads()
    downloads.holds(LIST, ONE, False, 0)
    assert downloads.holds(LIST, ONE, False, 10 * MS) == ""


def test_who_is_in_control_waits_for_no_other_client() -> None:
    """The other one would keep its turn by asking once a second."""
    downloads = Downloads()
    assert downloads.holds(LIST, TWO, False, 0) == ""
    assert downloads.holds(LIST, ONE, False, 10 * MS, in_control=True) == ""
    assert "another client" in downloads.holds(LIST, TWO, False, 20 * MS)
    assert downloads.holds(LIST, (3, Address(9, 1)), False, 30 * MS), "nor does a third one"


def test_nobody_begins_during_the_station_s_own_transfer() -> None:
    downloads = Downloads()
    assert "station" in downloads.holds(LIST, ONE, True, 0)
    assert downloads.holds(LIST, ONE, False, 10 * MS) == ""


def test_what_is_no_download_is_not_held() -> None:
    count = MissionCount(count=1, **TO)
    assert Downloads().holds(count, ONE, True, 0) == ""
    assert Downloads().holds(DONE, ONE, True, 0) == ""


def test_who_asks_on_and_on_gives_way_to_the_others_in_their_order() -> None:
    """A client that is not in control had the turn for itself by asking once a second."""
    downloads = Downloads()
    third = (3, Address(9, 1))
    began: list[tuple[int, tuple[int, Address]]] = []
    turn: tuple[int, Address] | None = None
    for second in range(200):
        for offset, reader in enumerate((ONE, TWO, third)):
            now_ns = (second * 1000 + offset) * MS
            if downloads.holds(LIST, reader, False, now_ns) == "" and turn != reader:
                turn = reader
                began.append((second, reader))
    assert [reader for _, reader in began] == [ONE, TWO, third, ONE]
    assert [second for second, _ in began] == [0, 60, 120, 181], "after the third asked at 180"


def test_alone_it_may_read_for_as_long_as_it_likes() -> None:
    downloads = Downloads()
    held = [downloads.holds(LIST, ONE, False, second * 1000 * MS) for second in range(200)]
    assert set(held) == {""}


def test_who_was_held_first_is_next() -> None:
    downloads = Downloads()
    third = (3, Address(9, 1))
    assert downloads.holds(LIST, ONE, False, 0) == ""
    assert downloads.holds(LIST, TWO, False, 10 * MS)
    assert downloads.holds(LIST, third, False, 20 * MS)
    assert downloads.holds(DONE, ONE, False, 30 * MS) == ""
    assert downloads.holds(LIST, third, False, 40 * MS), "it came after the other"
    assert downloads.holds(LIST, ONE, False, 45 * MS), "and who has just read, too"
    assert downloads.holds(LIST, TWO, False, 50 * MS) == ""


def test_who_has_gone_is_not_waited_for() -> None:
    downloads = Downloads()
    downloads.holds(LIST, ONE, False, 0)
    downloads.holds(LIST, TWO, False, 10 * MS)
    downloads.holds(DONE, ONE, False, 20 * MS)
    third = (3, Address(9, 1))
    assert downloads.holds(LIST, third, False, 30 * MS)
    assert downloads.holds(LIST, third, False, 10 * MS + ASKS_ON_NS + MS) == ""


def test_who_is_held_back_is_answered_before_it_gives_up() -> None:
    """MAVSDK after 2 s, QGroundControl after 5 s."""
    downloads = Downloads()
    downloads.holds(LIST, ONE, False, 0)
    due = []
    for ms in (10, 510, 1010, 1510):
        downloads.holds(ITEM, ONE, False, ms * MS)
        assert downloads.holds(LIST, TWO, False, ms * MS)
        due.append(downloads.answers(TWO, ms * MS))
    assert due == [False, False, False, True]
    assert not downloads.answers(ONE, 1510 * MS)


def test_a_reader_whose_connection_has_ended_is_waited_for_no_longer() -> None:
    downloads = Downloads()
    downloads.holds(LIST, ONE, False, 0)
    assert downloads.holds(LIST, TWO, False, 10 * MS)
    downloads.gone(ONE[0])
    assert downloads.holds(LIST, TWO, False, 20 * MS) == ""


def test_who_gets_the_number_of_a_link_that_was_another_s_has_nothing_of_its_turn() -> None:
    """Ground stations have the same address, 255/190, and the lowest free link is given again."""
    downloads = Downloads()
    third = (3, Address(250, 190))
    downloads.holds(LIST, ONE, False, 0)
    assert downloads.holds(LIST, TWO, False, 10 * MS)
    assert downloads.holds(LIST, third, False, 20 * MS)
    downloads.gone(TWO[0])
    downloads.holds(DONE, ONE, False, 30 * MS)
    assert downloads.holds(LIST, TWO, False, 40 * MS), "another one, that came after the third"
    assert downloads.holds(LIST, third, False, 50 * MS) == ""


def test_two_behind_one_link_are_two_readers() -> None:
    downloads = Downloads()
    behind_it = (ONE[0], Address(246, 190))
    downloads.holds(LIST, ONE, False, 0)
    assert "another client" in downloads.holds(LIST, behind_it, False, 10 * MS)
    downloads.holds(DONE, behind_it, False, 15 * MS)
    assert downloads.holds(LIST, TWO, False, 20 * MS), "the first reads on"
    downloads.holds(DONE, ONE, False, 30 * MS)
    assert downloads.holds(LIST, TWO, False, 40 * MS), "it asked later"
    assert downloads.holds(LIST, behind_it, False, 50 * MS) == ""


def test_a_client_that_comes_back_from_another_port_waits_for_itself_for_two_seconds() -> None:
    downloads = Downloads()
    moved = (4, ONE[1])
    downloads.holds(LIST, ONE, False, 0)
    assert downloads.holds(LIST, moved, False, SILENT_NS - MS)
    assert downloads.holds(LIST, moved, False, SILENT_NS) == ""
