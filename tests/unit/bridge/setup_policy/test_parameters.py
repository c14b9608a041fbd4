"""PARAM_SET and PARAM_EXT_SET: what safety stands on is not written by a client."""

from __future__ import annotations

import json
import math
import struct
from dataclasses import replace
from pathlib import Path

import pytest

from gcs.bridge.setup_policy.free_parameters import free_group_of
from gcs.bridge.setup_policy.guard import Guard
from gcs.bridge.setup_policy.safety_parameters import group_of
from gcs.bridge.setup_policy.verdict import GuardSeen
from gcs.gate.effects import Level
from gcs.gate.refusal import Code
from gcs.plan.model import AutopilotName
from gcs.protocol.parameter_names import names_of
from gcs.vehicle.missions.jobs import facts
from gcs.vehicle.parameters import failsafes, settings
from gcs.vehicle.parameters.thrust_meaning import NAMES_OF_THRUST
from gcs.wire.ids import ParamExtResult, ParamFault
from gcs.wire.messages import (
    Message,
    ParamError,
    ParamExtAck,
    ParamExtRequestRead,
    ParamRequestRead,
    ParamSet,
    ParamValue,
)
from tests.unit.bridge.setup_policy.wire import FLYING, PARKED, allowed, guard, refused, sent

INT32, REAL32 = 6, 9
NOW_NS = 10_000_000_000


def bytewise(value: int) -> float:
    """An integer in the float of PARAM_SET, as PX4 has it."""
    number: float = struct.unpack("<f", struct.pack("<i", value))[0]
    return number


def param_set(name: bytes, value: float = 0.0, kind: int = REAL32) -> ParamSet:
    message = sent("param_set", 1, 1, name, value, kind)
    assert isinstance(message, ParamSet)
    return message


def told(own: Guard, name: str, value: float, kind: int = REAL32) -> object:
    return own.heard(ParamValue(value, 874, 65535, name, kind), NOW_NS)


def test_switching_the_fence_of_a_px4_off_is_refused_with_the_number_and_the_policys_key() -> None:
    found = refused(guard().judge(param_set(b"GF_ACTION", bytewise(0), INT32), PARKED))
    assert found.refusal.code is Code.POLICY
    assert "GF_ACTION is guarded: it is of the vehicle's own fence" in found.refusal.sentence
    assert "bridge.parameters" in found.refusal.sentence
    assert found.refusal.numbers == (("value", 0.0),)


def test_an_integer_of_a_px4_is_read_out_of_the_bytes_of_the_float() -> None:
    found = refused(guard().judge(param_set(b"NAV_DLL_ACT", bytewise(7), INT32), PARKED))
    assert found.refusal.numbers == (("value", 7.0),)


def test_an_integer_of_an_arducopter_is_the_floats_value() -> None:
    own = guard(autopilot="ardupilot")
    found = refused(own.judge(param_set(b"FENCE_ENABLE", 1.0, INT32), PARKED))
    assert found.refusal.numbers == (("value", 1.0),)


def test_the_vehicle_is_asked_in_the_writes_place_so_that_the_client_hears_the_old_value() -> None:
    found = refused(guard().judge(param_set(b"GF_ACTION", 0.0, INT32), FLYING))
    assert found.ask_vehicle == (ParamRequestRead(-1, 1, 1, "GF_ACTION"),)
    assert found.answers == (ParamError(-1, 245, 190, "GF_ACTION", ParamFault.PERMISSION_DENIED),)


def test_a_broadcast_is_asked_of_the_autopilot() -> None:
    found = refused(guard().judge(sent("param_set", 0, 0, b"GF_ACTION", 0.0, INT32), FLYING))
    assert found.ask_vehicle == (ParamRequestRead(-1, 1, 1, "GF_ACTION"),)


TAKEOFF_HEIGHT = b"MIS_TAKEOFF_ALT"
PARKED_BELOW_30_M = replace(PARKED, max_takeoff_up_m=30.0)


@pytest.mark.parametrize("value", [2.5, 30.0])
def test_the_height_of_a_take_off_may_be_set_on_the_ground_as_mavsdk_does(value: float) -> None:
    allowed(guard().judge(param_set(TAKEOFF_HEIGHT, value), PARKED_BELOW_30_M))


