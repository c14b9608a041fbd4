"""Armed, disarmed, airborne and landed, as reported, in each state."""

from __future__ import annotations

import pytest

from tests.unit.gate.rows import Row, rows

ROWS = rows(
    """
# Arming is complete when it is shown; being armed by somebody completes no disarm.
GROUNDED | shows armed | =, it complete
armed; shows disarmed; abort; shows armed; disarm | shows armed | =
# Being armed in flight changes nothing.
{FLIGHT, HOLDING}; remembers armed=no | shows armed | =
# Disarmed it is nobody's, and what ends there is complete.
{RETURNING, LANDING, FLYING_MISSION, EXTERNAL} | shows disarmed | GROUNDED NONE, it complete; silent
{TAKING_OFF, GUIDED_STATES, HOLDING} | shows disarmed
    | GROUNDED NONE, it taken over NOT_ARMED; silent
# On the ground it completes what ends there.
climb; ignores TAKE_OFF; {abort, disarm, force, land} | shows disarmed | GROUNDED NONE, $ complete
# A hold of what may lift off is over with the disarm.
climb; ignores TAKE_OFF; hold; shows disarmed | wait 3 | =
# Nothing of ours ends with the disarm of a vehicle that stands.
armed | shows disarmed | =

# One that stands is not flown any more.
{GUIDED_STATES, EXTERNAL} | is ON_GROUND | GROUNDED NONE, it taken over NOT_FLYING; silent
# Standing is as good as held.
MOVING; {hold, abort} | is ON_GROUND | GROUNDED NONE, $ complete
# What was to do otherwise is not.
MOVING; land; refuses LAND; shows HOLD | is ON_GROUND | GROUNDED NONE
# Coming down is complete on the ground and disarmed, or three seconds later.
{RETURNING, LANDING} | is ON_GROUND | GROUNDED NONE | shows disarmed | =, it complete
{RETURNING, LANDING}; is ON_GROUND | wait 2.9 | = | wait 0.2 | =, it complete
FLYING_MISSION; remembers lifted=yes; is ON_GROUND | wait 2.9 | = | wait 0.2 | =, it complete
# Or at once where it is disarmed already.
{RETURNING, LANDING, FLYING_MISSION}; remembers lifted=yes armed=no
    | is ON_GROUND | GROUNDED NONE, it complete
# Before the lift-off the ground is nothing new.
climb; remembers armed={yes, no}; is UNDEFINED | is ON_GROUND | TAKING_OFF OURS
armed; loaded 4; mission; shows MISSION; remembers armed={yes, no}; is UNDEFINED
    | is ON_GROUND | FLYING_MISSION OURS
climb; is IN_AIR | is ON_GROUND | GROUNDED NONE, it taken over NOT_FLYING
armed; loaded 4; mission; shows MISSION; is IN_AIR | is ON_GROUND | GROUNDED NONE
# The air is nothing new to what flies, nor the ground to what stands.
{FLIGHT, HOLDING, EXTERNAL}; is UNDEFINED | is IN_AIR | =
GROUNDED; is UNDEFINED | is ON_GROUND | =
GROUNDED; no positions; wait 1.2; is UNDEFINED | is ON_GROUND | STALE NONE
# What lifts off without us is somebody else's, or what its mode says.
armed; shows {OTHER, HOLD}; disarm | is IN_AIR | EXTERNAL NONE, disarm taken over MODE_CHANGED
armed; shows <LAND, RETURN>; disarm
    | is IN_AIR | <LANDING, RETURNING> NONE, disarm taken over IN_AIR
connected; shows MISSION armed | is IN_AIR | EXTERNAL NONE
# A disarm that ended so has nothing to do with the return that flies.
connected; shows RETURN armed; disarm; is IN_AIR | fails DISARM; wait 5.1 | RETURNING NONE
# A landing that bounces goes on (station.md, bug 11: it timed out three seconds later).
ours; <land, return, return>; shows <LAND, LAND, RETURN>
    | is ON_GROUND | GROUNDED NONE
    | wait 1; is IN_AIR; wait 10 | <LANDING, LANDING, RETURNING> NONE
    | is ON_GROUND; shows disarmed | GROUNDED NONE, $ complete
# Our own take-off that comes late is held; ten seconds later it is somebody else's.
climb; ignores TAKE_OFF; disarm | is IN_AIR | HOLDING OURS, sends HOLD, disarm aborted OPERATOR
climb; ignores TAKE_OFF; shows OTHER; wait 10.1 | is IN_AIR | EXTERNAL NONE
# A mission that lifts off again goes on, and is ours so that it is braked.
FLYING_MISSION; remembers lifted=yes | is ON_GROUND | GROUNDED NONE | is IN_AIR
    | FLYING_MISSION OURS
# It is held where nothing may fly (hostile run 43013300: it flew on, and the explorer took it for a
# ... mission that had been taken over), or where its operator is lost.
FLYING_MISSION; remembers lifted=yes; is ON_GROUND; raised GPS_LOST
    | is IN_AIR | HOLDING OURS, sends HOLD, it aborted SEVERITY
FLYING_MISSION; remembers lifted=yes operator_lost=yes; is ON_GROUND
    | is IN_AIR | HOLDING OURS, sends HOLD, it aborted OPERATOR_LOST
# The landed state ages while the vehicle is heard.
armed; wait 1; no landed | wait 4 | GROUNDED NONE; landed UNDEFINED

# A hold of what is disarmed is not repeated.
climb; abort; shows disarmed | wait 3 | =
# Nor is one of what refuses to disarm and cannot lift off any more: our own take-off comes no more
# ... ten seconds after it was commanded.
climb; wait 9.5; abort; wait 1.2 | fails DISARM | GROUNDED NONE, abort aborted VEHICLE_REFUSED
    | wait 3 | =
climb; wait 9.5; abort; no positions; wait 1.2
    | fails DISARM | STALE NONE, abort aborted VEHICLE_REFUSED | wait 3 | =
# What lifts off all the same is held in the air.
climb; hold; wait 10.5 | is IN_AIR | HOLDING OURS, sends HOLD
""",
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_a_report_of_arming_or_landing_does(row: Row) -> None:
    row.fly()
