"""Hold, abort, land, return and disarm in each state: on the ground, in the air, and where nobody
knows."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle
from gcs.gate.inputs import VerifierChanged
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows


def net(flight: Flight) -> None:
    """An exclusion zone over home, from 5 m to 8 m."""
    script = flight.script
    fence = verifier_for(script.policy, "px4", (0.0, 0.0, 0.0), None)
    zone = Zone("net", False, Circle((0.0, 0.0), 4.0), 5.0, 8.0)
    script.feed(VerifierChanged(replace(fence, zones=(*fence.zones, zone))))


ROWS = rows(
    """
# In the air it holds at once and ends what was under way; the hold that is seen completes it.
{AIRBORNE} | <hold, abort> | HOLDING OURS, sends HOLD, it aborted OPERATOR, <hold, abort> accepted
           | shows HOLD | =, <hold, abort> complete
           | wait 3 | =
# A take-off that stands may come yet, so it is held and disarmed.
climb | <hold, abort>
      | GROUNDED NONE, sends HOLD DISARM, it aborted OPERATOR, <hold, abort> accepted
      | wait 1.1 | =, sends HOLD
# The hold of an abort that disarms completes nothing.
climb | abort; shows HOLD | GROUNDED NONE, sends HOLD DISARM, it aborted OPERATOR, abort accepted
      | shows disarmed | =, abort complete
# Where the position is too old it holds and streams no more.
stale {MOVING, FLYING_MISSION} | <hold, abort>
      | STALE OURS, sends HOLD, it aborted OPERATOR, <hold, abort> accepted; silent
      | positions; tick | HOLDING OURS
# Abort of a vehicle that is not heard is sent until its time is over.
NO_VEHICLE | abort    | NO_VEHICLE NONE, sends HOLD, it aborted OPERATOR, abort accepted
           | wait 3   | =, sends HOLD HOLD HOLD
           | wait 2.1 | =, sends HOLD HOLD, abort timed out NO_ANSWER
# None of them is ever refused in flight, whether or not a request is under way.
in {EXTERNAL, HOLDING} | {hold, abort} | HOLDING OURS, sends HOLD, $ accepted
in {EXTERNAL, HOLDING} | land | LANDING OURS, sends LAND, land accepted
ours; no positions; wait 1.1 | {hold, abort} | STALE OURS, sends HOLD, $ accepted
ours; no positions; wait 1.1 | land | LANDING OURS, sends LAND, land accepted
ours; no positions; wait 1.1 | return | STALE OURS, sends HOLD, return refused RTL_BLOCKED
# Nothing is asked of nobody, nor of somebody who is lost.
unheard    | <hold, abort, land, disarm> | =, <hold, abort, land, disarm> refused NO_VEHICLE
NO_VEHICLE | <disarm, force, return>     | =, <disarm, force, return> refused NO_VEHICLE
# Hold is repeated at 1 Hz until the heartbeat shows it, and then no more.
MOVING | hold; wait 2.5 | HOLDING OURS, sends HOLD HOLD HOLD, it aborted OPERATOR, hold accepted
       | shows HOLD | =, hold complete | wait 3 | =
# The held point is streamed where it was verified; what somebody else flew is held in silence.
MOVING   | at 1 0 1.5; hold | HOLDING OURS, sends HOLD, it aborted OPERATOR, hold accepted
         | wait 1 | =, sends HOLD; setpoints 1 0 1.5
EXTERNAL | hold; wait 1 | HOLDING OURS, sends HOLD, it aborted OPERATOR, hold accepted complete;
         ... setpoints none
# It is commanded and takes the place of what was under way; held in its place until it is shown.
{AIRBORNE, STALE -MOVING, -TAKING_PICTURE, -HOLDING}
    | land | LANDING OURS, sends LAND, it superseded, land accepted; silent
    | shows LAND | =; silent
{MOVING, TAKING_PICTURE, HOLDING}
    | land | LANDING OURS, sends LAND, it superseded, land accepted; streams
    | shows LAND | =; silent

# Disarmed on the ground there is nothing left to do.
connected | <disarm, force, abort, land, return>
          | =, <disarm, force, abort, land, return> accepted complete