@pytest.mark.parametrize(
    ("value", "seen"),
    [
        (30.1, PARKED_BELOW_30_M),
        (0.0, PARKED_BELOW_30_M),
        (-5.0, PARKED_BELOW_30_M),
        (math.nan, PARKED_BELOW_30_M),
        (math.inf, PARKED_BELOW_30_M),
        (5.0, PARKED),
        (5.0, replace(PARKED_BELOW_30_M, armed=True)),
        (5.0, replace(PARKED_BELOW_30_M, armed=None)),
        (5.0, replace(PARKED_BELOW_30_M, on_ground=False)),
    ],
)
def test_no_higher_than_the_policy_allows_and_not_while_something_may_fly(
    value: float, seen: GuardSeen
) -> None:
    refused(guard().judge(param_set(TAKEOFF_HEIGHT, value), seen))


@pytest.mark.parametrize(
    "rules", ['parameters = "refuse"', 'parameters_guarded = ["MIS_TAKEOFF_ALT"]']
)
def test_a_policy_may_keep_the_height_of_a_take_off_too(rules: str) -> None:
    refused(guard(rules).judge(param_set(TAKEOFF_HEIGHT, 5.0), PARKED_BELOW_30_M))


def test_after_a_write_the_height_is_awaited_until_the_vehicle_has_told_the_new_one() -> None:
    """An answer to somebody who read it may have left the vehicle before the write came."""
    own, seen = guard(), replace(PARKED_BELOW_30_M, now_ns=NOW_NS)
    allowed(own.judge(param_set(TAKEOFF_HEIGHT, 20.0), seen))
    assert own.awaits("MIS_TAKEOFF_ALT")
    own.heard(ParamValue(2.5, 874, 400, "MIS_TAKEOFF_ALT", REAL32), NOW_NS + 100_000_000)
    assert own.awaits("MIS_TAKEOFF_ALT"), "the old value"
    own.heard(ParamValue(20.0, 874, 400, "MIS_TAKEOFF_ALT", REAL32), NOW_NS + 200_000_000)
    assert not own.awaits("MIS_TAKEOFF_ALT")


def test_a_write_that_the_vehicle_does_not_take_is_not_awaited_for_ever() -> None:
    own, seen = guard(), replace(PARKED_BELOW_30_M, now_ns=NOW_NS)
    allowed(own.judge(param_set(TAKEOFF_HEIGHT, 20.0), seen))
    own.heard(ParamValue(2.5, 874, 400, "MIS_TAKEOFF_ALT", REAL32), NOW_NS + 3_000_000_000)
    assert not own.awaits("MIS_TAKEOFF_ALT")


def test_an_arducopter_has_no_such_height() -> None:
    own = guard(autopilot="ardupilot")
    refused(own.judge(param_set(TAKEOFF_HEIGHT, 5.0), PARKED_BELOW_30_M))


@pytest.mark.parametrize("component", [0, 1, 100, 190])
def test_an_autopilot_takes_a_write_to_a_component_that_nobody_knows(component: int) -> None:
    """ArduPilot processes what it cannot forward (MAVLink_routing, from memory)."""
    refused(guard().judge(sent("param_set", 1, component, b"GF_ACTION", 0.0, INT32), FLYING))


@pytest.mark.parametrize("name", [b"gf_action", b"Gf_Action", b"GF_ACTION\0junk"])
def test_case_and_what_stands_behind_a_nul_do_not_matter(name: bytes) -> None:
    refused(guard().judge(param_set(name), PARKED))


def test_a_name_of_16_letters_has_no_nul() -> None:
    """MC_AT_SYSID_AMP has 15 and COM_ARM_AUTH_REQ 16 (recorded list of PX4 1.14.3)."""
    found = refused(guard().judge(param_set(b"COM_ARM_AUTH_REQ"), PARKED))
    assert found.ask_vehicle == (ParamRequestRead(-1, 1, 1, "COM_ARM_AUTH_REQ"),)


@pytest.mark.parametrize("name", [b"", b"\xff\xfe\xff", b"GF ACTION", b" GF_ACTION", b"GF-ACTION"])
def test_what_cannot_be_a_name_is_refused_and_not_asked_for(name: bytes) -> None:
    found = refused(guard().judge(param_set(name), PARKED))
    assert "no name of a parameter" in found.refusal.sentence
    assert found.ask_vehicle == ()


def test_a_parameter_that_nothing_stands_on_is_forwarded_and_told() -> None:
    own = guard()
    assert told(own, "SDLOG_MODE", bytewise(0), INT32) is None
    note = allowed(own.judge(param_set(b"SDLOG_MODE", bytewise(1), INT32), FLYING)).note
    assert note == "SDLOG_MODE = 1 is forwarded; it is 0 now"
    change = own.heard(ParamValue(bytewise(1), 874, 65535, "SDLOG_MODE", INT32), NOW_NS)
    assert change is not None
    assert change.text == "SDLOG_MODE was 0 and is 1 now: written by 245/190"
    assert change.level is Level.INFO


