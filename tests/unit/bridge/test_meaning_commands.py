"""What commands of clients ask for: MAVLink common.xml, and what real autopilots made of them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.translate.meaning import Forward, Words
from gcs.bridge.translate.translate import meaning_of
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, GENERIC, PX4, Autopilot
from gcs.wire.messages import Message
from tests.unit.bridge.vehicles import (
    NAN,
    UNSET,
    command_int,
    command_long,
    flying,
    goal,
    refusal,
    standing,
    words,
)

BOTH = pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)

GLOBAL = mavlink.MAV_FRAME_GLOBAL
RELATIVE = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT
TERRAIN = mavlink.MAV_FRAME_GLOBAL_TERRAIN_ALT
CHANGE_MODE = 1.0

# 100 m north and 50 m east of the origin of `flying`.  Computed apart from this program: on a
# sphere of 6,371,000 m a degree of latitude is 111,194.9266 m; ArduPilot counts
# 111,318.84502145034 m a degree.  Of longitude times the cosine of 47.3978 degrees.
PX4_LAT, PX4_LON = 47.397742 + 100 / 111_194.9266, 8.545594 + 50 / (111_194.9266 * 0.67692)
ARDU_LAT = 47.397742 + 100 / 111_318.84502145034
ARDU_LON = 8.545594 + 50 / (111_318.84502145034 * math.cos(math.radians(47.397742 + 0.000449)))


def e7(degrees: float) -> int:
    return round(degrees * 1e7)


# ------------------------------------------------------------------------- arming, take-off


@BOTH
def test_arming(autopilot: Autopilot) -> None:
    arm = command_long(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1.0)
    assert words(meaning_of(arm, standing(autopilot))) == ["arm"]


@BOTH
def test_forced_arming_is_arming_with_its_checks_and_says_so(autopilot: Autopilot) -> None:
    arm = command_long(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 21196.0)
    meaning = meaning_of(arm, standing(autopilot))
    assert words(meaning) == ["arm"]
    assert isinstance(meaning, Words)
    assert "checks are not skipped" in meaning.note


@BOTH
def test_mavsdk_fills_what_it_does_not_use_with_nan(autopilot: Autopilot) -> None:
    """Seen of MAVSDK 4.1.0: arm is 1, NaN, NaN, NaN, NaN, NaN, NaN, and not forced."""
    nans = (NAN,) * 6
    assert meaning_of(command_long(400, 1.0, *nans), standing(autopilot)) == meaning_of(
        command_long(400, 1.0), standing(autopilot)
    )
    disarm = meaning_of(command_long(400, 0.0, *nans), flying(autopilot))
    assert isinstance(disarm, Words)
    assert not disarm.asks[0].force


@BOTH
def test_disarming_by_force_is_asked_of_the_gate_as_such(autopilot: Autopilot) -> None:
    gentle = meaning_of(command_long(400, 0.0), flying(autopilot))
    forced = meaning_of(command_long(400, 0.0, 21196.0), flying(autopilot))
    assert isinstance(gentle, Words)
    assert not gentle.asks[0].force
    assert isinstance(forced, Words)
    assert forced.asks[0].force
    # ArduCopter 4.7, recorded: 2989 in p2 does not disarm in the air.
    other = meaning_of(command_long(400, 0.0, 2989.0), flying(autopilot))
    assert isinstance(other, Words)
    assert not other.asks[0].force


@BOTH
@pytest.mark.parametrize("p1", [0.6, 2.0, -1.0, NAN, math.inf])
def test_neither_arm_nor_disarm(autopilot: Autopilot, p1: float) -> None:
    assert refusal(meaning_of(command_long(400, p1), standing(autopilot))).startswith("UNSUPPORTED")


def take_off_up_m(meaning: object) -> float:
    assert words(meaning) == ["takeoff"]
    assert isinstance(meaning, Words)
    assert meaning.asks[0].up_m is not None
    return meaning.asks[0].up_m


def test_px4_takes_off_to_a_height_above_sea_level() -> None:
    """It stands 500 m above the sea; 510 is 10 m above it."""
    take_off = command_long(22, 0.0, 0.0, 0.0, NAN, NAN, NAN, 510.0)
    assert take_off_up_m(meaning_of(take_off, standing(PX4))) == pytest.approx(10.0)


def test_px4_without_a_height_takes_off_to_its_own() -> None:
    take_off = command_long(22, 0.0, 0.0, 0.0, NAN, NAN, NAN, NAN)
    assert take_off_up_m(meaning_of(take_off, standing(PX4))) == 2.5


@pytest.mark.parametrize("height_m", [10.0, 0.0, 500.0, 502.0])
def test_px4_too_low_a_take_off_is_its_own_least_height(height_m: float) -> None:
    """PX4 1.14.3, recorded (commands_px4.json, "takeoff in air"): "Using minimum takeoff altitude:
    2.50 m".  A script that means 10 m above home gets that."""
    take_off = command_long(22, 0.0, 0.0, 0.0, NAN, NAN, NAN, height_m)
    meaning = meaning_of(take_off, standing(PX4))
    assert take_off_up_m(meaning) == 2.5
    assert isinstance(meaning, Words)
    assert "too low" in meaning.note


