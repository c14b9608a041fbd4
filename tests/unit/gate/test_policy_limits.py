"""The least and the largest value of each number of a policy: the limit passes, beyond it does not.

Each policy that passes is used as the gate uses it, which shows that the value arrived.
"""

from __future__ import annotations

import pytest

from gcs.gate.airspace.stopping import distance_h_m, distance_v_m
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.step_context import StepContext
from gcs.gate.policy.parse import parse_policy
from gcs.gate.policy.policy import Approach, Braking, Pace, Policy
from gcs.gate.policy.zonespec import CircleSpec, ZoneSpec
from gcs.gate.states import State
from gcs.toml import TomlError
from tests.unit.gate.script import Script

MOST = 100_000
"""Metres, seconds, metres per second: no number is larger."""


def error(text: str) -> TomlError:
    with pytest.raises(TomlError) as caught:
        parse_policy(text, "my.toml")
    return caught.value


def value(policy: Policy, key: str) -> object:
    found: object = policy
    for part in key.split("."):
        found = getattr(found, part)
    return found


@pytest.mark.parametrize(
    ("key", "least", "below"),
    [
        ("max_distance_m", 0.0, -0.001),
        ("mission_wind_m_s", 0.0, -0.001),
        ("creep_m", 0.0, -0.001),
        ("stale_grace_s", 0.0, -0.001),
        ("arrival.dwell_s", 0.0, -0.001),
        ("arrival.radius_m", 0.01, 0.009),
        ("arrival.speed_m_s", 0.01, 0.009),
        ("arrival.yaw_deg", 1.0, 0.99),
        ("speeds.cruise_m_s", 0.01, 0.009),
        ("speeds.climb_m_s", 0.01, 0.009),
        ("speeds.descend_m_s", 0.01, 0.009),
        ("speeds.turn_deg_s", 1.0, 0.99),
        ("position_age_s", 0.05, 0.049),
        ("takeoff.max_up_m", 0.1, 0.09),
        ("deadline_min_s", 0.1, 0.09),
        ("stream.good_again_s", 0.0, -0.001),
        ("stream.position_age_s", 0.1, 0.09),
        ("stream.deadman_s", 0.1, 0.09),
        ("stream.max_speed_h_m_s", 0.0, -0.001),
        ("stream.max_speed_up_m_s", 0.0, -0.001),
        ("stream.max_speed_down_m_s", 0.0, -0.001),
        ("stream.max_a_m_s2", 0.0, -0.001),
        ("stream.max_yaw_rate_deg_s", 0.0, -0.001),
        ("stream.stick_speed_h_m_s", 0.0, -0.001),
        ("stream.stick_speed_up_m_s", 0.0, -0.001),
        ("stream.stick_speed_down_m_s", 0.0, -0.001),
        ("stream.stick_yaw_rate_deg_s", 0.0, -0.001),
        ("stream.stick_dead_band", 0.0, -0.001),
        ("photo_timeout_s", 0.1, 0.09),
        ("heartbeat_age_s", 1.0, 0.99),
        ("jump_speed_m_s", 1.0, 0.99),
        ("deadline_factor", 1.0, 0.99),
        ("takeoff.timeout_s", 1.0, 0.99),
        ("arm_timeout_s", 1.0, 0.99),
        ("land_timeout_s", 1.0, 0.99),
    ],
)
def test_the_least_value(key: str, least: float, below: float) -> None:
    assert value(parse_policy(f"{key} = {least}", "my.toml"), key) == least
    assert error(f"{key} = {below}").key == key


@pytest.mark.parametrize(
    "key",
    [
        "max_up_m",
        "max_distance_m",
        "mission_wind_m_s",
        "creep_m",
        "arrival.radius_m",
        "arrival.max_radius_m",
        "arrival.dwell_s",
        "speeds.cruise_m_s",
        "stale_grace_s",
        "jump_speed_m_s",
        "deadline_factor",
        "deadline_min_s",
        "takeoff.timeout_s",
        "control.timeout_s",
        "braking.px4.position_error_h_m",
    ],
)
def test_no_number_is_larger_than_a_hundred_thousand(key: str) -> None:
    parse_policy(f"{key} = {MOST}", "my.toml")
    assert error(f"{key} = {MOST + 1}").key == key


