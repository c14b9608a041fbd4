"""Component metadata says of each parameter what its table says."""

from __future__ import annotations

import json
from struct import calcsize

from tests.unit.vehicle_services.test_events import TEXTS
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.events.health_report import Checked, report
from vehicle_sim.services.events.metadata import GENERAL_PATH, metadata_of
from vehicle_sim.services.events.px4_events import Modes, PX4Event, event_of
from vehicle_sim.storage.store import crc32_of

METADATA = metadata_of("px4")
KEYS = {
    "name", "type", "shortDesc", "units", "default", "min", "max", "decimalPlaces", "group",
    "rebootRequired", "values", "bitmask",
}  # fmt: skip
"""Of parameter.schema.json, which allows no others."""


def content(path: str) -> bytes:
    return METADATA.files[path].read("")


def described() -> dict[str, dict[str, object]]:
    """By the general file, as a ground station finds it."""
    general = json.loads(content(GENERAL_PATH))
    assert (METADATA.uri, METADATA.crc) == (
        f"mftp://{GENERAL_PATH}",
        crc32_of(content(GENERAL_PATH)),
    )
    assert general["version"] == 1
    entry, _ = general["metadataTypes"]
    assert entry["type"] == 1  # COMP_METADATA_TYPE_PARAMETER
    data = content(entry["uri"].removeprefix("mftp://"))
    assert entry["fileCrc"] == crc32_of(data)
    parameters = json.loads(data)
    assert parameters["version"] == 1
    return {each["name"]: each for each in parameters["parameters"]}


def test_every_parameter_is_described_with_its_bounds() -> None:
    told = described()
    specs = Parameters("px4").specs
    assert [*told] == [spec.name for spec in specs]
    for spec in specs:
        each = told[spec.name]
        assert set(each) <= KEYS
        assert each["type"] == ("Int32" if spec.integer else "Float")
        bounds = (None, None) if spec.inert else (spec.low, spec.high)
        assert (each.get("min"), each.get("max"), each["default"]) == (*bounds, spec.default)
        assert ("does nothing in this vehicle" in str(each["shortDesc"])) is spec.inert
        assert each["rebootRequired"] is spec.reboot
        assert each["shortDesc"]


def test_units_and_choices_are_taken_from_the_text() -> None:
    told = described()
    assert told["MIS_TAKEOFF_ALT"]["units"] == "m"
    assert told["MPC_ACC_HOR"]["units"] == "m/s^2"
    assert "[" not in str(told["MPC_ACC_HOR"]["shortDesc"])
    assert told["NAV_DLL_ACT"]["values"] == [
        {"value": 0, "description": "off"},
        {"value": 1, "description": "hold"},
        {"value": 2, "description": "return"},
        {"value": 3, "description": "land"},
        {"value": 5, "description": "terminate"},
        {"value": 6, "description": "disarm"},
    ]
    assert "values" not in told["MAV_SYS_ID"]


def test_bits_are_told_apart_from_choices() -> None:
    told = described()
    assert told["COM_RC_OVERRIDE"]["bitmask"] == [
        {"index": 0, "description": "from auto modes"},
        {"index": 1, "description": "from offboard"},
    ]
    assert told["COM_RCL_EXCEPT"]["bitmask"] == [
        {"index": 0, "description": "mission"},
        {"index": 1, "description": "other auto modes"},
        {"index": 2, "description": "offboard"},
    ]
    assert "values" not in told["COM_RC_OVERRIDE"]
    assert "values" not in told["COM_RCL_EXCEPT"]


# --------------------------------------------------------------------------------- events

SIZES = {"uint8_t": "B", "uint16_t": "H", "uint32_t": "I", "int32_t": "i", "float": "f"}


def event_file() -> dict[str, dict[str, dict[str, dict[str, object]]]]:
    """What the general file names as the events of the component 1."""
    _, entry = json.loads(content(GENERAL_PATH))["metadataTypes"]
    assert entry["type"] == 4  # COMP_METADATA_TYPE_EVENTS
    data = content(entry["uri"].removeprefix("mftp://"))
    assert entry["fileCrc"] == crc32_of(data)
    told = json.loads(data)
    assert told["version"] == 1
    component: dict[str, dict[str, dict[str, dict[str, object]]]] = told["components"]["1"]
    return component


def all_that_are_sent() -> list[PX4Event]:
    said = (event_of(text, Modes(0x30000, 0x60000)) for text, *_ in TEXTS)
    nothing_is_well = Checked(
        *(False,) * 8, station=False, within_fence=False, mode_to_arm_in=False
    )
    shaken = Checked(velocity=False)
    return [
        *(event for event in said if event is not None),
        *report(nothing_is_well),
        *report(shaken),
    ]


def test_every_event_that_is_sent_is_defined_with_arguments_of_its_size() -> None:
    component = event_file()
    sizes = {name: SIZES[str(enum["type"])] for name, enum in component["enums"].items()} | SIZES
    defined: dict[str, list[dict[str, str]]] = {}
    for group in component["event_groups"].values():
        for number, event in group["events"].items():
            assert isinstance(event, dict)
            defined[number] = event.get("arguments", [])
    sent = all_that_are_sent()
    assert {str(event.id & 0xFFFFFF) for event in sent} == set(defined)
    for event in sent:
        assert event.id >> 24 == 1
        arguments = defined[str(event.id & 0xFFFFFF)]
        form = "<" + "".join(sizes[each["type"]] for each in arguments)
        assert len(event.arguments) == calcsize(form), event


def test_a_station_finds_the_arming_checks_by_their_groups() -> None:
    groups = event_file()["event_groups"]
    checks, health = groups["arming_check"]["events"], groups["health"]["events"]
    summaries = {
        str(event["name"])
        for events in (checks, health)
        for event in events.values()
        if isinstance(event, dict) and event.get("type") == "summary"
    }
    assert summaries == {"commander_arming_check_summary", "commander_health_summary"}
    assert len(checks) == 11
    bits = event_file()["enums"]["health_component_t"]["entries"]
    assert isinstance(bits, dict)
    named = {bit: json.loads(json.dumps(bits[str(1 << bit)]))["name"] for bit in range(31)}
    assert [named[bit] for bit in (3, 7, 11, 12, 17, 20, 27, 29)] == [
        *("gps", "remote_control", "battery", "communication_links", "local_position_estimate"),
        *("system", "magnetometer", "gyro"),
    ]
