"""Between the server's threads and ours: nothing waits, nothing grows, and answers find back."""

from __future__ import annotations

import select
import threading
from collections.abc import Iterator

import pytest

from gcs.live.inbox import MAX_CALLS, MAX_ITEMS, MAX_OF_A_VIEWER, Inbox
from gcs.live.inputs import Called, Gone, Published
from gcs.live.services import Answer

pytestmark = pytest.mark.slow  # threads, a socket

YES = Answer(True, "accepted")


@pytest.fixture
def inbox() -> Iterator[Inbox]:
    made = Inbox()
    yield made
    made.close()


def published(viewer: int) -> Published:
    return Published(viewer, "json", "x/PointStamped", b"{}")


def readable(inbox: Inbox) -> bool:
    return bool(select.select([inbox], [], [], 0.0)[0])


def test_what_is_put_wakes_whoever_takes_and_comes_in_order(inbox: Inbox) -> None:
    assert not readable(inbox)
    assert inbox.put(published(1))
    assert inbox.put(Gone(2))
    assert readable(inbox)
    assert inbox.take() == [published(1), Gone(2)]
    assert not readable(inbox)
    assert inbox.take() == []


def test_one_viewer_leaves_room_for_others_and_all_together_are_bounded(inbox: Inbox) -> None:
    assert sum(inbox.put(published(1)) for _ in range(1_000)) == MAX_OF_A_VIEWER
    assert inbox.put(published(2))
    for viewer in range(3, 2_000):
        inbox.put(published(viewer))
    assert inbox.put(Gone(1))
    assert len(inbox.take()) == MAX_ITEMS + 1
    assert inbox.put(published(1))


def test_a_call_waits_for_its_own_answer(inbox: Inbox) -> None:
    told: dict[int, Answer] = {}

    def call(viewer: int) -> None:
        told[viewer] = inbox.call(viewer, "land", b"", watching=True, wait_s=10.0)

    threads = [threading.Thread(target=call, args=(viewer,)) for viewer in (1, 2)]
    for thread in threads:
        thread.start()
    calls: list[Called] = []
    while len(calls) < 2:
        assert select.select([inbox], [], [], 10.0)[0]
        calls += [item for item in inbox.take() if isinstance(item, Called)]
    for each in reversed(calls):
        inbox.answer(each.call, Answer(True, str(each.viewer)))
    for thread in threads:
        thread.join()
    assert told == {1: Answer(True, "1"), 2: Answer(True, "2")}
    inbox.answer(calls[0].call, YES)  # nobody waits any more


def test_a_call_that_nobody_answers_ends_in_time(inbox: Inbox) -> None:
    told = inbox.call(1, "land", b"", watching=True, wait_s=0.01)
    assert (told.accepted, told.code) == (False, "NO_ANSWER")


def test_so_many_threads_wait_and_no_more(inbox: Inbox) -> None:
    told: list[Answer] = []

    def call(viewer: int) -> None:
        told.append(inbox.call(viewer, "land", b"", watching=True, wait_s=10.0))

    threads = [threading.Thread(target=call, args=(viewer,)) for viewer in range(MAX_CALLS)]
    for thread in threads:
        thread.start()
    calls: list[Called] = []
    while len(calls) < MAX_CALLS:
        assert select.select([inbox], [], [], 10.0)[0]
        calls += [item for item in inbox.take() if isinstance(item, Called)]
    busy = inbox.call(99, "land", b"", watching=True, wait_s=10.0)
    assert (busy.accepted, busy.code) == (False, "BUSY")
    for each in calls:
        inbox.answer(each.call, YES)
    for thread in threads:
        thread.join()
    assert told == [YES] * MAX_CALLS
