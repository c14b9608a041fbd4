"""What is wrong before a take-off is found by name, and nothing is sent to find it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import pytest

from gcs import ipc
from gcs.gate.policy.parse import parse_policy
from gcs.gate.policy.policy import Policy
from gcs.operator.preflight import to_read
from gcs.session import inputs
from tests.loopback.flight import Flight, Personality
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.simulation.fault_script import fault_of

FOUR_CELLS = parse_policy("battery.low_v = 14.0", "my.toml")
GOOD: dict[Personality, dict[str, float]] = {
    "px4": {"NAV_DLL_ACT": 2, "GF_ACTION": 2, "GF_MAX_HOR_DIST": 150, "GF_MAX_VER_DIST": 50},
    "ardupilot": {
        "FS_GCS_ENABLE": 1,
        "BATT_FS_LOW_ACT": 2,
        "FENCE_ENABLE": 1,
        "FENCE_ACTION": 4,
        "FENCE_ALT_MAX": 50,
    },
}
"""What either has other than the default policy wants it, out of the box."""
FAILSAFE: dict[Personality, tuple[str, float]] = {
    "px4": ("NAV_DLL_ACT", 0),
    "ardupilot": ("FS_GCS_ENABLE", 0),
}
WIDE: dict[Personality, str] = {"px4": "GF_MAX_HOR_DIST", "ardupilot": "FENCE_RADIUS"}
SLOW: dict[Personality, tuple[str, float]] = {
    "px4": ("MPC_XY_CRUISE", 3),
    "ardupilot": ("WP_SPD", 3),
}


def standing(
    personality: Personality,
    policy: Policy = FOUR_CELLS,
    changed: Mapping[str, float] = MappingProxyType({}),
) -> Flight:
    """On the ground, recorded, and all that the station reads by itself has been read."""
    newest: Firmware = "1.14" if personality == "px4" else "4.7"
    params = {**GOOD[personality], **changed}
    flight = Flight(personality, policy=policy, params=params, firmware=newest)
    flight.connected()
    flight.feed(inputs.RecorderChanged(True, "logs/x.mcap"))
    flight.feed(inputs.RecorderGrew(50_000, 5_000_000_000))
    flight.run(8.0)
    return flight


def look(flight: Flight) -> ipc.PreflightReport:
    before = len(flight.events)
    flight.feed(inputs.OperatorLine(1, ipc.Preflight(7)))
    told = [each for each in flight.events[before:] if isinstance(each, ipc.PreflightReport)][-1]
    assert told.id == 7
    return told


def bad(flight: Flight) -> dict[str, str]:
    """The rows that do not pass."""
    return {row.name: row.verdict for row in look(flight).rows if row.verdict != "pass"}


def read_what_is_unread(flight: Flight) -> None:
    for alternatives in to_read(look(flight)):
        for ask in alternatives:
            if flight.done(flight.say(ask.word, name=ask.name)) == "complete":
                break


def test_a_vehicle_that_is_ready_passes_once_all_is_read(personality: Personality) -> None:
    flight = standing(personality)
    sent = len(flight.sent)
    assert bad(flight) == {"stop parameters": "caution"}
    assert len(flight.sent) == sent, "nothing is sent for it"
    read_what_is_unread(flight)
    report = look(flight)
    assert not report.fails
    assert (report.vehicle, report.unread, report.mission_unverified) == (1, [], False)
    assert bad(flight) == {}


def lose_gps(flight: Flight) -> None:
    assert flight.world.inject(fault_of("gps_lost", {}, "script"), 1)


def lose_a_cell(flight: Flight) -> None:
    assert flight.world.inject(fault_of("battery", {"cells": 1}, "script"), 1)


def full_disk(flight: Flight) -> None:
    flight.feed(inputs.DiskLow(1_000_000, 20.0, True))


def no_record(flight: Flight) -> None:
    flight.feed(inputs.RecorderChanged(False, "logs/x.mcap", "the recorder failed"))


def silence(flight: Flight) -> None:
    flight.vehicle_silent = True


@pytest.mark.parametrize(
    ("fault", "row", "verdict"),
    [
        (lose_gps, "gps", "fail"),
        (lose_a_cell, "battery", "fail"),
        (full_disk, "disk", "fail"),
        (no_record, "recorder", "caution"),
        (silence, "link", "fail"),
    ],
)
def test_a_fault_is_found_by_name(
    fault: Callable[[Flight], None], row: str, verdict: str, personality: Personality
) -> None:
    flight = standing(personality)
    fault(flight)
    flight.run(6.0)
    assert bad(flight)[row] == verdict


def test_settings_are_found_with_the_commands_that_mend_them(personality: Personality) -> None:
    off, wide, slow = FAILSAFE[personality], WIDE[personality], SLOW[personality]
    changed = dict((off, (wide, 500.0), slow))
    rows = {row.name: row for row in look(standing(personality, changed=changed)).rows}
    sound = 10.0 if personality == "ardupilot" else 5.0
    (mend,) = rows["failsafes"].remedies
    assert mend.startswith(f"gcs param set {off[0]} ")
    assert rows["fence on board"].remedies == ["gcs fence put"]
    assert rows["stop parameters"].remedies == [f"gcs param set {slow[0]} {sound:g}"]


def test_before_anything_is_told_nothing_passes_that_is_the_vehicle_s(
    personality: Personality,
) -> None:
    flight = Flight(personality)
    assert bad(flight)["vehicle"] == "fail"
    flight.until(lambda: flight.session.telemetry is not None)
    found = bad(flight)
    assert found["home and origin"] == found["estimator"] == "fail"
    assert {"gps", "battery", "arming checks", "failsafes", "disk"} <= found.keys()


def test_a_policy_that_asks_for_it_refuses_to_arm_while_a_row_fails(
    personality: Personality,
) -> None:
    flight = standing(personality, parse_policy('[arming]\npreflight = "no_fail"', "my.toml"))
    full_disk(flight)
    flight.run(1.5)
    refused = flight.say("arm")
    assert flight.done(refused) == "refused PREFLIGHT"
    (verdict,) = flight.verdicts(refused)
    assert verdict.sentence.startswith("disk: 0.0 GB are free")
    flight.feed(inputs.RecorderGrew(100_000, 5_000_000_000))
    flight.run(1.5)
    flight.do("arm")
    flight.do("takeoff", up_m=3.0)
    full_disk(flight)
    flight.run(2.0)
    assert "preflight_failed" not in flight.conditions, "in the air it is too late"
