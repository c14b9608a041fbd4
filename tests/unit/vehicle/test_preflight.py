"""Each row of what is looked at before a take-off: what passes, what is a caution, what fails."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from gcs.gate.condition import Condition
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.station.preflight import CHECKS as OF_STATION
from gcs.station.preflight import Itself
from gcs.vehicle.health.position_health import Estimator, Gps
from gcs.vehicle.parameters.failsafes import Finding
from gcs.vehicle.parameters.stop_parameters import Stops
from gcs.vehicle.preflight import CHECKS, OF_ROWS, Found, Known, rows

SOUND = (
    (Finding("stick loss", "return", False), ()),
    (Finding("geofence", "radius 100 m", False), ()),
)
READY = Known(
    DEFAULT,
    "1/1 px4 quadrotor",
    rx_hz=200.0,
    gps=Gps(fix_type=3, satellites=10),
    estimator=Estimator(seen_ns=1),
    placed=True,
    home=True,
    origin=True,
    battery_told=True,
    battery_pct=80.0,
    battery_v=16.0,
    prearm_ok=True,
    failsafes=SOUND,
    failsafes_asked=True,
    mission_told=True,
)
NO_GPS_NEEDED = parse_policy('severities.gps_lost = "caution"', "indoors.toml")
TIMED = parse_policy("battery.endurance_s = 1200", "timed.toml")
OFF = (Finding("stick loss", "off (NAV_RCL_ACT = 0)", True), ("gcs param set NAV_RCL_ACT 2",))
WIDE = (Finding("geofence", "no radius", True), ("gcs param set GF_MAX_HOR_DIST 150",))
OWN = Itself(1_790_000_000_000_000_000, True, "logs/x.mcap", 5_000_000_000)


def found(name: str, seen: Known) -> Found:
    (check,) = (each for each in CHECKS if each.name == name)
    return check.judge(seen)


def test_what_is_ready_passes() -> None:
    assert {row.verdict for row in rows(READY)} == {"pass"}
    assert {judge(OWN, READY).verdict for judge in OF_STATION.values()} == {"pass"}


@pytest.mark.parametrize(
    ("row", "changed", "verdict", "says"),
    [
        ("vehicle", {"refusal": "multirotors only"}, "fail", "multirotors only"),
        ("vehicle", {"on_ground": False}, "caution", "not known to stand"),
        ("link", {"lost": True, "silent_s": 4.0}, "fail", "for 4 s"),
        ("link", {"rx_hz": 0.0}, "caution", "not known yet"),
        ("link", {"wrong": {Condition.LINK_POOR: "40 % lost"}}, "caution", "40 % lost"),
        ("gps", {"gps": Gps()}, "fail", "nothing of a GPS"),
        ("gps", {"gps": Gps(fix_type=1)}, "fail", "no fix"),
        ("gps", {"gps": Gps(fix_type=1), "policy": NO_GPS_NEEDED}, "caution", "no fix"),
        ("gps", {"wrong": {Condition.GPS_LOST: "no GPS"}}, "fail", "gps_lost: no GPS"),
        ("gps", {"wrong": {Condition.GPS_POOR: "4 satellites"}}, "caution", "4 satellites"),
        ("estimator", {"estimator": Estimator()}, "caution", "nothing of its estimator"),
        ("estimator", {"estimator": Estimator(("GPS glitch",), 1)}, "fail", "GPS glitch"),
        ("estimator", {"placed": False}, "fail", "no position"),
        ("estimator", {"stale": True}, "fail", "too old"),
        ("home and origin", {"home": False}, "fail", "home not known"),
        ("home and origin", {"bad_place": "300 m outside"}, "fail", "300 m outside"),
        ("home and origin", {"wrong": {Condition.ORIGIN_MISMATCH: "by 9 m"}}, "caution", "by 9 m"),
        ("battery", {"battery_pct": None}, "caution", "not known"),
        ("battery", {"wrong": {Condition.BATTERY_LOW: "12 % are left"}}, "fail", "12 % are left"),
        ("battery", {"policy": TIMED}, "pass", "flies for 13 min"),
        ("arming checks", {"prearm_ok": None}, "caution", "does not say"),
        (
            "arming checks",
            {"prearm_ok": False, "why_not_arm": "Compass not calibrated"},
            "fail",
            "Compass not calibrated",
        ),
        (
            "arming checks",
            {"prearm_ok": False, "other_mode": "AUTO.LAND", "arming_mode": "AUTO.LOITER"},
            "caution",
            "in AUTO.LAND it would not arm",
        ),
        ("failsafes", {"failsafes_asked": False}, "caution", "being read"),
        ("failsafes", {"failsafes": ()}, "caution", "not known here"),
        ("failsafes", {"failsafes": (OFF, SOUND[1])}, "caution", "stick loss: off"),
        ("fence on board", {"failsafes": (SOUND[0], WIDE)}, "caution", "no radius"),
        ("stop parameters", {"stops": Stops(unread=(("WP_SPD", "WPNAV_SPEED"),))}, "caution", "1 "),
        ("stop parameters", {"stops": Stops(("A is 3, not 5",), ("mend",))}, "caution", "A is 3"),
        ("mission", {"mission_unverified": "3 items", "mission_told": True}, "caution", "3 items"),
        (
            "mission",
            {"mission_unverified": "it did not clear", "mission_refused": True},
            "fail",
            "did not clear",
        ),
        ("mission", {"mission_items": 4}, "pass", "its time is not judged"),
        (
            "other conditions",
            {"wrong": {Condition.VEHICLE_FENCE_BREACHED: "above its ceiling"}},
            "caution",
            "above its ceiling",
        ),
        ("other conditions", {"wrong": {Condition.FENCE_BREACHED: "outside"}}, "fail", "outside"),
    ],
)
def test_a_row(row: str, changed: dict[str, Any], verdict: str, says: str) -> None:
    told = found(row, replace(READY, **changed))
    assert told.verdict == verdict
    assert says in told.sentence


def test_what_mends_it_is_told() -> None:
    weak = replace(READY, failsafes=(OFF, WIDE))
    assert found("failsafes", weak).remedies == OFF[1]
    assert found("fence on board", weak).remedies == ("gcs fence put",)
    own = replace(weak, policy_path="yard.toml")
    assert found("fence on board", own).remedies == ("gcs fence put --policy yard.toml",)
    unread = replace(READY, stops=Stops(unread=(("WP_SPD", "WPNAV_SPEED"), ("WP_ACC",))))
    assert found("stop parameters", unread).remedies == ("gcs param get WP_SPD WP_ACC",)


def test_nothing_that_is_not_known_yet_passes() -> None:
    """But that nothing is wrong which nobody has told of."""
    unknown = {row.name for row in rows(Known(DEFAULT, "1/1 px4 quadrotor")) if row.waits}
    everything = {check.name for check in CHECKS}
    assert everything - unknown == {"vehicle", "stop parameters", "mission", "other conditions"}
    assert all(row.verdict != "pass" for row in rows(Known(DEFAULT, "")) if row.name in unknown)


@pytest.mark.parametrize(
    ("row", "own", "verdict"),
    [
        ("recorder", replace(OWN, recording=False), "caution"),
        ("recorder", replace(OWN, recording=False, arm_requires_recording=True), "fail"),
        ("disk", replace(OWN, free_bytes=None), "caution"),
        ("disk", replace(OWN, free_bytes=150_000_000), "caution"),
        ("disk", replace(OWN, free_bytes=15_000_000), "fail"),
        ("clock", replace(OWN, now_ns=86_400_000_000_000), "caution"),
    ],
)
def test_a_row_of_the_station(row: str, own: Itself, verdict: str) -> None:
    assert OF_STATION[row](own, READY).verdict == verdict


def test_conditions_have_rows_that_there_are() -> None:
    names = {check.name for check in CHECKS} | set(OF_STATION)
    assert set(OF_ROWS) - names == {"itself"}
