"""Component metadata says of each parameter what its table says."""

from __future__ import annotations

import json

from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.metadata import GENERAL_PATH, metadata_of
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
    (entry,) = general["metadataTypes"]
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
