"""At which nanosecond a thing is due: just before it nothing happens, at the very one it does."""

from __future__ import annotations

import pytest

from gcs.gate.inputs import HeartbeatSeen, LandedSeen
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows


def fresh(flight: Flight) -> None:
    """Everything is reported this instant."""
    script = flight.script
    script.feed(HeartbeatSeen(script.armed, script.mode, script.mode.value))
    script.feed(LandedSeen(script.landed))
    script.position()


ROWS = rows(
    """
# A position is too old when it is older than a second; the grace is over half a second later.
MOVING; fresh | later 1; bare-tick | = | later 0.000000001; bare-tick | STALE OURS
MOVING; fresh; later 1.000000001; bare-tick
    | later 0.499999999; bare-tick | =
    | later 0.000000001; bare-tick | STALE OURS, sends HOLD, it aborted STALE
# A vehicle is lost three and a half seconds after its heartbeat, and so is its landed state.
GROUNDED; fresh | later 3.499999999; bare-tick | STALE NONE
    | later 0.000000001; bare-tick | NO_VEHICLE NONE, it aborted LINK_LOST
GROUNDED; fresh; later 2; shows
    | later 1.499999999; bare-tick | STALE NONE; landed ON_GROUND
    | later 0.000000001; bare-tick | =; landed UNDEFINED
# A deadline, and a mode that is not shown; until then another mode is that of before.
TAKING_PICTURE | later 9.999999999; fresh; bare-tick | =
    | later 0.000000001; fresh; bare-tick | HOVERING OURS, it timed out DEADLINE
ours; land | later 4.999999999; fresh; bare-tick | =
    | later 0.000000001; fresh; bare-tick | HOLDING OURS, sends HOLD, land timed out NO_ANSWER
ours; land; later 4.999999999 | shows OTHER | LANDING OURS
ours; land; later 5           | shows OTHER | EXTERNAL NONE, land taken over MODE_CHANGED
# The next hold.
HOLDING | later 0.999999999; bare-tick | = | later 0.000000001; bare-tick | =, sends HOLD
# A guided command of ours may come for ten seconds, and so may a take-off.
ardupilot: flown; control; tick; hold; shows HOLD; later 9.999999999
    | shows GUIDED | HOLDING OURS, sends HOLD
ardupilot: flown; control; tick; hold; shows HOLD; later 10 | shows GUIDED | EXTERNAL NONE
armed; up; ignores TAKE_OFF; later 9.999999999; fresh | is IN_AIR | HOLDING OURS, sends HOLD
armed; up; ignores TAKE_OFF; later 10; fresh          | is IN_AIR | EXTERNAL NONE
# While one may come it is not sure to stand.
armed; up; ignores TAKE_OFF; later 9.999999999; fresh | land
    | LANDING OURS, sends LAND, land accepted
armed; up; ignores TAKE_OFF; later 10; fresh          | land | =, land accepted complete
# A request and a lost operator are judged by the time they come, a report is not.
HOVERING; fresh; later 2 | photo | STALE TAKING, photo refused STALE
HOVERING; fresh; later 2 | quits | STALE OURS, sends HOLD, it aborted OPERATOR_LOST; states STALE
MOVING; fresh; later 2   | shows | =

# What is due next: nothing with nobody, the position first, in STALE the grace, then the heartbeat.
unheard | nothing | =; due none
TAKING_PICTURE; fresh | nothing | =; due 1.0
MOVING; fresh; later 1.000000001; bare-tick | nothing | STALE OURS; due 0.5
armed; fresh; later 1.000000001; bare-tick  | nothing | STALE NONE; due 2.499999999
# The task where it is earlier.
photo_timeout_s=<0.75, 1.25>: ours; fresh
    | photo | TAKING_PICTURE OURS, sends PHOTO, photo accepted; due <0.75, 1.0>
# The hold to be repeated, control to be asked for, the mode that is waited for.
HOLDING; later 0.5; fresh        | nothing | =; due 0.5
flown; control; later 0.5; fresh | nothing | =; due 0.55
ours; return; later 4.5; fresh   | nothing | =; due 0.5 | shows RETURN | =; due 1.0
""",
    fresh,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_when_it_is_due(row: Row) -> None:
    row.fly()
