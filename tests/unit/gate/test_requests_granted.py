"""What is granted, what it begins, which request it displaces, and what the operator is told."""

from __future__ import annotations

import pytest

from gcs.gate.effects import SwitchedFence
from gcs.gate.inputs import Requested
from gcs.gate.requests import SwitchFence
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows


def switched(flight: Flight) -> None:
    """The fence is switched, and the new one is not told yet."""
    flight.script.gate.handle(Requested(99, "keyboard", SwitchFence(on=True)), flight.script.now_ns)


def is_on(flight: Flight) -> None:
    assert flight.script.all(SwitchedFence) == [SwitchedFence(on=True)]


ROWS = rows(
    """
# Control is taken at the present place.
EXTERNAL | {control, resume} | HOVERING TAKING, it superseded, $ accepted; holds 0 0 1.5; streams
HOLDING  | resume            | HOVERING TAKING, it superseded, $ accepted; holds 0 0 1.5; streams
# ArduPilot is asked for guided at once, px4 when the stream is a second old, and once.
ardupilot: flown | control; tick | HOVERING TAKING, sends GUIDED, control accepted
flown | control; wait 1 | HOVERING TAKING, control accepted
      | wait 0.05 | =, sends GUIDED | wait 1.95 | =
# A vehicle that already flies is external; on the ground there is no control to take.
flown | goto 1 0 1.5 | EXTERNAL NONE, goto refused NOT_IN_CONTROL
connected | control | GROUNDED NONE, control refused NOT_FLYING
# Control that is not confirmed ends in hold and external; guided that comes then is held.
flown | control; wait 6.1 | =, sends GUIDED HOLD, control accepted timed out NO_ANSWER
      | shows GUIDED | =, sends HOLD
# A vehicle that refuses guided ends the request, with its words.
flown; control; wait 1.1
    | rejects GUIDED no position | EXTERNAL NONE, sends HOLD, control aborted VEHICLE_REFUSED;
    ... says "no position"; says "TEMPORARILY_REJECTED"
flown; control; wait 1.1
    | fails GUIDED | EXTERNAL NONE, sends HOLD, control aborted VEHICLE_REFUSED;
    ... says "the vehicle refused guided mode (FAILED)"
# A picture is asked for and the place is streamed; one seen before it is not ours.
in HOVERING; photo seen 7
    | photo | TAKING_PICTURE OURS, sends PHOTO, photo accepted; awaits PHOTO; streams
    | photo seen 7 | = | photo seen 8 | HOVERING OURS, photo complete
# A mission is started; held in its place until it is shown, and then nothing is streamed.
armed; loaded 4
    | mission
    | FLYING_MISSION OURS, sends START_MISSION, mission accepted; awaits START_MISSION; silent
    | shows MISSION | =; silent
in HOVERING; loaded 4
    | mission
    | FLYING_MISSION OURS, sends START_MISSION, mission accepted; awaits START_MISSION; streams
    | shows MISSION | =; silent
# The fence is switched where the policy lets it; a mission was verified by another one.
fence_switchable=yes: {STATES -FLYING_MISSION}
    | fence-on; is-on | =, fence-on accepted complete; says "the fence is on"
fence_switchable=yes: FLYING_MISSION
    | fence-on; is-on
    | HOLDING OURS, sends HOLD, it aborted BAD_MISSION, fence-on accepted complete
fence_switchable=yes: connected | fence-off
    | =, fence-off accepted complete; says "the fence is off"
# Between the switch and the new fence no mission starts.
lab: ours; loaded 4; switched | mission | HOVERING OURS, mission refused NO_ORIGIN
# Switched on again it stops a flight outside.
lab: ours 0.5; fence-off; goto 30 0 1
    | tick | MOVING OURS, goto accepted
    | fence-on | HOLDING OURS, sends HOLD, goto aborted OUTSIDE_FENCE, fence-on accepted complete
# A newer goal takes the place of one that waits for its tick.
in HOVERING; goto 0 5 1.5 | go | =, goto replaced; goal 0 0 1.5
    | tick | MOVING OURS, go accepted; goal 4 0 1.5
# The owner of a goal may replace it where the policy says so.
retarget=replace: MOVING | another's go | =, go refused BUSY | go | =
    | tick | =, it superseded, go accepted; goal 4 0 1.5
# One that does not clear leaves the goal that flies, or the hover.
retarget=replace: MOVING | goto 500 0 1.5; tick | =, goto refused OUTSIDE_FENCE; goal 3 0 1.5
in HOVERING | goto 500 0 1.5; tick | =, goto refused OUTSIDE_FENCE; streams
# Every accepted request has one outcome and every refused none.
MOVING | photo; hold; shows HOLD
       | HOLDING OURS, sends HOLD, it aborted OPERATOR, photo refused BUSY, hold accepted complete
# Home and fence told again on the ground change nothing.
GROUNDED | same-fence | =; same | home 0 5 0 | =

# A refusal is one warning with its code and its sentence.
MOVING | photo | =, photo refused BUSY;
    ... tells WARNING Refused (BUSY): another request is under way:
    ... MOVING, goal (3.00 E, 0.00 N, 1.50 U)
# Completion is told and is no warning; what is accepted is not told.
connected | arm         | =, sends ARM, arm accepted; tells nothing
          | shows armed | =, arm complete; tells INFO Complete: arm
# A goal that a newer one replaces before its tick is not refused.
ours | goto 3 0 1.5; go | =, goto replaced; warns not
# Any other end is a warning with the request and the reason.
ours; goto 3 0 1.5; tick
    | hold | HOLDING OURS, sends HOLD, goto aborted OPERATOR, hold accepted;
    ... warns goto: aborted: stopped by the operator
# Of a vehicle that another flies it is told that nothing is done.
BATTERY_LOW=HOLD: EXTERNAL | raised BATTERY_LOW | =;
    ... says "HOLD: battery_low: bad"; says "nothing is done about it"
BATTERY_LOW=CAUTION: EXTERNAL | raised BATTERY_LOW | =; tells WARNING CAUTION: battery_low: bad
# The severity is told with what is wrong, also where the return that it demands is blocked.
BATTERY_LOW=HOLD: MOVING | raised BATTERY_LOW | HOLDING OURS, sends HOLD, it aborted SEVERITY;
    ... says "severity is HOLD: battery_low"
BATTERY_LOW=RETURN: MOVING; remembers return_up_m=none
    | raised BATTERY_LOW | HOLDING OURS, sends HOLD, it aborted SEVERITY;
    ... says "severity is RETURN: battery_low"
# A pilot's mode is why a goal that waits for its tick is refused.
ours; goto 3 0 1.5 | shows {HOLD, TAKEOFF, OTHER} | EXTERNAL NONE, goto refused MODE_CHANGED
# A hold that nobody answers is told once, also where its last try ends after it was commanded anew.
MOVING | hold; ignores HOLD | HOLDING OURS, sends HOLD, it aborted OPERATOR, hold accepted;
    ... says "No answer to the request for hold mode"
    | wait 1; ignores HOLD; ignores HOLD; wait 1; ignores HOLD | =, sends HOLD HOLD;
    ... unsaid "No answer"
# Silence is told again after an answer, and about something else.
HOLDING; ignores HOLD; wait 1 | ignores HOLD | =; unsaid "No answer"
    | wait 1; accepts HOLD | =, sends HOLD; unsaid "No answer"
    | wait 1; ignores HOLD | =, sends HOLD; says "No answer"
climb; abort | ignores HOLD | =; says "No answer"
    | ignores DISARM | =, abort timed out NO_ANSWER; says "No answer"
""",
    switched, is_on,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_is_granted(row: Row) -> None:
    row.fly()