def test_px4_takes_off_here_only() -> None:
    """It would fly to the place after its climb, along a leg that nobody verified."""
    here = command_long(22, 0.0, 0.0, 0.0, NAN, 47.397751, 8.5456206, 510.0)
    assert take_off_up_m(meaning_of(here, standing(PX4))) == pytest.approx(10.0)
    there = command_long(22, 0.0, 0.0, 0.0, NAN, PX4_LAT, PX4_LON, 510.0)
    text = refusal(meaning_of(there, standing(PX4)))
    assert text.startswith("UNSUPPORTED")
    assert "DO_REPOSITION" in text
    nowhere = command_long(22, 0.0, 0.0, 0.0, NAN, 0.0, 0.0, 510.0)
    assert take_off_up_m(meaning_of(nowhere, standing(PX4))) == pytest.approx(10.0)


def test_ardupilot_takes_off_to_a_height_above_home() -> None:
    take_off = command_long(22, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0)
    assert take_off_up_m(meaning_of(take_off, standing(ARDUPILOT))) == pytest.approx(10.0)
    on_a_roof = standing(ARDUPILOT, pos_ned=(1.0, 2.0, -15.0))
    assert take_off_up_m(meaning_of(take_off, on_a_roof)) == pytest.approx(7.0)
    before_home = standing(ARDUPILOT, home_ned=None, home_amsl_m=None)
    assert take_off_up_m(meaning_of(take_off, before_home)) == 10.0


def test_ardupilot_takes_off_in_frame_3_only() -> None:
    """GCS_Mavlink.cpp: any other frame of COMMAND_INT is DENIED; places are ignored."""
    relative = command_int(22, RELATIVE, x=e7(48.0), y=e7(9.0), z=10.0)
    assert take_off_up_m(meaning_of(relative, standing(ARDUPILOT))) == pytest.approx(10.0)
    amsl = command_int(22, GLOBAL, z=510.0)
    assert refusal(meaning_of(amsl, standing(ARDUPILOT))).startswith("UNSUPPORTED")


def test_a_take_off_above_sea_level_needs_the_origin() -> None:
    take_off = command_long(22, 0.0, 0.0, 0.0, NAN, NAN, NAN, 510.0)
    assert refusal(meaning_of(take_off, standing(PX4, origin=None))).startswith("NO_ORIGIN")
    assert refusal(meaning_of(take_off, standing(PX4, pos_ned=None))).startswith("NO_POSITION")


# --------------------------------------------------------------------- landing, return, stop


@BOTH
def test_landing_is_where_it_is_whatever_the_place(autopilot: Autopilot) -> None:
    """PX4 1.14.3, recorded: "Landing at current position"."""
    plain = meaning_of(command_long(21), flying(autopilot))
    assert plain == meaning_of(command_long(21, 0, 0, 0, NAN, NAN, NAN, 0), flying(autopilot))
    assert words(plain) == ["land"]
    placed = meaning_of(command_long(21, 0, 0, 0, 0, 48.0, 9.0, 0), flying(autopilot))
    assert words(placed) == ["land"]
    assert isinstance(placed, Words)
    assert "not at the place" in placed.note


