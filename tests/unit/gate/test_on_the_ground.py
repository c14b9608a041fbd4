"""Arming, and modes that are asked for, on the ground: sent, and complete when they are seen."""

from __future__ import annotations

import pytest

from tests.unit.gate.rows import Row, rows

ROWS = rows(
    """
# Arming is complete when the heartbeat shows it, and not when it is answered.
connected | arm | =, sends ARM, arm accepted | accepts ARM | = | shows armed | =, arm complete
armed | arm | =, arm accepted complete; says "the vehicle is armed already"
# A late answer is reported and not acted on, and silence is not told as one.
connected; arm | wait 5.1 | =, arm timed out NO_ANSWER; cancels ARM
    | accepts ARM | =; same; tells INFO A late answer to arm, not acted on
connected; arm; wait 5.1
    | ignores ARM no answer to 2 tries | =;
    ... tells INFO No answer to arm, which is waited for no longer: no answer to 2 tries
# PX4 is in OFFBOARD again after a flight in it, and does not arm there: it is seen left first.
connected GUIDED | arm; accepts HOLD; shows GUIDED | =, sends HOLD, arm accepted
    | shows HOLD | =, sends ARM | shows armed | =, arm complete | wait 3 | =
connected LAND | arm | =, sends HOLD, arm accepted | shows HOLD | =, sends ARM
# The mode is asked for until it is seen, or the deadline ends it.
connected GUIDED | arm; wait 3.5 | =, sends HOLD HOLD HOLD HOLD, arm accepted
    | wait 1.6 | =, sends HOLD, arm timed out NO_ANSWER | wait 3 | =
# A refusal of the mode is told at once (station.md, bug 12: it was NO_ANSWER after five seconds).
connected GUIDED; arm | refuses HOLD | =, arm aborted VEHICLE_REFUSED | wait 3 | =
# Arming has its whole time after the mode that it needs; a PX4 that refuses it ends it.
connected LAND; arm; wait 4 | shows HOLD; wait 4 | =, sends ARM
    | rejects ARM High Accelerometer Bias | =, arm aborted VEHICLE_REFUSED;
    ... says "High Accelerometer Bias"
# An arming that is taken back is not sent again.
connected; arm | hold | =, sends HOLD, arm aborted OPERATOR, hold accepted; cancels ARM

# autopilots.md 9: an estimator that starts has no position yet, which is not one too old.
unheard; fence again; no positions; shows; tick | {up, goto 0 0 2}
    | STALE NONE, $ refused NO_POSITION;
    ... says "no position yet (the estimator is starting)"
# Arming waits for it, for as long as the policy says.
unheard; fence again; no positions; shows; tick
    | arm; wait 40 | STALE NONE, arm accepted
    | positions; tick | GROUNDED NONE, sends ARM | shows armed | =, arm complete
ardupilot: unheard; fence again; no positions; shows; tick; arm
    | positions; tick | GROUNDED NONE, sends GUIDED | shows GUIDED | =, sends ARM
arm_timeout_s=45: unheard; fence again; no positions; shows; tick
    | arm; wait 44.9 | =, arm accepted | wait 0.2 | =, arm timed out NO_POSITION
# A position that was there and is too old is not waited for.
connected; no positions; wait 1.2 | arm | =, arm refused STALE
# A second request finds it busy, and a stop, a severity and a lost operator end the wait.
unheard; fence again; no positions; shows; tick; arm | arm | =, arm refused BUSY
unheard; fence again; no positions; shows; tick; arm
    | hold | =, sends HOLD, arm aborted OPERATOR, hold accepted
    | positions; wait 1 | GROUNDED NONE, hold complete
unheard; fence again; no positions; shows; tick; arm
    | abort | =, sends DISARM, arm aborted OPERATOR, abort accepted
    | positions; wait 1 | GROUNDED NONE
BATTERY_LOW=HOLD: unheard; fence again; no positions; shows; tick; arm
    | raised BATTERY_LOW | =, arm aborted SEVERITY
unheard; fence again; no positions; shows; tick; arm | quits | =, arm aborted OPERATOR_LOST

# autopilots.md 2: hold mode on the ground is sent, and complete when it is seen.
connected GUIDED | {hold, mode AUTO.LOITER HOLD}; accepts HOLD | =, sends HOLD, $ accepted
    | shows HOLD | =, $ complete
connected GUIDED; no positions; wait 1.2
    | hold; shows HOLD | STALE NONE, sends HOLD, hold accepted complete
connected GUIDED; hold | refuses HOLD | =, hold aborted VEHICLE_REFUSED | wait 3 | =
armed | hold | =, sends HOLD, hold accepted
ardupilot: connected; shows OTHER | mode hold HOLD; shows HOLD
    | =, sends HOLD, mode accepted complete

# What is so already is said.
connected | {land, return} | =, $ accepted complete; says "the vehicle stands on the ground"
connected | {disarm, force} | =, $ accepted complete; says "the vehicle is disarmed already"
connected | abort | =, $ accepted complete; says "the vehicle stands on the ground, disarmed"

# An ArduCopter keeps a take-off that it was told in GUIDED until it leaves that mode, over a
# ... disarming too: a guided mode in which it was armed is left and entered again first.
ardupilot: connected OTHER; shows GUIDED disarmed; shows armed; shows disarmed
    | arm | =, sends HOLD, arm accepted
    | accepts HOLD; shows HOLD | =, sends GUIDED
    | accepts GUIDED; shows GUIDED | =, sends ARM
    | shows armed | =, arm complete | wait 3 | =
# The deadline ends it, and so does a hold that is refused.
ardupilot: connected OTHER; shows GUIDED disarmed; shows armed; shows disarmed; arm
    | wait 3; shows HOLD; wait 2.1 | =, sends HOLD HOLD HOLD GUIDED, arm timed out NO_ANSWER
    | shows GUIDED | =
ardupilot: connected OTHER; shows GUIDED disarmed; shows armed; shows disarmed; arm
    | fails HOLD | =, arm aborted VEHICLE_REFUSED
# A guided mode that was entered since is a new one.
ardupilot: connected OTHER; shows GUIDED disarmed; shows armed; shows disarmed
    | shows OTHER; shows GUIDED; arm | =, sends ARM, arm accepted
# What it was told before it was heard nobody knows, nor while it was lost.
ardupilot: connected GUIDED | arm | =, sends HOLD, arm accepted
ardupilot: connected OTHER; shows GUIDED; no heartbeats; wait 6; shows; is ON_GROUND; tick
    | arm | =, sends HOLD, arm accepted
# px4 has no such mode.
connected; shows armed; shows disarmed | arm | =, sends ARM, arm accepted
# ArduPilot goes guided before it arms; a mode that never comes is not waited for longer.
ardupilot: connected | arm | =, sends GUIDED, arm accepted | shows GUIDED | =, sends ARM; asks none
    | shows armed | =, arm complete | up | TAKING_OFF OURS, sends TAKE_OFF, up accepted
ardupilot: connected; arm | wait 5.1 | =, arm timed out NO_ANSWER | shows GUIDED | =

# Clients of an ArduCopter set GUIDED by its name before they arm: it moves nothing on the ground.
ardupilot: connected | mode guided GUIDED | =, sends GUIDED, mode accepted
    | accepts GUIDED | = | shows GUIDED | =, mode complete
ardupilot: connected; shows armed | mode guided GUIDED | =, sends GUIDED, mode accepted
ardupilot: connected; shows GUIDED | mode guided GUIDED | =, mode accepted complete
ardupilot: connected; mode guided GUIDED | fails GUIDED | =, mode aborted VEHICLE_REFUSED
ardupilot: connected; mode guided GUIDED
    | accepts GUIDED; wait 5.1 | =, mode timed out NO_ANSWER
ardupilot: connected; arm | mode guided GUIDED | =, mode refused BUSY
ardupilot: connected | control | =, control refused NOT_FLYING

# PX4 arms in no mode in which it would fly at once (scenarios_px4.json, D2 and C6), ArduPilot in
# ... guided alone, another autopilot in any.
connected {GUIDED, LAND, RETURN, MISSION, TAKEOFF} | arm | =, sends HOLD, arm accepted
connected {HOLD, OTHER} | arm | =, sends ARM, arm accepted
ardupilot: connected OTHER; shows {MODES -GUIDED} | arm | =, sends GUIDED, arm accepted
ardupilot: connected OTHER; shows GUIDED | arm | =, sends ARM, arm accepted
somebody: connected {MODES} | arm | =, sends ARM, arm accepted
""",
)  # fmt: skip


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_is_done_on_the_ground(row: Row) -> None:
    row.fly()
