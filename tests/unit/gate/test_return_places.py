"""A return is cleared by the ways to every place where it may end, and to home."""

from __future__ import annotations

import pytest

from gcs.gate.airspace.return_place import ReturnPlace
from gcs.gate.inputs import ReturnPlacesSeen
from tests.unit.gate.airspace import at
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows

PLACES = {
    "near": ReturnPlace("rally point 1", at(2, 0, 0)),
    "outside": ReturnPlace("rally point 2", at(0, 500, 0)),
    "too-high": ReturnPlace("rally point 3", at(2, 0, 0), over_up_m=200.0),
    "on-a-hill": ReturnPlace("rally point 1", at(2, 0, 47.0)),
    "on-a-higher-hill": ReturnPlace("rally point 1", at(2, 0, 49.0)),
}


def may_end(flight: Flight, *names: str) -> None:
    flight.script.feed(ReturnPlacesSeen(tuple(PLACES[name] for name in names)))


def not_known(flight: Flight, *why: str) -> None:
    flight.script.feed(ReturnPlacesSeen(None, " ".join(why)))


ROWS = rows(
    """
# Clear ways to home and to each place clear it.
{AIRBORNE}; may-end near | return | RETURNING OURS, sends RETURN, it superseded, return accepted
# One blocked way refuses it and is named; while they are not known it is refused with the reason.
{AIRBORNE -LANDING}; may-end near outside
    | return | HOLDING OURS, sends HOLD, it aborted OPERATOR, return refused RTL_BLOCKED;
    ... says "rally point 2"; says "land instead"
{AIRBORNE -LANDING}; may-end near too-high
    | return | HOLDING OURS, sends HOLD, it aborted OPERATOR, return refused RTL_BLOCKED;
    ... says "climb to return height"; says "land instead"
{AIRBORNE -LANDING}; not-known they are being read
    | return | HOLDING OURS, sends HOLD, it aborted OPERATOR, return refused RTL_BLOCKED;
    ... says "they are being read: land instead"
    | may-end; return | RETURNING OURS, sends RETURN, return accepted
# A higher way to a place counts from its ground: the yard's ceiling is 50 m up.
HOVERING; may-end on-a-hill | return | RETURNING OURS, sends RETURN, it superseded, return accepted
HOVERING; may-end on-a-higher-hill
    | return | HOLDING OURS, sends HOLD, it aborted OPERATOR, return refused RTL_BLOCKED
# The gate's own return is judged by the same ways.
BATTERY_LOW=RETURN, rtl_blocked=<hold, land, forward>: MOVING; {may-end outside, not-known}
    | raised BATTERY_LOW
    | <HOLDING, LANDING, RETURNING> OURS, sends <HOLD, LAND, RETURN>, it aborted SEVERITY
""",
    may_end,
    not_known,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_where_a_return_may_end(row: Row) -> None:
    row.fly()
