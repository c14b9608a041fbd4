"""What the answers of the vehicle do in each state: an answer only ends a command (DESIGN 4)."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind
from gcs.gate.inputs import CommandEnded
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows


def nobodys_answers(flight: Flight) -> None:
    for result in (0, 2, None):
        flight.script.feed(CommandEnded(-1, CommandKind.LAND, result))


ROWS = rows(
    """
# An acknowledgement moves nothing.
<GROUNDED, TAKING_OFF, TAKING_PICTURE, FLYING_MISSION, HOLDING, EXTERNAL>
    | accepts <ARM, TAKE_OFF, PHOTO, START_MISSION, HOLD, FORCE_DISARM> | =
HOVERING; wait 1.2 | accepts GUIDED | =
ours; <return, land> | accepts <RETURN, LAND> | =
# A refusal or no answer ends the request.  What would fly on by itself is held; with a picture
# ... missing, hovering goes on; one whose control we asked for is given up.
GROUNDED | refuses ARM | =, it aborted VEHICLE_REFUSED
GROUNDED | ignores ARM | =, it timed out NO_ANSWER
TAKING_OFF; remembers mode=HOLD
    | <refuses, ignores> TAKE_OFF
    | HOLDING OURS, sends HOLD, it <aborted VEHICLE_REFUSED, timed out NO_ANSWER>
HOVERING; wait 1.2
    | <refuses, ignores> GUIDED
    | EXTERNAL NONE, sends HOLD, it <aborted VEHICLE_REFUSED, timed out NO_ANSWER>
TAKING_PICTURE
    | <refuses, ignores> PHOTO
    | HOVERING OURS, it <aborted VEHICLE_REFUSED, timed out NO_ANSWER>
FLYING_MISSION; remembers mode=HOLD
    | <refuses, ignores> START_MISSION
    | HOLDING OURS, sends HOLD, it <aborted VEHICLE_REFUSED, timed out NO_ANSWER>
ours; return
    | <refuses, ignores> RETURN
    | HOLDING OURS, sends HOLD, return <aborted VEHICLE_REFUSED, timed out NO_ANSWER>
ours; land
    | <refuses, ignores> LAND
    | HOLDING OURS, sends HOLD, land <aborted VEHICLE_REFUSED, timed out NO_ANSWER>
EXTERNAL
    | <refuses, ignores> FORCE_DISARM | =, it <aborted VEHICLE_REFUSED, timed out NO_ANSWER>
# A lost answer is nothing where the vehicle shows that it does it, a refusal is one.
ours; return; shows {RETURN, LAND} | ignores RETURN | =
ours; return; shows {RETURN, LAND}
    | refuses RETURN | HOLDING OURS, sends HOLD, return aborted VEHICLE_REFUSED
ours; land; shows LAND | ignores LAND | =
ours; land; shows LAND | refuses LAND | HOLDING OURS, sends HOLD, land aborted VEHICLE_REFUSED
<TAKING_OFF, FLYING_MISSION> | ignores <TAKE_OFF, START_MISSION> | =
<TAKING_OFF, FLYING_MISSION>
    | refuses <TAKE_OFF, START_MISSION> | HOLDING OURS, sends HOLD, it aborted VEHICLE_REFUSED
# What did not leave the ground stays there; a command that may come late finds it disarmed.
climb; remembers mode=HOLD | refuses TAKE_OFF | GROUNDED NONE, it aborted VEHICLE_REFUSED
climb; remembers mode=HOLD
    | ignores TAKE_OFF | GROUNDED NONE, sends HOLD DISARM, it timed out NO_ANSWER
armed; loaded 4; mission
    | refuses START_MISSION | GROUNDED NONE, mission aborted VEHICLE_REFUSED
armed; loaded 4; mission
    | ignores START_MISSION | GROUNDED NONE, sends HOLD DISARM, mission timed out NO_ANSWER
# A take-off that nobody answers and that comes late is held.
in TAKING_OFF; ignores TAKE_OFF | is IN_AIR | HOLDING OURS, sends HOLD
# With a position too old the stream ends and the vehicle is held.
<TAKING_PICTURE, FLYING_MISSION, TAKING_OFF>; no positions; wait 1.2
    | refuses <PHOTO, START_MISSION, TAKE_OFF>
    | STALE OURS, sends HOLD, it aborted VEHICLE_REFUSED; silent | positions; tick | HOLDING OURS
<TAKING_PICTURE, FLYING_MISSION, TAKING_OFF>; no positions; wait 1.2
    | ignores <PHOTO, START_MISSION, TAKE_OFF>
    | STALE OURS, sends HOLD, it timed out NO_ANSWER; silent | positions; tick | HOLDING OURS
# An arming that fails there just ends.
GROUNDED; no positions; wait 1.2 | refuses ARM | STALE NONE, it aborted VEHICLE_REFUSED
GROUNDED; no positions; wait 1.2 | ignores ARM | STALE NONE, it timed out NO_ANSWER
# An answer that nobody waits for is told and not acted on.
{GROUNDED, TAKING_OFF, HOVERING, TAKING_PICTURE, FLYING_MISSION, RETURNING, LANDING, HOLDING}
    | nobodys-answers | =; same; setpoints none
{EXTERNAL, MOVING, STALE, NO_VEHICLE} | nobodys-answers | =; same; setpoints none

