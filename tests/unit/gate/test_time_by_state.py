"""What time alone does in each state: arrival, deadlines, the end of a climb, repeated holds."""

from __future__ import annotations

import pytest

from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows
from tests.unit.gate.situations import remember


def disarms_unseen(flight: Flight) -> None:
    """It is disarmed, and that is known without the report of it."""
    remember(flight.script, armed=False)
    flight.script.armed = False


ROWS = rows(
    """
# A goal has twice the time of the slowest flight: 2 m/s level, 0.7 m/s up, 0.5 m/s down, added up.
ours; goto 60 0 1.5; tick | wait 59.95 | = | wait 0.1
    | HOLDING OURS, sends HOLD, goto timed out DEADLINE
ours; goto 0 0 22.5; tick | wait 59.95 | = | wait 0.1
    | HOLDING OURS, sends HOLD, goto timed out DEADLINE
ours 22.5; goto 0 0 1.5; tick
    | wait 83.95 | = | wait 0.1 | HOLDING OURS, sends HOLD, goto timed out DEADLINE
ours; goto 30 40 8.5; tick
    | wait 69.95 | = | wait 0.1 | HOLDING OURS, sends HOLD, goto timed out DEADLINE
# It counts from where the vehicle is.
ours; at 20 -10 1.5; tick; goto 50 30 1.5; tick
    | wait 49.95 | = | wait 0.1 | HOLDING OURS, sends HOLD, goto timed out DEADLINE
ours; at -10 30 1.5; tick; goto -10 70 1.5; tick
    | wait 39.95 | = | wait 0.1 | HOLDING OURS, sends HOLD, goto timed out DEADLINE
ours 3; at 0 0 3; tick; goto 20 0 2.0625; tick
    | wait 23.7 | = | wait 0.1 | HOLDING OURS, sends HOLD, goto timed out DEADLINE
# A short flight has twenty seconds, a picture ten and hovering goes on.
MOVING         | wait 19.95 | = | wait 0.1 | HOLDING OURS, sends HOLD, it timed out DEADLINE
TAKING_PICTURE | wait 9.95  | = | wait 0.1 | HOVERING OURS, it timed out DEADLINE
# A landing has three minutes and goes on.
LANDING | wait 179.95 | = | wait 0.1 | =, it timed out DEADLINE
# One whose report was missed is complete on the ground.
land_timeout_s=10: LANDING; no landed; disarms-unseen; wait 9.9
    | wait 0.1 | GROUNDED NONE, it complete
# A take-off has a minute; on the ground it is given up there.
TAKING_OFF | wait 57.95 | =
           | wait 2.05 | HOLDING OURS, sends HOLD, it timed out DEADLINE
climb | wait 59.95 | =
      | wait 0.1 | GROUNDED NONE, sends HOLD DISARM, it timed out DEADLINE
# Arming, disarming and a forced disarm have five seconds.
connected; arm               | wait 4.95 | = | wait 0.1 | =, arm timed out NO_ANSWER
connected; shows armed; disarm | wait 4.95 | = | wait 0.1 | =, disarm timed out NO_ANSWER
EXTERNAL                     | wait 4.95 | = | wait 0.1 | =, it timed out NO_ANSWER
# A hold has five seconds and is repeated all the same, also where a take-off may come yet.
HOLDING | wait 4.95 | =, sends HOLD HOLD HOLD HOLD | wait 0.1
    | =, sends HOLD, it timed out NO_ANSWER
        | wait 2.1 | =, sends HOLD HOLD
climb; ignores TAKE_OFF; hold
    | wait 5.1 | =, sends HOLD HOLD HOLD HOLD HOLD, hold timed out NO_ANSWER
    | wait 2.1 | =, sends HOLD HOLD
climb; ignores TAKE_OFF; no positions; wait 1.2; hold
    | wait 5.1 | =, sends HOLD HOLD HOLD HOLD HOLD, hold timed out NO_ANSWER
    | wait 2.1 | =, sends HOLD HOLD
# It is repeated each second, not sooner.
HOLDING | wait 0.95 | = | wait 0.05 | =, sends HOLD | wait 0.95 | = | wait 0.05 | =, sends HOLD
        | wait 0.95 | = | wait 0.05 | =, sends HOLD
# Control has the time to stream and five seconds.
HOVERING | wait 6 | =, sends GUIDED | wait 0.1 | EXTERNAL NONE, sends HOLD, it timed out NO_ANSWER
# What came down while its position was too old is complete.
ours; {land, return}; is ON_GROUND; no positions; wait 1.2 | wait 2 | STALE NONE, $ complete
# An arming whose position is too old ends all the same.
GROUNDED; no positions; wait 1.2 | wait 4 | STALE NONE, it timed out NO_ANSWER
# A goal whose time is over within the grace is held.
MOVING; wait 18.8; no positions; wait 1.15
    | wait 0.1 | STALE OURS, sends HOLD, it timed out DEADLINE; silent
    | positions; tick | HOLDING OURS
# A tick sends no command.
{FLIGHT, GROUNDED} | tick 3 | =

# Arrival: closer than 0.5 m, slower than 0.5 m/s, for 0.5 s; then it hovers at the goal.
MOVING; at 3 0 1.5 | wait 0.45 | =
    | wait 0.1 | HOVERING OURS, it complete; holds 3 0 1.5; streams
MOVING; at <2.5, 3> 0 1.5 by <0, 0.5625> 0 0 | wait 0.6 | =
MOVING; at <2.5625, 3> 0 1.5 by <0, 0.5> 0 0 | wait 0.6 | HOVERING OURS, it complete
# Leaving begins the time anew.
MOVING; at 3 0 1.5; wait 0.3; at 2 0 1.5; tick; at 3 0 1.5
    | wait 0.4 | = | wait 0.1 | HOVERING OURS, it complete
# A goal where it is begins its time with the verdict.
ours; goto 0.25 0 1.5; tick | wait 0.45 | = | wait 0.05 | HOVERING OURS, goto complete
# Without a position nobody arrives, and a sample between two ticks is no arrival.
MOVING; at 3 0 1.5; no positions; wait 0.45 | later 1; bare-tick | STALE OURS
MOVING; at 3 0 1.5 | later 0.9; position | = | bare-tick | HOVERING OURS, it complete
# Any speed will do where the policy asks for none.
arrival=lab: ours; goto 3 0 1.5
    | at 3 0 1.5 by 4 0 0; tick | HOVERING OURS, goto accepted complete
""",
    disarms_unseen,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_time_does(row: Row) -> None:
    row.fly()


@pytest.mark.slow
@pytest.mark.parametrize("state", ["RETURNING", "FLYING_MISSION"])
def test_a_return_and_a_mission_have_as_long_as_it_takes(state: str) -> None:
    (row,) = rows(f"{state} | wait 400 | =")
    row.fly()
