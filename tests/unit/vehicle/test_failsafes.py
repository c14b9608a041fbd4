"""What a vehicle does by itself, from its parameters, beside what the policy wants."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.vehicle.missions.uploaded_fence import UploadedFence
from gcs.vehicle.parameters.failsafes import CASES, Finding, findings, limits_of, parameters_of

LIMITS = limits_of(DEFAULT, own_sysid=255)

PX4_1_14: dict[str, float] = {
    "NAV_DLL_ACT": 0,
    "COM_DL_LOSS_T": 10,
    "NAV_RCL_ACT": 2,
    "COM_OBL_RC_ACT": 0,
    "COM_OF_LOSS_T": 1.0,
    "COM_LOW_BAT_ACT": 2,
    "GF_ACTION": 2,
    "GF_MAX_HOR_DIST": 0.0,
    "GF_MAX_VER_DIST": 0.0,
    "RTL_RETURN_ALT": 30.0,
}
"""px4_1_14_params.json."""
COPTER_4_7: dict[str, float] = {
    "FS_GCS_ENABLE": 0,
    "FS_GCS_TIMEOUT": 5.0,
    "MAV_GCS_SYSID": 255,
    "MAV_GCS_SYSID_HI": 0,
    "FS_THR_ENABLE": 1,
    "GUID_TIMEOUT": 3.0,
    "BATT_FS_LOW_ACT": 0,
    "BATT_LOW_VOLT": 10.5,
    "BATT_LOW_MAH": 0.0,
    "FS_EKF_ACTION": 1,
    "FENCE_ENABLE": 0,
    "FENCE_ACTION": 1,
    "FENCE_TYPE": 7,
    "FENCE_RADIUS": 150.0,
    "FENCE_ALT_MAX": 100.0,
    "RTL_ALT_M": 15.0,
}
"""arducopter_4_7_params.json."""
RECORDED = {"px4": PX4_1_14, "ardupilot": COPTER_4_7}


def said(autopilot: str, about: str, **changed: float) -> Finding:
    """What is said of one case where these parameters are other than recorded; how it is mended is
    a test of its own."""
    values = {**RECORDED[autopilot], **changed}
    (found,) = (each for each in findings(autopilot, values, LIMITS) if each.about == about)
    return replace(found, mends=())


@pytest.mark.parametrize(
    ("autopilot", "changed", "mends"),
    [
        ("px4", {"NAV_DLL_ACT": 0}, (("NAV_DLL_ACT", 2),)),
        ("px4", {"NAV_DLL_ACT": 1, "COM_DL_LOSS_T": 300}, (("COM_DL_LOSS_T", 10),)),
        (
            "px4",
            {"NAV_DLL_ACT": 0, "COM_DL_LOSS_T": 300},
            (("NAV_DLL_ACT", 2), ("COM_DL_LOSS_T", 10)),
        ),
        ("ardupilot", {"FS_GCS_ENABLE": 0}, (("FS_GCS_ENABLE", 1),)),
    ],
)
def test_what_is_weak_is_mended_by_as_little_as_is_enough(
    autopilot: str, changed: dict[str, float], mends: tuple[tuple[str, float], ...]
) -> None:
    found = findings(autopilot, {**RECORDED[autopilot], **changed}, LIMITS)
    (station,) = (each for each in found if each.about == "ground-station loss")
    assert station.mends == mends


def test_what_a_px4_does_as_delivered() -> None:
    found = findings("px4", PX4_1_14, LIMITS)
    assert [(each.words, each.weak) for each in found] == [
        ("ground-station loss: off (NAV_DLL_ACT = 0)", True),
        ("stick loss: return", False),
        ("offboard loss: position mode after 1 s", False),
        ("low battery: land when critical", False),
        ("geofence breach: hold", False),
        (
            "geofence: no radius (GF_MAX_HOR_DIST = 0), the policy's is 150 m, "
            "no height (GF_MAX_VER_DIST = 0), the policy's is 50 m",
            True,
        ),
        ("return: at 30 m", False),
    ]


def test_what_an_arducopter_does_as_delivered() -> None:
    found = findings("ardupilot", COPTER_4_7, LIMITS)
    assert [(each.words, each.weak) for each in found] == [
        ("ground-station loss: off (FS_GCS_ENABLE = 0)", True),
        ("stick loss: return", False),
        ("offboard loss: stop after 3 s of velocities, positions are held", False),
        ("low battery: off (BATT_FS_LOW_ACT = 0)", True),
        ("position lost: land", False),
        ("geofence breach: off (FENCE_ENABLE = 0)", True),
        ("geofence: radius 150 m, height 100 m (FENCE_ALT_MAX), the policy's is 50 m", True),
        ("return: at 15 m", False),
    ]


@pytest.mark.parametrize(
    ("autopilot", "about", "name", "value", "words"),
    [
        ("px4", "geofence breach", "GF_ACTION", 1, "warns only (GF_ACTION = 1)"),
        ("px4", "low battery", "COM_LOW_BAT_ACT", 0, "off (COM_LOW_BAT_ACT = 0)"),
        ("px4", "stick loss", "NAV_RCL_ACT", 0, "off (NAV_RCL_ACT = 0)"),
        (
            "px4",
            "offboard loss",
            "COM_OBL_RC_ACT",
            2,
            "manual mode after 1 s (COM_OBL_RC_ACT = 2), which holds no place",
        ),
        ("px4", "offboard loss", "COM_OF_LOSS_T", 60.0, "position mode after 60 s"),
        (
            "px4",
            "return",
            "RTL_RETURN_ALT",
            60.0,
            "at 60 m (RTL_RETURN_ALT), above the policy's ceiling of 50 m",
        ),
        ("ardupilot", "stick loss", "FS_THR_ENABLE", 0, "off (FS_THR_ENABLE = 0)"),
        ("ardupilot", "position lost", "FS_EKF_ACTION", 0, "off (FS_EKF_ACTION = 0)"),
    ],
)
def test_what_is_weak(autopilot: str, about: str, name: str, value: float, words: str) -> None:
    assert said(autopilot, about, **{name: value}) == Finding(about, words, weak=True)


def test_a_station_that_is_lost_for_long_before_anything_happens() -> None:
    assert said("px4", "ground-station loss", NAV_DLL_ACT=2) == Finding(
        "ground-station loss", "return after 10 s", weak=False
    )
    assert said("px4", "ground-station loss", NAV_DLL_ACT=2, COM_DL_LOSS_T=300).weak
    assert not said("ardupilot", "ground-station loss", FS_GCS_ENABLE=1).weak
    assert said("ardupilot", "ground-station loss", FS_GCS_ENABLE=1, FS_GCS_TIMEOUT=120).weak


def test_an_arducopter_that_watches_another_station() -> None:
    """Recorded: only the station's number that it is told counts."""
    found = said("ardupilot", "ground-station loss", FS_GCS_ENABLE=1, MAV_GCS_SYSID=252)
    assert found.weak
    assert found.says == "it watches another station than this one, 255 (MAV_GCS_SYSID = 252)"
    assert not said(
        "ardupilot", "ground-station loss", FS_GCS_ENABLE=1, MAV_GCS_SYSID=250, MAV_GCS_SYSID_HI=255
    ).weak


