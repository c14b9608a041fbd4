"""Requests for a flight mode, by the numbers that pymavlink's tables and PX4's header give them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.translate.meaning import Forward, Reject, Words
from gcs.bridge.translate.translate import meaning_of
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.wire.messages import Message
from tests.unit.bridge.vehicles import command_long, flying, refusal, sent, standing, words

CUSTOM = 1
COPTER = {name: number for number, name in mavutil.mode_mapping_acm.items()}


def px4(name: str) -> Message:
    """As pymavlink's `set_mode_px4`: base mode, main mode, sub mode."""
    base, main, sub = mavutil.px4_map[name]
    return command_long(176, float(base), float(main), float(sub))


def copter(name: str) -> Message:
    """As pymavlink's `set_mode_apm` for a vehicle that takes DO_SET_MODE."""
    return command_long(176, CUSTOM, float(COPTER[name]))


def set_mode(base: int, custom: int) -> Message:
    return sent(mavlink.MAVLink_set_mode_message(1, base, custom))


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        ("LOITER", ["hold"]),
        ("MISSION", ["mission_start"]),
        ("RTL", ["rtl"]),
        ("LAND", ["land"]),
        ("TAKEOFF", ["takeoff"]),
    ],
)
def test_px4s_modes(name: str, asked: list[str]) -> None:
    assert words(meaning_of(px4(name), flying(PX4))) == asked


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        ("BRAKE", ["hold"]),
        ("LOITER", ["hold"]),
        ("AUTO", ["mission_start"]),
        ("RTL", ["rtl"]),
        ("LAND", ["land"]),
        ("SMART_RTL", ["mode"]),
    ],
)
def test_ardupilots_modes(name: str, asked: list[str]) -> None:
    assert words(meaning_of(copter(name), flying(ARDUPILOT))) == asked


@pytest.mark.parametrize("name", ["MANUAL", "POSCTL", "FOLLOWME"])
def test_px4s_modes_of_the_sticks_are_refused(name: str) -> None:
    assert refusal(meaning_of(px4(name), flying(PX4))).startswith("POLICY")
    assert refusal(meaning_of(px4(name), standing(PX4, armed=True))).startswith("POLICY")


@pytest.mark.parametrize("name", ["STABILIZE", "CIRCLE"])
def test_ardupilots_modes_of_the_sticks_are_refused(name: str) -> None:
    assert refusal(meaning_of(copter(name), flying(ARDUPILOT))).startswith("POLICY")


def test_the_old_message_says_the_same() -> None:
    main, sub = mavutil.px4_map["RTL"][1:]
    assert words(meaning_of(set_mode(CUSTOM, main << 16 | sub << 24), flying(PX4))) == ["rtl"]
    assert words(meaning_of(set_mode(CUSTOM, COPTER["LAND"]), flying(ARDUPILOT))) == ["land"]


def test_a_hold_that_obeys_the_sticks_is_held_otherwise_and_told() -> None:
    meaning = meaning_of(copter("LOITER"), flying(ARDUPILOT))
    assert isinstance(meaning, Words)
    assert "BRAKE" in meaning.note
    brake = meaning_of(copter("BRAKE"), flying(ARDUPILOT))
    assert isinstance(brake, Words)
    assert not brake.note


def test_a_policy_may_let_modes_of_the_sticks_through() -> None:
    """`[bridge] manual_modes`, by the names that `mode` takes, too."""
    names = ("POSCTL", "loiter")
    assert meaning_of(px4("POSCTL"), flying(PX4, manual_modes=names)) == Forward()
    assert "manual_modes" in refusal(meaning_of(px4("ALTCTL"), flying(PX4, manual_modes=names)))
    assert words(meaning_of(px4("ALTCTL"), standing(PX4))) == ["mode"], "the gate's to refuse"
    assert words(meaning_of(px4("LOITER"), flying(PX4, manual_modes=names))) == ["hold"]
    assert meaning_of(copter("LOITER"), flying(ARDUPILOT, manual_modes=names)) == Forward()
    other = flying(PX4, manual_modes=names, in_control=False)
    assert words(meaning_of(px4("POSCTL"), other)) == ["control"], "refused: not in control"


def test_px4s_take_off_mode_climbs_to_its_own_height() -> None:
    meaning = meaning_of(px4("TAKEOFF"), standing(PX4, armed=True))
    assert isinstance(meaning, Words)
    assert meaning.asks[0].up_m == 2.5


