"""What a severity demands in each state, and what the loss of the operator does."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.rows import Row, rows


def has(flight: Flight, *conditions: str) -> None:
    assert flight.script.gate.conditions == tuple(Condition[name] for name in conditions)


def texts(flight: Flight, *told: str) -> None:
    assert tuple(text for _, text in flight.script.gate.memory.conditions) == told


ROWS = rows(
    """
# What we fly does what the severity says.
BATTERY_LOW=<HOLD, RETURN, LAND, TERMINATE>: {VERIFIED}
    | raised BATTERY_LOW | <HOLDING, RETURNING, LANDING, LANDING> OURS,
    ... sends <HOLD, RETURN, LAND, LAND>, it aborted SEVERITY; severity <HOLD, RETURN, LAND,
    ... TERMINATE>
# A return that is blocked is what the policy says.
BATTERY_LOW=RETURN, rtl_blocked=<hold, land, forward>: {VERIFIED}; return-height 80
    | raised BATTERY_LOW
    | <HOLDING, LANDING, RETURNING> OURS, sends <HOLD, LAND, RETURN>, it aborted SEVERITY
# A take-off that stands is given up, and so is arming; a disarm goes on.
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: climb
    | raised BATTERY_LOW | GROUNDED NONE, sends HOLD DISARM, it aborted SEVERITY
    | wait 1.1 | =, sends HOLD
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: GROUNDED | raised BATTERY_LOW | =, it aborted SEVERITY
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: GROUNDED; disarm | raised BATTERY_LOW | =
# What comes down already goes on; a return lands where that is demanded.
BATTERY_LOW={HOLD, RETURN}: RETURNING | raised BATTERY_LOW | =
BATTERY_LOW={LAND, TERMINATE}: RETURNING
    | raised BATTERY_LOW | LANDING OURS, sends LAND, it aborted SEVERITY
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: LANDING | raised BATTERY_LOW | =
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: flown; shows RETURN
    | raised BATTERY_LOW | RETURNING NONE
# What is held stays held, or returns or lands where that is demanded and not blocked.
BATTERY_LOW=HOLD: HOLDING | raised BATTERY_LOW | =
BATTERY_LOW=RETURN: HOLDING; return-height 80 | raised BATTERY_LOW | =
BATTERY_LOW=<RETURN, RETURN, RETURN, LAND, TERMINATE>, rtl_blocked=<hold, forward, land, hold,
    ... hold>:
    ... HOLDING; return-height <1.5, 80, 80, 1.5, 1.5>
    | raised BATTERY_LOW | <RETURNING, RETURNING, LANDING, LANDING, LANDING> OURS,
    ... sends <RETURN, RETURN, LAND, LAND, LAND>, it aborted SEVERITY
# With an old position it is held and streams no more, or lands where that is demanded.
BATTERY_LOW={HOLD, RETURN}: STALE
    | raised BATTERY_LOW | =, sends HOLD, it aborted SEVERITY; silent
    | over BATTERY_LOW; positions; tick | HOLDING OURS
BATTERY_LOW={LAND, TERMINATE}: STALE
    | raised BATTERY_LOW | LANDING OURS, sends LAND, it aborted SEVERITY
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: GROUNDED; no positions; wait 1.2
    | raised BATTERY_LOW | STALE NONE, it aborted SEVERITY
# What is held already waits for its position, and a return that was due is flown then.
BATTERY_LOW=RETURN: STALE; hold | raised BATTERY_LOW | =
    | positions; position | RETURNING OURS, sends RETURN, hold aborted SEVERITY
MOVING; no positions; wait 1.1
    | raised BATTERY_CRITICAL | STALE OURS, sends HOLD, it aborted SEVERITY; severity RETURN
    | positions; tick | RETURNING OURS, sends RETURN
MOVING; no positions; wait 3 | raised BATTERY_CRITICAL | STALE OURS; severity RETURN
    | positions; tick | RETURNING OURS, sends RETURN
# A condition that is over by then demands nothing.
MOVING; no positions; wait 1.1; raised BATTERY_CRITICAL; over BATTERY_CRITICAL
    | positions; tick | HOLDING OURS
# Where somebody else flies, or nobody is heard, nothing is sent.
BATTERY_LOW={CAUTION, HOLD, RETURN, LAND, TERMINATE}: EXTERNAL | raised BATTERY_LOW | =
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: NO_VEHICLE | raised BATTERY_LOW | =
# What comes and goes and is not severe changes nothing.
BATTERY_LOW={NOMINAL, CAUTION}: {STATES}
    | raised BATTERY_LOW; over BATTERY_LOW | =; same; setpoints none
# What is over changes nothing more.
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: {HOLDING, EXTERNAL, GROUNDED};
    ... return-height 80; raised BATTERY_LOW | over BATTERY_LOW | =; severity NOMINAL
