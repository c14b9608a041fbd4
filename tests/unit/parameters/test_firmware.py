"""Either generation of an autopilot: its version, its names, and one vehicle behind them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.unit.vehicle_services.fake_vehicle import Bench, S, long
from vehicle_sim.autopilot.firmware import FIRMWARES, Firmware, FirmwareError, firmware_of
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import ParameterError, Parameters, Quantity
from vehicle_sim.autopilot.parameters.tables import RENAMED, TABLES
from vehicle_sim.autopilot.parameters.tables.renamed import COPTER_4_7, Meaning
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

VERSIONS: list[tuple[Personality, Firmware, int]] = [
    ("px4", "1.14", 0x010E03FF),  # as recorded
    ("px4", "1.15", 0x010F00FF),
    ("ardupilot", "4.5", 0x040507FF),
    ("ardupilot", "4.7", 0x04070000),  # as recorded
]


@pytest.mark.parametrize(("personality", "firmware", "version"), VERSIONS)
def test_the_version_that_is_told_is_the_one_that_is_played(
    personality: Personality, firmware: Firmware, version: int
) -> None:
    bench = Bench(personality, firmware=firmware)
    heard = bench.send(long(Cmd.REQUEST_MESSAGE, m.IDS[m.AutopilotVersion])) + bench.advance(S)
    told = [each for each in heard if isinstance(each, m.AutopilotVersion)]
    assert [each.flight_sw_version for each in told] == [version]


def test_the_older_generation_is_played_unless_another_is_asked_for() -> None:
    assert firmware_of("px4", None) == "1.14"
    assert firmware_of("ardupilot", None) == "4.5"
    assert Parameters("ardupilot").firmware == "4.5"


@pytest.mark.parametrize(("personality", "firmware"), [("px4", "4.7"), ("ardupilot", "1.14")])
def test_another_autopilots_firmware_is_refused(personality: Personality, firmware: str) -> None:
    with pytest.raises(FirmwareError, match=firmware):
        firmware_of(personality, firmware)


# behaviour.json, rank 1, "parameter names".
@pytest.mark.parametrize(
    "name",
    [
        "RTL_ALT_M", "RTL_ALT_FINAL_M", "RTL_CLIMB_MIN_M", "RTL_SPEED_MS", "WP_SPD", "WP_SPD_UP",
        "WP_SPD_DN", "WP_ACC", "WP_RADIUS_M", "LAND_SPD_MS", "LAND_ALT_LOW_M", "LOIT_SPEED_MS",
        "CIRCLE_RADIUS_M", "MAV_SYSID", "MAV_GCS_SYSID", "MAV1_POSITION", "ARMING_SKIPCHK",
        "SIM_GPS1_ENABLE",
    ],
)  # fmt: skip
def test_4_7_has_its_own_names_and_not_those_of_4_5(name: str) -> None:
    new, old = Parameters("ardupilot", "4.7"), Parameters("ardupilot", "4.5")
    (renamed,) = (each for each in COPTER_4_7 if each.new == name)
    assert name in new
    assert name not in old
    assert renamed.old in old
    assert renamed.old not in new
    with pytest.raises(ParameterError, match=renamed.old):
        new.value(renamed.old)


@pytest.mark.parametrize(
    ("name", "value", "quantity", "si"),
    [
        ("RTL_ALT_M", 22.5, Quantity.RETURN_UP_M, 22.5),
        ("WP_SPD", 7.0, Quantity.CRUISE_M_S, 7.0),
        ("WP_SPD_DN", 1.2, Quantity.DESCEND_M_S, 1.2),
        ("LAND_SPD_MS", 0.4, Quantity.LAND_M_S, 0.4),
        ("WP_RADIUS_M", 3.0, Quantity.ACCEPT_M, 3.0),
        ("MAV_SYSID", 42.0, Quantity.SYSTEM_ID, 42.0),
    ],
)
def test_what_is_set_by_a_new_name_acts(
    name: str, value: float, quantity: Quantity, si: float
) -> None:
    parameters = Parameters("ardupilot", "4.7")
    parameters.set(name, value)
    assert parameters.si(quantity) == pytest.approx(si, rel=1e-6)


@pytest.mark.parametrize(
    ("left_out", "checks"),
    [(0, 1), (-1, 0), (4, 0x1FFFFA), (0x1FFFFE, 0)],
)
def test_checks_left_out_are_those_that_are_not_made(left_out: int, checks: int) -> None:
    parameters = Parameters("ardupilot", "4.7")
    parameters.set("ARMING_SKIPCHK", left_out)
    assert parameters.get("ARMING_CHECK") == checks


def test_a_gps_that_is_not_enabled_is_disabled() -> None:
    parameters = Parameters("ardupilot", "4.7")
    assert parameters.get("SIM_GPS_DISABLE") == 0
    parameters.set("SIM_GPS1_ENABLE", 0)
    assert parameters.get("SIM_GPS_DISABLE") == 1


def test_both_generations_are_the_same_vehicle() -> None:
    new, old = Parameters("ardupilot", "4.7"), Parameters("ardupilot", "4.5")
    assert len(new) == len(old)
    for spec in TABLES["ardupilot"]:
        assert new.get(spec.name) == old.get(spec.name)


@given(st.sampled_from([each for each in COPTER_4_7 if each.meaning is Meaning.SCALED]),
       st.floats(-1e4, 1e4))  # fmt: skip
def test_there_and_back_is_the_same_value(renamed: object, value: float) -> None:
    assert isinstance(renamed, type(COPTER_4_7[0]))
    assert renamed.to_old(renamed.to_new(value)) == pytest.approx(value)


def test_every_renamed_parameter_is_one_of_ours_and_names_are_unique() -> None:
    ours = {spec.name for spec in TABLES["ardupilot"]}
    assert set(RENAMED["4.7"]) <= ours
    assert len({each.new for each in COPTER_4_7}) == len(COPTER_4_7) == len(RENAMED["4.7"])
    for firmwares in FIRMWARES.items():
        for firmware in firmwares[1]:
            names = [spec.name for spec in Parameters(firmwares[0], firmware).specs]
            assert names == sorted(set(names))
            assert all(len(name) <= 16 for name in names)
