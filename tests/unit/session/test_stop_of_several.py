"""A stop of several vehicles is answered once, in whatever order they accept it and end."""

from __future__ import annotations

from itertools import permutations

import pytest

from gcs import ipc
from gcs.session.stop_of_several import StopOfSeveral

ACCEPTED = ipc.VerdictEvent(7, "rtl", "accepted")
REFUSED = ipc.VerdictEvent(7, "rtl", "refused", "RTL_BLOCKED", "the way home")
COMPLETE = ipc.EndingEvent(7, "rtl", "complete", "", "landed")
ABORTED = ipc.EndingEvent(7, "rtl", "aborted", "OPERATOR", "an operator stopped it")
Told = ipc.VerdictEvent | ipc.EndingEvent

WAYS: dict[str, tuple[Told, ...]] = {
    "complete": (ACCEPTED, COMPLETE),
    "aborted": (ACCEPTED, ABORTED),
    "refused": (REFUSED,),
}


def orders(first: tuple[Told, ...], second: tuple[Told, ...]) -> set[tuple[int, ...]]:
    """Every order of what two vehicles tell, by which of them does."""
    return set(permutations([1] * len(first) + [2] * len(second)))


@pytest.mark.parametrize("first", WAYS)
@pytest.mark.parametrize("second", WAYS)
def test_it_has_one_verdict_and_one_ending_at_the_very_end(first: str, second: str) -> None:
    both = {first, second}
    for order in orders(WAYS[first], WAYS[second]):
        stop, told = StopOfSeveral(2), list[ipc.Event]()
        left = {1: list(WAYS[first]), 2: list(WAYS[second])}
        accepted = False
        for turn, sysid in enumerate(order):
            event = left[sysid].pop(0)
            accepted |= event is ACCEPTED
            if isinstance(event, ipc.VerdictEvent):
                told += stop.verdict(sysid, event)
            else:
                told += stop.ending(sysid, event)
            over = turn == len(order) - 1
            assert len(told) == accepted + over
        verdict, *endings = told
        assert isinstance(verdict, ipc.VerdictEvent)
        if both == {"refused"}:
            assert (verdict.code, endings) == ("RTL_BLOCKED", [])
            assert verdict.sentence == f"vehicle {order[0]}: the way home"
            continue
        assert verdict is ACCEPTED
        (ending,) = endings
        assert isinstance(ending, ipc.EndingEvent)
        assert (ending.id, ending.word) == (7, "rtl")
        if both == {"complete"}:
            assert (ending.ended, ending.sentence) == ("complete", "all 2 vehicles")
        else:
            undone = {1 if first != "complete" else 2, 2 if second != "complete" else 1}
            assert ending.ended == "aborted"
            assert int(ending.sentence.split(":")[0].removeprefix("vehicle ")) in undone