# Armed it stands all the same.
armed | <land, return, arm> | GROUNDED NONE, <land, return, arm> accepted complete
# What is being armed is disarmed.
GROUNDED | <disarm, force>
         | GROUNDED NONE, sends DISARM, it superseded, <disarm, force> accepted
GROUNDED | abort | GROUNDED NONE, sends DISARM, it aborted OPERATOR, abort accepted
# A disarm is complete when the heartbeat shows it.
armed | <disarm, force, abort> | =, sends DISARM, <disarm, force, abort> accepted
      | accepts DISARM | = | shows disarmed | =, <disarm, force, abort> complete
# A second arm while the first is under way is refused.
GROUNDED | arm | =, arm refused BUSY
# Armed and not known to stand it is asked to come down, and that is not complete at once.
armed; no landed; wait 4 | <hold, abort, land, return>
    | <HOLDING, HOLDING, LANDING, RETURNING> OURS, sends <HOLD, HOLD, LAND, RETURN>,
    ... <hold, abort, land, return> accepted; awaits <HOLD, HOLD, LAND, RETURN>
# So is what climbed, whatever was reported last.
armed; wait 1; no landed; at 0 0 0.8 | hold | HOLDING OURS, sends HOLD, hold accepted
# So is it held with a disarm under way.
armed; no landed; wait 4; disarm | <hold, abort>
    | HOLDING OURS, sends HOLD, disarm aborted OPERATOR, <hold, abort> accepted
# Where a take-off was given up and may come yet, hold is commanded; abort also disarms.
climb; refuses TAKE_OFF; disarm
    | hold | GROUNDED NONE, sends HOLD, disarm aborted OPERATOR, hold accepted
    | wait 1.1 | =, sends HOLD
climb; refuses TAKE_OFF; disarm
    | abort | GROUNDED NONE, sends HOLD DISARM, disarm aborted OPERATOR, abort accepted
# A landing is commanded there.
climb; refuses TAKE_OFF; disarm | land | LANDING OURS, sends LAND, disarm superseded, land accepted
# Disarmed it takes off no more.
climb; refuses TAKE_OFF; shows disarmed | <land, return> | =, <land, return> accepted complete
# A blocked return of what may fly is treated as in flight.
rtl_blocked=<hold, land>: climb; refuses TAKE_OFF; disarm; return-height 80
    | return | <HOLDING, LANDING> OURS, sends <HOLD, LAND>,
    ... disarm aborted OPERATOR, return refused RTL_BLOCKED
rtl_blocked=forward: climb; refuses TAKE_OFF; disarm; return-height 80
    | return | RETURNING OURS, sends RETURN, disarm superseded, return accepted
# In a climb whose landed state is lost, abort holds.
climb 10; no landed; at 0 0 1 | abort
    | HOLDING OURS, sends HOLD, it aborted OPERATOR, abort accepted

# Standing with an old position there is nothing left to do.
armed; no positions; wait 1.2 | <land, return> | =, <land, return> accepted complete
# It is disarmed.
armed; no positions; wait 1.2 | <disarm, abort> | STALE NONE, sends DISARM, <disarm, abort> accepted
    | shows disarmed | =, <disarm, abort> complete
armed; no positions; wait 1.2; shows disarmed | <disarm, abort>
    | =, <disarm, abort> accepted complete
# A forced disarm on the ground is a disarm.
armed; no positions; wait 1.2 | force | GROUNDED NONE, sends DISARM, force accepted
    | shows disarmed | =, force complete
# What is being armed is disarmed.
stale GROUNDED | disarm | STALE NONE, sends DISARM, it superseded, disarm accepted
stale GROUNDED | abort  | STALE NONE, sends DISARM, it aborted OPERATOR, abort accepted
# A take-off that stands is held and disarmed by abort; disarm forgets it.
climb; no positions; wait 1.2
    | abort | STALE NONE, sends HOLD DISARM, it aborted OPERATOR, abort accepted
    | positions; tick | GROUNDED NONE
