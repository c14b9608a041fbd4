"""Conditions that another one ensures already: each holds by itself too.

The gate's memory is set by hand here to what no flight leads to.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.gate.inputs import Requested, Tick
from gcs.gate.machine import progress
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import Memory, Task
from gcs.gate.machine.step_context import StepContext
from gcs.gate.requests import TakePhoto
from gcs.gate.states import State
from tests.unit.gate.flight_words import Flight, place
from tests.unit.gate.rows import Row, rows
from tests.unit.gate.script import SECOND, Script, policy
from tests.unit.gate.situations import flight, remember, state_of


def holds_with_a_picture(flight: Flight) -> None:
    """A hold that is not awaited any more, and a picture that is under way all the same."""
    flight.step("HOLDING")
    task = Task(Requested(flight.script.asked, "keyboard", TakePhoto()), Event.PHOTO)
    remember(flight.script, hold_again_ns=None, asked_mode=None, task=task)


def known_at(flight: Flight, *enu: str) -> None:
    remember(flight.script, pos_ned=place(*enu))


def clock_begins(flight: Flight) -> None:
    flight.script = Script(policy("default"), start_ns=0)


ROWS = rows(
    """
# Without an operator nothing is granted even where we still fly: a lost operator is a hold.
retarget=replace: in HOVERING; loaded 4; remembers operator_lost=yes
    | {go, control, resume, photo, mission} | =, $ refused OPERATOR_LOST
retarget=replace: in MOVING; remembers operator_lost=yes | go | =, go refused OPERATOR_LOST
# While it is severe nothing is granted either: a severity of HOLD is a hold as well.
BATTERY_LOW=HOLD, retarget=replace: in HOVERING; loaded 4; remembers conditions=BATTERY_LOW
    | {go, mission} | =, $ refused SEVERITY
BATTERY_LOW=HOLD, retarget=replace: in MOVING; remembers conditions=BATTERY_LOW
    | go | =, go refused SEVERITY
# Control is regained only where nothing is severe: not at the top of a climb, nor after a mission.
BATTERY_LOW=HOLD: TAKING_OFF; remembers conditions=BATTERY_LOW; stands-at 0 0 1.5
    | tick | HOLDING OURS, sends HOLD, it aborted TOO_CLOSE
BATTERY_LOW=HOLD: FLYING_MISSION; item 4 5; remembers conditions=BATTERY_LOW
    | {shows HOLD, item 4 5 finished} | HOLDING OURS, sends HOLD, it complete
# In HOLDING a pilot's mode takes over whatever is under way, and so does the ground.
holds-with-a-picture; remembers mode=HOLD guided_until_ns=0
    | shows {TAKEOFF, MISSION, OTHER, GUIDED} | EXTERNAL NONE, it taken over MODE_CHANGED
holds-with-a-picture; remembers mode=HOLD guided_until_ns=0
    | shows <RETURN, LAND> | <RETURNING, LANDING> NONE, it taken over MODE_CHANGED
holds-with-a-picture | is ON_GROUND | GROUNDED NONE, it taken over NOT_FLYING
# So does a pilot's hold in a hover.
HOVERING; remembers control=OURS mode=GUIDED
    | shows HOLD | EXTERNAL NONE, it taken over MODE_CHANGED
# Control is being taken whether or not a request asks for it.
HOVERING; remembers task=none | photo | =, photo refused CONTROL_PENDING
# Without a fence (between one that is switched and the new one) no stop is predicted.
in HOVERING; remembers verifier=none | position | =
# The same fence told again judges nothing anew.
MOVING; known-at 0 170 1.5 | same-fence | =
# At the first instant of the clock no command of ours has been sent, and none comes late.
clock-begins; shows armed; position | shows GUIDED | EXTERNAL NONE
clock-begins; shows disarmed; position | is IN_AIR | EXTERNAL NONE
""",
    holds_with_a_picture, known_at, clock_begins,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_holds_by_itself(row: Row) -> None:
    row.fly()


def test_nothing_is_known_of_a_climb_whose_position_is_too_old() -> None:
    script, _ = flight(State.TAKING_OFF)
    memory = script.gate.memory
    memory.pos_ned = (0.0, 0.0, -30.0)
    assert progress.climbs_too_high(StepContext(script.policy, memory, script.now_ns))
    old = StepContext(script.policy, memory, script.now_ns + 2 * SECOND)
    assert not progress.climbs_too_high(old)


def test_a_vehicle_that_was_lost_has_reported_as_little_as_one_never_heard() -> None:
    script, _ = flight(State.TAKING_OFF)
    script.now_ns += 4 * SECOND
    script.feed(Tick(0))
    assert state_of(script) is State.NO_VEHICLE
    lost, new = script.gate.memory, Memory("px4")
    assert not new.heard_before
    assert lost == replace(
        new,
        heard_before=True,
        boot_ms=lost.boot_ms,
        home_ned=lost.home_ned,
        return_up_m=lost.return_up_m,
        return_places=lost.return_places,
        climb_ends_within_m=lost.climb_ends_within_m,
        lost_in_flight=True,
        verifier=lost.verifier,
        asked_until_ns=lost.asked_until_ns,
        takeoff_until_ns=lost.takeoff_until_ns,
        top_ned=lost.top_ned,
    )
