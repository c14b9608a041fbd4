"""What a report means: which samples are positions, what is a jump, what stands, what is new."""

from __future__ import annotations

import pytest

from gcs.gate.inputs import LandedSeen, PositionSeen
from gcs.gate.states import LandedState
from tests.unit.gate.flight_words import Flight, place
from tests.unit.gate.rows import Row, rows
from tests.unit.gate.script import MS
from tests.unit.gate.situations import STILL, UP


def stamped(flight: Flight, east: str, after_ms: str, arrives_ms: str) -> None:
    """A sample so far east, stamped and arriving so long after the last."""
    script = flight.script
    boot_ms = script.gate.memory.boot_ms + int(after_ms)
    script.now_ns += int(arrives_ms) * MS
    script.feed(PositionSeen(place(east, "0", str(UP)), STILL, boot_ms))


def at_boot(flight: Flight, east: str, north: str, up: str, boot_ms: str, *reset: str) -> None:
    flight.script.feed(PositionSeen(place(east, north, up), STILL, int(boot_ms), bool(reset)))


def no_number(flight: Flight, axis: str, wrong: str) -> None:
    n, e, d, vn, ve, vd = (float(wrong) if i == int(axis) else 0.25 for i in range(6))
    flight.script.feed(PositionSeen((n, e, d), (vn, ve, vd), flight.script.now_ns // MS))


def flies_by(flight: Flight, *v_enu: str) -> None:
    """A sample where it is, with that velocity."""
    script = flight.script
    script.feed(PositionSeen(script.pos_ned, place(*v_enu), script.now_ns // MS))


def lifts_to(flight: Flight, up: str) -> None:
    """A sample above where it stands, 0.2 s on by its own clock."""
    script = flight.script
    north, east, _ = script.pos_ned
    script.feed(PositionSeen((north, east, -float(up)), STILL, script.now_ns // MS + 200))


def known_at(flight: Flight, *enu: str) -> None:
    assert flight.script.gate.pos_ned == place(*enu)


def landed_seen(flight: Flight, landed: str) -> None:
    """Told once, and not with each tick."""
    flight.script.feed(LandedSeen(LandedState[landed]))


def mission_over(flight: Flight) -> None:
    assert flight.script.gate.memory.mission_over


def picture_was(flight: Flight, index: str) -> None:
    assert flight.script.gate.memory.photo_index == int(index)


ROWS = rows(
    """
# A jump is faster than 30 m/s and half a metre, by the vehicle's clock (samples may queue), by ours
# ... where its clock stands still.
in HOVERING; position | stamped <3.5 100 100, 3.5 100 1, 3.5 0 100, 0.5 0 0> | =
in HOVERING; position
    | stamped <3.5625 100 100, 3.5625 100 1, 3.5625 0 100, 0.5625 0 0> | HOLDING OURS, sends HOLD
# A stamp no further ahead than a position stays fresh is believed, another is a clock that was set.
in HOVERING; position | stamped 0 1100 100 | =
in HOVERING; position | stamped 0 1101 100 | HOLDING OURS, sends HOLD
in HOVERING; later 0.05 | at-boot 40 0 1.5 4294967295 | HOLDING OURS, sends HOLD
# Samples that queued and come at once are no jump.
in MOVING; later 0.5
    | stamped 0 100 0; stamped 1.5 100 0; stamped 3 100 0; stamped 4.5 100 0 | =
# The first position is no jump.
unheard; shows HOLD armed; is IN_AIR | at-boot 0 90 1.5 5000; known-at 0 90 1.5 | EXTERNAL NONE
# One number that is none makes it no position.
in HOVERING; position | no-number {0, 1, 2, 3, 4, 5} {nan, inf}; known-at 0 0 1.5 | =
# One of the same stamp counts and an older one does not.
in HOVERING; position | stamped 0.25 0 10; known-at 0.25 0 1.5 | =
    | stamped 0 -1 10; known-at 0.25 0 1.5 | =
# After a reset the clock begins anew; without one, and no jump, nothing is held.
in HOVERING; position | at-boot 0.25 0 1.5 1 reset; known-at 0.25 0 1.5 | HOLDING OURS, sends HOLD
in HOVERING; position | sample 0.25 0 1.5 | =
# The floor counts for what is known to fly: sinking at 2.5 m/s it stops below it.
in HOVERING; position; landed-seen IN_AIR    | flies-by 0 0 -2.5 | HOLDING OURS
in HOVERING; position; landed-seen UNDEFINED | flies-by 0 0 -2.5 | =
# It does not count for what begins or ends on the ground.
{TAKING_OFF, RETURNING, LANDING}; is IN_AIR | flies-by 0 0 -3 | =
# A mission that lifts off: PX4 takes a climb of half a metre to be over at once, so the floor is
# ... for what has climbed, and not for what has not.
armed; is ON_GROUND; loaded 3; mission; shows MISSION; is IN_AIR | at 0 0 -0.1 | FLYING_MISSION OURS
armed; is ON_GROUND; loaded 3; mission; shows MISSION; is IN_AIR; at 0 0 3
    | at 0 0 2 by 0 0 -8 | HOLDING OURS, sends HOLD, mission aborted FENCE_BREACH
# While control is being taken a stop is predicted already.
HOVERING | flies-by 0 12 0 | = | flies-by 0 60 0 | HOLDING OURS, sends HOLD, it aborted FENCE_BREACH

# Half a metre above where it stood it does not stand, whatever is reported.
stands-at 4 3 7; armed; wait 1; no landed; lifts-to 7.5 | land
    | GROUNDED NONE, land accepted complete
stands-at 4 3 7; armed; wait 1; no landed; lifts-to 7.5625
    | land | LANDING OURS, sends LAND, land accepted
# Each report that it stands is of where it is now.
armed; at 0 0 0.45; is ON_GROUND; at 0 0 0.9 | land | GROUNDED NONE, land accepted complete
    | at 0 0 1; land | LANDING OURS, sends LAND, land accepted
# But not during a take-off: px4 says ON_GROUND for up to a second into a climb.
climb; flies 0 0 1; at 0 0 1; is ON_GROUND
    | abort | HOLDING OURS, sends HOLD, it aborted OPERATOR, abort accepted
# Nor while one that was given up may come late.
climb; refuses TAKE_OFF; flies 0 0 1; at 0 0 1; is ON_GROUND
    | hold | HOLDING OURS, sends HOLD, hold accepted
# Taking off and landing are in the air, not known is neither.
armed | is {IN_AIR, TAKEOFF, LANDING} | EXTERNAL NONE
armed; is UNDEFINED | land | LANDING OURS, sends LAND, land accepted
# What is reported again is nothing new.
MOVING; is TAKEOFF | is LANDING | =
# A report without a position says nothing of height, nor do heights from before a jump.
unheard; shows armed; is ON_GROUND; at 0 0 40 | land | GROUNDED NONE, land accepted complete
armed; no landed; at-boot 0 0 40 1 reset | land | GROUNDED NONE, land accepted complete
# A mission that is finished is over at any item; a picture that failed was a picture.
armed | item 0 5 finished; mission-over | =
in HOVERING | photo failed 1; picture-was 1 | =
""",
    stamped,
    at_boot,
    no_number,
    flies_by,
    lifts_to,
    known_at,
    landed_seen,
    mission_over,
    picture_was,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_a_report_means(row: Row) -> None:
    row.fly()