climb; no positions; wait 1.2
    | disarm | STALE NONE, sends DISARM, it superseded, disarm accepted
    | positions; tick | GROUNDED NONE
# The hold of an abort that disarms completes nothing there either.
climb; no positions; wait 1.2; abort
    | shows HOLD; wait 1.5 | = | shows disarmed | =, abort complete
# Hold is a hold there, a landing is commanded, and a return is blocked and held.
climb; no positions; wait 1.2 | hold | STALE OURS, sends HOLD, it aborted OPERATOR, hold accepted
climb; no positions; wait 1.2 | land | LANDING OURS, sends LAND, it superseded, land accepted
climb; no positions; wait 1.2
    | return | STALE OURS, sends HOLD, it aborted OPERATOR, return refused RTL_BLOCKED
# So it is when the take-off can come late no more: it is under way as long as it is not given up.
climb; wait 12; no positions; wait 1.2
    | land | LANDING OURS, sends LAND, it superseded, land accepted

# Disarmed by one message and in the air by another, with no position yet: it is not known to stand.
unheard; shows disarmed; is IN_AIR | disarm | STALE NONE, disarm refused IN_AIR
unheard; shows disarmed; is IN_AIR | abort  | STALE OURS, sends HOLD, abort accepted

# A clear return is commanded; held in its place until it is shown.
{AIRBORNE -MOVING, -TAKING_PICTURE, -HOLDING}
    | return | RETURNING OURS, sends RETURN, it superseded, return accepted; silent
    | shows RETURN | =; silent
{MOVING, TAKING_PICTURE, HOLDING}
    | return | RETURNING OURS, sends RETURN, it superseded, return accepted; streams
    | shows RETURN | =; silent
# It is complete on the ground, disarmed.
MOVING | return; shows RETURN; is ON_GROUND
    | GROUNDED NONE, sends RETURN, it superseded, return accepted
       | shows disarmed | =, return complete
# A blocked one holds at once, lands, or is forwarded, as the policy says; a landing goes on.
{AIRBORNE -LANDING}; return-height 80
    | return | HOLDING OURS, sends HOLD, it aborted OPERATOR, return refused RTL_BLOCKED;
    ... says "'home'"; says "land instead"
rtl_blocked=land: {AIRBORNE -LANDING}; return-height 80
    | return | LANDING OURS, sends LAND, it aborted OPERATOR, return refused RTL_BLOCKED
rtl_blocked=forward: {AIRBORNE}; return-height 80
    | return | RETURNING OURS, sends RETURN, it superseded, return accepted
rtl_blocked={hold, land}: LANDING; return-height 80 | return | =, return refused RTL_BLOCKED
# With a position too old it is blocked and holds.
stale {MOVING, FLYING_MISSION}
    | return | STALE OURS, sends HOLD, it aborted OPERATOR, return refused RTL_BLOCKED; silent
    | positions; tick | HOLDING OURS
# The whole way home is judged, its descent too, and a severity finds it blocked as well.
ours; net; return-height 10; goto 20 0 1.5; wait 0.1; at 20 0 1.5; wait 1
    | return | HOLDING OURS, sends HOLD, return refused RTL_BLOCKED; says "the descent at home";
    ... says "net"; says "land instead"
ours; net; return-height 10; goto 20 0 1.5; wait 0.1; at 20 0 1.5; wait 1
    | raised BATTERY_CRITICAL | HOLDING OURS, sends HOLD

# In the air a disarm is refused, and a forced one where the policy does not allow it.
{AIRBORNE, STALE} | disarm | =, disarm refused IN_AIR; same
{AIRBORNE, STALE -EXTERNAL} | force | =, force refused POLICY; same | force
    | =, force refused POLICY
{flown, ours} | force; force; force
    | =, force refused POLICY, force refused POLICY, force refused POLICY
# Forced it needs the policy and a second request.
allow_force_disarm=yes: {AIRBORNE -EXTERNAL}
    | force | =, force refused IN_AIR
    | force | EXTERNAL NONE, sends FORCE_DISARM, it superseded, force accepted; silent
    | position | =
    | shows disarmed | GROUNDED NONE, force complete