def test_a_battery_that_is_never_found_low() -> None:
    assert not said("ardupilot", "low battery", BATT_FS_LOW_ACT=2).weak
    found = said("ardupilot", "low battery", BATT_FS_LOW_ACT=2, BATT_LOW_VOLT=0.0)
    assert found == Finding(
        "low battery", "never noticed (BATT_LOW_VOLT and BATT_LOW_MAH are 0)", True
    )


def test_a_fence_of_the_vehicle_that_only_reports() -> None:
    assert not said("ardupilot", "geofence breach", FENCE_ENABLE=1).weak
    found = said("ardupilot", "geofence breach", FENCE_ENABLE=1, FENCE_ACTION=0)
    assert found == Finding("geofence breach", "reports only (FENCE_ACTION = 0)", weak=True)


@pytest.mark.parametrize("value", [77.0, 2.5, -1.0, 0.5, 1e20, -1e20, math.inf, math.nan])
@pytest.mark.parametrize(
    ("autopilot", "about", "name"),
    [
        ("px4", "ground-station loss", "NAV_DLL_ACT"),
        ("px4", "stick loss", "NAV_RCL_ACT"),
        ("px4", "offboard loss", "COM_OBL_RC_ACT"),
        ("px4", "low battery", "COM_LOW_BAT_ACT"),
        ("px4", "geofence breach", "GF_ACTION"),
        ("ardupilot", "ground-station loss", "FS_GCS_ENABLE"),
        ("ardupilot", "stick loss", "FS_THR_ENABLE"),
        ("ardupilot", "low battery", "BATT_FS_LOW_ACT"),
        ("ardupilot", "position lost", "FS_EKF_ACTION"),
        ("ardupilot", "geofence breach", "FENCE_ACTION"),
        ("ardupilot", "geofence breach", "FENCE_ENABLE"),
    ],
)
def test_a_number_that_the_autopilot_does_not_know_is_no_action(
    autopilot: str, about: str, name: str, value: float
) -> None:
    found = said(autopilot, about, **{"FENCE_ENABLE": 1.0, name: value})
    assert found.weak
    assert f"({name} = {value:g})" in found.says
    assert "unknown" in found.says