GUIDED = pytest.mark.parametrize(
    ("autopilot", "guided"),
    [(PX4, px4("OFFBOARD")), (ARDUPILOT, copter("GUIDED"))],
    ids=["px4", "ardupilot"],
)


@GUIDED
@pytest.mark.parametrize(
    ("state", "mode_name", "asked"),
    [
        (State.HOLDING, "", ["resume"]),
        (State.EXTERNAL, "", ["resume"]),
        (State.FLYING_MISSION, "", ["hold", "resume"]),
        (State.RETURNING, "", ["hold", "resume"]),
        (State.RETURNING, "guided", ["hold", "resume"]),
        (State.LANDING, "", ["hold", "resume"]),
        (State.HOVERING, "", []),
        (State.HOVERING, "guided", []),
        (State.MOVING, "guided", []),
        (State.TAKING_OFF, "guided", []),
        (State.TAKING_OFF, "", ["control"]),
    ],
)
def test_guided_gets_to_where_the_gate_hovers(
    state: State, mode_name: str, asked: list[str], autopilot: Autopilot, guided: Message
) -> None:
    """On ArduPilot the way from a hold to a go-to: GUIDED, then the target."""
    seen = flying(autopilot, state=state)
    seen = seen if mode_name else flying(autopilot, state=state, mode_name="")
    assert words(meaning_of(guided, seen)) == asked


@GUIDED
@pytest.mark.parametrize("state", [State.FLYING_MISSION, State.RETURNING, State.LANDING])
def test_what_would_be_refused_after_a_hold_stops_nothing(
    state: State, autopilot: Autopilot, guided: Message
) -> None:
    why = Refusal(Code.SEVERITY, "severity is RETURN: battery_critical")
    seen = flying(autopilot, state=state, why_not_resume=lambda: why)
    assert meaning_of(guided, seen) == Reject(why)
    if state is not State.LANDING:
        jump = meaning_of(command_long(224, 1.0), replace(seen, state=State.FLYING_MISSION))
        assert jump == Reject(why)
    if state is State.RETURNING:
        assert meaning_of(command_long(300), seen) == Reject(why)
        if autopilot is PX4:
            assert meaning_of(command_long(300, 2.0), seen) == Reject(why), "from its third item"


@GUIDED
@pytest.mark.parametrize("state", [State.FLYING_MISSION, State.RETURNING, State.LANDING])
def test_guided_stops_nothing_for_a_client_who_is_not_in_control(
    state: State, autopilot: Autopilot, guided: Message
) -> None:
    """`hold` is heard from everybody; to go on from there it would be refused."""
    for known in ("", flying(autopilot).mode_name):  # the heartbeat may still show it
        seen = flying(autopilot, state=state, mode_name=known, in_control=False)
        assert words(meaning_of(guided, seen)) == ["control"]


@GUIDED
def test_guided_that_is_flown_for_another_client_is_no_success(
    autopilot: Autopilot, guided: Message
) -> None:
    """It would read ACCEPTED, and then each of its setpoints would be refused."""
    seen = flying(autopilot, state=State.HOVERING, in_control=False)
    assert words(meaning_of(guided, seen)) == ["control"]


@GUIDED
def test_guided_on_the_ground_waits_for_a_take_off_and_offboard_is_for_the_gate_to_decide(
    autopilot: Autopilot, guided: Message
) -> None:
    """Clients of ArduPilot set GUIDED before they arm: MAVProxy's `mode guided`, pymavlink."""
    meaning = meaning_of(guided, standing(autopilot))
    if autopilot is PX4:
        assert isinstance(meaning, Words)
        assert [ask.mode for ask in meaning.asks] == ["OFFBOARD"]
    else:
        assert meaning == Forward()


def test_nav_guided_enable_is_the_same() -> None:
    held = flying(PX4, state=State.HOLDING)
    assert words(meaning_of(command_long(92, 1.0), held)) == ["resume"]
    assert refusal(meaning_of(command_long(92, 2.0), held)).startswith("UNSUPPORTED")


def test_a_mission_that_is_flown_need_not_start() -> None:
    flown = flying(PX4, state=State.FLYING_MISSION, mode_name="AUTO.MISSION")
    assert words(meaning_of(px4("MISSION"), flown)) == []


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)
def test_a_mission_that_another_client_flies_is_asked_for_and_so_refused(
    autopilot: Autopilot,
) -> None:
    flown = flying(autopilot, state=State.FLYING_MISSION, in_control=False)
    mode = px4("MISSION") if autopilot is PX4 else copter("AUTO")
    for message in (mode, command_long(300), command_long(262, 6.0)):
        assert words(meaning_of(message, flown)) == ["mission_start"]


