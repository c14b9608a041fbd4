"""A policy file is strict: every mistake is told with file, line, key and a hint."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec import Struct, structs

import gcs.gate.policy
from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import (
    Approach,
    Arrival,
    Braking,
    BridgeRules,
    ControlTimes,
    MissionRules,
    Overshoot,
    Policy,
    Speeds,
    TakeOffLimits,
)
from gcs.gate.policy.zonespec import BoxSpec, CircleSpec, PolygonSpec, ZoneSpec
from gcs.toml import TomlError
from gcs.toml_lines import find_lines

SHIPPED = Path(next(iter(gcs.gate.policy.__path__)))


def shipped(name: str) -> str:
    return (SHIPPED / name).read_text(encoding="utf-8")


def error(text: str) -> TomlError:
    with pytest.raises(TomlError) as caught:
        parse_policy(text, "my.toml")
    return caught.value


KINDS = [Policy, Arrival, Braking, Speeds, TakeOffLimits, ControlTimes, MissionRules]
KINDS += [Approach, Overshoot, BridgeRules]
PARTS = (
    DEFAULT.arrival,
    DEFAULT.speeds,
    DEFAULT.takeoff,
    DEFAULT.control,
    DEFAULT.mission,
    DEFAULT.bridge,
)


def test_the_shipped_default_is_the_default() -> None:
    assert parse_policy(shipped("default.toml"), "default.toml") == DEFAULT


@pytest.mark.parametrize("kind", KINDS)
def test_no_default_stands_anywhere_but_in_the_shipped_file(kind: type[Struct]) -> None:
    assert all(key.required for key in structs.fields(kind))


def test_an_empty_file_is_the_default() -> None:
    assert parse_policy("", "my.toml") == DEFAULT


def test_the_shipped_default_names_every_key_there_is() -> None:
    lines = find_lines(shipped("default.toml"))
    for key in structs.fields(Policy):
        assert (key.name,) in lines or (key.name, 0) in lines, key.name
    for condition in Condition:
        assert ("severities", condition.value) in lines
    for part in PARTS:
        name = next(f.name for f in structs.fields(Policy) if getattr(DEFAULT, f.name) is part)
        for key in structs.fields(part):
            assert (name, key.name) in lines, (name, key.name)
    for autopilot, overshoot in DEFAULT.overshoot.items():
        for key in structs.fields(overshoot):
            assert ("overshoot", autopilot, key.name) in lines
    for autopilot, approach in DEFAULT.approach.items():
        for key in structs.fields(approach):
            assert ("approach", autopilot, key.name) in lines
    for autopilot, braking in DEFAULT.braking.items():
        for key in structs.fields(braking):
            assert ("braking", autopilot, key.name) in lines


def test_the_labs_policy_is_the_labs() -> None:
    lab = parse_policy(shipped("lab.toml"), "lab.toml")
    assert lab.name == "lab"
    assert (lab.arrival.radius_m, lab.arrival.speed_m_s, lab.arrival.dwell_s) == (0.5, None, 0.0)
    assert (lab.margin_h_m, lab.margin_v_m, lab.bounds_inclusive) == (0.0, 0.0, True)
    assert (lab.brake_slack_h_m, lab.brake_slack_v_m, lab.fence_switchable) == (0.5, 0.5, True)
    (cage,) = lab.fence
    assert cage == BoxSpec(
        (-5.0, 5.0), (-5.0, 5.0), name="cage", frame="local", floor_up_m=0.0, ceiling_up_m=2.0
    )


def test_every_kind_of_zone() -> None:
    policy = parse_policy(
        """
        [[fence]]
        name = "field"
        kind = "polygon"
        frame = "geographic"
        corners = [
            [47.0, 8.0],  # a comment, and a ] in it
            [47.0, 8.1],
            [47.1, 8.0],
        ]
        [[fence]]
        name = "tower"
        kind = "circle"
        inclusion = false
        centre = [20, 35]
        radius_m = 8
        ceiling_up_m = "none"
        [[fence]]
        name = "street"
        kind = "box"
        frame = "local"
        east_m = [-50, 50]
        north_m = [0, 60.5]
        floor_up_m = 1
        """,
        "my.toml",
    )
    assert policy.fence == (
        PolygonSpec(((47.0, 8.0), (47.0, 8.1), (47.1, 8.0)), name="field", frame="geographic"),
        CircleSpec(8.0, (20.0, 35.0), name="tower", inclusion=False),
        BoxSpec((-50.0, 50.0), (0.0, 60.5), name="street", frame="local", floor_up_m=1.0),
    )


def test_severities_are_mapped_by_name() -> None:
    policy = parse_policy('severities.battery_low = "land"', "my.toml")
    assert policy.severities[Condition.BATTERY_LOW] is Severity.LAND
    assert policy.severities[Condition.TICK_LATE] is Severity.CAUTION
    assert set(DEFAULT.severities) == set(Condition)


def test_an_error_reads_file_line_key_and_what() -> None:
    found = error('name = "x"\n\nmargin_h = 3.0\n')
    assert str(found) == "my.toml:3: margin_h: unknown key"
    assert found.hint == "did you mean margin_h_m?"


ZONE = '[[fence]]\nname = "a"\n'


@pytest.mark.parametrize(
    ("text", "line", "key", "what"),
    [
        ("margin_h_m = -1", 1, "margin_h_m", "impossible"),
        ("\nmargin_h_m = nan", 2, "margin_h_m", "not finite"),
        ("\nmargin_v_m = inf", 2, "margin_v_m", "not finite"),
        ('max_up_m = "high"', 1, "max_up_m", '"high" is not a number'),
        ("max_up_m = true", 1, "max_up_m", "not a number"),
        ("bounds_inclusive = 1", 1, "bounds_inclusive", "neither true nor false"),
        ("name = 3", 1, "name", "not a text"),
        ('rtl_blocked = "lnad"', 1, "rtl_blocked", "none of: hold, land, forward"),
        ('[severities]\nbattery_lo = "land"', 2, "severities.battery_lo", "unknown key"),
        ('[severities]\nbattery_low = "bad"', 2, "severities.battery_low", "none of"),
        ("[arrival]\nradius_m = 0", 2, "arrival.radius_m", "impossible"),
        ("arrival = 0.5", 1, "arrival", "is a table"),
        ("[braking.vtol]\nreact_s = 1", 1, "braking.vtol", "unknown key"),
        ("[braking.px4]\na_brake_h_m_s2 = 0", 2, "braking.px4.a_brake_h_m_s2", "impossible"),
        ("[takeof]\nmax_up_m = 3", 1, "takeof", "unknown key"),
        ("bridge = 3", 1, "bridge", "is a table"),
        ('[bridge]\nfenc = "refuse"', 2, "bridge.fenc", "unknown key"),
        ('[bridge]\nparameters = "all"', 2, "bridge.parameters", "none of: guard, refuse"),
        ('[bridge]\ncalibration = "forward"', 2, "bridge.calibration", "none of"),
        ("[bridge]\nmax_clients = 0", 2, "bridge.max_clients", "0 is impossible"),
        ("[bridge]\nmax_clients = 1.5", 2, "bridge.max_clients", "not a whole number"),
        ('[bridge]\nmax_clients = "4"', 2, "bridge.max_clients", "not a number"),
        ("[bridge]\nclient_rate_hz = nan", 2, "bridge.client_rate_hz", "not finite"),
        ("[bridge]\nclient_gone_s = 0", 2, "bridge.client_gone_s", "impossible"),
        ('[bridge]\nextra_denied = "X"', 2, "bridge.extra_denied", "not a list of texts"),
        ("[bridge]\nextra_denied = [3]", 2, "bridge.extra_denied[1]", "not a text"),
        (
            '[bridge]\nparameters_allowed = ["GF_*", "gf_action"]',
            2,
            "bridge.parameters_allowed[2]",
            "names no parameter",
        ),
        (
            '[bridge]\nparameters_guarded = ["X"]\nparameters_allowed = ["X"]',
            3,
            "bridge.parameters_allowed[1]",
            "parameters_guarded, too",
        ),
        (
            '[bridge]\nparameters = "refuse"\nparameters_guarded = ["SDLOG_*"]',
            3,
            "bridge.parameters_guarded",
            'means nothing beside parameters = "refuse", which refuses them all',
        ),
        (
            '[bridge]\nparameters = "refuse"\nparameters_allowed = ["SDLOG_MODE", "*"]',
            3,
            "bridge.parameters_allowed[2]",
            "allows every parameter, which",
        ),
        (
            '[bridge]\nparameters = "forward"\nparameters_guarded = ["SDLOG_*"]',
            3,
            "bridge.parameters_guarded",
            'means nothing beside parameters = "forward", which forwards them all',
        ),
        (
            '[bridge]\nparameters_allowed = ["SDLOG_*"]\nparameters = "forward"',
            2,
            "bridge.parameters_allowed",
            'means nothing beside parameters = "forward"',
        ),
        ("position_age_s = 10.1", 1, "position_age_s", "10.1 is impossible"),
        ("heartbeat_age_s = 61", 1, "heartbeat_age_s", "61 is impossible"),
        ('name = "a\\u0000b\\u001b[31m"', 1, "name", "cannot be printed (U+0000, U+001B)"),
        (
            '[[fence]]\nname = "a\\u202eb"\nradius_m = 5',
            2,
            "fence[1].name",
            "cannot be printed (U+202E)",
        ),
        (
            '[bridge]\nextra_denied = ["X"]\nextra_harmless = ["X"]',
            3,
            "bridge.extra_harmless[1]",
            "extra_denied, too",
        ),
        ("[battery]\nendurance_s = 0", 2, "battery.endurance_s", "impossible"),
        ('[battery]\nendurance_s = "long"', 2, "battery.endurance_s", "not a number"),
        ("x = [1,\n2", 2, "", "not TOML"),
        ("name = 'a'\nname = 'b'\n", 2, "", "not TOML"),
        ("fence = []", 1, "fence", "no inclusion zone"),
        ("[fence]\nradius_m = 5", 1, "fence", "list of tables"),
        ("[[fence]]\nradius_m = 5", 1, "fence[1].name", "missing"),
        (ZONE + 'kind = "circle"', 1, "fence[1].radius_m", "missing"),
        (ZONE + "radius_m = 5\nradious = 1", 4, "fence[1].radious", "unknown key"),
        (ZONE + "radius_m = 2", 3, "fence[1].radius_m", "leaves nothing"),
        (ZONE + "radius_m = 5\neast_m = [0, 1]", 4, "fence[1].east_m", "unknown key"),
        (ZONE + 'kind = "cube"', 3, "fence[1].kind", "none of"),
        (ZONE + "inclusion = false\nradius_m = 5", 1, "fence", "no inclusion zone"),
        (ZONE + "radius_m = 5\n" + ZONE + "radius_m = 6", 2, "fence[1].name", "two zones"),
        (
            ZONE + "radius_m = 5\n[[fence]]\nname = 'b'\nradius_m = 0",
            6,
            "fence[2].radius_m",
            "impossible",
        ),
        (
            ZONE + "radius_m = 5\nfloor_up_m = 5\nceiling_up_m = 5",
            5,
            "fence[1].ceiling_up_m",
            "not above the floor",
        ),
        (
            ZONE + "radius_m = 5\nfloor_up_m = 5\nceiling_up_m = 5.5",
            5,
            "fence[1].ceiling_up_m",
            "leaves nothing",
        ),
        (
            ZONE + 'kind = "box"\neast_m = [5, -5]\nnorth_m = [0, 9]',
            4,
            "fence[1].east_m",
            "is empty",
        ),
        (
            ZONE + 'kind = "box"\neast_m = [0, 3]\nnorth_m = [0, 9]',
            4,
            "fence[1].east_m",
            "leaves nothing",
        ),
        (ZONE + 'kind = "box"\neast_m = [0]', 4, "fence[1].east_m", "not a pair"),
        (
            ZONE + 'kind = "box"\nframe = "geographic"\neast_m = [0, 3]',
            4,
            "fence[1].frame",
            "metres",
        ),
        (ZONE + 'kind = "polygon"\ncorners = 3', 4, "fence[1].corners", "not a list"),
        (ZONE + 'kind = "polygon"\ncorners = [[0, 0], [1, 1]]', 4, "fence[1].corners", "at least"),
        (
            ZONE + 'kind = "polygon"\ncorners = [[0, 0], [9, 9], [9, 0], [0, 9]]',
            4,
            "fence[1].corners",
            "intersects itself",
        ),
        (
            ZONE + 'frame = "geographic"\nradius_m = 9\ncentre = [147, 8]',
            5,
            "fence[1].centre",
            "nowhere",
        ),
        (ZONE + 'frame = "geographic"\nradius_m = 9', 1, "fence[1].centre", "missing"),
        ('[[fence]]\nkind = "file"', 1, "fence[1].path", "missing"),
        ("min_up_m = 50\nmax_up_m = 50", 2, "max_up_m", "not above min_up_m"),
        ("max_up_m = 20\n[takeoff]\nmax_up_m = 25", 3, "takeoff.max_up_m", "above the policy's"),
        (
            "[arrival]\nradius_m = 5\nmax_radius_m = 1",
            3,
            "arrival.max_radius_m",
            "1 is less than radius_m of 5",
        ),
        ("[arrival]\nmax_radius_m = 0.4", 2, "arrival.max_radius_m", "less than radius_m of 0.5"),
        (
            "[bridge]\nmessages_hz = 1\nmessage_hz = 1000",
            3,
            "bridge.message_hz",
            "1000 is more than messages_hz of 1",
        ),
        ("[bridge]\nmessage_hz = 501", 2, "bridge.message_hz", "more than messages_hz of 500"),
        ("[control]\nstream_s = 5\ntimeout_s = 5", 3, "control.timeout_s", "before the stream"),
        ("margin_h_m = 200", 1, "margin_h_m", "leaves nothing"),
        ("margin_v_m = 25", 1, "margin_v_m", "leaves nothing"),
    ],
)
def test_what_is_wrong_is_told_with_line_and_key(text: str, line: int, key: str, what: str) -> None:
    found = error(text)
    assert (found.line, found.key) == (line, key)
    assert what in found.what
    assert str(found).startswith(f"my.toml:{line}: ")


def test_a_lower_ceiling_alone_does_not_quarrel_with_the_default_take_off() -> None:
    assert parse_policy("max_up_m = 20", "my.toml").max_up_m == 20.0


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        (
            "[arrival]\nradius_m = 5\nmax_radius_m = 1",
            "max_radius_m = 5 leaves the radius as it is",
        ),
        ("[bridge]\nmessage_hz = 501", "messages_hz is what all messages together may have"),
    ],
)
def test_a_contradiction_has_a_hint(text: str, hint: str) -> None:
    assert error(text).hint == hint


def test_a_wider_radius_and_a_lower_sum_alone_do_not_quarrel_with_the_defaults() -> None:
    assert parse_policy("arrival.radius_m = 2", "my.toml").arrival.radius_m == 2.0
    assert parse_policy("bridge.messages_hz = 20", "my.toml").bridge.messages_hz == 20.0


def test_equal_limits_do_not_quarrel() -> None:
    parse_policy("[arrival]\nradius_m = 2\nmax_radius_m = 2", "my.toml")
    parse_policy("[bridge]\nmessage_hz = 20\nmessages_hz = 20", "my.toml")


def test_lines_are_found_past_strings_comments_and_nested_lists() -> None:
    text = '''a = "x # [no]" # [b]
text = """
[not.a.table]
c = 1
"""
list = [
  [1, 2],
  ["]", 3],
]
["quoted"]
d.e = 1
[[items]]
f = 1
[items.sub]
g = 1
[[items]]
f = 2
'''
    lines = find_lines(text)
    assert lines[("a",)] == 1
    assert lines[("text",)] == 2
    assert lines[("list",)] == 6
    assert lines[("quoted", "d", "e")] == 11
    assert lines[("items", 0, "f")] == 13
    assert lines[("items", 0, "sub", "g")] == 15
    assert lines[("items", 1, "f")] == 17
    assert ("not", "a", "table") not in lines
    assert ("c",) not in lines


def test_a_stranger_brakes_as_the_worst_of_all() -> None:
    worst = DEFAULT.braking_of("betaflight")
    assert worst.react_s == max(b.react_s for b in DEFAULT.braking.values())
    assert worst.a_brake_h_m_s2 == min(b.a_brake_h_m_s2 for b in DEFAULT.braking.values())
    assert DEFAULT.braking_of("px4") == DEFAULT.braking["px4"]


def test_a_goal_at_the_margin_may_be_hovered_at_without_a_brake() -> None:
    for braking in DEFAULT.braking.values():
        assert braking.position_error_h_m <= DEFAULT.brake_slack_h_m <= DEFAULT.margin_h_m
        assert braking.position_error_v_m <= DEFAULT.brake_slack_v_m <= DEFAULT.margin_v_m


# ----------------------------------------------------------- brakes that come too late


@pytest.mark.parametrize(
    ("text", "key", "what"),
    [
        ("margin_h_m = 0.5", "margin_h_m", "0.5 is less than brake_slack_h_m of 1.5"),
        ("margin_h_m = 0.0", "margin_h_m", "0 is less than brake_slack_h_m of 1.5"),
        ("margin_h_m = 1.49", "margin_h_m", "1.49 is less than brake_slack_h_m of 1.5"),
        ("brake_slack_h_m = 2.01", "brake_slack_h_m", "2.01 is more than margin_h_m of 2"),
        ("margin_v_m = 0.2", "margin_v_m", "0.2 is less than brake_slack_v_m of 0.3"),
        ("brake_slack_v_m = 0.4", "brake_slack_v_m", "0.4 is more than margin_v_m of 0.3"),
    ],
)
def test_a_slack_beyond_the_margin_is_refused(text: str, key: str, what: str) -> None:
    """The vehicle was out by 0.49 m before the brake with the first of these."""
    found = error(text)
    assert (found.line, found.key) == (1, key)
    assert found.what.startswith(what)
    assert "could leave the fence before the gate brakes" in found.what
    assert "allow_stop_outside = true" in found.hint
    assert parse_policy(f"{text}\nallow_stop_outside = true", "my.toml").allow_stop_outside


def test_a_slack_as_large_as_the_margin_is_no_fault() -> None:
    assert parse_policy("margin_h_m = 1.5", "my.toml").margin_h_m == 1.5
    both = parse_policy("margin_h_m = 0.5\nbrake_slack_h_m = 0.5", "my.toml")
    assert (both.margin_h_m, both.brake_slack_h_m) == (0.5, 0.5)


# ------------------------------------------------------------------------ fence files

FILE = '[[fence]]\nkind = "file"\npath = "yard.plan"\n'


def yard(*, inclusion: bool = True, radius_m: float = 50.0) -> tuple[ZoneSpec, ...]:
    return (CircleSpec(radius_m, (47.0, 8.0), name="y", inclusion=inclusion, frame="geographic"),)


def test_the_zones_of_a_fence_file_stand_where_it_is_named() -> None:
    asked: list[str] = []

    def read(path: str) -> tuple[ZoneSpec, ...]:
        asked.append(path)
        return yard()

    policy = parse_policy(f"{ZONE}radius_m = 9\n{FILE}", "my.toml", read)
    assert asked == ["yard.plan"]
    assert [zone.name for zone in policy.fence] == ["a", "y"]
    assert policy.fence[1:] == yard()


def test_a_fence_file_of_exclusion_zones_alone_is_no_fence() -> None:
    with pytest.raises(TomlError, match="has no inclusion zone") as caught:
        parse_policy(FILE, "my.toml", lambda _: yard(inclusion=False))
    assert (caught.value.line, caught.value.key) == (1, "fence")
    assert "yard.plan" in caught.value.hint


def test_a_fence_file_is_held_to_the_margins_too() -> None:
    with pytest.raises(TomlError, match="leaves nothing of this zone") as caught:
        parse_policy(FILE, "my.toml", lambda _: yard(radius_m=2.0))
    assert (caught.value.line, caught.value.key) == (3, "fence[1].path")


def test_a_fence_file_where_none_can_be_read_is_refused() -> None:
    assert (error(FILE).line, error(FILE).key) == (3, "fence[1].path")


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ('rtl_blocked = "x"', "write one of them"),
        ("battery.endurance_s = true", 'a number, or "none"'),
        ('[bridge]\nparameters = "forward"\nparameters_allowed = ["X"]', 'parameters = "guard"'),
    ],
)
def test_what_to_write_in_its_place_is_in_the_hint(text: str, hint: str) -> None:
    with pytest.raises(TomlError) as caught:
        parse_policy(text, "my.toml")
    assert hint in caught.value.hint


def test_the_oldest_position_and_heartbeat_that_a_policy_may_take() -> None:
    oldest = parse_policy("position_age_s = 10\nheartbeat_age_s = 60", "my.toml")
    assert (oldest.position_age_s, oldest.heartbeat_age_s) == (10.0, 60.0)
    named = parse_policy('[bridge]\nparameters = "refuse"\nparameters_allowed = ["X"]', "my.toml")
    assert named.bridge.parameters_allowed == ("X",)