@pytest.mark.parametrize(
    ("autopilot", "name", "values"),
    [("px4", "GF_ACTION", (2, 3, 4, 5)), ("ardupilot", "FENCE_ACTION", (1, 2, 3, 4, 5))],
)
def test_every_breach_action_that_is_known_is_one(
    autopilot: str, name: str, values: tuple[int, ...]
) -> None:
    for value in range(10):
        found = said(autopilot, "geofence breach", **{"FENCE_ENABLE": 1.0, name: float(value)})
        assert found.weak == (value not in values), value


@pytest.mark.parametrize("value", [math.nan, math.inf, -1.0, 1e20])
def test_bits_of_what_is_no_set_of_bits_are_none(value: float) -> None:
    found = said("ardupilot", "geofence", FENCE_TYPE=value, FENCE_ALT_MAX=50.0)
    assert found.weak
    assert found.says.startswith("no circle")


def test_a_fence_of_the_vehicle_is_as_narrow_as_the_policys_or_it_is_weak() -> None:
    assert not said("px4", "geofence", GF_MAX_HOR_DIST=150.4, GF_MAX_VER_DIST=50.0).weak
    assert said("px4", "geofence", GF_MAX_HOR_DIST=151.0, GF_MAX_VER_DIST=50.0).weak
    assert said("px4", "geofence", GF_MAX_HOR_DIST=100.0, GF_MAX_VER_DIST=51.0).weak
    assert not said("ardupilot", "geofence", FENCE_ALT_MAX=50.0).weak
    assert said("ardupilot", "geofence", FENCE_ALT_MAX=50.0, FENCE_TYPE=5).says == (
        "no circle (FENCE_TYPE = 5), height 50 m"
    )


def fenced(autopilot: str, uploaded: UploadedFence, **changed: float) -> Finding:
    """What is said of its fence, where that was uploaded."""
    values = {**RECORDED[autopilot], "GF_MAX_VER_DIST": 50.0, "FENCE_ALT_MAX": 50.0, **changed}
    limits = replace(LIMITS, uploaded=uploaded)
    (found,) = (each for each in findings(autopilot, values, limits) if each.about == "geofence")
    return found


def test_an_uploaded_fence_that_is_as_narrow_as_the_policys_does_for_the_circle() -> None:
    near = fenced("px4", UploadedFence(1, 2, 140.2))
    assert near == Finding(
        "geofence",
        "no radius (GF_MAX_HOR_DIST = 0), the policy's is 150 m, height 50 m, "
        "uploaded: 1 to stay in, 2 to stay out of, up to 140 m from home",
        weak=False,
    )
    assert not fenced("ardupilot", UploadedFence(1, 0, 150.0), FENCE_RADIUS=500.0).weak