@BOTH
def test_return(autopilot: Autopilot) -> None:
    assert words(meaning_of(command_long(20), flying(autopilot))) == ["rtl"]


STOPS = {
    "DO_PAUSE_CONTINUE": command_long(193, 0.0),
    "OVERRIDE_GOTO": command_long(252, 0.0, 2.0),
    "NAV_LOITER_UNLIM": command_long(17),
    "NAV_GUIDED_ENABLE off": command_long(92, 0.0),
}


@BOTH
@pytest.mark.parametrize("state", list(State), ids=lambda s: s.name)
@pytest.mark.parametrize("name", STOPS)
def test_a_stop_is_a_hold_in_every_state(name: str, state: State, autopilot: Autopilot) -> None:
    """Invariant 10: `hold` is a word that everybody may say, and that is never refused."""
    assert words(meaning_of(STOPS[name], flying(autopilot, state=state))) == ["hold"]


@BOTH
def test_going_on(autopilot: Autopilot) -> None:
    go_on = command_long(193, 1.0)
    held = flying(autopilot, state=State.HOLDING)
    assert words(meaning_of(go_on, held)) == ["resume"]
    in_a_mission = flying(autopilot, state=State.HOLDING, mission_paused=True)
    assert words(meaning_of(go_on, in_a_mission)) == ["resume", "mission_start"]
    assert refusal(meaning_of(command_long(193, 0.5), held)).startswith("UNSUPPORTED")


# ----------------------------------------------------------------------------- reposition


@pytest.mark.parametrize(
    ("frame", "height_m"), [(GLOBAL, 505.0), (5, 505.0), (RELATIVE, 5.0), (6, 5.0)]
)
def test_px4_reposition_in_every_frame_of_the_map(frame: int, height_m: float) -> None:
    """505 m above the sea is 5 m above home and 17 m above the origin."""
    message = command_int(
        192, frame, (-1.0, CHANGE_MODE, 0.0, NAN), e7(PX4_LAT), e7(PX4_LON), height_m
    )
    meaning = meaning_of(message, flying(PX4))
    assert words(meaning) == ["goto"]
    assert goal(meaning) == pytest.approx((50.0, 100.0, 17.0), abs=0.05)
    assert isinstance(meaning, Words)
    assert meaning.asks[0].yaw_deg is None


def test_ardupilot_reposition_with_its_own_projection() -> None:
    message = command_int(192, RELATIVE, (-1.0, 0.0, 0.0, 1.0), e7(ARDU_LAT), e7(ARDU_LON), 5.0)
    meaning = meaning_of(message, flying(ARDUPILOT))
    assert goal(meaning) == pytest.approx((50.0, 100.0, 17.0), abs=0.02)
    assert isinstance(meaning, Words)
    assert meaning.asks[0].yaw_deg is None


def test_px4_reposition_heading_is_in_radians() -> None:
    message = command_long(192, -1.0, CHANGE_MODE, 0.0, math.pi / 2, PX4_LAT, PX4_LON, 505.0)
    meaning = meaning_of(message, flying(PX4))
    assert isinstance(meaning, Words)
    assert meaning.asks[0].yaw_deg == pytest.approx(90.0, abs=1e-4)


def test_px4_reposition_keeps_what_is_not_given() -> None:
    higher = command_int(192, RELATIVE, (-1.0, CHANGE_MODE, 0.0, NAN), UNSET, UNSET, 15.0)
    assert goal(meaning_of(higher, flying(PX4))) == pytest.approx((2.0, 1.0, 27.0))
    there = command_int(192, RELATIVE, (-1.0, CHANGE_MODE, 0.0, NAN), e7(PX4_LAT), e7(PX4_LON), NAN)
    assert goal(meaning_of(there, flying(PX4))) == pytest.approx((50.0, 100.0, 22.0), abs=0.05)