def test_a_value_that_is_not_known_is_told_so() -> None:
    note = allowed(guard().judge(param_set(b"SDLOG_MODE", 1.0), FLYING)).note
    assert note == "SDLOG_MODE = 1 is forwarded; it is not known now"


def test_what_the_station_itself_sets_for_an_operator_is_no_stranger_s() -> None:
    own = guard()
    assert told(own, "GF_ACTION", bytewise(2), INT32) is None
    own.written_by_station(ParamSet(bytewise(3), 1, 1, "GF_ACTION", INT32), NOW_NS)
    change = own.heard(ParamValue(bytewise(3), 874, 10, "GF_ACTION", INT32), NOW_NS)
    assert change is not None
    assert change.text == "GF_ACTION was 2 and is 3 now: written by the station"


def test_a_fence_that_is_switched_off_past_the_bridge_is_told_as_a_warning() -> None:
    own = guard()
    assert own.heard(ParamValue(bytewise(2), 874, 10, "GF_ACTION", INT32), NOW_NS) is None
    assert own.heard(ParamValue(bytewise(2), 874, 10, "GF_ACTION", INT32), NOW_NS) is None
    change = own.heard(ParamValue(bytewise(0), 874, 10, "GF_ACTION", INT32), NOW_NS)
    assert change is not None
    assert change.level is Level.WARNING
    assert change.text == "GF_ACTION was 2 and is 0 now, and no client of this bridge wrote it"


@pytest.mark.parametrize("name", ["SDLOG_UTC_OFFSET", "CAL_MAG0_XOFF"])
def test_what_the_vehicle_changes_by_itself_is_no_news(name: str) -> None:
    own = guard()
    assert told(own, name, 1.0) is None
    assert told(own, name, 2.0) is None


@pytest.mark.parametrize("value", [float("nan"), float("inf"), float("-inf")])
def test_no_number_is_no_value(value: float) -> None:
    found = refused(guard().judge(param_set(b"SDLOG_MODE", value, REAL32), PARKED))
    assert found.refusal.code is Code.NON_FINITE
    (answer,) = found.answers
    assert isinstance(answer, ParamError)
    assert answer.error == ParamFault.VALUE_OUT_OF_RANGE


def test_an_integer_whose_bytes_are_no_number_as_a_float_is_a_value() -> None:
    allowed(guard().judge(param_set(b"SDLOG_MODE", bytewise(-1), INT32), PARKED))


def test_qgroundcontrol_may_say_that_it_has_the_parameters_of_a_px4() -> None:
    for rules in ("", 'parameters = "refuse"'):
        assert allowed(guard(rules).judge(param_set(b"_HASH_CHECK", 1.5), PARKED)).note == ""


def test_the_policy_may_allow_a_guarded_one_by_name_or_by_pattern() -> None:
    own = guard('parameters_allowed = ["MPC_YAW_MODE", "GF_*"]')
    allowed(own.judge(param_set(b"MPC_YAW_MODE"), PARKED))
    allowed(own.judge(param_set(b"GF_ACTION"), PARKED))
    refused(own.judge(param_set(b"MPC_YAW_MODEX"), PARKED))
    refused(own.judge(param_set(b"NAV_DLL_ACT"), PARKED))


def test_the_policy_may_guard_more() -> None:
    found = refused(
        guard('parameters_guarded = ["SDLOG_*"]').judge(param_set(b"SDLOG_MODE"), FLYING)
    )
    assert "parameters_guarded" in found.refusal.sentence


def test_the_policy_may_refuse_all_or_forward_all() -> None:
    refused(guard('parameters = "refuse"').judge(param_set(b"SDLOG_MODE"), PARKED))
    allowed(guard('parameters = "forward"').judge(param_set(b"GF_ACTION"), PARKED))
    own = guard('parameters = "refuse"\nparameters_allowed = ["SDLOG_MODE"]')
    allowed(own.judge(param_set(b"SDLOG_MODE"), PARKED))


def test_an_autopilot_of_an_unknown_kind_has_the_guarded_names_of_both() -> None:
    own = guard(autopilot="of an unknown kind")
    refused(own.judge(param_set(b"GF_ACTION"), PARKED))
    refused(own.judge(param_set(b"FENCE_ENABLE"), PARKED))


