"""A policy from disk: the zones of its fence files are its zones, and are judged as its own."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.zonespec import CircleSpec
from gcs.policy_file import PolicyFileError, load_policy

CENTRE = (47.397742, 8.545594)
POLICY = '[[fence]]\nkind = "file"\npath = "yard.plan"\n'


def fence(*circles: tuple[float, bool]) -> bytes:
    """A plan of circles about one place: radius in metres, inclusion."""
    entries = [
        {"circle": {"center": CENTRE, "radius": radius_m}, "inclusion": inclusion, "version": 1}
        for radius_m, inclusion in circles
    ]
    return json.dumps(
        {
            "fileType": "Plan",
            "version": 1,
            "geoFence": {"version": 2, "polygons": [], "circles": entries},
        }
    ).encode()


@pytest.fixture
def policy(tmp_path: Path) -> Path:
    path = tmp_path / "policy.toml"
    path.write_text(POLICY)
    return path


def error(policy: Path) -> PolicyFileError:
    with pytest.raises(PolicyFileError) as caught:
        load_policy(str(policy))
    return caught.value


def test_a_shipped_policy_comes_with_its_text() -> None:
    policy, text = load_policy("default")
    assert policy == DEFAULT
    assert 'name = "default"' in text


@pytest.mark.parametrize(
    ("text", "what", "hint"),
    [
        ('extra_denied = ["DO_DIGICAM"]', "bridge.extra_denied[1]: 'DO_DIGICAM' is no message", ""),
        ('extra_denied = ["HEARTBEAT"]', '"HEARTBEAT" is between a client and the gate', ""),
        ('extra_denied = ["COMMAND_LONG"]', '"COMMAND_LONG" carries commands', "command's name"),
        ('extra_denied = ["181"]', '"181" is no name', "did you mean DO_SET_RELAY?"),
        ('extra_harmless = ["DO_REPOSITION"]', "moves the vehicle: the gate decides", ""),
        ('extra_harmless = ["PARAM_SET"]', "has a key of its own", ""),
        ('extra_harmless = ["REQUEST_MESSAGE"]', "is harmless already", "leave it out"),
        ('manual_modes = ["POSCTRL"]', "is no mode of an autopilot", "did you mean POSCTL?"),
    ],
)
def test_a_name_in_the_bridges_section_that_cannot_be_meant(
    policy: Path, text: str, what: str, hint: str
) -> None:
    policy.write_text(f"[bridge]\n{text}\n")
    found = error(policy)
    assert str(found).startswith(f"{policy}:2: bridge.")
    assert what in str(found)
    assert hint in found.hint


def test_names_in_the_bridges_section_that_can(policy: Path) -> None:
    policy.write_text(
        """
        [bridge]
        extra_denied = ["DO_SET_RELAY", "MAV_CMD_DO_REPOSITION", "PARAM_SET"]
        extra_harmless = ["DO_PARACHUTE", "TUNNEL"]
        manual_modes = ["POSCTL", "loiter"]
        """
    )
    read, _ = load_policy(str(policy))
    assert read.bridge.manual_modes == ("POSCTL", "loiter")


def test_the_zones_of_a_fence_file_beside_the_policy_take_its_place(policy: Path) -> None:
    (policy.parent / "yard.plan").write_bytes(fence((80.0, True), (5.0, False)))
    read, text = load_policy(str(policy))
    assert [(type(zone), zone.inclusion) for zone in read.fence] == [
        (CircleSpec, True),
        (CircleSpec, False),
    ]
    assert {zone.frame for zone in read.fence} == {"geographic"}
    assert text == POLICY


def test_a_fence_file_with_exclusion_zones_only_is_refused(policy: Path) -> None:
    """It says nothing of where the vehicle may be: a goal 900 m out used to be cleared."""
    (policy.parent / "yard.plan").write_bytes(fence((5.0, False)))
    found = error(policy)
    assert str(found) == f"{policy}:1: fence: has no inclusion zone"
    assert found.hint.startswith("yard.plan only says where it may not be")


def test_a_fence_file_and_an_inclusion_zone_of_ones_own_go_together(policy: Path) -> None:
    (policy.parent / "yard.plan").write_bytes(fence((5.0, False)))
    policy.write_text(f'{POLICY}[[fence]]\nname = "field"\nradius_m = 50\n')
    read, _ = load_policy(str(policy))
    assert [zone.inclusion for zone in read.fence] == [False, True]


def test_a_zone_of_a_fence_file_that_the_margin_fills_is_refused(policy: Path) -> None:
    (policy.parent / "yard.plan").write_bytes(fence((2.0, True)))
    found = error(policy)
    assert str(found).startswith(f"{policy}:3: fence[1].path: zone '")
    assert "of yard.plan: radius_m: the margin of 2 m leaves nothing of this zone" in str(found)


def test_a_fence_file_that_is_not_there_is_told_with_who_names_it(policy: Path) -> None:
    found = error(policy)
    missing = policy.parent / "yard.plan"
    assert str(found) == f"{policy}:3: fence[1].path: {missing}: No such file or directory"
    assert found.hint == "the path of a plan, from the folder of this file"


def test_a_fence_file_that_is_no_plan_is_told_with_its_own_place(policy: Path) -> None:
    (policy.parent / "yard.plan").write_bytes(fence((0.0, True)))
    assert str(error(policy)).startswith(f"{policy.parent / 'yard.plan'}:geoFence.circles[0]")


def test_a_policy_that_is_not_there_is_told(tmp_path: Path) -> None:
    found = error(tmp_path / "none.toml")
    assert str(found) == f"{tmp_path / 'none.toml'}: No such file or directory"
    assert "`default`, `lab`" in found.hint


def test_a_mistake_is_told_with_its_line_and_a_hint(policy: Path) -> None:
    policy.write_text("\nmargin_h = 3\n")
    found = error(policy)
    assert str(found) == f"{policy}:2: margin_h: unknown key"
    assert found.hint == "did you mean margin_h_m?"


def test_a_policy_that_is_no_text_is_told(policy: Path) -> None:
    policy.write_bytes(b'name = "\xff"')
    assert str(error(policy)) == f"{policy}:1: text: is not UTF-8"


def test_a_binary_policy_is_no_text(policy: Path) -> None:
    policy.write_bytes(b"\x7fELF\0\0\xff\xfe")
    found = error(policy)
    assert str(found) == f"{policy}: is no text"
    assert found.hint == "a TOML file is wanted"


def test_the_words_of_a_severity_are_listed_once(policy: Path) -> None:
    policy.write_text('[severities]\nbattery_low = "orange"\n')
    found = error(policy)
    assert str(found).endswith(
        '"orange" is none of: nominal, caution, hold, return, land, terminate'
    )
    assert found.hint == "write one of them"
    policy.write_text('[severities]\nbattery_low = "retrun"\n')
    assert error(policy).hint == "did you mean return?"
