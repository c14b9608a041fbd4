"""A take-off: what is commanded, how far up it is, whether it has left the ground, where it ends.

PX4's own tolerance of the end of a climb is 0.8 m, the policy's arrival radius 0.5 m.
"""

from __future__ import annotations

import pytest

from gcs.gate.effects import SendCommand
from gcs.gate.machine.memory import Memory
from tests.unit.gate.flight_words import Flight, place
from tests.unit.gate.rows import Row, rows
from tests.unit.gate.situations import elsewhere, remember


def climbed_to(flight: Flight, up: str, mode: str) -> None:
    """The vehicle ends its climb so high, two metres off its place, and shows `mode`."""
    flight.do(f"is TAKEOFF; at 2 0 {up} by 0 0 1; is IN_AIR; flies 0 0 0; shows {mode}; tick")


def told_no_tolerance(flight: Flight) -> None:
    remember(flight.script, climb_ends_within_m=Memory("px4").climb_ends_within_m)


def clears_no_more(flight: Flight) -> None:
    remember(flight.script, verifier=elsewhere(flight.script))


def may_come_until_now(flight: Flight) -> None:
    remember(flight.script, takeoff_until_ns=flight.script.now_ns)


def known_to_be_at(flight: Flight, *enu: str) -> None:
    remember(flight.script, pos_ned=place(*enu))


def sends_up(flight: Flight, up: str) -> None:
    sent = flight.script.all(SendCommand)[-1]
    assert (sent.request_id, sent.up_m) == (flight.script.asked, float(up))


