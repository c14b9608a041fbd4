"""A jump, a home or a fence that moved, a breach ahead: what was verified is so no more."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.frames import ned_from_enu
from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.effects import CommandKind, SendSetpoint
from gcs.gate.geometry import Circle
from gcs.gate.inputs import HeartbeatSeen, LandedSeen, PositionSeen, VerifierChanged
from gcs.gate.states import State
from tests.unit.gate.flight_words import Flight, place
from tests.unit.gate.rows import Row, rows
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to, remember


def dashes(flight: Flight) -> None:
    """Five seconds later it is ten metres from the fence, at twelve metres a second towards it."""
    script = flight.script
    script.now_ns += 5 * SECOND
    script.feed(HeartbeatSeen(script.armed, script.mode, script.mode.value))
    script.feed(LandedSeen(script.landed))
    script.effects.clear()
    script.feed(PositionSeen((140.0, 0.0, -UP), (12.0, 0.0, 0.0), script.now_ns // MS))


def brakes_inside(flight: Flight) -> None:
    """Asked to fly back at 2.5 m/s ([pace]), to the held place, which is before the fence."""
    (brake,) = flight.script.all(SendSetpoint)
    held_ned = flight.script.gate.hold_goal_ned
    assert brake.permit.reason.startswith("brake")
    assert brake.permit.pos_ned is not None
    assert held_ned is not None
    assert 140.0 - 2.5 / 0.95 <= brake.permit.pos_ned[0] <= held_ned[0] < 148.0


def fence_about(flight: Flight, east: str) -> None:
    """The same fence about another home."""
    script = flight.script
    verifier = verifier_for(script.policy, script.autopilot, place(east, "0", "0"), None)
    script.feed(VerifierChanged(verifier))


def tower(flight: Flight) -> None:
    verifier = verifier_for(flight.script.policy, "px4", (0.0, 0.0, 0.0), None)
    zone = Zone("tower", False, Circle((90.0, 90.0), 5.0), 0.0, 20.0)
    flight.script.feed(VerifierChanged(replace(verifier, zones=(*verifier.zones, zone))))


def known_at(flight: Flight, north: str) -> None:
    """The place that is known last lies so far north."""
    remember(flight.script, pos_ned=(float(north), 0.0, -UP))


def seen_at(flight: Flight, *numbers: str) -> None:
    """One sample: so far east and north, so fast to the east and to the north."""
    east, north, v_east, v_north = map(float, numbers)
    now_ms = flight.script.now_ns // MS
    flight.script.feed(PositionSeen((north, east, -UP), (v_north, v_east, 0.0), now_ms))


ROWS = rows(
    """
# A jump holds and the place is verified anew.
{VERIFIED, RETURNING} | jumps 20 0 1.5 | HOLDING OURS, sends HOLD, it aborted ESTIMATOR_RESET;
    ... holds 20 0 1.5
HOVERING; jumps 20 0 1.5; stands-at 20 0 1.5 | nothing | HOLDING OURS; streams
# A held vehicle is held at its new place, or in silence where that does not clear.
HOLDING | jumps 20 0 1.5 | =; holds 20 0 1.5
HOLDING; stands-at 170 0 1.5 | jumps 170 0 1.5 | =; holds none; silent
# It is nothing to what we do not fly to a place, nor to a return of the vehicle's own.
{GROUNDED, LANDING, EXTERNAL} | jumps 20 0 1.5 | =
flown; shows RETURN | jumps 20 0 1.5 | RETURNING NONE
# 20 m between two samples are a jump without the counter, too.
in HOVERING; goto 3 0 1.5; tick | sample 20 0 1.5
    | HOLDING OURS, sends HOLD, goto aborted ESTIMATOR_RESET;
    ... holds 20 0 1.5

# Home that moves by more than a metre holds and is told.
{VERIFIED, RETURNING} | home 5 0 0 | HOLDING OURS, sends HOLD, it aborted HOME_MOVED;
    ... says "Home moved by 5.0 m while the vehicle flies"
{VERIFIED} | home 0.9 0 0 | =
in HOVERING | home 1 0 0 | = | home 2.0625 0 0 | HOLDING OURS, sends HOLD
# A held vehicle is verified anew.
HOLDING; sample 3 0 1.5 | home 5 0 0 | =; holds 3 0 1.5
{GROUNDED, LANDING, EXTERNAL} | home 5 0 0 | =
flown; shows RETURN | home 5 0 0 | RETURNING NONE
# A first home did not move, and on the ground it may.
unheard; shows HOLD armed; is IN_AIR; position | home 0 50 0 | EXTERNAL NONE; unsaid "moved"
connected | home 0 50 0 | =; unsaid "moved"

