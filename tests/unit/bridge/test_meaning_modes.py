"""Requests for a flight mode, by the numbers that pymavlink's tables and PX4's header give them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pymavlink.dialects.v20 import all as mavlink

from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State
from gcs.wire.messages import Message
from tests.unit.bridge.rows import BOTH, A, P, Row, air, ground, hold, table
from tests.unit.bridge.vehicles import COPTER_MODES, command_long, copter_mode, px4_mode, sent

HOLDING, MISSION, EXTERNAL = State.HOLDING, State.FLYING_MISSION, State.EXTERNAL
NO_RESUME = Refusal(Code.SEVERITY, "severity is RETURN: battery_critical")
CANNOT: dict[str, Any] = {"why_not_resume": lambda: NO_RESUME}
SEVERE = "SEVERITY: severity is RETURN: battery_critical"
MINE_NOT: dict[str, Any] = {"in_control": False}
GUIDED = {"px4": px4_mode("OFFBOARD"), "ardupilot": copter_mode("GUIDED")}
AUTO = {"px4": px4_mode("MISSION"), "ardupilot": copter_mode("AUTO")}
START = command_long(300)
LEAVES_MISSION = "hold, resume, mission_start"
POLICY_MODES = ("POSCTL", "loiter")


def set_mode(base: int, custom: int) -> Message:
    return sent(mavlink.MAVLink_set_mode_message(1, base, custom))


def standard(number: int) -> Message:
    """DO_SET_STANDARD_MODE."""
    return command_long(262, float(number))


MODES = {
    "of a PX4": [
        Row(P, air(), px4_mode("LOITER"), "hold"),
        Row(P, air(), px4_mode("MISSION"), "mission_start"),
        Row(P, air(), px4_mode("RTL"), "rtl"),
        Row(P, air(), px4_mode("LAND"), "land"),
        Row(P, air(), px4_mode("TAKEOFF"), "takeoff 2.5"),
        Row(P, ground(armed=True), px4_mode("TAKEOFF"), "takeoff 2.5"),
        # The old message says the same; a mission that is flown need not start.
        Row(P, air(), set_mode(1, 4 << 16 | 5 << 24), "rtl"),
        Row(P, air(MISSION, mode_name="AUTO.MISSION"), px4_mode("MISSION"), ""),
    ],
    "of an ArduPilot": [
        Row(A, air(), copter_mode("BRAKE"), "hold"),
        # A hold that obeys the sticks is held otherwise, and told.
        Row(A, air(), copter_mode("LOITER"), "hold", "BRAKE"),
        Row(A, air(), copter_mode("AUTO"), "mission_start"),
        Row(A, air(), copter_mode("RTL"), "rtl"),
        Row(A, air(), copter_mode("LAND"), "land"),
        Row(A, air(), copter_mode("SMART_RTL"), "mode SMART_RTL"),
        Row(A, air(), set_mode(1, COPTER_MODES["LAND"]), "land"),
    ],
    "of the sticks": [
        *(Row(P, air(), px4_mode(name), "POLICY") for name in ("MANUAL", "POSCTL", "FOLLOWME")),
        *(
            Row(P, ground(armed=True), px4_mode(name), "POLICY")
            for name in ("MANUAL", "POSCTL", "FOLLOWME")
        ),
        *(Row(A, air(), copter_mode(name), "POLICY") for name in ("STABILIZE", "CIRCLE")),
        # `[bridge] manual_modes`, by the names that `mode` takes, too.
        Row(P, air(manual_modes=POLICY_MODES), px4_mode("POSCTL"), "forwarded"),
        Row(P, air(manual_modes=POLICY_MODES), px4_mode("ALTCTL"), "POLICY: manual_modes"),
        Row(P, ground(), px4_mode("ALTCTL"), "mode ALTCTL"),  # the gate's to refuse
        Row(P, air(manual_modes=POLICY_MODES), px4_mode("LOITER"), "hold"),
        Row(A, air(manual_modes=POLICY_MODES), copter_mode("LOITER"), "forwarded"),
        Row(P, air(manual_modes=POLICY_MODES, **MINE_NOT), px4_mode("POSCTL"), "control"),
    ],
    # On ArduPilot the way from a hold to a go-to: GUIDED, then the target.
    "guided gets to where the gate hovers": [
        Row(BOTH, air(HOLDING, mode_name=""), GUIDED, "resume"),
        Row(BOTH, air(EXTERNAL, mode_name=""), GUIDED, "resume"),
        Row(BOTH, air(MISSION, mode_name=""), GUIDED, "hold, resume"),
        Row(BOTH, air(State.RETURNING, mode_name=""), GUIDED, "hold, resume"),
        Row(BOTH, air(State.RETURNING), GUIDED, "hold, resume"),
        Row(BOTH, air(State.LANDING, mode_name=""), GUIDED, "hold, resume"),
        Row(BOTH, air(State.HOVERING, mode_name=""), GUIDED, ""),
        Row(BOTH, air(State.HOVERING), GUIDED, ""),
        Row(BOTH, air(State.MOVING), GUIDED, ""),
        Row(BOTH, air(State.TAKING_OFF), GUIDED, ""),
        Row(BOTH, air(State.TAKING_OFF, mode_name=""), GUIDED, "control"),
        # Clients of ArduPilot set GUIDED before they arm: MAVProxy's `mode guided`, pymavlink.
        Row(P, ground(), GUIDED, "mode OFFBOARD"),
        Row(A, ground(), GUIDED, "forwarded"),
        # NAV_GUIDED_ENABLE is the same.
        Row(P, air(HOLDING), command_long(92, 1), "resume"),
        Row(P, air(HOLDING), command_long(92, 2), "UNSUPPORTED"),
    ],
    "what would be refused after a hold stops nothing": [
        *(Row(BOTH, air(s, **CANNOT), GUIDED, SEVERE) for s in (MISSION, State.RETURNING)),
        Row(BOTH, air(State.LANDING, **CANNOT), GUIDED, SEVERE),
        Row(BOTH, air(MISSION, **CANNOT), command_long(224, 1), SEVERE),
        Row(BOTH, air(State.RETURNING, **CANNOT), START, SEVERE),
        Row(P, air(State.RETURNING, **CANNOT), command_long(300, 2), SEVERE),  # from its third item
    ],
    # `hold` is heard from everybody; to go on from there it would be refused.  Hovering for
    # another one would read ACCEPTED, and then each setpoint would be refused.
    "guided stops nothing for who is not in control": [
        *(Row(BOTH, air(s, **MINE_NOT), GUIDED, "control") for s in (MISSION, State.RETURNING)),
        *(
            Row(BOTH, air(s, mode_name="", **MINE_NOT), GUIDED, "control")
            for s in (MISSION, State.RETURNING, State.LANDING)
        ),
        Row(BOTH, air(State.LANDING, **MINE_NOT), GUIDED, "control"),
        Row(BOTH, air(State.HOVERING, **MINE_NOT), GUIDED, "control"),
    ],
    "a mission that another client flies is asked for and so refused": [
        Row(BOTH, air(MISSION, **MINE_NOT), message, "mission_start")
        for message in (AUTO, START, standard(6))
    ],
    # MAVSDK's goto_location, then start_mission before it is there.
    "a mission starts out of what is flown by stopping first": [
        row
        for state in (State.TAKING_OFF, State.MOVING, State.STREAMING, State.RETURNING)
        for row in (
            Row(P, air(state), px4_mode("MISSION"), LEAVES_MISSION),
            Row(P, air(state), START, LEAVES_MISSION),
            Row(P, air(state, **MINE_NOT), px4_mode("MISSION"), "mission_start"),
        )
    ],
    # MAVSDK pauses with the hold mode and starts again with the mission mode, or MISSION_START.
    "a mission goes on after a hold": [
        row
        for state in (HOLDING, EXTERNAL)
        for row in (
            Row(
                P, air(state, mode_name="AUTO.LOITER"), px4_mode("MISSION"), "resume, mission_start"
            ),
            Row(A, air(state, mode_name="BRAKE"), copter_mode("AUTO"), "resume, mission_start"),
            Row(A, air(state, mode_name="BRAKE"), START, "resume, mission_start"),
        )
    ],
    # As a click on the map does not; the mode, which is asked for by itself, does.
    "a command that starts a mission takes no vehicle from a pilot": [
        Row(P, air(EXTERNAL, mode_name="POSCTL"), START, "mission_start"),
        Row(P, air(EXTERNAL, mode_name="POSCTL"), px4_mode("MISSION"), "resume, mission_start"),
        Row(A, air(EXTERNAL, mode_name="STABILIZE"), START, "mission_start"),
        Row(A, air(EXTERNAL, mode_name="STABILIZE"), copter_mode("AUTO"), "resume, mission_start"),
    ],
    "modes that do not exist": [
        Row(A, air(), command_long(176, 1, 99), "UNSUPPORTED"),
        Row(P, air(), command_long(176, 1, 4, 99), "UNSUPPORTED"),
        # Commander.cpp takes main mode 4 without a sub mode for the mission; nobody names it so.
        Row(P, air(), command_long(176, 1, 4, 0), "UNSUPPORTED"),
    ],
    # PX4 would fly its mission; ArduPilot: the safety switch.
    "base modes alone": [
        row
        for flags in (mavlink.MAV_MODE_AUTO_ARMED, mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 0)
        for row in (
            Row(BOTH, air(), set_mode(flags, 0), "UNSUPPORTED"),
            Row(BOTH, air(), command_long(176, flags), "UNSUPPORTED"),
        )
    ],
    "standard modes": [
        Row(P, air(), standard(5), "rtl"),
        Row(P, air(), standard(6), "mission_start"),
        Row(P, air(), standard(7), "land"),
        Row(P, air(), standard(8), "takeoff 2.5"),
        *(Row(P, air(), standard(n), "UNSUPPORTED") for n in (0, 1, 2, 3, 4, 9, -1)),
        Row(A, ground(), standard(8), "UNSUPPORTED"),
    ],
}


@table(MODES)
def test_what_a_mode_asks_for(rows: Sequence[Row]) -> None:
    hold(rows)