def test_px4_reposition_to_nowhere_is_a_stop() -> None:
    """QGroundControl's "pause" (from memory: pauseVehicle of its PX4 plug-in)."""
    pause = command_long(192, -1.0, CHANGE_MODE, 0.0, NAN, NAN, NAN, NAN)
    assert words(meaning_of(pause, flying(PX4, state=State.MOVING))) == ["hold"]


@pytest.mark.parametrize("state", [State.HOLDING, State.EXTERNAL], ids=lambda s: s.name)
def test_reposition_with_the_flag_leaves_a_hold(state: State) -> None:
    """Both recorded: with flag 1 it is taken in every mode and changes it."""
    px4 = command_long(192, -1.0, CHANGE_MODE, 0.0, NAN, PX4_LAT, PX4_LON, 505.0)
    assert words(meaning_of(px4, flying(PX4, state=state))) == ["resume", "goto"]
    place = (e7(ARDU_LAT), e7(ARDU_LON), 5.0)
    flag = command_int(192, RELATIVE, (-1.0, CHANGE_MODE), *place)
    assert words(meaning_of(flag, flying(ARDUPILOT, state=state))) == ["resume", "goto"]
    without = command_int(192, RELATIVE, (-1.0, 0.0), *place)
    assert words(meaning_of(without, flying(ARDUPILOT, state=state))) == ["goto"]


@pytest.mark.parametrize(
    ("mode_name", "asked"),
    [("POSCTL", ["goto"]), ("STABILIZED", ["goto"]), ("AUTO.LOITER", ["resume", "goto"])],
)
def test_reposition_takes_no_vehicle_from_a_pilot(mode_name: str, asked: list[str]) -> None:
    """The autopilot would take it; here a pilot's sticks outrank a click on the map, and the gate
    refuses the go-to: NOT_IN_CONTROL."""
    flag = command_long(192, -1.0, CHANGE_MODE, 0.0, NAN, PX4_LAT, PX4_LON, 505.0)
    seen = flying(PX4, state=State.EXTERNAL, mode_name=mode_name)
    assert words(meaning_of(flag, seen)) == asked


@pytest.mark.parametrize("flags", [0.0, 2.0, 3.0, NAN])
def test_px4_reposition_without_the_flag_alone(flags: float) -> None:
    """PX4 1.14.3, recorded: flags 0 is UNSUPPORTED in every mode (scenarios_px4.json)."""
    message = command_long(192, -1.0, flags, 0.0, NAN, PX4_LAT, PX4_LON, 505.0)
    assert refusal(meaning_of(message, flying(PX4))).startswith("UNSUPPORTED")


def test_ardupilot_reposition_as_command_long() -> None:
    """ArduCopter 4.7, recorded: UNSUPPORTED on the ground and in the air."""
    message = command_long(192, -1.0, CHANGE_MODE, 0.0, NAN, ARDU_LAT, ARDU_LON, 5.0)
    assert "COMMAND_INT" in refusal(meaning_of(message, flying(ARDUPILOT)))


@BOTH
@pytest.mark.parametrize("frame", [1, 2, 7, 8, 9, 10, 11, 12, 20, 99, 255])
def test_reposition_in_frames_that_neither_takes(autopilot: Autopilot, frame: int) -> None:
    """Recorded for 8 and 2: UNSUPPORTED (PX4), DENIED, "Unknown mavlink coordinate frame"
    (ArduCopter).  Heights above terrain need data that nobody here has."""
    lat, lon = e7(PX4_LAT), e7(PX4_LON)
    message = command_int(192, frame, (-1.0, CHANGE_MODE, 0.0, NAN), lat, lon, 5.0)
    assert refusal(meaning_of(message, flying(autopilot))).startswith("UNSUPPORTED")


def test_reposition_needs_the_origin() -> None:
    message = command_long(192, -1.0, CHANGE_MODE, 0.0, NAN, PX4_LAT, PX4_LON, 505.0)
    assert refusal(meaning_of(message, flying(PX4, origin=None))).startswith("NO_ORIGIN")


@pytest.mark.parametrize("place", [(91.0, 8.0), (47.0, 181.0), (NAN, 8.0), (47.0, math.inf)])
def test_reposition_to_no_place_on_the_map(place: tuple[float, float]) -> None:
    message = command_long(192, -1.0, CHANGE_MODE, 0.0, NAN, *place, 505.0)
    assert "no place on the map" in refusal(meaning_of(message, flying(PX4)))