# A second condition that is no worse demands nothing new.
BATTERY_LOW=HOLD, OTHER_STATION=HOLD: in HOLDING; raised BATTERY_LOW
    | raised OTHER_STATION | = | over OTHER_STATION | =; severity HOLD
BATTERY_LOW=RETURN, ORIGIN_MISMATCH=RETURN: ours; raised BATTERY_LOW; hold; shows HOLD
    | raised ORIGIN_MISMATCH | HOLDING OURS
# Of two conditions the worst wins, and each stands by itself.
BATTERY_LOW=CAUTION, OTHER_STATION=HOLD: in HOVERING
    | raised OTHER_STATION; raised BATTERY_LOW; has BATTERY_LOW OTHER_STATION
    | HOLDING OURS, sends HOLD; severity HOLD
connected | raised BATTERY_LOW 20; raised OTHER_STATION 255; raised BATTERY_LOW 19; texts 19 255 | =
    | over BATTERY_LOW; has OTHER_STATION | =

# Operator lost: what we fly is held, and may be left when the hold is seen.
{FLIGHT -RETURNING, -LANDING}
    | quits | HOLDING OURS, sends HOLD, it aborted OPERATOR_LOST; unsettled
    | shows HOLD | =; settled
# A take-off that stands is given up, and so is arming.
climb | quits | GROUNDED NONE, sends HOLD DISARM, it aborted OPERATOR_LOST | wait 1.1
    | =, sends HOLD
GROUNDED | quits | =, it aborted OPERATOR_LOST; cancels ARM; settled
# A take-off that may come yet is held, but not of a vehicle that is disarmed.
climb; ignores TAKE_OFF; disarm
    | quits | GROUNDED NONE, sends HOLD, disarm aborted OPERATOR_LOST | wait 1.1 | =, sends HOLD
climb; ignores TAKE_OFF; shows disarmed; arm
    | quits | GROUNDED NONE, arm aborted OPERATOR_LOST
# With an old position it is held and streams no more; what stands is left alone.
{MOVING, FLYING_MISSION}; no positions; wait 1.1
    | quits | STALE OURS, sends HOLD, it aborted OPERATOR_LOST; silent
    | positions; tick | HOLDING OURS
GROUNDED; no positions; wait 1.2 | quits | STALE NONE, it aborted OPERATOR_LOST
# A hold goes on until it is shown.
{HOLDING, NO_VEHICLE} | quits | = | wait 1.1 | =, sends HOLD
# What somebody else flies is left alone and nothing is left open.
EXTERNAL | quits | =, it aborted OPERATOR_LOST; settled
in {EXTERNAL, GROUNDED} | quits | =; settled
flown; shows <RETURN, LAND> | quits | <RETURNING, LANDING> NONE
# What comes down goes on and may be left (newcomer.md 8: leaving a return put it into hold).
in {RETURNING, LANDING} | quits | =, it aborted OPERATOR_LOST; settled
BATTERY_LOW={HOLD, RETURN}: RETURNING; raised BATTERY_LOW | quits | =, it aborted OPERATOR_LOST
BATTERY_LOW={HOLD, RETURN, LAND, TERMINATE}: LANDING; raised BATTERY_LOW
    | quits | =, it aborted OPERATOR_LOST
BATTERY_CRITICAL=LAND: in HOVERING; raised BATTERY_CRITICAL | quits | LANDING OURS
# A return or landing that is not shown yet is asked for on.
in HOVERING; {return, land}
    | quits
    | =, $ aborted OPERATOR_LOST; says "the vehicle goes on by itself"; cancels none; unsettled
# Landing can still be asked for and is flown to its end.
MOVING; quits | land | LANDING OURS, sends LAND, land accepted
# An arming that is not answered is not left open where the vehicle flies, nor a disarming without
# ... a position.
connected; shows GUIDED; arm; is IN_AIR | shows HOLD | HOLDING OURS, sends ARM
    | quits | =, arm aborted OPERATOR_LOST; settled
connected; shows armed; no positions; wait 1.5; disarm
    | wait 1 | STALE NONE | quits | =, disarm aborted OPERATOR_LOST
# Nobody heard, nothing sent.
unheard | quits | =; setpoints none | bare-tick | =; setpoints none
# Who leaves after a landing whose positions are old is told how it ended
# ... (`random_flight.flown(394015001986)`: landed, still armed, and no position any more).
{RETURNING, LANDING}; at 0 0 0; is ON_GROUND; no positions
    | wait 2 | STALE NONE | quits | =, it aborted OPERATOR_LOST
""",
    has, texts,
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_severity_and_a_lost_operator_demand(row: Row) -> None:
    row.fly()