ROWS = rows(
    """
# The command has the height, also where it waited for its mode.
armed | take-off 7; sends-up 7 | TAKING_OFF OURS, sends TAKE_OFF, take-off accepted
ardupilot: connected; shows HOLD armed
    | take-off 3; shows GUIDED; sends-up 3
    | TAKING_OFF OURS, sends GUIDED TAKE_OFF, take-off accepted
# Not armed, no take-off.
connected | up | =, up refused NOT_ARMED
# The ground is as far down as where it stands: ten metres east of home it is disarmed by a stop.
stands-at 10 0 0; climb | hold
    | GROUNDED NONE, sends HOLD DISARM, it aborted OPERATOR, hold accepted
# A climb counts from where it stands.
{px4, ardupilot, somebody}: stands-at 4 3 7; connected; shows GUIDED armed
    | take-off 5 | TAKING_OFF OURS, sends TAKE_OFF, take-off accepted; top 4 3 12

# It ends hovering under confirmed control: taken, shown, and arrived.
armed; up; shows TAKEOFF; is TAKEOFF; at 0 0 1 by 0 0 1; is IN_AIR | tick | =; setpoints none
    | at 0 0 2; shows HOLD; tick | HOVERING TAKING
    | wait 1.1; shows GUIDED | MOVING OURS, sends GUIDED
    | wait 0.5 | HOVERING OURS, up complete
# The hold mode of an old heartbeat is not the end of the climb.
armed; up; is IN_AIR; at 0 0 0.3 by 0 0 1 | shows HOLD; wait 0.5 | TAKING_OFF OURS
# A climb to 5 m is over nearer than 0.5 m and slower than 0.3 m/s, and then control is taken.
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 <4.5, 5.5, 5> by 0 0 <0, 0, 0.3>; is IN_AIR
    | tick | TAKING_OFF OURS
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 <4.5625, 5.4375, 5> by 0 0 <0, 0, 0.25>; is IN_AIR
    | tick | HOVERING TAKING
ardupilot: climb 5; is TAKEOFF; flies 0 0 1; at 0 0 5 by 0 0 0; is IN_AIR | tick | HOVERING TAKING
# PX4 says by its hold mode that it is up, and may have passed through take-off to it unseen.
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 5 by 0 0 1; is IN_AIR
    | tick | TAKING_OFF OURS | shows HOLD; tick | HOVERING TAKING
armed; take-off 1.5 | wait 5.2 | TAKING_OFF OURS
    | is IN_AIR; flies 0 0 1; at 0 0 1.5 by 0 0 1; tick | HOVERING TAKING
# Far below and slow the climb ended there; in take-off mode it climbs on.
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 3 by 0 0 0; is IN_AIR; shows HOLD
    | tick | HOLDING OURS, sends HOLD, it aborted VEHICLE_REFUSED; says "2.0 m below the height";
    ... holds 0 0 3
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 3 by 0 0 0; is IN_AIR | wait 1 | TAKING_OFF OURS
# While it still climbs the hold mode is waited out.
climb 10; is IN_AIR; at 0 0 9 by 0 0 0.8
    | shows HOLD; tick | TAKING_OFF OURS | at 0 0 9.8; tick | HOVERING TAKING
# Above and slow the climb ended there; less than a metre above is told as above, too.
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 6 by 0 0 0; is IN_AIR; shows HOLD
    | tick | HOLDING OURS, sends HOLD, it aborted VEHICLE_REFUSED; says "1.0 m above the height"
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 {5.5, 5.75, 5.9375} by 0 0 1; is IN_AIR; flies 0 0 0
    | shows HOLD; tick | HOLDING OURS, sends HOLD, it aborted VEHICLE_REFUSED;
    ... says "m above the height asked for"
# A metre above the arrival radius is too high.
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 6.5 by 0 0 1; is IN_AIR | tick | TAKING_OFF OURS
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 6.5625 by 0 0 1; is IN_AIR
    | tick | HOLDING OURS, sends HOLD, it aborted TOO_HIGH
# At the top and not allowed to hover it is held.
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 5 by 0 0 0; is IN_AIR; known-to-be-at 170 0 5
    | bare-tick | HOLDING OURS, sends HOLD, it aborted TOO_CLOSE
# What is not known to fly has not climbed.
climb 5; is TAKEOFF; flies 0 0 1; at 0 0 5 by 0 0 0; remembers landed=UNDEFINED | tick
    | TAKING_OFF OURS

# The top that was verified is streamed and flown to.
climb 5; climbed-to {3.75, 4.25, 4.75, 5.25} HOLD
    | nothing | =; holds 0 0 5
    | wait 1.1; shows GUIDED | MOVING OURS, sends GUIDED; setpoints 0 0 5
    | at 0 0 5; wait 1 | HOVERING OURS, it complete; holds 0 0 5
# A climb that ended further below is not over; of one that told no tolerance the radius counts.
climb 5 | climbed-to 3.5 HOLD | HOLDING OURS, sends HOLD, it aborted VEHICLE_REFUSED
ardupilot: climb 5 | climbed-to 4.25 GUIDED | TAKING_OFF OURS
climb 5; told-no-tolerance; is IN_AIR; at 0 0 4.25
    | shows HOLD; tick | HOLDING OURS, sends HOLD, it aborted VEHICLE_REFUSED
# A vehicle that does not show the end climbs on.
climb 5; climbed-to 3.5 HOLD; remembers state=TAKING_OFF mode=TAKEOFF; shows TAKEOFF; at 0 0 4.25
    | wait 0.2 | TAKING_OFF OURS
# It is complete nearer to its height than the arrival radius: a PX4 may rest 0.28 m beside it.
climb 5; climbed-to 4.25 HOLD; wait 1.1; shows GUIDED; at 0 0 {4.625, 5.375} | wait 1 | MOVING OURS
climb 5; climbed-to 4.25 HOLD; wait 1.1; shows GUIDED; at 0 0 4.6875
    | wait 1 | HOVERING OURS, it complete
# The rest has the deadline of a goal.
climb 5; climbed-to 4.25 HOLD; wait 1.1; shows GUIDED
    | wait 20.1 | HOLDING OURS, sends HOLD, it timed out DEADLINE
# A top that clears no more is not flown to.
climb 5; climbed-to 4.25 HOLD; wait 1.1; clears-no-more
    | shows GUIDED | HOLDING OURS, sends HOLD, it aborted OUTSIDE_FENCE
# Guided mode that is shown while the position is too old waits for a fresh one.
climb 5; climbed-to 4.25 HOLD; wait 1.1
    | later 1.1; shows GUIDED | HOVERING TAKING | position; shows GUIDED | MOVING OURS
# A goal that comes while control is taken waits for the mode (MAVSDK's examples send one).
climb 5; climbed-to 4.25 HOLD
    | goto 3 0 5; wait 1.1 | HOVERING TAKING, sends GUIDED; setpoints 0 0 5
    | shows GUIDED; tick | MOVING OURS, it superseded, goto accepted; goal 3 0 5
climb 5; climbed-to 4.25 HOLD; goto 3 0 5
    | wait 6.1 | EXTERNAL NONE, sends GUIDED HOLD, it timed out NO_ANSWER, goto refused NO_ANSWER
# One in the last tenth of the climb waits for its end (DroneKit's scripts send one at 95 %, once).
retarget=replace, ardupilot: climb 10; is IN_AIR; at 0 0 9.0625 by 0 0 1
    | goto 3 0 10; tick | TAKING_OFF OURS
    | at 0 0 10; flies 0 0 0; wait 1.1; shows GUIDED; tick
    | MOVING OURS, sends GUIDED, it superseded, goto accepted; goal 3 0 10
retarget=replace, ardupilot: climb 10; is IN_AIR; at 0 0 8.9375 by 0 0 1
    | goto 3 0 10; tick | TAKING_OFF OURS, goto refused BUSY
    | at 0 0 10; flies 0 0 0; wait 1.1; shows GUIDED; tick
    | HOVERING OURS, sends GUIDED, it complete; goal 0 0 10
retarget=refuse, ardupilot: climb 10; is IN_AIR; at 0 0 9.5 by 0 0 1
    | goto 3 0 10; tick | TAKING_OFF OURS, goto refused BUSY
# It is refused where a pilot brakes near the top, and where the climb is stopped.
retarget=replace, ardupilot: climb 10; is IN_AIR; at 0 0 9.5 by 0 0 1; goto 3 0 10
    | flies 0 0 0; at 0 0 9.6; shows HOLD; wait 0.2
    | HOVERING TAKING, sends GUIDED, goto refused MODE_CHANGED
retarget=replace, ardupilot: climb 10; is IN_AIR; at 0 0 9.5 by 0 0 1; goto 3 0 10
    | hold | HOLDING OURS, sends HOLD, it aborted OPERATOR, goto replaced, hold accepted

# A climb that is still reported to stand is not disarmed: its landed state lags.
climb 5; at 0 0 3 by 0 0 1 | wait 11 | TAKING_OFF OURS
    | hold | HOLDING OURS, sends HOLD, it aborted OPERATOR, hold accepted
# A take-off comes late until its time and not at it: then what is reported to stand is believed to.
connected; shows armed; is ON_GROUND; stands-at 0 0 1; tick; may-come-until-now; is ON_GROUND
    | land | GROUNDED NONE, land accepted complete
""",
    climbed_to,
    told_no_tolerance,
    clears_no_more,
    may_come_until_now,
    known_to_be_at,
    sends_up,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_how_it_takes_off(row: Row) -> None:
    row.fly()