def test_nan_as_an_integer_is_no_place() -> None:
    """0x7FF80000 is the upper half of a NaN; PX4 denies it ("x/y invalid of command")."""
    nan = 0x7FF80000
    message = command_int(192, RELATIVE, (-1.0, CHANGE_MODE, 0.0, NAN), nan, nan, 5.0)
    assert "no place on the map" in refusal(meaning_of(message, flying(PX4)))


def test_a_repeated_reposition_asks_for_nothing_more() -> None:
    """A client whose acknowledgement was lost sends it again."""
    message = command_long(192, -1.0, CHANGE_MODE, 0.0, NAN, PX4_LAT, PX4_LON, 505.0)
    first = goal(meaning_of(message, flying(PX4)))
    under_way = flying(PX4, state=State.MOVING, goal_ned=(first[1], first[0], -first[2]))
    assert words(meaning_of(message, under_way)) == []
    aborted = flying(PX4, state=State.HOLDING, goal_ned=(first[1], first[0], -first[2]))
    assert words(meaning_of(message, aborted)) == ["resume", "goto"]


def test_a_goal_that_another_client_flies_to_is_asked_for_and_so_refused() -> None:
    message = command_long(192, -1.0, CHANGE_MODE, 0.0, NAN, PX4_LAT, PX4_LON, 505.0)
    first = goal(meaning_of(message, flying(PX4)))
    here = {"goal_ned": (first[1], first[0], -first[2]), "in_control": False}
    for state in (State.MOVING, State.HOVERING):
        assert words(meaning_of(message, flying(PX4, state=state, **here))) == ["goto"]


# ----------------------------------------------------------------- heights, headings, circles


def test_change_altitude() -> None:
    amsl = command_long(186, 530.0, GLOBAL)
    assert goal(meaning_of(amsl, flying(PX4))) == pytest.approx((2.0, 1.0, 42.0))
    relative = command_long(186, 30.0, RELATIVE)
    assert goal(meaning_of(relative, flying(PX4))) == pytest.approx((2.0, 1.0, 42.0))
    held = flying(PX4, state=State.HOLDING)
    assert words(meaning_of(amsl, held)) == ["resume", "goto"]
    # ArduCopter 4.7, recorded: 186 is UNSUPPORTED on the ground and in the air.
    assert refusal(meaning_of(amsl, flying(ARDUPILOT))).startswith("UNSUPPORTED")


@pytest.mark.parametrize(
    ("params", "yaw_deg"),
    [
        ((270.0, 10.0, 1.0, 0.0), -90.0),
        ((0.0, 0.0, 0.0, 0.0), 0.0),
        ((45.0, 0.0, 1.0, 1.0), 135.0),
        ((45.0, 0.0, -1.0, 1.0), 45.0),
        ((180.0, 0.0, 1.0, 1.0), -90.0),
    ],
)
def test_ardupilot_condition_yaw(params: tuple[float, ...], yaw_deg: float) -> None:
    """It points east (90) and holds its goal; relative angles turn clockwise unless p3 is -1."""
    meaning = meaning_of(command_long(115, *params), flying(ARDUPILOT))
    assert goal(meaning) == (2.0, 1.0, 22.0)
    assert isinstance(meaning, Words)
    assert meaning.asks[0].yaw_deg == pytest.approx(yaw_deg, abs=1e-4)


@pytest.mark.parametrize("params", [(-1.0,), (361.0,), (NAN,), (90.0, 0.0, 0.0, 2.0)])
def test_ardupilot_condition_yaw_beyond_its_range(params: tuple[float, ...]) -> None:
    assert refusal(meaning_of(command_long(115, *params), flying(ARDUPILOT)))


def test_px4_takes_no_condition_yaw() -> None:
    """PX4 1.14.3, recorded: UNSUPPORTED in the air and on the ground (commands_px4.json)."""
    assert refusal(meaning_of(command_long(115, 90.0), flying(PX4))).startswith("UNSUPPORTED")


