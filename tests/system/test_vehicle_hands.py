"""MAVSDK orbits, follows and flies by hand without a word of ours."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import pytest

from tests.system.patience import PATIENT_S, until
from tests.system.vehicle_program import free_port, vehicle_sim

mavsdk = pytest.importorskip("mavsdk")

from mavsdk.plugins.action import Action, OrbitYawBehavior  # noqa: E402
from mavsdk.plugins.follow_me import Config, FollowMe, TargetLocation  # noqa: E402
from mavsdk.plugins.manual_control import ManualControl  # noqa: E402
from mavsdk.plugins.telemetry import FlightMode, Telemetry  # noqa: E402

pytestmark = pytest.mark.system


PATIENT = ("--param", "COM_RC_LOSS_T=35")
"""Sticks that the machine stops for a second are not lost."""


@contextmanager
def flying() -> Iterator[tuple[object, Telemetry, Action]]:
    """A px4 in HOLD, up to NAV_MC_ALT_RAD below 2.5 m; four times as fast as life."""
    port = free_port()
    with vehicle_sim("--speedup", "4", *PATIENT, "--link", f"udpout://127.0.0.1:{port}") as lines:
        station = mavsdk.Configuration.create_with_component_type(
            mavsdk.ComponentType.GROUND_STATION
        )
        with mavsdk.Mavsdk(station) as sdk:
            sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
            system = sdk.first_autopilot(PATIENT_S)
            assert system is not None, lines
            telemetry, action = Telemetry(system), Action(system)
            until(telemetry.health_all_ok, "health all ok")
            until(lambda: math.isfinite(telemetry.home().latitude_deg), "home")
            action.arm()
            until(telemetry.armed, "armed")
            action.takeoff()
            until(lambda: telemetry.position().relative_altitude_m > 1.5, "1.5 m up")
            until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "taken off")
            yield system, telemetry, action


def test_mavsdk_orbits_round_where_it_took_off() -> None:
    with flying() as (_, telemetry, action):
        home = telemetry.home()
        height_m = home.absolute_altitude_m + 5.0
        action.do_orbit(
            8.0,
            3.0,
            OrbitYawBehavior.HOLD_FRONT_TO_CIRCLE_CENTER,
            home.latitude_deg,
            home.longitude_deg,
            height_m,
        )

        def bearing_deg() -> float:
            here = telemetry.position_velocity_ned().position
            return math.degrees(math.atan2(here.east_m, here.north_m)) % 360.0

        def on_circle() -> bool:
            here = telemetry.position_velocity_ned().position
            away_m = math.hypot(here.north_m, here.east_m)
            return abs(away_m - 8.0) < 0.8 and abs(here.down_m + 5.0) < 0.8

        def past(start_deg: float) -> bool:
            return 90.0 < (bearing_deg() - start_deg) % 360.0 < 180.0

        until(on_circle, "on the circle")
        for _ in range(4):
            start = bearing_deg()
            until(partial(past, start), "a quarter further")
            assert on_circle()


@pytest.mark.thorough
def test_mavsdk_follow_me_configures_and_follows() -> None:
    with flying() as (system, telemetry, _):
        follow = FollowMe(system)
        follow.set_config(Config(10.0, 6.0, 0.1, Config.FollowAltitudeMode(0), 8.0, 180.0))
        follow.start()
        until(lambda: telemetry.flight_mode() is FlightMode.FOLLOW_ME, "following")
        home = telemetry.home()
        place = TargetLocation(
            home.latitude_deg + 20.0 / 111_319.5,
            home.longitude_deg,
            home.absolute_altitude_m,
            0.0,
            0.0,
            0.0,
        )

        def beside() -> bool:
            follow.set_target_location(place)
            here = telemetry.position_velocity_ned().position
            away_m = math.hypot(here.north_m - 20.0, here.east_m)
            return abs(away_m - 6.0) < 1.0 and abs(here.down_m + 10.0) < 1.0

        until(beside, "6 m from the leader and 10 m up")
        follow.stop()
        until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "holding again")


@pytest.mark.thorough
def test_mavsdk_flies_by_hand() -> None:
    with flying() as (system, telemetry, _):
        manual = ManualControl(system)
        for _ in range(10):
            manual.set_manual_control_input(0.0, 0.0, 0.5, 0.0)
            time.sleep(0.05)
        manual.start_position_control()
        until(lambda: telemetry.flight_mode() is FlightMode.POSCTL, "by hand")

        def forward() -> bool:
            manual.set_manual_control_input(0.6, 0.0, 0.5, 0.0)
            return bool(telemetry.position_velocity_ned().velocity.north_m_s > 1.5)

        def still() -> bool:
            manual.set_manual_control_input(0.0, 0.0, 0.5, 0.0)
            return bool(abs(telemetry.position_velocity_ned().velocity.north_m_s) < 0.3)

        until(forward, "flying forward")
        until(still, "braked")