allow_force_disarm=yes: STALE
    | force | =, force refused IN_AIR
    | force | EXTERNAL NONE, sends FORCE_DISARM, it superseded, force accepted; silent
    | shows disarmed | =, force complete
allow_force_disarm=yes: {in HOLDING, ours; no positions; wait 1.1}
    | force | =, force refused IN_AIR | force | EXTERNAL NONE, sends FORCE_DISARM, force accepted
EXTERNAL | force | =, sends FORCE_DISARM, it superseded, force accepted
EXTERNAL; wait 6 | force | =, force refused IN_AIR
    | force | =, sends FORCE_DISARM, force accepted | shows disarmed | GROUNDED NONE, force complete
# Within five seconds, and not later; one without force is no first request.
allow_force_disarm=yes: ours | force; tick 100 | =, force refused IN_AIR
    | force | EXTERNAL NONE, sends FORCE_DISARM, force accepted
allow_force_disarm=yes: ours | force; tick 101 | =, force refused IN_AIR
    | force; wait 4.9 | =, force refused IN_AIR
    | force | EXTERNAL NONE, sends FORCE_DISARM, force accepted
allow_force_disarm=yes: ours | disarm; force | =, disarm refused IN_AIR, force refused IN_AIR
# Without an operator no motor is stopped in the air.
allow_force_disarm=yes: {AIRBORNE -EXTERNAL}; force; quits | force | =, force refused OPERATOR_LOST
EXTERNAL; wait 6; force; quits | force | =, force refused OPERATOR_LOST
# On the ground a take-off is disarmed, and without an operator all the same.
climb | <disarm, force> | GROUNDED NONE, sends DISARM, it superseded, <disarm, force> accepted
armed; quits | disarm; force | =, sends DISARM DISARM, disarm accepted superseded, force accepted

# A refused hold ends its request, and the hold goes on being commanded at 1 Hz.
EXTERNAL; {hold, abort} | refuses HOLD | HOLDING OURS, {hold, abort} aborted VEHICLE_REFUSED
{MOVING, stale MOVING}; {hold, abort}
    | refuses HOLD not now | =, {hold, abort} aborted VEHICLE_REFUSED;
    ... says "the vehicle refused hold mode (DENIED): not now"
    | wait 1.1 | =, sends HOLD | refuses HOLD; wait 1.1 | =, sends HOLD
    | shows HOLD; shows HOLD; wait 5 | =
# It ends on the ground where a take-off may come late, and where the vehicle is not heard any more.
in TAKING_OFF; ignores TAKE_OFF; hold | refuses HOLD not now
    | GROUNDED NONE, hold aborted VEHICLE_REFUSED
NO_VEHICLE; abort | refuses HOLD not now | =, abort aborted VEHICLE_REFUSED
# The gate's own hold is commanded at 1 Hz whatever the answer, until it is seen.
MOVING | quits | HOLDING OURS, sends HOLD, it aborted OPERATOR_LOST
       | refuses HOLD; wait 1 | =, sends HOLD | refuses HOLD; wait 1 | =, sends HOLD
       | shows HOLD; wait 3 | =
# Only resume leads back to hovering, and the goal is gone.
in HOLDING | goto 3 0 1.5; control | =, goto refused HOLDING, control refused HOLDING
    | resume; wait 1.1; shows GUIDED | HOVERING OURS, sends GUIDED, resume accepted complete;
    ... holds 0 0 1.5
# Our own guided that comes after the hold is held again.
in HOLDING; resume; wait 1.1; abort; shows HOLD
    | shows GUIDED | HOLDING OURS, sends HOLD
# After a refused disarm of what is not known to stand it is held.
armed; no landed; wait 4; disarm
    | fails DISARM | HOLDING OURS, sends HOLD, disarm aborted VEHICLE_REFUSED
# A hold after a take-off that nobody answered is commanded.
climb; shows HOLD
    | ignores TAKE_OFF | GROUNDED NONE, sends HOLD DISARM, it timed out NO_ANSWER
    | hold | =, sends HOLD, hold accepted
""",
    net,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_stops_it(row: Row) -> None:
    row.fly()
