"""MAVSDK 4 flies the vehicle without a word of ours."""

from __future__ import annotations

import math

import pytest

from tests.system.vehicle_program import free_port, until, vehicle_sim

mavsdk = pytest.importorskip("mavsdk")

from mavsdk.plugins.action import Action  # noqa: E402
from mavsdk.plugins.offboard import Offboard, PositionNedYaw  # noqa: E402
from mavsdk.plugins.telemetry import FlightMode, Telemetry  # noqa: E402

pytestmark = pytest.mark.system


def test_mavsdk_connects_arms_takes_off_flies_two_offboard_positions_and_lands() -> None:
    port = free_port()
    with vehicle_sim("--speedup", "4", "--link", f"udpout://127.0.0.1:{port}") as lines:
        station = mavsdk.Configuration.create_with_component_type(
            mavsdk.ComponentType.GROUND_STATION
        )
        with mavsdk.Mavsdk(station) as sdk:
            sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
            system = sdk.first_autopilot(10.0)
            assert system is not None, lines
            telemetry, action, offboard = Telemetry(system), Action(system), Offboard(system)
            until(telemetry.health_all_ok, "health all ok")

            action.arm()
            until(telemetry.armed, "armed")
            action.takeoff()
            until(lambda: telemetry.flight_mode() is FlightMode.TAKEOFF, "taking off")
            until(lambda: telemetry.position().relative_altitude_m > 2.0, "2 m up")
            until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "taken off")

            def distance_m(goal: PositionNedYaw) -> float:
                here = telemetry.position_velocity_ned().position
                return math.dist(
                    (here.north_m, here.east_m, here.down_m),
                    (goal.north_m, goal.east_m, goal.down_m),
                )

            first = PositionNedYaw(5.0, 0.0, -4.0, 0.0)
            second = PositionNedYaw(5.0, 5.0, -3.0, 90.0)
            offboard.set_position_ned(first)
            offboard.start()
            until(lambda: distance_m(first) < 0.5, "at the first position")
            offboard.set_position_ned(second)
            until(lambda: distance_m(second) < 0.5, "at the second position")
            until(lambda: abs(telemetry.attitude_euler().yaw_deg - 90.0) < 5.0, "looking east")
            offboard.stop()

            action.land()
            until(lambda: not telemetry.in_air(), "landed")
            until(lambda: not telemetry.armed(), "disarmed")