@pytest.mark.parametrize(
    ("key", "most"), [("separation.within_s", 60.0), ("arrival.yaw_deg", 180.0)]
)
def test_the_greatest_value(key: str, most: float) -> None:
    assert value(parse_policy(f"{key} = {most}", "my.toml"), key) == most
    assert error(f"{key} = {most + 0.001}").key == key


def test_an_arrival_s_radius_grows_to_a_hundredth_of_a_metre_at_least() -> None:
    policy = parse_policy("arrival.radius_m = 0.01\narrival.max_radius_m = 0.01", "my.toml")
    assert (policy.arrival.radius_m, policy.arrival.max_radius_m) == (0.01, 0.01)
    found = error("arrival.radius_m = 0.01\narrival.max_radius_m = 0.009")
    assert found.key == "arrival.max_radius_m"
    assert "impossible" in found.what


def test_control_waits_a_tenth_of_a_second_at_least() -> None:
    policy = parse_policy("control.stream_s = 0.0\ncontrol.timeout_s = 0.1", "my.toml")
    assert (policy.control.stream_s, policy.control.timeout_s) == (0.0, 0.1)
    assert error("control.stream_s = 0.0\ncontrol.timeout_s = 0.09").key == "control.timeout_s"


class TestInUse:
    def test_a_position_may_be_asked_to_be_as_young_as_a_twentieth_of_a_second(self) -> None:
        policy = parse_policy("position_age_s = 0.05", "my.toml")
        memory = Memory("px4", pos_ns=0)
        assert not StepContext(policy, memory, SECOND_NS // 20).stale
        assert StepContext(policy, memory, SECOND_NS // 20 + 1).stale

    def test_a_vehicle_may_be_missed_after_a_second(self) -> None:
        script = Script(parse_policy("heartbeat_age_s = 1.0", "my.toml")).connect()
        script.reports_heartbeat = script.reports_position = False
        script.wait(2.5)
        assert script.gate.state is State.NO_VEHICLE

    @pytest.mark.parametrize(
        ("key", "least", "most", "below", "above"),
        [
            ("react_s", 0.0, 10.0, -0.01, 10.5),
            ("a_brake_h_m_s2", 0.1, 50.0, 0.09, 50.5),
            ("a_brake_v_m_s2", 0.1, 50.0, 0.09, 50.5),
            ("position_error_h_m", 0.0, MOST, -0.01, MOST + 1),
            ("position_error_v_m", 0.0, MOST, -0.01, MOST + 1),
        ],
    )
    def test_braking(self, key: str, least: float, most: float, below: float, above: float) -> None:
        """At 1 m/s, beside and above: v react + v^2 / (2 a_brake) + position error."""
        for limit in (least, most):
            policy = parse_policy(f"[braking.px4]\n{key} = {limit}", "my.toml")
            b = policy.braking_of("px4")
            assert getattr(b, key) == limit
            beside_m = b.react_s + 0.5 / b.a_brake_h_m_s2 + b.position_error_h_m
            above_m = b.react_s + 0.5 / b.a_brake_v_m_s2 + b.position_error_v_m
            assert distance_h_m((1.0, 0.0, 0.0), b, 0.0) == pytest.approx(beside_m)
            assert distance_v_m((0.0, 0.0, 1.0), b, 0.0) == pytest.approx(above_m)
        for beyond in (below, above):
            assert error(f"[braking.px4]\n{key} = {beyond}").key == f"braking.px4.{key}"


@pytest.mark.parametrize(
    ("key", "least", "most", "below", "above"),
    [
        ("react_s", 0.0, 10.0, -0.01, 10.5),
        ("a_brake_h_m_s2", 0.1, 50.0, 0.09, 50.5),
        ("a_brake_v_m_s2", 0.1, 50.0, 0.09, 50.5),
    ],
)
def test_approach(key: str, least: float, most: float, below: float, above: float) -> None:
    for limit in (least, most):
        policy = parse_policy(f"[approach.px4]\n{key} = {limit}", "my.toml")
        assert getattr(policy.approach_of("px4"), key) == limit
    for beyond in (below, above):
        assert error(f"[approach.px4]\n{key} = {beyond}").key == f"approach.px4.{key}"


def test_another_autopilot_approaches_with_the_worst_of_each_number() -> None:
    """Neither of the two is the worse one throughout."""
    policy = parse_policy(
        """
        [approach.px4]
        react_s = 0.2
        a_brake_h_m_s2 = 5.0
        a_brake_v_m_s2 = 2.0
        [approach.ardupilot]
        react_s = 0.4
        a_brake_h_m_s2 = 4.0
        a_brake_v_m_s2 = 3.0
        """,
        "my.toml",
    )
    assert policy.approach_of("betaflight") == Approach(0.4, 4.0, 2.0)


@pytest.mark.parametrize(
    ("key", "least", "most", "below", "above"),
    [
        ("most_m_s", 0.1, MOST, 0.09, MOST + 1),
        ("near_m_s", 0.1, MOST, 0.09, MOST + 1),
        ("gain_m_s", 0.1, MOST, 0.09, MOST + 1),
        ("end_m_s2", 0.1, 50.0, 0.09, 50.5),
        ("lag_s", 0.0, 10.0, -0.01, 10.5),
        ("follow_per_s", 0.05, 10.0, 0.04, 10.5),
        ("follow_m_s2", 0.1, 50.0, 0.09, 50.5),
        ("past_m", 0.0, 100.0, -0.01, 100.5),
        ("back_m_s", 0.0, 10.0, -0.01, 10.5),
    ],
)
@pytest.mark.parametrize("axis", ["level", "vertical"])
def test_pace(axis: str, key: str, least: float, most: float, below: float, above: float) -> None:
    for limit in (least, most):
        policy = parse_policy(f"[pace.px4.{axis}]\n{key} = {limit}", "my.toml")
        assert getattr(getattr(policy.pace_of("px4"), axis), key) == limit
    for beyond in (below, above):
        assert error(f"[pace.px4.{axis}]\n{key} = {beyond}").key == f"pace.px4.{axis}.{key}"


def test_another_autopilot_is_paced_by_the_slowest_of_each_number() -> None:
    """At the same speed a position is nearer to the one that follows faster."""
    level = {
        "px4": (5.0, 2.0, 3.0, 1.0, 0.2, 0.9, 4.0, 6.0, 2.0),
        "ardupilot": (4.0, 4.0, 6.0, 2.0, 0.7, 0.5, 8.0, 3.0, 1.0),
    }
    first = ("most_m_s", "near_m_s", "gain_m_s", "end_m_s2", "lag_s")
    names = (*first, "follow_per_s", "follow_m_s2", "past_m", "back_m_s")
    lines = "".join(
        f"[pace.{autopilot}.level]\n"
        + "".join(f"{name} = {x}\n" for name, x in zip(names, numbers, strict=True))
        for autopilot, numbers in level.items()
    )
    policy = parse_policy(lines, "my.toml")
    assert policy.pace_of("betaflight").level == Pace(4.0, 2.0, 3.0, 1.0, 0.7, 0.9, 8.0, 6.0, 1.0)


def test_another_autopilot_brakes_with_the_worst_of_each_number() -> None:
    """Neither of the two is the worse one throughout."""
    policy = parse_policy(
        """
        [braking.px4]
        react_s = 0.2
        a_brake_h_m_s2 = 5.0
        a_brake_v_m_s2 = 2.0
        position_error_h_m = 0.5
        position_error_v_m = 0.1
        [braking.ardupilot]
        react_s = 0.4
        a_brake_h_m_s2 = 4.0
        a_brake_v_m_s2 = 3.0
        position_error_h_m = 0.3
        position_error_v_m = 0.2
        """,
        "my.toml",
    )
    assert policy.braking_of("betaflight") == Braking(0.4, 4.0, 2.0, 0.5, 0.2)


# -------------------------------------------------------------------------------- zones


def zone(keys: str) -> ZoneSpec:
    """The second zone of a policy, an exclusion zone with these keys."""
    first = '[[fence]]\nname = "a"\nradius_m = 50\n'
    second = f'[[fence]]\nname = "b"\ninclusion = false\n{keys}'
    _, spec = parse_policy(first + second, "my.toml").fence
    return spec


def circle(radius_m: float = 5.0, centre: str = "[0, 0]", more: str = "") -> ZoneSpec:
    return zone(f"radius_m = {radius_m}\ncentre = {centre}\n{more}")


def test_a_circle_is_about_home_where_it_says_nothing_else() -> None:
    assert zone("radius_m = 5") == CircleSpec(5.0, (0.0, 0.0), name="b", inclusion=False)
    assert CircleSpec(5.0, name="b").centre == (0.0, 0.0)


class TestZones:
    @pytest.mark.parametrize(("limit", "beyond"), [(0.01, 0.009), (100_000.0, 100_001.0)])
    def test_the_radius_of_a_circle(self, limit: float, beyond: float) -> None:
        spec = circle(limit)
        assert isinstance(spec, CircleSpec)
        assert spec.radius_m == limit
        with pytest.raises(TomlError, match="radius_m"):
            circle(beyond)

    @pytest.mark.parametrize("key", ["floor_up_m", "ceiling_up_m"])
    @pytest.mark.parametrize(("limit", "beyond"), [(-10_000, -10_001), (100_000, 100_001)])
    def test_heights(self, key: str, limit: float, beyond: float) -> None:
        assert getattr(circle(more=f"{key} = {limit}"), key) == limit
        with pytest.raises(TomlError, match=key):
            circle(more=f"{key} = {beyond}")

    @pytest.mark.parametrize("sign", [1, -1])
    def test_places(self, sign: int) -> None:
        spec = circle(centre=f"[0, {sign * 1_000_000}]")
        assert isinstance(spec, CircleSpec)
        assert spec.centre == (0.0, sign * 1.0e6)
        with pytest.raises(TomlError, match="centre"):
            circle(centre=f"[0, {sign * 1_000_001}]")

    @pytest.mark.parametrize("sign", [1, -1])
    def test_degrees_end_at_the_poles_and_at_the_date_line(self, sign: int) -> None:
        geographic = 'frame = "geographic"'
        spec = circle(centre=f"[{sign * 90}, {sign * 180}]", more=geographic)
        assert isinstance(spec, CircleSpec)
        assert spec.centre == (sign * 90.0, sign * 180.0)
        for nowhere in (f"[{sign * 90.01}, 8]", f"[47, {sign * 180.01}]"):
            with pytest.raises(TomlError, match="is nowhere"):
                circle(centre=nowhere, more=geographic)

    @pytest.mark.parametrize("key", ["east_m", "north_m"])
    def test_a_box_of_no_width_is_empty(self, key: str) -> None:
        other = "north_m" if key == "east_m" else "east_m"
        with pytest.raises(TomlError, match="is empty"):
            zone(f'kind = "box"\n{key} = [5, 5]\n{other} = [0, 9]')


class TestRoom:
    """The default's margins are 2 m beside and 0.3 m above."""

    @pytest.mark.parametrize("key", ["east_m", "north_m"])
    @pytest.mark.parametrize(("width_m", "room"), [(3.75, False), (4.0, False), (4.25, True)])
    def test_a_box_is_wider_than_both_its_margins(
        self, key: str, width_m: float, room: bool
    ) -> None:
        other = "north_m" if key == "east_m" else "east_m"
        text = f'[[fence]]\nname = "a"\nkind = "box"\n{key} = [-1, {width_m - 1}]\n{other} = [0, 9]'
        if room:
            assert parse_policy(text, "my.toml").fence[0].name == "a"
        else:
            assert "leaves nothing of this zone" in error(text).what

    @pytest.mark.parametrize(("height_m", "room"), [(0.5, False), (1.0, False), (1.25, True)])
    def test_a_zone_is_higher_than_both_its_margins(self, height_m: float, room: bool) -> None:
        text = (
            "margin_v_m = 0.5\n"
            f'[[fence]]\nname = "a"\nradius_m = 9\nfloor_up_m = 5\nceiling_up_m = {5 + height_m}'
        )
        if room:
            assert parse_policy(text, "my.toml").margin_v_m == 0.5
        else:
            assert "leaves nothing below this ceiling" in error(text).what


# ------------------------------------------------------------------------------ the file


@pytest.mark.parametrize("fence", ["5", '"yard"', "[5]", '["yard"]'])
def test_a_fence_that_is_no_list_of_tables(fence: str) -> None:
    found = error(f"fence = {fence}")
    assert (found.line, found.key) == (1, "fence")
    assert "list of tables" in found.what


def test_the_highest_take_off_may_be_the_highest_place() -> None:
    policy = parse_policy("max_up_m = 20\n[takeoff]\nmax_up_m = 20", "my.toml")
    assert policy.takeoff.max_up_m == policy.max_up_m == 20.0


class TestNamesOfFenceFiles:
    """A file is called by its name where it has one, else by its path."""

    def parse(self, *files: str) -> Policy:
        text = "".join(f'[[fence]]\nkind = "file"\n{keys}\n' for keys in files)
        return parse_policy(text, "my.toml", lambda path: (CircleSpec(50.0, name=path),))

    def test_two_files_without_a_name_are_two_files(self) -> None:
        policy = self.parse('path = "yard.plan"', 'path = "field.plan"')
        assert [spec.name for spec in policy.fence] == ["yard.plan", "field.plan"]

    def test_the_same_file_twice_is_a_mistake(self) -> None:
        with pytest.raises(TomlError, match=r'two zones are called "yard\.plan"'):
            self.parse('path = "yard.plan"', 'path = "yard.plan"')

    def test_the_same_name_twice_is_a_mistake(self) -> None:
        with pytest.raises(TomlError, match='two zones are called "y"'):
            self.parse('path = "yard.plan"\nname = "y"', 'path = "field.plan"\nname = "y"')


class TestStream:
    def test_it_is_over_no_sooner_than_a_sample_counts_no_more(self) -> None:
        policy = parse_policy("stream.deadman_s = 0.1\nstream.ends_after_s = 0.1", "my.toml")
        assert policy.stream.ends_after_s == policy.stream.deadman_s == 0.1
        wrong = error("stream.deadman_s = 1.0\nstream.ends_after_s = 0.9")
        assert (wrong.key, wrong.line) == ("stream.ends_after_s", 2)
        assert "0.9 is less than deadman_s of 1" in str(wrong)

    def test_a_position_for_a_sample_is_no_older_than_any(self) -> None:
        policy = parse_policy("position_age_s = 0.4\nstream.position_age_s = 0.4", "my.toml")
        assert policy.stream.position_age_s == 0.4
        wrong = error("position_age_s = 0.4\nstream.position_age_s = 0.45")
        assert wrong.key == "stream.position_age_s"
        assert "0.45 is more than position_age_s of 0.4" in str(wrong)

    @pytest.mark.parametrize("key", ["speed_h_m_s", "speed_up_m_s", "speed_down_m_s"])
    def test_no_stick_asks_for_more_than_a_stream_may(self, key: str) -> None:
        text = f"stream.max_{key} = 0.5"
        assert parse_policy(text, "my.toml").stream.deadman_s == 0.5, "a default stick is cut"
        parse_policy(f"{text}\nstream.stick_{key} = 0.5", "my.toml")
        wrong = error(f"{text}\nstream.stick_{key} = 0.6")
        assert (wrong.key, wrong.line) == (f"stream.stick_{key}", 2)
        assert f"0.6 is more than max_{key} of 0.5" in str(wrong)

    def test_a_dead_band_leaves_some_of_the_stick(self) -> None:
        assert parse_policy("stream.stick_dead_band = 0.9", "my.toml").stream.stick_dead_band == 0.9
        assert error("stream.stick_dead_band = 0.91").key == "stream.stick_dead_band"

    @pytest.mark.parametrize("value", ["nan", "inf", "1e6", '"fast"'])
    def test_a_speed_is_a_number(self, value: str) -> None:
        assert error(f"stream.max_speed_h_m_s = {value}").key == "stream.max_speed_h_m_s"

    def test_a_key_that_there_is_not(self) -> None:
        assert error("stream.max_speed = 3").key == "stream.max_speed"