@BOTH
def test_going_around_is_refused_with_what_to_do_instead(autopilot: Autopilot) -> None:
    assert "hold" in refusal(meaning_of(command_long(191), flying(autopilot)))


@BOTH
@pytest.mark.parametrize("command", [195, 196, 197, 198, 201])
def test_looking_somewhere_is_forwarded(autopilot: Autopilot, command: int) -> None:
    assert meaning_of(command_long(command), flying(autopilot)) == Forward()


@BOTH
@pytest.mark.parametrize(
    "message", [command_long(195), command_long(178, 1.0, 2.0), command_long(178, 1.0, -1.0)]
)
def test_what_is_forwarded_is_so_for_the_client_in_control_only(
    autopilot: Autopilot, message: Message
) -> None:
    """`control` is the request that is refused OTHER_OPERATOR, as it should be."""
    assert meaning_of(message, flying(autopilot)) == Forward()
    other = flying(autopilot, in_control=False)
    assert words(meaning_of(message, other)) == ["control"]


# ----------------------------------------------------------------------- missions and speeds


@BOTH
def test_mission_start(autopilot: Autopilot) -> None:
    assert words(meaning_of(command_long(300), flying(autopilot))) == ["mission_start"]
    assert refusal(meaning_of(command_long(300, 3.0), standing(autopilot)))


def test_a_mission_start_in_the_air_names_its_first_item_on_px4_alone() -> None:
    """C10_mission_start_px4, recorded: MISSION_START 1, 1 ACCEPTED.  ArduCopter denies it."""
    hold = flying(PX4, state=State.HOLDING, mode_name="AUTO.LOITER")
    for seen, before in ((flying(PX4), []), (hold, ["resume"])):
        start = meaning_of(command_long(300, 3.0), seen)
        assert words(start) == [*before, "mission_set_current", "mission_start"]
        assert isinstance(start, Words)
        assert start.asks[-2].item == 3
    assert "no items" in refusal(meaning_of(command_long(300, 3.0), flying(ARDUPILOT)))


def test_px4_arms_for_a_mission_ardupilot_does_not() -> None:
    """Commander.cpp: switches to the mission and arms.  ArduCopter 4.7, recorded: ACCEPTED
    disarmed, and nothing flies.  What is on board is verified before the motors run."""
    start = ["mission_check", "arm", "mission_start"]
    assert words(meaning_of(command_long(300), standing(PX4))) == start
    armed = standing(PX4, armed=True)
    assert words(meaning_of(command_long(300), armed)) == ["mission_start"]
    assert words(meaning_of(command_long(300), standing(ARDUPILOT))) == ["mission_start"]
    last = meaning_of(command_long(300, 0.0, 5.0), flying(ARDUPILOT))
    assert refusal(last).startswith("UNSUPPORTED")  # GCS_Mavlink.cpp: DENIED


@BOTH
def test_the_current_item_is_set_where_no_mission_is_flown(autopilot: Autopilot) -> None:
    """Whether there is such an item, and whether the vehicle stands, the station says."""
    for seen in (standing(autopilot), flying(autopilot, mission_items=5)):
        for item in (0, 4):
            meaning = meaning_of(command_long(224, float(item)), seen)
            assert words(meaning) == ["mission_set_current"]
            assert isinstance(meaning, Words)
            assert meaning.asks[0].item == item


@BOTH
def test_a_landing_by_the_mission_begins_at_its_marker(autopilot: Autopilot) -> None:
    """MAVLink common: DO_LAND_START as a command lands with the mission's landing pattern."""
    jump = ["mission_set_current", "mission_start"]
    for state, before in (
        (State.HOVERING, []),
        (State.HOLDING, ["resume"]),
        (State.FLYING_MISSION, ["hold", "resume"]),
    ):
        seen = flying(autopilot, state=state, mission_items=9, land_starts=(6,))
        meaning = meaning_of(command_long(189), seen)
        assert words(meaning) == [*before, *jump]
        assert isinstance(meaning, Words)
        assert meaning.asks[-2].item == 6