# A fence that moves: what clears no more is held with the reason.
<TAKING_OFF, HOVERING, MOVING, TAKING_PICTURE, FLYING_MISSION> | fence elsewhere
    | HOLDING OURS, sends HOLD, it aborted <OUTSIDE_FENCE, OUTSIDE_FENCE, OUTSIDE_FENCE,
    ... OUTSIDE_FENCE, BAD_MISSION>
in HOVERING; goto 100 0 1.5; wait 0.5
    | fence-about -100 | HOLDING OURS, sends HOLD, goto aborted OUTSIDE_FENCE
# A take-off that stands is given up.
climb | fence elsewhere | GROUNDED NONE, sends HOLD DISARM, it aborted OUTSIDE_FENCE
      | wait 1.1 | =, sends HOLD
# A vehicle that is held or hovers outside the new fence is held in silence.
HOLDING; tick | fence elsewhere | =; silent
in HOVERING | fence-about 500 | HOLDING OURS, sends HOLD | wait 1 | =, sends HOLD; setpoints none
{GROUNDED, RETURNING, LANDING, EXTERNAL} | fence elsewhere | =
# A mission flies on only in the fence that it was verified by; the same one changes nothing.
FLYING_MISSION | tower | HOLDING OURS, sends HOLD, it aborted BAD_MISSION
in MOVING | fence again | =
# In the grace it ends the stream with its reason.
stale MOVING | fence elsewhere | STALE OURS, sends HOLD, it aborted OUTSIDE_FENCE
    | position | HOLDING OURS

# A breach ahead is braked in the instant of the sample; one that follows setpoints is stopped by
# ... them (0.3 s + 12 / 5 s), and told its hold mode when it is slow.
{TAKING_OFF, HOVERING, FLYING_MISSION, RETURNING}
    | dashes; brakes-inside | HOLDING OURS, sends HOLD, it aborted FENCE_BREACH;
    ... says "inclusion circle 'home'"
in HOVERING | dashes; brakes-inside | HOLDING OURS
    | stands-at 0 148 1.5; wait 2.65 | = | wait 0.1 | =, sends HOLD
{MOVING, TAKING_PICTURE}
    | dashes; brakes-inside | HOLDING OURS, it aborted FENCE_BREACH; says "inclusion circle 'home'"
    | stands-at 0 148 1.5; wait 2.65 | = | wait 0.1 | =, sends HOLD
# What lands, or is held, or is not ours is left alone.
{LANDING, EXTERNAL, HOLDING; shows HOLD} | dashes | =; setpoints none
# It is braked by a sample that comes late, but not where it is held already.
stale {MOVING, TAKING_PICTURE}; known-at 139
    | later 0.3; seen-at 0 140 0 12 | HOLDING OURS, it aborted FENCE_BREACH; brakes
stale FLYING_MISSION; known-at 139
    | later 0.3; seen-at 0 140 0 12 | HOLDING OURS, sends HOLD, it aborted FENCE_BREACH; brakes
HOLDING; shows HOLD; no positions; wait 1.2 | dashes | HOLDING OURS
in HOVERING; goto 100 0 1.5; at 100 0 1.5 by 12 0 0; no positions; wait 1.2
    | stands-at 134 0 1.5; position | HOLDING OURS, goto aborted FENCE_BREACH; brakes
    | wait 2.75 | STALE OURS, sends HOLD HOLD
# It is so while control is being taken: invariant 6 begins with the first setpoint.
in EXTERNAL; at 130 0 1.5; control; wait 0.3
    | nothing | HOVERING TAKING
    | later 0.5; seen-at 142 0 12 0 | HOLDING OURS, sends HOLD, control aborted FENCE_BREACH; brakes
# A sample of the ordinary says nothing.
{HEARD} | position | =; setpoints none
""",
    dashes,
    tower,
    brakes_inside,
    fence_about,
    known_at,
    seen_at,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_clears_no_more(row: Row) -> None:
    row.fly()


@pytest.mark.parametrize("period_s", [0.5, 1.1, 1.3, 1.45])
@pytest.mark.parametrize("state", [State.MOVING, State.HOVERING, State.FLYING_MISSION])
def test_every_sample_is_predicted(state: State, period_s: float) -> None:
    """Slower than the policy's age, faster than age and grace: each arrives in STALE."""
    script = Script(policy("default"))
    lead_to(state, script)
    script.reports_position = False
    east = 0.0
    while east < 150.0 and script.gate.state is not State.HOLDING:
        script.wait(period_s)
        east += 8.0 * period_s
        script.pos_ned, script.v_ned = ned_from_enu((east, 0.0, UP)), (0.0, 8.0, 0.0)
        script.position()
    assert script.gate.state is State.HOLDING
    script.wait(2.0)  # setpoints stop it in 0.3 s + 8 / 5 s
    assert CommandKind.HOLD in script.commands()
    assert all(place[0] < 150.0 for _, place in script.setpoints())
