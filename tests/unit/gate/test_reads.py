"""What the gate answers when it is read: whether it may be left, its goals, its evidence."""

from __future__ import annotations

import pytest

from gcs.gate.effects import Verdict
from tests.unit.gate.flight_words import Flight, place
from tests.unit.gate.rows import Row, rows
from tests.unit.gate.script import SECOND, Script, policy
from tests.unit.gate.situations import UP


def names_goal(flight: Flight, *enu: str) -> None:
    """The last verdict has that goal as the active one; none: no words."""
    verdict = flight.script.all(Verdict)[-1]
    assert verdict.active_goal_ned == (place(*enu) if enu else None)


ROWS = rows(
    """
# The vehicle may be left where it is seen holding, on the ground, or not ours to hold.
MOVING   | nothing | =; unsettled
HOVERING | nothing | =; unsettled
ours; {return, land} | nothing | =; unsettled
ours; <return, land>; shows <RETURN, LAND> | nothing | =; settled
HOLDING  | nothing | =; unsettled | shows HOLD | HOLDING OURS, it complete; settled
TAKING_OFF | shows HOLD | =; unsettled
HOLDING; shows HOLD; wait 12; shows HOLD | nothing | =; settled
    | remembers mode=GUIDED | =; unsettled
armed | nothing | =; settled | disarm | =, sends DISARM, disarm accepted; unsettled
      | accepts DISARM | =; settled
flown | nothing | =; settled
NO_VEHICLE | nothing | =; unsettled

# The active goal is the one it flies to or hovers at.
ours | nothing | =; goal 0 0 1.5; holds 0 0 1.5
     | goto 3 0 1.5; tick | MOVING OURS, goto accepted; goal 3 0 1.5; holds 0 0 1.5
     | land | LANDING OURS, sends LAND, goto superseded, land accepted; goal none; holds 0 0 1.5
     | shows LAND | =; goal none; holds none
# A verdict names it.
MOVING | photo; names-goal 3 0 1.5 | =, photo refused BUSY;
       ... says "MOVING, goal (3.00 E, 0.00 N, 1.50 U)"
flown | photo; names-goal | =, photo refused NOT_IN_CONTROL

# A goal that clears no more by the tick is refused for the position.
ours; goto 0 3 1.5 | later 1.000000001; bare-tick | STALE OURS, goto refused STALE
# A request ends with its words.
MOVING | abort | HOLDING OURS, sends HOLD, it aborted OPERATOR, abort accepted;
       ... says "stopped by the operator"
# Resume at once after a hold takes the place of before.
HOLDING; sample 0.25 0 1.5 | resume | HOVERING TAKING, it superseded, resume accepted;
    ... holds 0.25 0 1.5
# A mission is refused where none is loaded any more.
ours; loaded 1; loaded 0 | mission | =, mission refused NO_MISSION
    | loaded 1; mission | FLYING_MISSION OURS, sends START_MISSION, mission accepted
# A take-off says where the top is: 4.25 m is within the radius of 4 m.
climb 4; is IN_AIR; flies 0 0 1; at 0 0 4.25 | shows HOLD; tick | HOVERING TAKING
""",
    names_goal,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_is_read(row: Row) -> None:
    row.fly()


def test_the_age_of_the_position() -> None:
    script = Script(policy("default"))
    assert script.gate.position_age_s(SECOND) is None
    script.position()
    assert script.gate.position_age_s(script.now_ns + SECOND // 4) == 0.25


def test_an_accepted_one_carries_the_numbers_it_was_cleared_on() -> None:
    script = Script(policy("default")).take_control(UP)
    asked = script.goto(3.0, 4.0, UP)
    script.tick()
    assert dict(script.verdict(asked).evidence)["leg_m"] == 5.0
