"""What a command carries, whose it is, and holds that are commanded and not shown yet."""

from __future__ import annotations

import pytest

from gcs.gate.effects import SendCommand
from gcs.gate.machine.memory import GATE
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows
from tests.unit.gate.script import SECOND


def last(flight: Flight) -> SendCommand:
    return flight.script.all(SendCommand)[-1]


def tried_for(flight: Flight, seconds: str) -> None:
    assert last(flight).deadline_ns == flight.script.now_ns + int(seconds) * SECOND


def permitted(flight: Flight) -> None:
    assert last(flight).permit is not None


def unpermitted(flight: Flight) -> None:
    assert last(flight).permit is None


def gates_own(flight: Flight) -> None:
    assert last(flight).request_id == GATE


def asked_for(flight: Flight) -> None:
    assert (last(flight).request_id, last(flight).up_m) == (flight.script.asked, 0.0)


ROWS = rows(
    """
# A hold is tried for a second and others for five; those that are asked for carry the request.
ours | hold; tried-for 1; unpermitted; asked-for | HOLDING OURS, sends HOLD, hold accepted
     | land; tried-for 5; permitted; asked-for
     | LANDING OURS, sends LAND, hold superseded, land accepted
# What moves the vehicle carries a permit.
ours | return; permitted | RETURNING OURS, sends RETURN, return accepted
ours | photo; unpermitted | TAKING_PICTURE OURS, sends PHOTO, photo accepted
ardupilot: flown | control; tick; permitted; tried-for 5
    | HOVERING TAKING, sends GUIDED, control accepted
armed | disarm; unpermitted | =, sends DISARM, disarm accepted
allow_force_disarm=yes: flown; force | force; unpermitted | =, sends FORCE_DISARM, force accepted
# The gate's own are nobody's.
flown | control; wait 6.2; gates-own | =, sends GUIDED HOLD, control accepted timed out NO_ANSWER
# A hold that is repeated waits for one answer.
HOLDING | wait 2.1 | =, sends HOLD HOLD; awaits HOLD
# Past its request it is repeated at once in the gate's own name.
HOLDING; wait 4.95
    | later 0.05; photo; gates-own
    | =, sends HOLD, it timed out NO_ANSWER, photo refused HOLDING
climb; ignores TAKE_OFF; hold; wait 4.95
    | later 0.05; photo; gates-own
    | =, sends HOLD, hold timed out NO_ANSWER, photo refused NOT_FLYING
climb; ignores TAKE_OFF; no positions; wait 1.2; hold; wait 4.95
    | later 0.05; photo; gates-own
    | =, sends HOLD, hold timed out NO_ANSWER, photo refused STALE
# The one hold for our late guided is the gate's own: the request under way is a forced disarm.
allow_force_disarm=yes: flown; control; wait 1.1; force; force
    | shows GUIDED; gates-own | EXTERNAL NONE, sends HOLD
# Another mode that is shown completes no hold.
HOLDING; remembers hold_again_ns=none asked_mode=LAND | shows LAND | HOLDING OURS
HOLDING; remembers state={GROUNDED, STALE, EXTERNAL} hold_again_ns=none asked_mode=LAND
    | shows LAND | =
# A hold that is refused ends its request where somebody else flies.
HOLDING; remembers state=EXTERNAL control=NONE | fails HOLD
    | EXTERNAL NONE, it aborted VEHICLE_REFUSED
""",
    permitted,
    unpermitted,
    tried_for,
    gates_own,
    asked_for,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_is_sent(row: Row) -> None:
    row.fly()