def test_extended_parameters_are_guarded_by_name_too() -> None:
    def ext_set(name: bytes, value: bytes = b"0") -> Message:
        return sent("param_ext_set", 1, 100, name, value, 11)

    assert allowed(guard().judge(ext_set(b"CAM_MODE"), PARKED)).note == "CAM_MODE = 0 is forwarded"
    told = allowed(guard().judge(ext_set(b"CAM_MODE", b"1\x1b[2J\n"), PARKED)).note
    assert told == "CAM_MODE = 1?[2J  is forwarded", "the log is shown on a terminal"
    found = refused(guard().judge(ext_set(b"GF_ACTION"), PARKED))
    assert found.answers == (ParamExtAck("GF_ACTION", "", 11, ParamExtResult.FAILED),)
    assert found.ask_vehicle == (ParamExtRequestRead(-1, 1, 100, "GF_ACTION"),)


# ---------------------------------------------------------------------------- the tables


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_every_parameter_that_the_station_stands_on_is_guarded_by_every_name(
    autopilot: AutopilotName,
) -> None:
    wanted = {table[autopilot] for table in settings.READ_FIRST if autopilot in table}
    wanted |= {*failsafes.parameters_of(autopilot)}
    wanted |= {quantity.parameter for quantity in facts.QUANTITIES[autopilot]}
    wanted |= {*NAMES_OF_THRUST[autopilot]}
    for newest in wanted:
        for name in names_of(newest):
            assert group_of(autopilot, name.name) is not None, name.name


# Names of the recorded lists (px4_1_14_params.json, arducopter_4_7_params.json), and of ArduCopter
# 4.5 where 4.7 has another one.
GUARDED = {
    "px4": (
        "GF_ACTION GF_MAX_HOR_DIST GF_MAX_VER_DIST GF_SOURCE COM_OBL_RC_ACT COM_OF_LOSS_T"
        " NAV_DLL_ACT NAV_RCL_ACT COM_LOW_BAT_ACT COM_DL_LOSS_T COM_RC_LOSS_T BAT_LOW_THR"
        " BAT_CRIT_THR BAT_EMERGEN_THR BAT1_N_CELLS CBRK_FLIGHTTERM CBRK_SUPPLY_CHK RTL_RETURN_ALT"
        " RTL_TYPE RTL_CONE_ANG COM_ARM_WO_GPS COM_ARM_AUTH_REQ MPC_XY_VEL_MAX MPC_ACC_HOR"
        " MPC_Z_VEL_MAX_UP MAV_SYS_ID EKF2_GPS_CTRL EKF2_HGT_REF SYS_FAILURE_EN SYS_AUTOSTART"
        " PWM_MAIN_FUNC1 RC_MAP_KILL_SW CAL_GYRO0_XOFF SIM_GPS_USED NAV_ACC_RAD MIS_TAKEOFF_ALT"
        " FD_FAIL_P COM_DISARM_LAND MC_PITCH_P COM_FLTMODE1 COM_POS_FS_EPH COM_POWER_COUNT"
        " PD_GRIPPER_EN TRIG_PINS TRIG_PINS_EX TRIG_INTERFACE TRIG_PWM_SHOOT MNT_MODE_OUT"
    ),
    "ardupilot": (
        "FENCE_ENABLE FENCE_ACTION FENCE_RADIUS FENCE_ALT_MAX FENCE_MARGIN FENCE_TYPE"
        " FS_GCS_ENABLE FS_GCS_TIMEOUT FS_THR_ENABLE FS_EKF_ACTION FS_OPTIONS BATT_FS_LOW_ACT"
        " BATT_FS_CRT_ACT BATT_LOW_VOLT BATT_CAPACITY ARMING_SKIPCHK ARMING_CHECK RTL_ALT_M RTL_ALT"
        " SYSID_MYGCS MAV_GCS_SYSID MAV_SYSID SYSID_THISMAV BRD_SAFETY_DEFLT BRD_SAFETYENABLE"
        " WPNAV_SPEED WP_SPD WP_RADIUS_M LOIT_SPEED_MS PSC_NE_VEL_P PSC_ACCZ_P EK3_ENABLE"
        " AHRS_EKF_TYPE SERVO1_FUNCTION SIM_GPS1_ENABLE SIM_WIND_SPD DISARM_DELAY GUID_TIMEOUT"
        " AVOID_ENABLE RALLY_INCL_HOME MOT_SPIN_ARM FLTMODE1 RC7_OPTION SERIAL1_PROTOCOL"
        " ATC_RAT_RLL_P SCR_ENABLE MAV1_OPTIONS MAV1_EXTRA1 SR0_EXTRA1 LOG_BACKEND_TYPE LGR_ENABLE"
        " GRIP_ENABLE WINCH_TYPE NTF_BUZZ_PIN AFS_ENABLE AFS_TERM_ACTION AFS_TERMINATE TMODE_ENABLE"
        " QUIK_ENABLE OSD5_PARAM1_KEY OSD6_PARAM3_IDX CAM1_RELAY_ON CAM_RELAY_ON CAM1_SERVO_ON"
        " CAM1_FEEDBAK_PIN CAM1_TYPE CAM_TRIGG_TYPE MNT1_TYPE"
    ),
}
FREE = {
    "px4": "SDLOG_MODE SDLOG_UTC_OFFSET MNT_MODE_IN CAM_EXPOSURE_S TRIG_MODE COM_FLIGHT_UUID",
    "ardupilot": (
        "LOG_BITMASK LOG_DISARMED NTF_LED_BRIGHT CAM1_DURATION MNT1_PITCH_MIN OSD_TYPE STAT_RESET"
        " CAM_EXPOSURE_S"
    ),
}


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_what_is_guarded_and_what_is_free(autopilot: str) -> None:
    for name in GUARDED[autopilot].split():
        assert group_of(autopilot, name) is not None, name
        assert free_group_of(autopilot, name) is None, name
    for name in FREE[autopilot].split():
        assert group_of(autopilot, name) is None, name
        assert free_group_of(autopilot, name) is not None, name


