"""Policy files that must not start a station: file, line, key, what is wrong, and a hint.

`tests/system/test_wrong_input.py` starts the program with some of them and looks at the exit code.
"""

from __future__ import annotations

import json
import math
import time
from pathlib import Path

import pytest

from gcs.policy_file import PolicyFileError, load_policy

ZONE = '[[fence]]\nname = "a"\n'
POLYGON = ZONE + 'kind = "polygon"\n'
ON_EARTH = POLYGON + 'frame = "geographic"\n'
FILE = '[[fence]]\nkind = "file"\npath = "yard.plan"\n'
HOLE = '[[fence]]\nname = "b"\ninclusion = false\nradius_m = 9\n'


def error(folder: Path, text: str | bytes, plan: object = None) -> PolicyFileError:
    path = folder / "my.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    if plan is not None:
        (folder / "yard.plan").write_text(json.dumps(plan))
    with pytest.raises(PolicyFileError) as caught:
        load_policy(str(path))
    return caught.value


@pytest.mark.parametrize(
    ("text", "where", "what"),
    [
        ("margin = 2", "1: margin: ", "unknown key"),
        ("\n[arrival]\nradius = 3", "3: arrival.radius: ", "unknown key"),
        (ZONE + "radius_m = 9\ncolour = 1", "4: fence[1].colour: ", "unknown key"),
        ("[separation]\nleast_m = -1", "2: separation.least_m: ", "-1"),
        ("margin_h_m = nan", "1: margin_h_m: ", "not finite"),
        ("max_up_m = -inf", "1: max_up_m: ", "not finite"),
        (ZONE + "radius_m = nan", "3: fence[1].radius_m: ", "not finite"),
        (ZONE + "radius_m = 9\ncentre = [inf, 0]", "4: fence[1].centre: ", "not finite"),
        (
            POLYGON + "corners = [[0, 0], [9, nan], [9, 9]]",
            "4: fence[1].corners[2]: ",
            "not finite",
        ),
        ("margin_h_m = 200", "1: margin_h_m: ", "leaves nothing"),
        (ZONE + "radius_m = 1", "3: fence[1].radius_m: ", "leaves nothing"),
        (
            POLYGON + "corners = [[-9, -1], [90, -1], [90, 2], [-9, 2]]",
            "4: fence[1].corners: ",
            "the margin of 2 m leaves nothing",
        ),
        (
            ON_EARTH + "corners = [[47.4, 8.5], [47.4, 8.51], [47.40001, 8.51], [47.40001, 8.5]]",
            "5: fence[1].corners: ",
            "the margin of 2 m leaves nothing",
        ),
        (
            POLYGON + "corners = [[-9, -9], [90, 90], [90, -9], [-9, 90]]",
            "4: fence[1].corners: ",
            "intersects itself",
        ),
        (
            ON_EARTH + "corners = [[47.4, 8.5], [47.41, 8.51], [47.41, 8.5], [47.4, 8.51]]",
            "5: fence[1].corners: ",
            "edge 1 and edge 3 meet: the polygon intersects itself",
        ),
        (
            ON_EARTH + "corners = [[0, 179.99], [0.01, -179.99], [0.01, 179.99], [0, -179.99]]",
            "5: fence[1].corners: ",
            "intersects itself",
        ),
        (
            ON_EARTH + "corners = [[47.4, 8.5], [47.41, 8.5], [47.42, 8.5]]",
            "5: fence[1].corners: ",
            "lie on each other",
        ),
        (
            ON_EARTH + "corners = [[47.4, 8.5], [47.4, 8.5], [47.42, 8.5], [47.42, 8.51]]",
            "5: fence[1].corners: ",
            "corners 1 and 2 are the same point",
        ),
        (
            ON_EARTH + "corners = [[0, 0], [0, 40], [40, 20]]",
            "5: fence[1].corners: ",
            "within 1000 km",
        ),
        (ON_EARTH + "corners = [[91, 0], [0, 1], [1, 0]]", "5: fence[1].corners: ", "nowhere"),
        (ON_EARTH + "corners = []", "5: fence[1].corners: ", "at least 3"),
        (HOLE, "1: fence: ", "no inclusion zone"),
        ("fence = []", "1: fence: ", "no inclusion zone"),
        ("[bridge]\nmessage_hz = 0", "2: bridge.message_hz: ", "impossible"),
        ('[bridge]\ndownloads = "on_grund"', "2: bridge.downloads: ", "is none of"),
        (ZONE + "radius_m = 9\ncentre = [20, 0]", "4: fence[1].centre: ", "home is outside"),
        (
            ZONE + 'kind = "box"\neast_m = [5, 50]\nnorth_m = [-9, 9]',
            "4: fence[1].east_m: ",
            "home is outside",
        ),
        (
            ZONE + 'kind = "box"\neast_m = [-9, 9]\nnorth_m = [-50, -5]',
            "5: fence[1].north_m: ",
            "home is outside",
        ),
        (
            POLYGON + "corners = [[5, 0], [50, -40], [50, 40]]",
            "4: fence[1].corners: ",
            "home is outside",
        ),
        (ZONE + "radius_m = 9\nceiling_up_m = -1", "4: fence[1].ceiling_up_m: ", "home is above"),
        ("margin_h_m = 2\nmargin_h_m = 3", "2: ", "not TOML: Cannot overwrite a value"),
        ("[arrival]\n[arrival]", "2: ", "not TOML: Cannot declare"),
        ("margin_h_m = 1e308", "1: margin_h_m: ", "impossible"),
        ("margin_h_m = " + "9" * 400, "1: margin_h_m: ", "too large"),
        ("margin_h_m = " + "9" * 5000, " ", "not TOML that can be read"),
        ("a = " + "[" * 5000, " ", "not TOML that can be read"),
        ('margin_h_m = "2"', "1: margin_h_m: ", "not a number"),
        ("fence_switchable = 1", "1: fence_switchable: ", "neither true nor false"),
        ("braking = 3", "1: braking: ", "is a table"),
        (
            ZONE + "radius_m = 9\n" + ZONE + "radius_m = 9",
            "2: fence[1].name: ",
            'two zones are called "a"',
        ),
        (ZONE + "radius_m = 0", "3: fence[1].radius_m: ", "impossible"),
        (b"\x7fELF\0\1\2\xff", " ", "is no text"),
        (b"margin_h_m = 2\nname = '\xff'", "2: text: ", "is not UTF-8"),
        (b"name = 'a\0b'", "1: ", "not TOML"),
    ],
    ids=lambda value: str(value)[:40] if isinstance(value, str | bytes) else None,
)
def test_a_bad_policy_is_told_with_file_line_key_and_hint(
    text: str | bytes, where: str, what: str, tmp_path: Path
) -> None:
    found = error(tmp_path, text)
    assert str(found).startswith(f"{tmp_path / 'my.toml'}:{where}"), str(found)
    assert what in str(found)
    if not where.endswith(("text: ", "switchable: ", "braking: ")):
        assert found.hint, str(found)