@BOTH
def test_without_one_marker_there_is_no_landing_by_the_mission(autopilot: Autopilot) -> None:
    def refused(**changed: Any) -> str:
        seen = flying(autopilot, **{"mission_items": 9, "land_starts": (6,), **changed})
        return refusal(meaning_of(command_long(189), seen))

    assert refused(mission_items=0).startswith("NO_MISSION")
    assert refused(land_starts=()).startswith("BAD_MISSION")
    assert "items 3, 6" in refused(land_starts=(3, 6))
    assert refused(on_ground=True).startswith("NOT_FLYING")


@BOTH
def test_a_mission_that_is_flown_is_stopped_before_it_goes_on_elsewhere(
    autopilot: Autopilot,
) -> None:
    ours = flying(autopilot, state=State.FLYING_MISSION, mission_items=5)
    jump = meaning_of(command_long(224, 2.0), ours)
    assert words(jump) == ["hold", "resume", "mission_set_current", "mission_start"]
    beyond = meaning_of(command_long(224, 5.0), ours)
    assert refusal(beyond) == "BAD_MISSION: there is no item 5: the last one is 4"
    others = replace(ours, in_control=False)
    assert words(meaning_of(command_long(224, 2.0), others)) == ["mission_set_current"]


@BOTH
@pytest.mark.parametrize("item", [-1.0, 0.5, NAN, 65536.0, 1e38])
def test_no_item_at_all(autopilot: Autopilot, item: float) -> None:
    assert refusal(meaning_of(command_long(224, item), standing(autopilot)))


@BOTH
def test_speeds_up_to_the_policys(autopilot: Autopilot) -> None:
    for speed_m_s in (5.0, 1.0, -1.0, -2.0):
        assert meaning_of(command_long(178, 1.0, speed_m_s), flying(autopilot)) == Forward()
    text = refusal(meaning_of(command_long(178, 1.0, 5.5), flying(autopilot)))
    assert text.startswith("POLICY")
    assert "5.5 m/s" in text
    unknown = flying(autopilot, max_speed_m_s=0.0)
    assert refusal(meaning_of(command_long(178, 1.0, 0.5), unknown)).startswith("POLICY")


@pytest.mark.parametrize("kind", [2.0, 3.0, 4.0, NAN])
def test_climb_and_descent_keep_their_speeds(kind: float) -> None:
    """ArduCopter 4.7, recorded: 2 is climb, 3 descent, 4 DENIED.  PX4 1.14.3: the kind is ignored,
    "type 2 (climb) 1 m/s makes the horizontal cruise 1.05 m/s"."""
    message = command_long(178, kind, 1.0)
    assert refusal(meaning_of(message, flying(ARDUPILOT))).startswith("POLICY")
    assert meaning_of(message, flying(PX4)) == Forward()


@BOTH
@pytest.mark.parametrize("speed_m_s", [NAN, math.inf, -math.inf])
def test_a_speed_that_is_no_number_never_reaches_the_vehicle(
    autopilot: Autopilot, speed_m_s: float
) -> None:
    """ArduCopter 4.7, recorded: DO_CHANGE_SPEED NaN aborts it, a floating point exception."""
    message = command_long(178, 1.0, speed_m_s)
    assert refusal(meaning_of(message, flying(autopilot))).startswith("NON_FINITE")


@BOTH
def test_no_other_speed_in_a_mission(autopilot: Autopilot) -> None:
    mission = flying(autopilot, state=State.FLYING_MISSION)
    assert refusal(meaning_of(command_long(178, 1.0, 1.0), mission)).startswith("POLICY")


# -------------------------------------------------------------------------------- the rest


@BOTH
@pytest.mark.parametrize("command", [16, 82, 177, 185, 208, 209, 3000, 65535])
def test_what_has_no_row_is_refused(autopilot: Autopilot, command: int) -> None:
    assert refusal(meaning_of(command_long(command), flying(autopilot))).startswith("UNSUPPORTED")


def test_a_vehicle_that_cannot_be_commanded() -> None:
    meaning = meaning_of(command_long(400, 1.0), replace(flying(PX4), autopilot=GENERIC))
    assert refusal(meaning).startswith(Code.UNSUPPORTED_VEHICLE)