# Every parameter of the recorded lists that a client may write, family by family as
# `free_parameters.py` has them; all others are guarded.
FREE_OF_RECORDED = {
    "px4": (
        "px4_1_14_params.json",
        "COM_FLIGHT_UUID COM_FLT_PROFILE MNT_MODE_IN SDLOG_BOOT_BAT SDLOG_DIRS_MAX SDLOG_MISSION"
        " SDLOG_MODE SDLOG_PROFILE SDLOG_UTC_OFFSET SDLOG_UUID",
    ),
    "ardupilot": (
        "arducopter_4_7_params.json",
        "CAM_AUTO_ONLY CAM_MAX_ROLL LOG_BITMASK LOG_BLK_RATEMAX"
        " LOG_DARM_RATEMAX LOG_DISARMED LOG_FILE_BUFSIZE LOG_FILE_DSRMROT LOG_FILE_MB_FREE"
        " LOG_FILE_RATEMAX LOG_FILE_TIMEOUT LOG_MAX_FILES LOG_REPLAY"
        " MSP_OPTIONS MSP_OSD_NCELLS NMEA_MSG_EN NMEA_RATE_MS NTF_BUZZ_ON_LVL NTF_BUZZ_TYPES"
        " NTF_BUZZ_VOLUME NTF_DISPLAY_TYPE NTF_LED_BRIGHT NTF_LED_LEN NTF_LED_OVERRIDE"
        " NTF_LED_TYPES OSD_TYPE STAT_BOOTCNT STAT_DISTFLWN STAT_FLTCNT STAT_FLTTIME STAT_RESET"
        " STAT_RUNTIME",
    ),
}
RECORDED = Path(__file__).parents[5] / "shared" / "data" / "autopilots"


@pytest.mark.skipif(not RECORDED.is_dir(), reason="the recorded lists are not here")
@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_each_recorded_parameter_is_in_a_table(autopilot: str) -> None:
    """Neither forgotten by both tables nor free without a reason."""
    file, wanted = FREE_OF_RECORDED[autopilot]
    rows = json.loads((RECORDED / file).read_text(encoding="utf-8"))
    names = [row["name"] for row in rows if row["name"] != "_HASH_CHECK"]
    free = {name for name in names if free_group_of(autopilot, name) is not None}
    assert free == set(wanted.split())
    forgotten = [name for name in names if name not in free and not group_of(autopilot, name)]
    assert forgotten == []


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_what_no_table_knows_is_guarded(autopilot: str) -> None:
    found = refused(guard(autopilot=autopilot).judge(param_set(b"NEW_IN_5_0"), PARKED))
    assert "it is in no table here" in found.refusal.sentence
    allowed(
        guard('parameters_allowed = ["NEW_*"]', autopilot).judge(param_set(b"NEW_IN_5_0"), PARKED)
    )
