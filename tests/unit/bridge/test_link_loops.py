"""A loop of links is asked for where heartbeats multiply, and proved by what comes back."""

from __future__ import annotations

from gcs.bridge.effects import Reply
from gcs.bridge.peers.link_loops import (
    BEATS_NS,
    FORGOTTEN_NS,
    MOST_BEATS,
    QUESTIONS_KEPT,
    Loop,
    Loops,
)
from gcs.protocol.effects import Address
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Frame, split
from gcs.wire.messages import LinkNodeStatus, Message

S = 1_000_000_000
OWN = Address(255, 191)
LINKS = [4, 3]
NEW, OLD = (Loop(3, goes_on=False, told=told) for told in (False, True))


def as_frame(message: Message) -> Frame:
    (frame,) = split(FrameWriter(OWN.sysid, OWN.compid).write(message))
    assert isinstance(frame, Frame)
    return frame


def flood(loops: Loops, now_ns: int) -> list[Reply]:
    """Far too many heartbeats of one autopilot; what is asked then."""
    return [asked for _ in range(MOST_BEATS) for asked in loops.beat(1, LINKS, now_ns)]


def test_a_vehicle_with_a_few_links_is_no_loop() -> None:
    loops = Loops(OWN)
    for second in range(20):
        for link in range(3):
            assert loops.beat(1, LINKS, second * S + link) == []
        assert loops.beat(2, LINKS, second * S) == [], "each vehicle has its own"


def test_too_many_heartbeats_are_a_question_on_each_clients_link_every_two_seconds() -> None:
    loops = Loops(OWN)
    step_ns = BEATS_NS // (MOST_BEATS - 1)
    asked = [loops.beat(1, LINKS, S + number * step_ns) for number in range(MOST_BEATS)]
    assert asked[:-1] == [[]] * (MOST_BEATS - 1)
    assert [(each.link, each.source) for each in asked[-1]] == [(3, OWN), (4, OWN)]
    assert flood(loops, 4 * S - 1) == []
    assert len(flood(loops, 4 * S)) == 2


def test_what_comes_back_proves_the_loop_once() -> None:
    loops = Loops(OWN)
    on_3, on_4 = (as_frame(asked.message) for asked in flood(loops, S))
    assert loops.came_back(on_3, S + 5) == NEW
    assert loops.came_back(on_3, S + 6) == OLD, "it goes round as all else does"
    assert loops.came_back(on_4, S + 6) == Loop(4, goes_on=False, told=False)


def test_a_loop_that_goes_on_is_told_apart_from_what_is_still_on_its_way() -> None:
    loops = Loops(OWN)
    first = as_frame(flood(loops, S)[0].message)
    assert loops.came_back(first, S) == NEW
    again = as_frame(flood(loops, 3 * S)[0].message)
    assert loops.came_back(again, 3 * S) == Loop(3, goes_on=True, told=False)
    assert loops.came_back(first, 3 * S) == OLD
    assert loops.came_back(again, 3 * S) == OLD
    later_ns = S + FORGOTTEN_NS + 1
    assert loops.came_back(as_frame(flood(loops, later_ns)[0].message), later_ns) == NEW


def test_what_was_not_asked_proves_nothing() -> None:
    loops = Loops(OWN)
    asked = flood(loops, S)[0].message
    assert isinstance(asked, LinkNodeStatus)
    other = flood(Loops(OWN), S + 1)[0].message
    assert loops.came_back(as_frame(other), S) is None, "another station's of our address"
    for second in range(2, 3 + QUESTIONS_KEPT * 2, 2):
        flood(loops, S + second * S)
    assert loops.came_back(as_frame(asked), 30 * S) is None, "only the last ones are known"
