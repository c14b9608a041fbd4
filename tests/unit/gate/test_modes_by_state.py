"""The mode that the heartbeat shows moves the state: DESIGN 4, control and streaming.

A mode change that we did not command leads to EXTERNAL, or to RETURNING or LANDING where the mode
says so; a mode that was commanded is waited for as long as the policy says.
"""

from __future__ import annotations

import pytest

from gcs.gate.states import Control, State
from tests.unit.gate.flight_words import FACTS, Flight
from tests.unit.gate.rows import Row, rows
from tests.unit.gate.situations import remember


def interrupted(flight: Flight, state: str, control: str = "OURS") -> None:
    """STALE out of `state`, with no mode awaited, and one shown that is not asked about."""
    script = flight.script
    flight.step(f"stale {'MOVING' if state == 'STREAMING' else state}")
    remember(script, back_to=State[state], control=Control[control])
    remember(script, mode=None, asked_mode=None, hold_again_ns=None)


def overdue(flight: Flight, awaited: str, shown: str) -> None:
    """The mode that is awaited is overdue this instant, while it climbs on."""
    modes = {"asked_mode": FACTS["mode"](awaited), "mode": FACTS["mode"](shown)}
    now_ns = flight.script.now_ns
    remember(flight.script, asked_until_ns=now_ns, v_ned=(0.0, 0.0, -1.0), **modes)