@pytest.mark.parametrize(
    ("uploaded", "words"),
    [
        (
            UploadedFence(1, 0, 400.0),
            "uploaded: 1 to stay in, 0 to stay out of, "
            "up to 400 m from home, the policy's is 150 m",
        ),
        (UploadedFence(0, 2), "uploaded: 0 to stay in, 2 to stay out of"),
        (
            UploadedFence(1, 0),
            "uploaded: 1 to stay in, 0 to stay out of, where home is not known",
        ),
        (UploadedFence(unreadable="it says no"), "uploaded: not known (it says no)"),
    ],
)
def test_any_other_uploaded_fence_does_not(uploaded: UploadedFence, words: str) -> None:
    found = fenced("px4", uploaded)
    assert found.weak
    assert found.says.endswith(words)
    assert not fenced("px4", uploaded, GF_MAX_HOR_DIST=150.0).weak, "the circle does"


def test_no_uploaded_fence_does_for_the_height() -> None:
    assert fenced("px4", UploadedFence(1, 0, 100.0), GF_MAX_VER_DIST=0.0).weak


def test_an_arducopter_that_uses_no_zones() -> None:
    found = fenced("ardupilot", UploadedFence(1, 0, 100.0), FENCE_TYPE=1)
    assert found.weak
    assert found.says.endswith("1 to stay in, 0 to stay out of, not in use (FENCE_TYPE = 1)")
    assert not fenced("ardupilot", UploadedFence(1, 0, 100.0), FENCE_TYPE=5).weak


def test_the_policys_reach_is_that_of_its_zones_about_home_and_its_own_limits() -> None:
    text = """
    max_distance_m = 90
    [[fence]]
    name = "a"
    kind = "box"
    east_m = [-30, 10]
    north_m = [-5, 40]
    ceiling_up_m = 20
    [[fence]]
    name = "b"
    kind = "polygon"
    corners = [[-60, -60], [60, -60], [0, 80]]
    [[fence]]
    name = "tower"
    inclusion = false
    radius_m = 3
    ceiling_up_m = 5
    """
    limits = limits_of(parse_policy(text, "my.toml"), own_sysid=1)
    assert limits.reach_m == pytest.approx(math.hypot(30, 40))
    assert limits.ceiling_up_m == 20.0
    far = 'max_distance_m = 90\n[[fence]]\nname = "a"\nkind = "circle"\nradius_m = 500'
    assert limits_of(parse_policy(far, "my.toml"), 1).reach_m == 90.0


def test_what_cannot_be_read_is_not_taken_for_on() -> None:
    for autopilot in CASES:
        for found in findings(autopilot, {}, LIMITS):
            assert found.weak == ("could not be read" in found.says), found
    assert sum(each.weak for each in findings("ardupilot", {}, LIMITS)) == 7


def test_of_another_autopilot_nothing_is_said() -> None:
    assert findings("of an unknown kind", {}, LIMITS) == ()
    assert parameters_of("of an unknown kind") == ()


@given(
    autopilot=st.sampled_from(sorted(CASES)),
    values=st.dictionaries(
        st.sampled_from(sorted({*PX4_1_14, *COPTER_4_7})), st.floats(allow_nan=True), max_size=20
    ),
)
def test_whatever_the_vehicle_answers_it_is_told(autopilot: str, values: dict[str, float]) -> None:
    found = findings(autopilot, values, LIMITS)
    assert len(found) == len(CASES[autopilot])
    assert all(each.says for each in found)


@given(st.sampled_from(["GF_MAX_HOR_DIST", "GF_MAX_VER_DIST", "COM_OF_LOSS_T", "RTL_RETURN_ALT"]))
def test_what_is_no_number_is_weak(name: str) -> None:
    on = {**PX4_1_14, "NAV_DLL_ACT": 2.0, "GF_MAX_HOR_DIST": 1.0, "GF_MAX_VER_DIST": 1.0}
    assert not any(each.weak for each in findings("px4", on, LIMITS))
    assert any(each.weak for each in findings("px4", {**on, name: math.nan}, LIMITS))
