"""In which states a stream begins, how it ends, and why it does not begin in the others."""

from __future__ import annotations

import pytest

from gcs.gate.inputs import OperatorLost
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows


def leaves(flight: Flight) -> None:
    """The operator goes, and may come back."""
    flight.script.feed(OperatorLost("gone", for_good=False))


ROWS = rows(
    """
# Samples are refused with the reason of the state and dropped, and so is a request; a return and a
# ... landing here are ours.
<NO_VEHICLE, STALE, GROUNDED, HOLDING, EXTERNAL>
    | velocity 1 0 0; bare-tick
    | =; stream <NO_VEHICLE, STALE, NOT_FLYING, HOLDING, NOT_IN_CONTROL>; velocities none
{FLIGHT -HOVERING} | velocity 1 0 0; bare-tick | =; stream BUSY; velocities none
<NO_VEHICLE, STALE, GROUNDED, HOLDING, EXTERNAL>
    | stream | =, stream refused <NO_VEHICLE, STALE, NOT_FLYING, HOLDING, NOT_IN_CONTROL>
{FLIGHT -HOVERING} | stream | =, stream refused BUSY
# The end of no stream changes nothing; it is not decided on a position too old.
{STATES -STALE, in HOVERING} | end-stream | =, end-stream accepted complete
stale HOVERING | end-stream | =, end-stream refused STALE
# A return or landing of the vehicle's own is not in our control.
ours; shows <RETURN, LAND> | velocity 1 0 0; stream
    | <RETURNING, LANDING> NONE, stream refused NOT_IN_CONTROL; stream NOT_IN_CONTROL
# While control is taken it waits.
flown; control | velocity 1 0 0; stream | HOVERING TAKING, stream refused CONTROL_PENDING;
    ... stream CONTROL_PENDING
# While a goal waits for its tick it is busy.
ours; go | velocity 1 0 0; stream | =, stream refused BUSY; stream BUSY
    | tick | MOVING OURS, go accepted
retarget=replace: ours; goto 5 0 1.5; tick; go
    | velocity 1 0 0; stream | =, stream refused BUSY; stream BUSY
    | tick | =, goto superseded, go accepted
# A severity of hold ends it and lets none begin, and an operator that leaves ends it.
ours; stream; velocity 1 0 0 | raised GPS_LOST | HOLDING OURS, sends HOLD, stream aborted SEVERITY
ours; stream; velocity 1 0 0 | leaves | HOLDING OURS, sends HOLD, stream aborted OPERATOR_LOST
# A refused first sample where a goal may be replaced leaves the goal flown.
retarget=replace: ours; goto 5 0 1.5; tick | velocity 0 50 0 | MOVING OURS; stream POLICY

# The first sample that clears begins the stream: decided at once, sent with the tick.
ours 10 | velocity 1 2 0.5 | STREAMING OURS; stream flown; velocities none
        | tick | =; velocities 1 2 0.5; setpoints none
# One that is asked for holds until its first sample.
ours 10 | stream | STREAMING OURS, stream accepted | tick | =; setpoints 0 0 10; velocities none
        | velocity 1 0 0; tick | =; velocities 1 0 0
# Begin again is complete at once, and a stream begun by a sample can be adopted.
ours 10; velocity 1 0 0; tick | stream | STREAMING OURS, stream accepted
    | stream | =, stream accepted complete
# A hold ends it in hold mode, and a landing; held in its place until that is shown.
ours 10; stream; velocity 1 0 0
    | another's {hold, abort} | HOLDING OURS, sends HOLD, stream aborted OPERATOR, $ accepted
    | velocity 1 0 0; tick | =; velocities none; setpoints 0 0 10
ours 10; velocity 1 0 0; tick; velocity 1 0 0
    | land | LANDING OURS, sends LAND, land accepted | tick | =; setpoints 0 0 10
    | shows LAND; tick | =; setpoints none; velocities none
# A goal of its client ends it and is flown, one of another is busy.
ours 10; stream; velocity 1 0 0 | goto 5 0 10 | HOVERING OURS, stream complete
    | tick | MOVING OURS, goto accepted
ours 10; velocity 1 0 0; tick | another's goto 5 0 10 | STREAMING OURS, goto refused BUSY
# A stream replaces a goal where the policy allows it, and its owner asks for it.
retarget=replace: ours 10; goto 20 0 10; tick
    | another's-velocity 0 1 0 | MOVING OURS; stream BUSY
    | velocity 0 1 0 | STREAMING OURS, goto superseded; stream flown
ours 10; goto 20 0 10; tick | stream; velocity 0 1 0 | MOVING OURS, stream refused BUSY; stream BUSY
# A pilot who takes over ends it.
ours 10; stream; velocity 1 0 0 | shows OTHER | EXTERNAL NONE, stream taken over MODE_CHANGED
    | velocity 1 0 0; bare-tick | =; stream NOT_IN_CONTROL; velocities none; setpoints none
# Samples of another source are refused once and never sent.
ours 10; velocity 1 0 0; tick
    | another's-velocity 0 3 0; tick; another's-velocity 0 3 0; tick | STREAMING OURS;
    ... stream OTHER_OPERATOR; velocities 1 0 0
    | another's stream | =, stream refused OTHER_OPERATOR
# Samples where none is flown are told once an episode, which is over when none came for 5 s.
connected | velocity 1 0 0; tick; velocity 1 0 0; tick; velocity 1 0 0 | =; stream NOT_FLYING
    | wait 5.1; velocity 1 0 0 | =; stream NOT_FLYING | wait 4.9; velocity 1 0 0 | =; stream untold
# A source that goes silent is held in its place, and then its stream is over.
ours 10; velocity 4 0 0; tick; velocity 4 0 0
    | wait 0.45 | STREAMING OURS; velocities 4 0 0; setpoints none
    | tick | =; velocities none; stream DEADLINE
ours 10; stream; velocity 1 0 0 | wait 4.95 | STREAMING OURS
    | tick | HOVERING OURS, stream timed out DEADLINE; says "no sample of the stream came for 5 s"
# A breach that is predicted all the same is braked and then held: setpoints stop it in 1.3 s.
ours 10; velocity 1 0 0; tick; velocity 1 0 0; at 148 0 10; flies 5 0 0
    | position | HOLDING OURS | wait 1.35 | =, sends HOLD
""",
    leaves,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_where_a_stream_begins_and_ends(row: Row) -> None:
    row.fly()