ROWS = rows(
    """
# A mode of somebody else's takes the vehicle over.
TAKING_OFF     | shows {MISSION, OTHER}
    | EXTERNAL NONE, it taken over MODE_CHANGED; goal none; silent
in HOVERING    | shows {HOLD, TAKEOFF, MISSION, OTHER} | EXTERNAL NONE; goal none; silent
{MOVING, TAKING_PICTURE} | shows {HOLD, TAKEOFF, MISSION, OTHER}
    | EXTERNAL NONE, it taken over MODE_CHANGED; goal none; silent
FLYING_MISSION | shows {GUIDED, HOLD, TAKEOFF, OTHER}
    | EXTERNAL NONE, it taken over MODE_CHANGED; goal none; silent
{RETURNING, LANDING} | shows {GUIDED, HOLD, TAKEOFF, MISSION, OTHER}
    | EXTERNAL NONE, it taken over MODE_CHANGED; goal none; silent
HOLDING; shows HOLD; wait 12 | shows {GUIDED, TAKEOFF, MISSION, OTHER}
    | EXTERNAL NONE; goal none; silent
# A return or a landing of the vehicle's own is seen as one.
{TAKING_OFF, MOVING, TAKING_PICTURE}
    | shows <RETURN, LAND> | <RETURNING, LANDING> NONE, it taken over MODE_CHANGED; silent
{in HOVERING, HOLDING; shows HOLD; wait 12} | shows <RETURN, LAND>
    | <RETURNING, LANDING> NONE; silent
LANDING | shows RETURN | RETURNING NONE, it taken over MODE_CHANGED; silent
# A failsafe of the vehicle's own that takes over is named; what ends otherwise is not laid on it.
{TAKING_OFF, MOVING, TAKING_PICTURE}
    | fails-safe RETURN | RETURNING NONE, it taken over VEHICLE_FAILSAFE;
    ... says "a failsafe of the vehicle's own took over: RETURN"
MOVING; fails-safe GUIDED | abort | HOLDING OURS, sends HOLD, it aborted OPERATOR, abort accepted
# A mission may end in a return or a landing, and a return ends in a landing.
FLYING_MISSION | shows <RETURN, LAND> | <RETURNING, LANDING> OURS
RETURNING      | shows LAND           | LANDING OURS
# The modes that a state is flown in change nothing; a climb ends in hold (px4) or guided.
TAKING_OFF | shows GUIDED; shows | = | shows HOLD; shows | = | shows TAKEOFF; shows | =
{in HOVERING, MOVING, TAKING_PICTURE} | shows GUIDED; shows | =
<FLYING_MISSION, RETURNING, LANDING> | shows <MISSION, RETURN, LAND>; shows | =
HOLDING; shows HOLD | shows HOLD; shows | =
# On the ground no mode moves anything.
GROUNDED | shows {MODES} | =
# Of a vehicle that somebody else flies a return and a landing are seen.
EXTERNAL; shows OTHER | shows {GUIDED, HOLD, TAKEOFF, MISSION, OTHER} | =
EXTERNAL | shows <RETURN, LAND> | <RETURNING, LANDING> NONE, it taken over MODE_CHANGED
# A mode that is only repeated sends nothing.
MOVING | shows | =; setpoints none

# A hold that is not shown yet is not given up for another mode.
HOLDING; shows GUIDED | shows {TAKEOFF, MISSION, RETURN, LAND, OTHER} | = | wait 1.1 | =, sends HOLD
HOLDING; shows OTHER  | shows GUIDED | = | wait 1.1 | =, sends HOLD
# While a mode is waited for, others are still those of before.
ours; loaded 5; {land, return, mission}; shows OTHER | shows GUIDED | =
ours; loaded 5; {land, return, mission}; shows GUIDED | shows {HOLD, TAKEOFF, OTHER} | =
ours; loaded 5; land; shows GUIDED    | shows {MISSION, RETURN, LAND} | LANDING OURS
ours; loaded 5; return; shows GUIDED  | shows {MISSION, RETURN} | RETURNING OURS
ours; loaded 5; mission; shows GUIDED | shows MISSION | FLYING_MISSION OURS
ours; loaded 5; return; shows GUIDED  | shows LAND | LANDING OURS
ours; loaded 5; mission; shows GUIDED | shows <RETURN, LAND> | <RETURNING, LANDING> OURS
in HOVERING; land | shows GUIDED; shows HOLD | =
# Control is confirmed by guided and by nothing else; the hold of before is no takeover.
HOVERING; wait 1.2; shows HOLD | shows GUIDED | HOVERING OURS, it complete
HOVERING; wait 1.2 | shows OTHER | EXTERNAL NONE, it taken over MODE_CHANGED
flown OTHER; control | shows HOLD | HOVERING TAKING

# A mode that never comes (5 s): a vehicle still in our guided mode is held, another one is
# ... somebody else's.
ours; {land, return}; shows GUIDED; wait 4.9 | wait 0.2
    | HOLDING OURS, sends HOLD, $ timed out NO_ANSWER
ours; {land, return}; shows OTHER; wait 4.9 | wait 0.2 | EXTERNAL NONE, $ timed out NO_ANSWER
ours; loaded 5; mission; shows GUIDED; wait 4.9
    | wait 0.2 | HOLDING OURS, sends HOLD, mission timed out NO_ANSWER
ours; loaded 5; mission; shows OTHER; wait 4.9
    | wait 0.2 | EXTERNAL NONE, mission timed out NO_ANSWER
# A return that lands at once shows a mode of its own.
ours; return; shows LAND; wait 4.9 | wait 0.2 | LANDING OURS
    | shows RETURN | RETURNING NONE, return taken over MODE_CHANGED
# A mission that does not begin on the ground leaves the vehicle there.
armed; loaded 5; mission; wait 4.9 | wait 0.2 | GROUNDED NONE, mission timed out NO_ANSWER
# A take-off in a pilot's mode stays on the ground, or is the pilot's in the air.
armed; take-off 1.5; shows OTHER | wait 5.2 | GROUNDED NONE, take-off timed out NO_ANSWER
armed; take-off 1.5; shows OTHER; is IN_AIR | nothing | TAKING_OFF OURS
    | wait 5.2 | EXTERNAL NONE, take-off timed out NO_ANSWER
climb | shows OTHER | GROUNDED NONE, it taken over MODE_CHANGED

# Our own guided command may take effect after it was given up: within 10 s it is held until shown.
flown; control; wait 6.2
    | shows GUIDED | EXTERNAL NONE, sends HOLD | wait 1 | =, sends HOLD | shows HOLD | = | wait 3
    | =
# A hold that nobody asked for gives way to a mode that somebody chose.
flown; control; wait 6.2; shows GUIDED | shows {OTHER, MISSION, TAKEOFF} | EXTERNAL NONE | wait 3
    | =
# Later it is somebody else's.
flown; control; wait 11.2 | shows GUIDED | EXTERNAL NONE
# A held vehicle that goes guided for us is held again until it shows.
in HOLDING; resume; wait 1.2; hold; shows HOLD
    | shows GUIDED | HOLDING OURS, sends HOLD | wait 1.1 | =, sends HOLD

# STALE: a mode that belongs to what was interrupted takes nothing over, any other does.  Return
# ... and land are the vehicle's own way down, whatever was interrupted.
interrupted TAKING_OFF | shows {GUIDED, HOLD, TAKEOFF} | STALE OURS
interrupted TAKING_OFF | shows {MISSION, OTHER} | STALE NONE, it taken over MODE_CHANGED
interrupted {HOVERING, MOVING, STREAMING, TAKING_PICTURE} | shows GUIDED | STALE OURS
interrupted {HOVERING, MOVING, STREAMING, TAKING_PICTURE}
    | shows {HOLD, TAKEOFF, MISSION, OTHER} | STALE NONE, it taken over MODE_CHANGED
interrupted FLYING_MISSION | shows MISSION | STALE OURS
interrupted FLYING_MISSION | shows {GUIDED, HOLD, TAKEOFF, OTHER}
    | STALE NONE, it taken over MODE_CHANGED
interrupted HOLDING | shows HOLD | STALE OURS
interrupted HOLDING | shows {GUIDED, TAKEOFF, MISSION, OTHER}
    | STALE NONE, it taken over MODE_CHANGED
# While control is being taken the hold of before fits too.
interrupted HOVERING TAKING | shows {GUIDED, HOLD} | STALE TAKING
interrupted HOVERING TAKING | shows {TAKEOFF, MISSION, OTHER}
    | STALE NONE, it taken over MODE_CHANGED
# An awaited mode that is overdue is no loss in a mode that fits, and one in any other.
TAKING_OFF; overdue TAKEOFF {TAKEOFF, HOLD, GUIDED} | bare-tick | =; asks none
FLYING_MISSION; overdue MISSION MISSION | bare-tick | =; asks none
RETURNING; overdue RETURN {RETURN, LAND} | bare-tick | =; asks none
LANDING; overdue LAND LAND | bare-tick | =; asks none
<TAKING_OFF, FLYING_MISSION, RETURNING, LANDING>; overdue <TAKEOFF, MISSION, RETURN, LAND> OTHER
    | bare-tick | EXTERNAL NONE, it timed out NO_ANSWER
# A hold that was refused is asked for again whatever the mode; its request ended with the refusal.
stale MOVING; abort; fails HOLD | shows {TAKEOFF, MISSION, RETURN, LAND, OTHER} | STALE OURS
    | position | HOLDING OURS
# Guided is asked for and awaited only with a fresh position; what the outage took is not given
# ... back.
flown; control; no positions | wait 1.3 | STALE TAKING
    | positions; tick | HOVERING TAKING, sends GUIDED
    | wait 4.65 | = | wait 0.1 | EXTERNAL NONE, sends HOLD, control timed out NO_ANSWER
""",
    interrupted,
    overdue,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_a_mode_does(row: Row) -> None:
    row.fly()