UNDER_WAY = [State.TAKING_OFF, State.MOVING, State.STREAMING, State.RETURNING]


@pytest.mark.parametrize("state", UNDER_WAY, ids=lambda s: s.name)
def test_a_mission_starts_out_of_what_is_flown_by_stopping_first(state: State) -> None:
    """MAVSDK's goto_location, then start_mission before it is there."""
    mine = flying(PX4, state=state, mode_name="OFFBOARD")
    assert words(meaning_of(px4("MISSION"), mine)) == ["hold", "resume", "mission_start"]
    assert words(meaning_of(command_long(300), mine)) == ["hold", "resume", "mission_start"]
    other = flying(PX4, state=state, mode_name="OFFBOARD", in_control=False)
    assert words(meaning_of(px4("MISSION"), other)) == ["mission_start"]


@pytest.mark.parametrize("state", [State.HOLDING, State.EXTERNAL], ids=lambda s: s.name)
def test_a_mission_goes_on_after_a_hold(state: State) -> None:
    """MAVSDK pauses with the hold mode and starts again with the mission mode, or MISSION_START."""
    px4_held = flying(PX4, state=state, mode_name="AUTO.LOITER")
    assert words(meaning_of(px4("MISSION"), px4_held)) == ["resume", "mission_start"]
    copter_held = flying(ARDUPILOT, state=state, mode_name="BRAKE")
    assert words(meaning_of(copter("AUTO"), copter_held)) == ["resume", "mission_start"]
    assert words(meaning_of(command_long(300), copter_held)) == ["resume", "mission_start"]


def test_a_command_that_starts_a_mission_takes_no_vehicle_from_a_pilot() -> None:
    """As a click on the map does not; the mode, which is asked for by itself, does."""
    flown = flying(PX4, state=State.EXTERNAL, mode_name="POSCTL")
    assert words(meaning_of(command_long(300), flown)) == ["mission_start"]
    assert words(meaning_of(px4("MISSION"), flown)) == ["resume", "mission_start"]
    flown = flying(ARDUPILOT, state=State.EXTERNAL, mode_name="STABILIZE")
    assert words(meaning_of(command_long(300), flown)) == ["mission_start"]
    assert words(meaning_of(copter("AUTO"), flown)) == ["resume", "mission_start"]


def test_modes_that_do_not_exist() -> None:
    assert refusal(meaning_of(command_long(176, CUSTOM, 99.0), flying(ARDUPILOT)))
    assert refusal(meaning_of(command_long(176, CUSTOM, 4.0, 99.0), flying(PX4)))
    # Commander.cpp takes main mode 4 without a sub mode for the mission; nobody names it so.
    assert refusal(meaning_of(command_long(176, CUSTOM, 4.0, 0.0), flying(PX4)))


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)
@pytest.mark.parametrize(
    "flags",
    [
        mavlink.MAV_MODE_AUTO_ARMED,  # PX4 would fly its mission
        mavlink.MAV_MODE_FLAG_SAFETY_ARMED,  # ArduPilot: the safety switch
        0,
    ],
)
def test_base_modes_alone_are_refused(autopilot: Autopilot, flags: int) -> None:
    assert refusal(meaning_of(set_mode(flags, 0), flying(autopilot))).startswith("UNSUPPORTED")
    assert refusal(meaning_of(command_long(176, float(flags)), flying(autopilot)))


@pytest.mark.parametrize(
    ("number", "asked"), [(5, ["rtl"]), (6, ["mission_start"]), (7, ["land"]), (8, ["takeoff"])]
)
def test_standard_modes(number: int, asked: list[str]) -> None:
    assert words(meaning_of(command_long(262, float(number)), flying(PX4))) == asked


@pytest.mark.parametrize("number", [0, 1, 2, 3, 4, 9, -1])
def test_standard_modes_that_need_sticks(number: int) -> None:
    meaning = meaning_of(command_long(262, float(number)), flying(PX4))
    assert refusal(meaning).startswith("UNSUPPORTED")


def test_ardupilot_has_no_mode_for_a_take_off() -> None:
    assert refusal(meaning_of(command_long(262, 8.0), standing(ARDUPILOT)))