# ------------------------------------------------------------- fences of a plan file


def plan(corners: list[list[float]], *, inclusion: bool = True) -> dict[str, object]:
    polygon = {"version": 1, "inclusion": inclusion, "polygon": corners}
    fence = {"version": 2, "polygons": [polygon], "circles": []}
    return {"fileType": "Plan", "version": 1, "groundStation": "x", "geoFence": fence}


@pytest.mark.parametrize(
    ("corners", "what"),
    [
        ([[47.4, 8.5], [47.41, 8.51], [47.41, 8.5], [47.4, 8.51]], "intersects itself"),
        ([[47.4, 8.5], [47.41, 8.51], [47.4, 8.5]], "corners 3 and 1 are the same point"),
        ([[47.4, 8.5], [47.4, 8.51], [47.40001, 8.51], [47.40001, 8.5]], "leaves nothing"),
    ],
    ids=["crosses itself", "closed with two corners", "narrower than the margins"],
)
def test_a_bad_zone_of_a_fence_file_is_told_with_who_names_it(
    corners: list[list[float]], what: str, tmp_path: Path
) -> None:
    found = error(tmp_path, FILE, plan(corners))
    start = f"{tmp_path / 'my.toml'}:3: fence[1].path: zone 'geoFence.polygons[0]' of yard.plan: "
    assert str(found).startswith(f"{start}corners: ")
    assert what in str(found)
    assert found.hint


def test_a_bad_exclusion_zone_of_a_fence_file_is_told_too(tmp_path: Path) -> None:
    bow = [[47.4, 8.5], [47.41, 8.51], [47.41, 8.5], [47.4, 8.51]]
    found = error(tmp_path, f"{ZONE}radius_m = 9\n{FILE}", plan(bow, inclusion=False))
    assert "my.toml:6: fence[2].path: zone" in str(found)


# --------------------------------------------------------------- fences that are good


def test_a_fence_of_a_thousand_corners_is_read_in_a_moment(tmp_path: Path) -> None:
    """It was 8 s, and again each time that home was told: the station stands still meanwhile."""
    reach_m = [4500.0, 5000.0]
    turns = [math.tau * k / 1000 for k in range(1000)]
    corners = [
        [reach_m[k % 2] * math.cos(turn), reach_m[k % 2] * math.sin(turn)]
        for k, turn in enumerate(turns)
    ]
    path = tmp_path / "my.toml"
    path.write_text(f"{POLYGON}corners = {json.dumps(corners)}\n")
    began_s = time.process_time()
    policy, _ = load_policy(str(path))
    assert time.process_time() - began_s < 2.0
    assert policy.fence[0].name == "a"


@pytest.mark.parametrize(
    "corners",
    [
        "[[-9, -9], [9, -9], [9, 9], [-9, 9], [-9, -9]]",
        "[[-9, -9], [-9, 9], [9, 9], [9, -9]]",
        "[[-3, -3], [900, -3], [900, 3], [-3, 3]]",
        "[[-9, -9], [9, -9], [9, 9], [0, 9], [-9, 9]]",
    ],
    ids=["closed", "clockwise", "a street", "a corner on a straight edge"],
)
def test_an_odd_polygon_is_taken(corners: str, tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    path.write_text(f"{POLYGON}corners = {corners}\n")
    assert load_policy(str(path))[0].fence[0].name == "a"


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ('[battery]\nlow_v = "off"', "battery.low_v"),
        ("[battery]\ncritical_v = false", "battery.critical_v"),
        ('[arrival]\nspeed_m_s = "any"', "arrival.speed_m_s"),
        ("[arrival]\nyaw_deg = true", "arrival.yaw_deg"),
    ],
)
def test_where_none_is_a_value_the_hint_says_so(text: str, key: str, tmp_path: Path) -> None:
    found = error(tmp_path, text)
    assert f":2: {key}: " in str(found)
    assert found.hint.endswith(', or "none"')