# A hold that is not answered is asked for again at the next second.
HOLDING | ignores HOLD | = | wait 1.1 | =, sends HOLD
{STALE, NO_VEHICLE}; abort | ignores HOLD | = | wait 1.1 | =, sends HOLD
# A refusal of the gate's own hold ends no request, and it is asked again.
TAKING_OFF; refuses TAKE_OFF | refuses HOLD; wait 1.1 | HOLDING OURS, sends HOLD
    | refuses HOLD; wait 1.1 | =, sends HOLD

# A disarm that is refused on the ground just ends, with an old position too.
armed; disarm | refuses DISARM | =, disarm aborted VEHICLE_REFUSED
armed; disarm; no positions; wait 1.2 | refuses DISARM | STALE NONE, disarm aborted VEHICLE_REFUSED
armed; disarm | ignores DISARM | =, disarm timed out NO_ANSWER
# Where a take-off may come yet the vehicle is held.
climb; disarm | refuses DISARM | GROUNDED NONE, sends HOLD, disarm aborted VEHICLE_REFUSED
              | wait 1.1 | =, sends HOLD
climb; no positions; wait 1.2; disarm
    | refuses DISARM | STALE NONE, sends HOLD, disarm aborted VEHICLE_REFUSED
# So is one that is not known to stand.
armed; no landed; wait 4; disarm
    | refuses DISARM | HOLDING OURS, sends HOLD, disarm aborted VEHICLE_REFUSED
# A disarm of a vehicle that was never seen armed is over with its answer and a heartbeat.
GROUNDED; {disarm, force, abort}
    | shows disarmed | = | accepts DISARM | = | shows disarmed | =, $ complete
GROUNDED | accepts ARM; shows disarmed | =
# One answer ends one command.
climb | abort | GROUNDED NONE, sends HOLD DISARM, it aborted OPERATOR, abort accepted;
      ... awaits HOLD DISARM
      | accepts HOLD | =; awaits DISARM | fails DISARM
    | =, sends HOLD, abort aborted VEHICLE_REFUSED

# A picture that nobody asked for changes nothing; ours ends the request, the very first one too.
{STATES -TAKING_PICTURE, -NO_VEHICLE} | photo {seen, failed} 4 | =
TAKING_PICTURE | photo <seen, failed> <4, 4>
               | HOVERING OURS, it <complete, aborted VEHICLE_REFUSED>
TAKING_PICTURE | photo seen 0 | HOVERING OURS, it complete
in HOVERING; photo seen 7; photo | photo seen 7 | = | photo seen 8 | HOVERING OURS, photo complete

# Items of a mission that does not fly change nothing, and neither does one of ours.
{STATES -FLYING_MISSION, -NO_VEHICLE} | {item 3 4, item 3 4 finished} | =
FLYING_MISSION | item 3 5 | =
# After the last one control is taken at the place; px4 shows its end by the hold mode.
FLYING_MISSION | item 4 5 finished | HOVERING TAKING; streams
    | wait 1.1; shows GUIDED | HOVERING OURS, sends GUIDED, it complete
FLYING_MISSION; item 4 5 | shows HOLD | HOVERING TAKING
# Where the place does not clear, or it is not known to fly, it is complete and held.
max_up_m=10: FLYING_MISSION; item 4 5; at 0 0 12
    | {item 4 5 finished, shows HOLD} | HOLDING OURS, sends HOLD, it complete
FLYING_MISSION; item 4 5; no landed; wait 4
    | {item 4 5 finished, shows HOLD} | HOLDING OURS, sends HOLD, it complete
# On the ground the landing completes it.
armed; loaded 4; mission; shows MISSION | item 3 4 finished | FLYING_MISSION OURS
# The hold mode is its end at the last item or past it, and not before, nor of another mission.
FLYING_MISSION; item {4 5, 5 5, 0 1} | shows HOLD | HOVERING TAKING
FLYING_MISSION; item {3 5, 0 2, 0 0, 3 0} | shows HOLD | EXTERNAL NONE, it taken over MODE_CHANGED
FLYING_MISSION | shows HOLD | EXTERNAL NONE, it taken over MODE_CHANGED
FLYING_MISSION; item 4 5; loaded 3 | shows HOLD | EXTERNAL NONE, it taken over MODE_CHANGED
# A mission that ends in a landing is complete on the ground.
FLYING_MISSION | shows LAND | LANDING OURS
    | is ON_GROUND | GROUNDED NONE | shows disarmed | =, it complete

# ArduPilot climbs once it shows guided, and then waits for no mode any more.
ardupilot: connected; arm; shows GUIDED; shows armed; shows HOLD
    | up | TAKING_OFF OURS, sends GUIDED, up accepted
    | shows GUIDED | =, sends TAKE_OFF; asks none | wait 6 | =
""",
    nobodys_answers,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_an_answer_does(row: Row) -> None:
    row.fly()
