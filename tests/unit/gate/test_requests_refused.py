"""What is refused in each state, what is so already, and what is asked for in vain.

A request that cannot be granted now is refused at once, and refused means gone: nothing changes.
"""

from __future__ import annotations

import pytest

from tests.unit.gate.rows import Row, rows

ROWS = rows(
    """
# With another request under way, by state.
NO_VEHICLE | {MOTION -fence-on} | =, $ refused NO_VEHICLE; same
STALE      | {go, control, resume, arm, up, photo, mission} | =, $ refused STALE; same
GROUNDED   | {go, control, resume, photo} | =, $ refused NOT_FLYING; same
GROUNDED   | {arm, up, mission} | =, $ refused BUSY; same
HOVERING   | {control, resume, photo, mission} | =, $ refused CONTROL_PENDING; same
{TAKING_OFF, RETURNING, LANDING} | {go, resume, photo, mission, control} | =, $ refused BUSY; same
{MOVING, TAKING_PICTURE, FLYING_MISSION} | {go, resume, photo, mission} | =, $ refused BUSY; same
HOLDING    | {go, control, photo, mission} | =, $ refused HOLDING; same
EXTERNAL   | {go, photo, mission} | =, $ refused NOT_IN_CONTROL; same
{FLIGHT, HOLDING, EXTERNAL} | {arm, up} | =, $ refused ALREADY_FLYING; same
{STATES -NO_VEHICLE} | acro | =, acro refused UNSUPPORTED; same
{STATES -NO_VEHICLE} | fence-on | =, fence-on refused POLICY; same

# What is so already is complete at once and displaces nothing.
GROUNDED | return | =, return accepted complete; same
{MOVING, TAKING_PICTURE, FLYING_MISSION} | control | =, control accepted complete; same
in HOVERING | {control, resume} | =, $ accepted complete; same

# Without an operator nothing that moves is wanted any more.
{STATES -EXTERNAL}; quits | {MOTION} | =, $ refused OPERATOR_LOST; same
EXTERNAL; shows OTHER; quits | {MOTION} | =, $ refused OPERATOR_LOST; same
# Nor is it while the vehicle comes down without one.
flown; shows <LAND, RETURN>; quits | {MOTION} | <LANDING, RETURNING> NONE, $ refused OPERATOR_LOST
# Nor is what would be granted; nothing withdraws the hold.
in HOVERING; loaded 4; quits | {go, control, resume, photo, mission, return}
    | HOLDING OURS, $ refused OPERATOR_LOST
in HOLDING; loaded 4; quits | {resume, return} | =, $ refused OPERATOR_LOST
in EXTERNAL; loaded 4; quits | {resume, control, return} | =, $ refused OPERATOR_LOST
in GROUNDED; loaded 4; quits | {arm, up, mission, control, return} | =, $ refused OPERATOR_LOST
in {HOVERING, GROUNDED, EXTERNAL}; quits; shows HOLD
    | {resume, control, return, arm, up, photo} | =, $ refused OPERATOR_LOST
# What makes it safer is heard, and so is a disarm on the ground.
in HOVERING; quits | abort; hold
    | =, sends HOLD HOLD, abort accepted aborted OPERATOR, hold accepted
in HOVERING; quits | land | LANDING OURS, sends LAND, land accepted
in GROUNDED; quits | disarm | =, sends DISARM, disarm accepted

# Take-off and mission need the vehicle armed, on the ground, and nothing severe.
BATTERY_LOW=HOLD: armed; loaded 4; shows disarmed | {up, mission} | =, $ refused NOT_ARMED
BATTERY_LOW=HOLD: armed; loaded 4; no landed; wait 4 | {up, mission} | =, $ refused IN_AIR
BATTERY_LOW=HOLD: armed; loaded 4; raised BATTERY_LOW | {up, mission} | =, $ refused SEVERITY
# Of several conditions the worst counts, whichever came first.
BATTERY_LOW=HOLD: armed; loaded 4; {raised OTHER_STATION; raised BATTERY_LOW,
    ... raised BATTERY_LOW; raised OTHER_STATION} | {up, mission} | =, $ refused SEVERITY
BATTERY_LOW=HOLD: armed; raised BATTERY_LOW; over BATTERY_LOW
    | up | TAKING_OFF OURS, sends TAKE_OFF, up accepted
# Arming needs nothing severe.
BATTERY_LOW=HOLD: armed; shows disarmed; raised BATTERY_LOW | arm | =, arm refused SEVERITY
# Control needs nothing severe, a clear place (too fast for the way back) and a vehicle that flies.
BATTERY_LOW=HOLD: armed; flown
    | raised BATTERY_LOW; {resume, control} | =, $ refused SEVERITY
    | over BATTERY_LOW; at 170 0 1.5 by 2 0 0; {resume, control} | =, $ refused OUTSIDE_FENCE
    | no landed; wait 4; {resume, control} | =, $ refused NOT_FLYING
# So does resuming.
BATTERY_LOW=HOLD: armed; is IN_AIR; hold; shows HOLD; at 0 0 1.5
    | raised BATTERY_LOW; resume | HOLDING OURS, resume refused SEVERITY
    | over BATTERY_LOW; at 170 0 1.5 by 2 0 0; resume | =, resume refused OUTSIDE_FENCE
    | no landed; wait 4; resume | =, resume refused NOT_FLYING
# A mission needs a mission and a fence.
in {GROUNDED, HOVERING} | mission | =, mission refused NO_MISSION
    | loaded 4; remembers verifier=none; mission | =, mission refused NO_ORIGIN
unheard; shows HOLD armed; is ON_GROUND; position; loaded 4
    | mission | GROUNDED NONE, mission refused NO_ORIGIN
# Without a fence nothing that moves is accepted.
unheard; shows GUIDED armed; is ON_GROUND; position | up | GROUNDED NONE, up refused NO_ORIGIN
# A goal that waits for its tick keeps others out.
in HOVERING; loaded 4; go | {photo, mission} | =, $ refused BUSY

# Arming needs a recorder where the policy does, whatever else is wrong.
arm_requires_recording=yes, RECORDER_FAILED=CAUTION, BATTERY_LOW=CAUTION:
    ... connected; raised BATTERY_LOW | arm | =, sends ARM, arm accepted
arm_requires_recording=yes, RECORDER_FAILED=CAUTION, BATTERY_LOW=CAUTION:
    ... connected; raised BATTERY_LOW; raised RECORDER_FAILED | arm | =, arm refused RECORDER_DOWN
arm_requires_recording=no, RECORDER_FAILED=CAUTION, BATTERY_LOW=CAUTION:
    ... connected; raised BATTERY_LOW; raised RECORDER_FAILED | arm | =, sends ARM, arm accepted
arm_requires_recording=yes: connected; raised RECORDER_FAILED | arm | =, arm refused RECORDER_DOWN;
    ... says "arm_requires_recording = true"
# So it needs that nothing fails before a take-off.
arming.preflight=no_fail, PREFLIGHT_FAILED=CAUTION: connected; raised PREFLIGHT_FAILED
    ... | arm | =, arm refused PREFLIGHT; says "gcs preflight"
arming.preflight=off, PREFLIGHT_FAILED=CAUTION: connected; raised PREFLIGHT_FAILED
    ... | arm | =, sends ARM, arm accepted
# A refusal by the policy names its key.
connected | fence-off | =, fence-off refused POLICY;
    ... says "the policy does not allow it: fence_switchable = false"
flown | force | =, force refused POLICY; says "in the air: allow_force_disarm = false"
ours; goto 9 0 1.5; tick | goto 3 0 1.5 | MOVING OURS, goto refused BUSY;
    ... says "(policy: retarget = "clients")"
# Another operator's goal is not replaced: the key would be for the operator's own.
retarget=replace: ours; goto 9 0 1.5; tick | another's {go, stream} | =, $ refused BUSY;
    ... says "another operator's request is flown: MOVING, goal";
    ... says "hold it first, or wait for its end"
# A stream does not begin before one's own goal is decided.
retarget=replace: ours; goto 9 0 1.5; tick; goto 5 0 1.5 | stream | =, stream refused BUSY;
    ... says "another request is under way: MOVING, goal"
# On the ground the modes of flight are refused, and of others it is said why they are not sent.
connected | mode <AUTO.LAND LAND, AUTO.RTL RETURN, OFFBOARD GUIDED> | =, mode refused NOT_FLYING
connected | mode <LOITER OTHER BRAKE, ACRO OTHER, AUTO.TAKEOFF TAKEOFF> | =,
    ... mode refused UNSUPPORTED; says "<this station sends BRAKE in its place,
    ... no key of the policy allows it, `takeoff` climbs to a height>"
# A mode by its name is the request that it means.
in MOVING | mode AUTO.LAND LAND | LANDING OURS, sends LAND, it superseded, mode accepted
          | mode ACRO OTHER | =, mode refused UNSUPPORTED
# A climb that leaves the limits is refused, and so is one from what is not known to stand.
armed | take-off 500 | =, take-off refused TOO_HIGH
armed; wait 1; no landed; wait 4 | up | =, up refused IN_AIR
# No control is taken of a vehicle whose position is too old.
flown; no positions; later 2 | control | STALE NONE, control refused STALE
# A resume from the grace of a hold is refused, and a goal whose position is too old at its tick.
stale HOLDING | resume | =, resume refused STALE
in HOVERING; no positions; wait 1; goto 3 0 1.5 | tick | STALE OURS, goto refused STALE
""",
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_is_refused(row: Row) -> None:
    row.fly()
