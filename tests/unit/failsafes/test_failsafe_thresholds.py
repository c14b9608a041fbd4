"""When a failsafe strikes and what it does: the autopilots' own numbers, on both sides of each.

Asked of the checks themselves, without a flight.  PX4's are those of its parameter reference and of
failsafe.cpp, ArduCopter's of its parameter list, events.cpp, fence.cpp, ekf_check.cpp and
AP_BattMonitor.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.unit.failsafes.failsafe_inputs import (
    CHARGES,
    FULL,
    LOW_V,
    MS,
    VOLTAGES,
    Look,
    S,
    acts,
    clears,
    delays,
    parameters_of,
    warns,
)
from vehicle_sim.autopilot.failsafes.failsafe import (
    Action,
    Cause,
    Charge,
    by_capacity,
    by_voltage,
    charge_of,
)
from vehicle_sim.autopilot.fence.geofence import BreachKind, Crossing
from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import Personality

CIRCLE = BreachKind.CIRCLE
NONE = BreachKind.NONE

# --------------------------------------------------------------------------- ground station


@pytest.mark.parametrize(
    ("personality", "action", "silent_s"),
    [("px4", "NAV_DLL_ACT", 10), ("ardupilot", "FS_GCS_ENABLE", 5)],
)
def test_a_station_is_lost_after_com_dl_loss_t_and_fs_gcs_timeout(
    personality: Personality, action: str, silent_s: int
) -> None:
    look = Look(personality, {action: 1})
    look.checks.station_heard(look.seen.wall_ns)
    assert not acts(look.sees(), Cause.STATION)
    assert not acts(look.after(silent_s * S - 1), Cause.STATION)
    assert acts(look.after(1), Cause.STATION)
    assert look.station_lost()
    assert not acts(look.after(1), Cause.STATION), "once"
    assert look.checks.station_heard(look.seen.wall_ns) == look.checks.back_again
    assert look.checks.station_heard(look.seen.wall_ns) is None
    assert not look.station_lost()
    assert not acts(look.after(silent_s * S - 1), Cause.STATION)
    assert acts(look.after(1), Cause.STATION)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_a_station_that_was_never_heard_is_not_lost(personality: Personality) -> None:
    look = Look(personality, {"NAV_DLL_ACT" if personality == "px4" else "FS_GCS_ENABLE": 1})
    assert not acts(look.after(1000 * S), Cause.STATION)


@pytest.mark.parametrize(
    ("value", "action"),
    [(1, Action.HOLD), (2, Action.RETURN), (3, Action.LAND), (5, Action.TERMINATE),
     (6, Action.DISARM)],
)  # fmt: skip
def test_px4_does_what_nav_dll_act_and_nav_rcl_act_say(value: int, action: Action) -> None:
    look = Look("px4", {"NAV_DLL_ACT": value, "NAV_RCL_ACT": value})
    look.checks.station_heard(look.seen.wall_ns)
    look.sees()
    struck = look.after(10 * S, sticks_lost=True)
    assert acts(struck, Cause.STATION) == [action]
    assert acts(struck, Cause.STICKS) == [action]
    assert delays(struck, Cause.STATION) == delays(struck, Cause.STICKS) == [True]


def test_px4_only_tells_of_a_lost_station_by_default_and_goes_on_landing() -> None:
    look = Look("px4")
    look.checks.station_heard(look.seen.wall_ns)
    struck = look.after(10 * S)
    assert warns(struck, Cause.STATION)
    assert not acts(struck, Cause.STATION)
    landing = Look("px4", {"NAV_DLL_ACT": 2})
    landing.checks.station_heard(landing.seen.wall_ns)
    assert not acts(landing.after(10 * S, mode=landing.modes["AUTO.LAND"]), Cause.STATION)


@pytest.mark.parametrize(
    ("value", "of_station", "of_sticks"),
    [
        (0, [], []),
        (1, [Action.RETURN], [Action.RETURN]),
        (2, [], [Action.RETURN]),
        (3, [Action.RETURN], [Action.LAND]),
        (4, [Action.LAND], [Action.RETURN]),
        (5, [Action.LAND], [Action.LAND]),
        (6, [Action.RETURN], [Action.RETURN]),
        (7, [Action.BRAKE], [Action.BRAKE]),
    ],
)
def test_ardupilot_does_what_fs_gcs_enable_and_fs_thr_enable_say(
    value: int, of_station: list[Action], of_sticks: list[Action]
) -> None:
    look = Look("ardupilot")
    if value != 2:  # 2 of FS_GCS_ENABLE is an old one, which 4.x has taken out
        look.parameters.set("FS_GCS_ENABLE", value)
    look.parameters.set("FS_THR_ENABLE", value)
    look.checks.station_heard(look.seen.wall_ns)
    struck = look.after(5 * S, sticks_lost=True)
    assert acts(struck, Cause.STATION) == of_station
    assert acts(struck, Cause.STICKS) == of_sticks
    assert clears(look.after(MS, sticks_lost=False), Cause.STICKS) == bool(of_sticks)


@pytest.mark.parametrize("value", [0, 1])
def test_disarmed_a_lost_station_is_told_once(value: int) -> None:
    for personality, name, told in (
        ("px4", "NAV_DLL_ACT", 1 + value),
        ("ardupilot", "FS_GCS_ENABLE", value),
    ):
        look = Look(personality, {name: value})  # type: ignore[arg-type]  # one of the two
        wall_ns = look.seen.wall_ns
        look.checks.station_heard(wall_ns)
        silent_ns = 10 * S if personality == "px4" else 5 * S
        assert not list(look.checks.check_disarmed(wall_ns + silent_ns - 1, FULL, 1.0))
        assert len(list(look.checks.check_disarmed(wall_ns + silent_ns, FULL, 1.0))) == told
        assert not list(look.checks.check_disarmed(wall_ns + silent_ns + S, FULL, 1.0))


# ----------------------------------------------------------------------------------- sticks


@pytest.mark.parametrize(
    ("mode", "bit"),
    [("AUTO.MISSION", 1), ("AUTO.LOITER", 2), ("AUTO.RTL", 2), ("OFFBOARD", 4)],
)
@pytest.mark.parametrize("excepted", [0, 1, 2, 4, 7])
def test_com_rcl_except_excepts_missions_other_auto_modes_and_offboard(
    mode: str, bit: int, excepted: int
) -> None:
    look = Look("px4", {"COM_RCL_EXCEPT": excepted})
    look.sees(mode=look.modes[mode])
    assert bool(acts(look.sees(sticks_lost=True), Cause.STICKS)) != bool(excepted & bit)


def test_com_rcl_except_excepts_no_mode_that_is_flown_by_hand() -> None:
    look = Look("px4", {"COM_RCL_EXCEPT": 7})
    look.sees(mode=look.modes["POSCTL"])
    assert acts(look.sees(sticks_lost=True), Cause.STICKS) == [Action.RETURN]
    assert not acts(look.sees(), Cause.STICKS), "once"
    look.sees(sticks_lost=False)
    assert acts(look.sees(sticks_lost=True), Cause.STICKS) == [Action.RETURN]


def test_px4_that_was_armed_without_sticks_does_not_miss_them() -> None:
    look = Look("px4")
    assert not acts(look.sees(sticks_lost=True), Cause.STICKS)
    assert not acts(look.after(S), Cause.STICKS)
    look.sees(sticks_lost=False)
    assert acts(look.sees(sticks_lost=True), Cause.STICKS) == [Action.RETURN]


@pytest.mark.parametrize(
    ("mode", "cause", "bit"),
    [("AUTO", Cause.STICKS, 1), ("AUTO", Cause.STATION, 2), ("GUIDED", Cause.STICKS, 4),
     ("LAND", Cause.STICKS, 8), ("LAND", Cause.STATION, 8), ("ALT_HOLD", Cause.STATION, 16),
     ("LOITER", Cause.STATION, 16), ("LOITER", Cause.STICKS, 0), ("GUIDED", Cause.STATION, 0)],
)  # fmt: skip
@pytest.mark.parametrize("options", [0, 1, 2, 4, 8, 16])
def test_ardupilot_goes_on_where_fs_options_say_so(
    mode: str, cause: Cause, bit: int, options: int
) -> None:
    look = Look("ardupilot", {"FS_GCS_ENABLE": 1, "FS_OPTIONS": options})
    look.checks.station_heard(look.seen.wall_ns)
    struck = look.after(5 * S, sticks_lost=True, mode=look.modes[mode])
    assert bool(acts(struck, cause)) != bool(options & bit)


def test_ardupilot_disarms_on_the_ground() -> None:
    look = Look("ardupilot")
    assert acts(look.sees(sticks_lost=True, flying=False), Cause.STICKS) == [Action.DISARM]


# ---------------------------------------------------------------------------------- battery


@pytest.mark.parametrize(
    ("remaining", "charge"),
    [(0.151, Charge.FINE), (0.15, Charge.FINE), (0.149, Charge.LOW), (0.07, Charge.LOW),
     (0.069, Charge.CRITICAL), (0.05, Charge.CRITICAL), (0.049, Charge.EMERGENCY)],
)  # fmt: skip
def test_px4s_battery_is_low_below_15_critical_below_7_and_an_emergency_below_5_percent(
    remaining: float, charge: Charge
) -> None:
    """BAT_LOW_THR, BAT_CRIT_THR, BAT_EMERGEN_THR; Battery::determineWarning asks for less than."""
    parameters = parameters_of("px4")
    near = charge_of(parameters, FULL, remaining)
    exact = {0.15: "BAT_LOW_THR", 0.07: "BAT_CRIT_THR", 0.05: "BAT_EMERGEN_THR"}.get(remaining)
    assert (near if exact is None else charge_of(parameters, FULL, parameters.get(exact))) is charge


@pytest.mark.parametrize(
    ("value", "critical", "emergency"),
    [(0, [], []), (1, [Action.RETURN], [Action.RETURN]), (2, [Action.LAND], [Action.LAND]),
     (3, [Action.RETURN], [Action.LAND])],
)  # fmt: skip
def test_px4_does_what_com_low_bat_act_says(
    value: int, critical: list[Action], emergency: list[Action]
) -> None:
    look = Look("px4", {"COM_LOW_BAT_ACT": value})
    look.sees()
    low = look.sees(remaining=0.14)
    assert warns(low, Cause.BATTERY)
    assert not acts(low, Cause.BATTERY)
    assert not look.sees(), "once"
    struck = look.sees(remaining=0.06)
    assert acts(struck, Cause.BATTERY) == critical
    assert all(delays(struck, Cause.BATTERY))
    assert not look.sees(remaining=0.14), "nor when it recovers"
    assert acts(look.sees(remaining=0.04), Cause.BATTERY) == emergency


def test_px4_that_is_armed_with_a_low_battery_tells_it_and_acts_on_what_is_worse() -> None:
    look = Look("px4", {"COM_LOW_BAT_ACT": 2})
    assert warns(look.sees(remaining=0.06), Cause.BATTERY)
    assert not look.sees(remaining=0.06)
    assert acts(look.sees(remaining=0.04), Cause.BATTERY) == [Action.LAND]


def test_px4_disarmed_tells_each_time_that_its_battery_becomes_low() -> None:
    look = Look("px4")

    def told(remaining: float) -> int:
        return len(list(look.checks.check_disarmed(look.seen.wall_ns, FULL, remaining)))

    assert [told(part) for part in (0.2, 0.14, 0.13, 0.2, 0.14)] == [0, 1, 0, 0, 1]


@pytest.mark.parametrize(
    ("volts", "charge"),
    [(14.0, Charge.FINE), (13.9, Charge.LOW), (13.0, Charge.LOW), (12.9, Charge.CRITICAL)],
)
def test_ardupilots_thresholds_of_the_voltage(volts: float, charge: Charge) -> None:
    power = replace(FULL, voltage_v=volts)
    assert by_voltage(parameters_of("ardupilot", VOLTAGES), power) is charge
    unmeasured = parameters_of("ardupilot", VOLTAGES | {"BATT_MONITOR": 0})
    assert by_voltage(unmeasured, power) is Charge.FINE


@pytest.mark.parametrize(
    ("used_mah", "charge"),
    [(4000.0, Charge.FINE), (4001.0, Charge.LOW), (4600.0, Charge.LOW), (4601.0, Charge.CRITICAL)],
)
def test_ardupilots_thresholds_of_the_charge(used_mah: float, charge: Charge) -> None:
    power = Power(16.0, 10.0, used_mah, 50)
    assert by_capacity(parameters_of("ardupilot", CHARGES), power) is charge
    unmeasured = parameters_of("ardupilot", CHARGES | {"BATT_MONITOR": 0})
    assert by_capacity(unmeasured, power) is Charge.FINE
    assert charge_of(parameters_of("ardupilot", CHARGES), power, 1.0) is charge


def test_ardupilots_low_voltage_counts_after_batt_low_timer() -> None:
    """10 s by default, in which it must stay low."""
    look = Look("ardupilot", VOLTAGES | {"BATT_FS_LOW_ACT": 2, "BATT_FS_CRT_ACT": 1})
    assert not look.sees(power=LOW_V)
    assert not look.after(10 * S - 1)
    assert acts(look.after(1), Cause.BATTERY) == [Action.RETURN]
    assert look.checks.battery_failed
    assert not look.after(20 * S), "once"
    assert not look.sees(power=replace(FULL, voltage_v=12.9))
    assert not look.after(10 * S - 1)
    assert acts(look.after(1), Cause.BATTERY) == [Action.LAND]


def test_ardupilots_low_voltage_begins_anew_when_it_was_good_meanwhile() -> None:
    look = Look("ardupilot", VOLTAGES | {"BATT_FS_LOW_ACT": 2})
    look.sees(power=LOW_V)
    look.after(9 * S, power=FULL)
    assert not look.after(S, power=LOW_V)
    assert not look.after(10 * S - 1)
    assert acts(look.after(1), Cause.BATTERY) == [Action.RETURN]
    look.checks.reset()
    assert look.checks.battery_failed, "until the next start"
    look.checks.restart()
    assert not look.checks.battery_failed


@pytest.mark.parametrize(
    ("value", "action"),
    [(0, []), (1, [Action.LAND]), (2, [Action.RETURN]), (3, [Action.RETURN]), (4, [Action.LAND]),
     (5, [Action.TERMINATE]), (6, [Action.RETURN]), (7, [Action.BRAKE])],
)  # fmt: skip
@pytest.mark.parametrize(
    ("name", "used_mah"), [("BATT_FS_LOW_ACT", 4500.0), ("BATT_FS_CRT_ACT", 4700.0)]
)
def test_ardupilot_does_what_batt_fs_low_act_and_batt_fs_crt_act_say(
    name: str, used_mah: float, value: int, action: list[Action]
) -> None:
    look = Look("ardupilot", CHARGES | {name: value})
    struck = look.sees(power=replace(FULL, consumed_mah=used_mah))
    assert warns(struck, Cause.BATTERY)
    assert acts(struck, Cause.BATTERY) == action


# ------------------------------------------------------------------------------------ fence


@pytest.mark.parametrize(
    ("value", "action", "delayed"),
    [(0, [], []), (1, [], []), (2, [Action.HOLD], [False]), (3, [Action.RETURN], [True]),
     (4, [Action.TERMINATE], [True]), (5, [Action.LAND], [True])],
)  # fmt: skip
def test_px4_does_what_gf_action_says(
    value: int, action: list[Action], delayed: list[bool]
) -> None:
    look = Look("px4", {"GF_ACTION": value})
    struck = look.sees(crossing=Crossing(CIRCLE, NONE, 1.0))
    assert acts(struck, Cause.FENCE) == action
    assert delays(struck, Cause.FENCE) == delayed
    assert warns(struck, Cause.FENCE) == (value != 0)
    cleared = look.sees(crossing=Crossing(NONE, CIRCLE, 0.0))
    assert clears(cleared, Cause.FENCE)
    assert not acts(cleared, Cause.FENCE)


@pytest.mark.parametrize(
    ("value", "action"),
    [(0, []), (1, [Action.RETURN]), (2, [Action.LAND]), (3, [Action.RETURN]), (4, [Action.BRAKE]),
     (5, [Action.LAND])],
)  # fmt: skip
def test_ardupilot_does_what_fence_action_says(value: int, action: list[Action]) -> None:
    look = Look("ardupilot", {"FENCE_ACTION": value})
    assert acts(look.sees(crossing=Crossing(CIRCLE, NONE, 1.0)), Cause.FENCE) == action
    assert clears(look.sees(crossing=Crossing(NONE, CIRCLE, 0.0)), Cause.FENCE)
    on_ground = look.sees(crossing=Crossing(CIRCLE, NONE, 1.0), flying=False)
    assert acts(on_ground, Cause.FENCE) == ([Action.DISARM] if value else [])


def test_ardupilot_lands_more_than_100_m_outside() -> None:
    """AC_FENCE_GIVE_UP_DISTANCE."""
    look = Look("ardupilot", {"FENCE_ACTION": 1})
    assert acts(look.sees(crossing=Crossing(CIRCLE, NONE, 100.0)), Cause.FENCE) == [Action.RETURN]
    assert acts(look.sees(crossing=Crossing(CIRCLE, NONE, 100.1)), Cause.FENCE) == [Action.LAND]
