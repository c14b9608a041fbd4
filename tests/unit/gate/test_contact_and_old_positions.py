"""A vehicle that is not heard, and one whose position is too old: the grace, and what ends it."""

from __future__ import annotations

import pytest

from gcs.gate.inputs import LandedSeen
from gcs.gate.states import LandedState
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows


def reported_in_air(flight: Flight) -> None:
    """Without the script's own reports of it."""
    flight.script.feed(LandedSeen(LandedState.IN_AIR))


def knows_nothing(flight: Flight) -> None:
    memory = flight.script.gate.memory
    assert (memory.armed, memory.mode, memory.landed) == (False, None, LandedState.UNDEFINED)


ROWS = rows(
    """
# A vehicle that is not heard any more is nobody's.
HOVERING; wait 1.1; shows; no heartbeats
    | wait 3.4 | = | wait 0.2; knows-nothing
    | NO_VEHICLE NONE, it aborted LINK_LOST; awaits none; silent
{HEARD -HOLDING, -HOVERING}; shows; no heartbeats
    | wait 3.4 | = | wait 0.2; knows-nothing
    | NO_VEHICLE NONE, it aborted LINK_LOST; awaits none; silent
# A hold that was asked for is asked for until it is shown.
HOLDING; shows; no heartbeats
    | wait 3.4 | =, sends HOLD HOLD HOLD
    | wait 0.2; knows-nothing
    | NO_VEHICLE NONE, sends HOLD, it aborted LINK_LOST; awaits HOLD; silent
HOLDING | unheard for 4 | NO_VEHICLE NONE, sends HOLD HOLD HOLD HOLD, it aborted LINK_LOST
    | wait 5 | =, sends HOLD HOLD HOLD HOLD HOLD
    | heartbeats; positions; shows GUIDED; is IN_AIR; tick | HOLDING OURS, sends HOLD
    | shows HOLD; wait 3 | =
# Any message is a sign of life (autopilots.md 7: without its heartbeats a vehicle was lost that
# ... told
# ... all else), but tells no mode of a vehicle that was lost.
MOVING; no heartbeats
    | wait 1; message; wait 1; message; wait 1; message; wait 1; message; wait 1 | =
    | {message, reported-in-air} | =
{unheard, NO_VEHICLE} | message | NO_VEHICLE NONE
# A stop goes out to a vehicle that was heard once.
ours; unheard for 4 | {hold, abort, mode AUTO.LOITER HOLD} | NO_VEHICLE NONE, sends HOLD, $ accepted
ours; unheard for 4 | land | NO_VEHICLE NONE, sends LAND, land accepted
unheard | {hold, abort, land, mode AUTO.LOITER HOLD} | =, $ refused NO_VEHICLE
# A landing that is not heard of is told, and is complete where it is seen.
ours; unheard for 4; land
    | <ignores, refuses> LAND | =, land <timed out NO_ANSWER, aborted VEHICLE_REFUSED>
ours; unheard for 4; land; accepts LAND; heartbeats; positions; shows LAND; is IN_AIR
    | wait 10 | LANDING NONE | is ON_GROUND; shows disarmed | GROUNDED NONE, land complete
# Who quits holds what we flew when it was heard last, and asks nothing of nobody.
{MOVING, FLYING_MISSION}; shows; no heartbeats; wait 4 | quits | =, sends HOLD; unsettled
{RETURNING, LANDING, EXTERNAL, GROUNDED}; shows; no heartbeats; wait 4 | quits | =; settled
unheard | quits | =; settled
# Who quits does not take back the landing of what is not heard, or does not show it yet.
ours; unheard for 4; land | quits | =, land aborted OPERATOR_LOST; cancels none; unsettled
ours; unheard for 4; land; shows HOLD; position
    | nothing | EXTERNAL NONE | quits | =, land aborted OPERATOR_LOST; cancels none; settled
# So it is where the position went first.
MOVING | unheard for 4 | NO_VEHICLE NONE, sends HOLD HOLD, it aborted STALE
# No heartbeat is no vehicle, and one that returns is somebody else's.
in MOVING; unheard for 5; shows GUIDED; is IN_AIR | position | EXTERNAL NONE
# Abort is sent to a vehicle that is not heard any more, until its time is over.
in MOVING; unheard for 5
    | abort | NO_VEHICLE NONE, sends HOLD, abort accepted
    | wait 6 | =, sends HOLD HOLD HOLD HOLD HOLD HOLD, abort timed out NO_ANSWER
# Somebody who is heard first is stale until a position comes.
unheard | shows | STALE NONE | tick | GROUNDED NONE
# What flies when it is first heard is where its mode says; armed and not known to stand, it flies.
unheard; shows <RETURN, LAND, HOLD, GUIDED> armed; is IN_AIR
    | position | <RETURNING, LANDING, EXTERNAL, EXTERNAL> NONE
unheard; shows HOLD armed | position | EXTERNAL NONE
# Disarmed and not known to fly it stands; disarmed is believed before the landed state.
unheard; shows LAND disarmed | position | GROUNDED NONE
unheard; shows LAND disarmed; is IN_AIR | position | GROUNDED NONE
# A hold that was commanded to nobody is commanded to whoever is heard.
NO_VEHICLE; shows GUIDED; is IN_AIR | position | HOLDING OURS, sends HOLD; silent
# The first position of a return is no jump.
rtl_blocked=forward: unheard; shows armed; is IN_AIR; land; return | position | RETURNING OURS

# Old position: what is streamed goes on for the grace, then it is held in silence.
{MOVING, TAKING_PICTURE}; tick; no positions
    | wait 1 | = | wait 0.1 | STALE OURS; streams | wait 0.4
    | =, sends HOLD, it aborted STALE; silent
{TAKING_OFF, FLYING_MISSION}; tick; no positions
    | wait 1 | = | wait 0.1 | STALE OURS; silent | wait 0.4
    | =, sends HOLD, it aborted STALE; silent
HOVERING; tick; no positions
    | wait 1 | =, sends GUIDED | wait 0.1 | STALE TAKING; streams
    | wait 0.4 | STALE OURS, sends HOLD, it aborted STALE; silent
# A hold that was asked for goes on until it is seen.
HOLDING; tick; no positions
    | wait 1 | =, sends HOLD | wait 0.1 | STALE OURS; streams | wait 0.4 | =; silent
# The stream ends at the nearest tick to the end of the grace.
MOVING; no positions | wait 1.45 | STALE OURS; setpoints 3 0 1.5
    | wait 0.1 | =, sends HOLD, it aborted STALE; setpoints 3 0 1.5 | wait 0.05 | =; setpoints none
# A position within the grace goes on where it was, one after it finds the vehicle held.
stale <TAKING_OFF, MOVING, TAKING_PICTURE, FLYING_MISSION, HOLDING>
    | position | <TAKING_OFF, MOVING, TAKING_PICTURE, FLYING_MISSION, HOLDING> OURS
stale HOVERING | position | HOVERING TAKING
stale {VERIFIED}; wait 0.5 | position | HOLDING OURS
# A return and a landing are the vehicle's own business.
{RETURNING, LANDING}; no positions | wait 3 | =
# What we do not fly is stale and comes back, and nothing is sent.
stale <GROUNDED, EXTERNAL> | wait 1 | STALE NONE | position | <GROUNDED, EXTERNAL> NONE

# While it is too old a pilot takes over.
stale {MOVING, TAKING_PICTURE, FLYING_MISSION}
    | shows {OTHER, TAKEOFF, HOLD} | STALE NONE, it taken over MODE_CHANGED; silent
    | wait 1 | = | positions; tick | EXTERNAL NONE
# A failsafe of the vehicle's own is seen; on the ground it is a mode and nothing more.
stale {MOVING, TAKING_PICTURE, FLYING_MISSION}
    | shows <RETURN, LAND> | <RETURNING, LANDING> NONE, it taken over MODE_CHANGED
stale GROUNDED | shows {RETURN, LAND} | =
# A hold that is not shown yet is waited for; the one that is shown completes its request.
stale MOVING; hold; shows GUIDED | shows {TAKEOFF, MISSION, RETURN, LAND, OTHER} | =
stale MOVING; hold; shows OTHER  | shows GUIDED | =
stale MOVING; {hold, abort} | shows HOLD | STALE OURS, $ complete | wait 2 | =
# The gate's own hold that is shown is not repeated.
stale MOVING | wait 0.5 | =, sends HOLD, it aborted STALE | shows HOLD; wait 2 | =
# A commanded mode that is not shown yet is waited for.
ours; loaded 4; mission; no positions; wait 1.1
    | shows OTHER; shows RETURN; shows LAND; shows GUIDED | STALE OURS
# The modes it was flown in change nothing.
stale {MOVING, TAKING_PICTURE} | shows | =; streams
stale FLYING_MISSION           | shows | =; silent
flown OTHER; control; no positions; wait 1.1 | shows HOLD | STALE TAKING
# A disarmed vehicle is nobody's, and so is one that stands.
stale <MOVING, TAKING_PICTURE, FLYING_MISSION>
    | shows disarmed | STALE NONE, it <taken over NOT_ARMED, taken over NOT_ARMED, complete>; silent
    | wait 1 | = | positions; tick | GROUNDED NONE
stale {MOVING, TAKING_PICTURE, FLYING_MISSION}
    | is ON_GROUND | STALE NONE, it taken over NOT_FLYING; silent | wait 1 | =
# The ground is nothing new to what stood, nor the disarm of what somebody else flies to us.
stale GROUNDED; is UNDEFINED | is ON_GROUND | =
flown; no positions; wait 1.1 | shows disarmed | STALE NONE
# Arming is complete all the same, and being armed completes no other request.
stale GROUNDED | shows armed | =, it complete
stale MOVING; remembers armed=no | shows armed | =
# What is verified no more is held and not streamed, with the reason.
stale {MOVING, TAKING_PICTURE, FLYING_MISSION}
    | jumps 20 0 1.5 | HOLDING OURS, sends HOLD, it aborted ESTIMATOR_RESET
    | shows HOLD; positions; tick | =
stale {MOVING, TAKING_PICTURE, FLYING_MISSION}
    | home 5 0 0 | STALE OURS, sends HOLD, it aborted HOME_MOVED; silent
    | shows HOLD; positions; tick | HOLDING OURS
stale <MOVING, TAKING_PICTURE, FLYING_MISSION>
    | fence elsewhere
    | STALE OURS, sends HOLD, it aborted <OUTSIDE_FENCE, OUTSIDE_FENCE, BAD_MISSION>; silent
    | shows HOLD; positions; tick | HOLDING OURS
# What flew again after an outage and landed stands.
stale MOVING; positions; tick | land; shows LAND; is ON_GROUND; shows disarmed
    | GROUNDED NONE, sends LAND, it superseded, land accepted complete
    | land | =, land accepted complete
""",
    reported_in_air,
    knows_nothing,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_is_not_heard_or_too_old(row: Row) -> None:
    row.fly()
