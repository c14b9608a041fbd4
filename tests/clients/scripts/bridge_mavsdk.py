"""A program on MAVSDK 4 flies through the bridge, and then tries to leave the fence.

    python bridge_mavsdk.py udpout://127.0.0.1:14551 px4 fly offboard escape land

The words after the autopilot are what it does, in order; one line is printed for each thing done.
Nothing here knows that a bridge is between it and the vehicle.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from itertools import pairwise

from mavsdk.plugins import mission_raw as raw
from mavsdk.plugins.action import Action
from mavsdk.plugins.manual_control import ManualControl
from mavsdk.plugins.offboard import (
    Attitude,
    Offboard,
    PositionNedYaw,
    VelocityBodyYawspeed,
    VelocityNedYaw,
)
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FlightMode, Telemetry
from mavsdk_station import EARTH_M_PER_DEG, Station, ask_for_streams, ned_m, refusal, until

UP_M = 5.0
GLOBAL_RELATIVE_ALT_INT = 6


class Peer:
    def __init__(self, station: Station, autopilot: str) -> None:
        self.system = station.system
        self.autopilot = autopilot
        self.telemetry = Telemetry(station.system)
        self.action = Action(station.system)
        self.home_m = (0.0, 0.0, 0.0)
        """North, east, down of home in the local frame: not zero where the estimate wandered."""

    def done(self, what: str, call: Callable[..., object], *args: object) -> None:
        result = refusal(call, *args)
        assert result == "SUCCESS", f"{what}: {result}"
        print(f"{what}: accepted", flush=True)

    def refused(self, what: str, call: Callable[..., object], *args: object) -> None:
        result = refusal(call, *args)
        assert result != "SUCCESS", what
        print(f"{what}: refused {result}", flush=True)

    def here(self) -> tuple[float, float, float]:
        """North, east, up of home."""
        home, now = self.telemetry.home(), self.telemetry.position()
        east_m_per_deg = EARTH_M_PER_DEG * math.cos(math.radians(home.latitude_deg))
        return (
            (now.latitude_deg - home.latitude_deg) * EARTH_M_PER_DEG,
            (now.longitude_deg - home.longitude_deg) * east_m_per_deg,
            now.relative_altitude_m,
        )

    def come_to(self, north_m: float, east_m: float, up_m: float) -> None:
        until(
            lambda: math.dist(self.here(), (north_m, east_m, up_m)) < 1.2,
            f"at {north_m} {east_m} {up_m}",
        )
        time.sleep(1.5)

    def place(self, north_m: float, east_m: float) -> tuple[float, float]:
        home = self.telemetry.home()
        east_m_per_deg = EARTH_M_PER_DEG * math.cos(math.radians(home.latitude_deg))
        return (
            home.latitude_deg + north_m / EARTH_M_PER_DEG,
            home.longitude_deg + east_m / east_m_per_deg,
        )

    def goto(self, north_m: float, east_m: float, up_m: float) -> None:
        sea_m = self.telemetry.home().absolute_altitude_m
        self.action.goto_location(*self.place(north_m, east_m), sea_m + up_m, math.nan)

    # --------------------------------------------------------------------------- flying

    def fly(self) -> None:
        self.be_healthy()
        everything = Param(self.system).get_all_params()
        print("all parameters", len(everything.float_params) >= 30, flush=True)
        plan = self.mission((15, 0), (15, -15), (0, -15), last=21)
        self.done("upload", raw.MissionRaw(self.system).upload_mission, plan)
        back = raw.MissionRaw(self.system).download_mission()
        print("mission", [each.command for each in back] == [each.command for each in plan])
        self.take_off()
        self.done("goto", self.goto, 12.0, 0.0, UP_M)
        self.come_to(12.0, 0.0, UP_M)
        self.done("hold", self.action.hold)
        until(lambda: self.telemetry.flight_mode() is FlightMode.HOLD, "holds")
        self.done("goto", self.goto, 0.0, 0.0, UP_M)
        self.come_to(0.0, 0.0, UP_M)
        progress: list[int] = []
        missions = raw.MissionRaw(self.system)
        missions.subscribe_mission_progress(lambda now, _: progress.append(now.current))
        self.done("start of the mission", missions.start_mission)
        until(lambda: progress and progress[-1] >= 2, "second item")
        print("flies the mission", flush=True)
        self.done("hold", self.action.hold)
        self.done("return", self.action.return_to_launch)
        until(lambda: self.telemetry.flight_mode() is FlightMode.RETURN_TO_LAUNCH, "returns")
        print("returns", flush=True)
        self.done("hold", self.action.hold)

    def be_healthy(self) -> None:
        if self.autopilot == "ardupilot":
            ask_for_streams(self.telemetry)
        until(self.telemetry.health_all_ok, "health all ok")
        print("healthy", flush=True)
        until(lambda: math.isfinite(self.telemetry.home().latitude_deg), "home")

    def take_off(self) -> None:
        self.done("take-off height", self.action.set_takeoff_altitude, UP_M)
        self.done("arm", self.action.arm)
        self.done("take-off", self.action.takeoff)
        until(lambda: self.here()[2] > UP_M - 1.0, "up")
        if self.autopilot == "px4":
            until(lambda: self.telemetry.flight_mode() is FlightMode.HOLD, "taken off")
        time.sleep(3.0)
        print("took off", flush=True)

    def mission(self, *places: tuple[float, float], last: int) -> list[raw.MissionItem]:
        """Take-off, waypoints north and east of home, and a last item: 20 return, 21 land."""

        def step(seq: int, command: int, north_m: float, east_m: float, up_m: float):
            lat, lon = self.place(north_m, east_m)
            return raw.MissionItem(
                seq=seq,
                frame=GLOBAL_RELATIVE_ALT_INT if command != 20 else 2,
                command=command,
                current=int(seq == 0),
                autocontinue=1,
                param2=1.0 if command == 16 else 0.0,
                param4=math.nan if command != 20 else 0.0,
                x=round(lat * 1e7) if command != 20 else 0,
                y=round(lon * 1e7) if command != 20 else 0,
                z=up_m,
            )

        rows = [(22, 0.0, 0.0, UP_M), *((16, *at, UP_M) for at in places)]
        rows.append((last, *(places[-1] if last == 21 else (0.0, 0.0)), 0.0))
        if self.autopilot == "ardupilot":  # item 0 is home
            rows.insert(0, (16, 0.0, 0.0, 0.0))
        return [step(seq, *row) for seq, row in enumerate(rows)]

    def offboard(self) -> None:
        control = Offboard(self.system)
        north_m, east_m, down_m = ned_m(self.telemetry)
        control.set_position_ned(PositionNedYaw(north_m + 6.0, east_m, down_m, 0.0))
        self.done("offboard", control.start)
        until(lambda: abs(ned_m(self.telemetry)[0] - north_m - 6.0) < 1.2, "6 m north")
        print("offboard position", flush=True)
        control.set_velocity_ned(VelocityNedYaw(-2.0, 0.0, 0.0, 0.0))
        until(lambda: self.telemetry.velocity_ned().north_m_s < -1.5, "2 m/s southward")
        print("offboard velocity", flush=True)
        control.set_velocity_body(VelocityBodyYawspeed(0.0, 0.0, 0.0, 30.0))
        until(lambda: abs(self.telemetry.velocity_ned().north_m_s) < 0.4, "stopped")
        print("offboard body velocity", flush=True)
        self.done("offboard ended", control.stop)
        time.sleep(2.0)

    def orbit(self) -> None:
        """8 m about a place in the west of the yard, counter-clockwise at 2 m/s."""
        self.done("orbit", self.orbit_about, -8.0, 0.0, -20.0)
        until(lambda: self.speed_m_s() > 1.7 and self.from_circle_m() < 1.0, "circles", 40.0)
        bearings: list[float] = []
        for _ in range(40):
            time.sleep(0.1)
            assert self.from_circle_m() < 1.5
            bearings.append(math.atan2(self.here()[1] + 20.0, self.here()[0]))
        turned = sum(math.remainder(b - a, math.tau) for a, b in pairwise(bearings))
        print(f"orbit flown {turned < -0.5}", flush=True)
        self.done("hold", self.action.hold)
        until(lambda: self.telemetry.flight_mode() is FlightMode.HOLD, "holds")

    def orbit_about(self, radius_m: float, north_m: float, east_m: float) -> None:
        from mavsdk.plugins.action import OrbitYawBehavior

        sea_m = self.telemetry.home().absolute_altitude_m
        ahead = OrbitYawBehavior.HOLD_FRONT_TO_CIRCLE_CENTER
        self.action.do_orbit(radius_m, 2.0, ahead, *self.place(north_m, east_m), sea_m + UP_M)

    def from_circle_m(self) -> float:
        north_m, east_m, _ = self.here()
        return abs(math.hypot(north_m, east_m + 20.0) - 8.0)

    def speed_m_s(self) -> float:
        v = self.telemetry.velocity_ned()
        return math.hypot(v.north_m_s, v.east_m_s)

    def sticks(self) -> None:
        """A joystick, 25 times a second: forward at the fence of the yard, back, and let go of."""
        control = ManualControl(self.system)
        self.push(control, 0.5)
        self.done("position control", control.start_position_control)
        self.push(control, 1.0)
        north_m = self.here()[0]
        far_m = self.push(control, 25.0, x=1.0)
        print(f"full stick: came {far_m:.0f} m", flush=True)
        self.push(control, 3.0)
        held_m = self.here()[0]

        def back() -> bool:
            return abs(self.here()[0] - held_m) > 4.0

        self.push(control, 60.0, x=-0.6, until=back)
        print("full stick back", back(), flush=True)
        print("flew forward", held_m - north_m > 20.0, flush=True)
        self.push(control, 3.0)
        self.done("goto", self.goto, 0.0, 0.0, UP_M)

    def push(
        self,
        control: ManualControl,
        seconds: float,
        x: float = 0.0,
        until: Callable[[], bool] = lambda: False,
    ) -> float:
        """Forward, no longer than `until` it is so; the throttle is in its middle.  How far from
        home it came."""
        end_s, far_m = time.monotonic() + seconds, 0.0
        while time.monotonic() < end_s:
            control.set_manual_control_input(x, 0.0, 0.5, 0.0)
            far_m = max(far_m, *(abs(each) for each in self.here()[:2]))
            if until():
                break
            time.sleep(0.04)
        return far_m

    def attitudes(self) -> None:
        """Leaning at the fence of the yard, 28 m up, by 5 degrees; and back."""
        hover = Param(self.system).get_param_float("MPC_THR_HOVER")
        control = Offboard(self.system)

        def lean(pitch_deg: float) -> None:
            """Keeps the height by the thrust: a steady one sinks to where the gate refuses it."""
            under_m = 28.0 - self.here()[2]
            sinks_m_s = self.telemetry.velocity_ned().down_m_s
            thrust = hover + 0.02 * under_m + 0.05 * sinks_m_s
            control.set_attitude(Attitude(0.0, pitch_deg, 0.0, thrust))
            time.sleep(0.05)

        def north_m_s() -> float:
            return float(self.telemetry.velocity_ned().north_m_s)

        def leans_until(pitch_deg: float, condition: Callable[[], bool], what: str) -> None:
            def leans() -> bool:
                lean(pitch_deg)
                return condition()

            until(leans, what)

        self.done("goto", self.goto, 0.0, 0.0, 28.0)
        self.come_to(0.0, 0.0, 28.0)
        lean(0.0)
        self.done("attitude", control.start)
        leans_until(-5.0, lambda: north_m_s() > 1.0, "leans to the north")
        print("flies where it leans", flush=True)
        leans_until(-5.0, lambda: self.here()[0] > 15.0, "15 m north")
        leans_until(-5.0, lambda: abs(north_m_s()) < 0.3, "held")
        held_m = self.here()[0]
        print(f"held {held_m:.0f} m north", flush=True)
        leans_until(5.0, lambda: self.here()[0] < held_m - 5.0, "leans back")
        print("flies back", flush=True)
        self.done("offboard ended", control.stop)
        time.sleep(4.0)

    def land(self) -> None:
        self.done("land", self.action.land)
        until(lambda: not self.telemetry.armed(), "landed and disarmed")
        print("landed and disarmed", flush=True)

    # ------------------------------------------------------------------------- escaping

    def escape(self) -> None:
        """One attempt of each kind; all others are flown in tests/loopback."""
        self.refused("goto outside the yard", self.goto, 200.0, 0.0, UP_M)
        missions = raw.MissionRaw(self.system)
        returns = self.mission((30, 0), (30, 45), (0, 45), last=20)
        self.refused("mission that returns through the mast", missions.upload_mission, returns)
        self.settings()
        self.streams()

    def settings(self) -> None:
        name = {"px4": "GF_ACTION", "ardupilot": "FENCE_ENABLE"}[self.autopilot]
        param = Param(self.system)
        before = param.get_param_int(name)
        said = refusal(param.set_param_int, name, 0)
        assert param.get_param_int(name) == before
        print(f"parameter {name}: kept {said}", flush=True)

    def streams(self) -> None:
        control = Offboard(self.system)
        _, _, down_m = ned_m(self.telemetry)
        control.set_position_ned(PositionNedYaw(200.0, 0.0, down_m, 0.0))
        print("offboard outside:", refusal(control.start), flush=True)
        self.farthest("offboard position outside", 6.0)
        control.set_velocity_ned(VelocityNedYaw(-10.0, 0.0, 0.0, 0.0))
        if refusal(control.is_active) == "SUCCESS":
            print("offboard again:", refusal(control.start), flush=True)
        self.farthest("velocity at the fence", 25.0)
        refusal(control.stop)
        self.done("hold", self.action.hold)
        time.sleep(4.0)

    def farthest(self, what: str, seconds: float) -> None:
        end_s, far_m = time.monotonic() + seconds, 0.0
        while time.monotonic() < end_s:
            far_m = max(far_m, *(abs(x) for x in self.here()[:2]))
            time.sleep(0.05)
        print(f"{what}: came {far_m:.0f} m", flush=True)


def main(url: str, autopilot: str, *words: str) -> None:
    with Station(url) as station:
        peer = Peer(station, autopilot)
        for word in words:
            getattr(peer, word)()


if __name__ == "__main__":
    main(*sys.argv[1:])
