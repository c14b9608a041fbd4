"""`--view`: what a 3-D viewer is sent, decoded by pymavlink."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.shell.urls import UrlError, UrlKind, parse_view
from vehicle_sim.simulation.world import Datagram, LinkSpec, Transmit, Wake, World

HOME = Geodetic(47.397742, 8.545594, 488.0)
S = 1_000_000_000
VIEWER = ("127.0.0.1", 19410)


class Watched:
    """Two vehicles, a link of theirs, and a viewer."""

    def __init__(self, speedup: int = 1) -> None:
        self.now_ns = 0
        self.vehicles = [Autopilot("px4", HOME, seed=1 + lane) for lane in range(2)]
        servers = []
        for system, vehicle in enumerate(self.vehicles, start=1):
            parameters = Parameters("px4")
            profile = profile_of("px4", parameters.firmware)
            servers.append(VehicleServer(vehicle, profile, parameters, system, Fraction(speedup)))
        self.world = World(servers, [LinkSpec()], Fraction(speedup), viewer=VIEWER)

    def run(self, seconds: float) -> list[Any]:
        """What the viewer hears, as pymavlink reads it."""
        end_ns = self.now_ns + round(seconds * S)
        reader = mavlink.MAVLink(None)
        heard: list[Any] = []
        while self.now_ns < end_ns:
            self.now_ns = min(end_ns, max(self.now_ns + 1, self.world.deadline_ns))
            for output in self.world.handle(Wake(), self.now_ns):
                if isinstance(output, Transmit) and output.link == 1:
                    assert output.peer == VIEWER
                    heard += reader.parse_buffer(output.data) or []
        return heard


def of(heard: list[Any], kind: str, system: int) -> list[Any]:
    return [each for each in heard if each.get_type() == kind and each.get_srcSystem() == system]


@pytest.mark.parametrize("speedup", [1, 10])
def test_each_vehicle_is_shown_50_times_a_second_of_wall_time(speedup: int) -> None:
    heard = Watched(speedup).run(2.9)
    for system in (1, 2):
        assert len(of(heard, "HIL_STATE_QUATERNION", system)) == pytest.approx(145, abs=1)
        beats = of(heard, "HEARTBEAT", system)
        assert len(beats) == 3
        assert (beats[0].type, beats[0].autopilot) == (2, 12)
    assert {each.get_type() for each in heard} == {"HIL_STATE_QUATERNION", "HEARTBEAT"}


def test_what_is_shown_is_the_truth() -> None:
    watched = Watched()
    watched.run(2.0)
    heard = watched.run(1.0)
    shown = of(heard, "HIL_STATE_QUATERNION", 1)[-1]
    truth = watched.vehicles[0].truth
    assert (shown.lat / 1e7, shown.lon / 1e7) == pytest.approx((truth.lat_deg, truth.lon_deg))
    assert shown.alt / 1e3 == pytest.approx(truth.alt_amsl_m, abs=0.01)
    assert shown.attitude_quaternion == pytest.approx(truth.q_ned_from_frd, abs=1e-5)
    assert shown.zacc == pytest.approx(-1000, abs=30)
    assert math.isclose(shown.time_usec / 1e6, truth.time_s, abs_tol=0.03)


def test_nobody_else_hears_it_and_the_viewer_is_not_heard() -> None:
    watched = Watched()
    watched.world.handle(Datagram(1, VIEWER, b"\xfd" * 40), 0)
    assert watched.world.links == ()
    assert all(each.get_type() in ("HIL_STATE_QUATERNION", "HEARTBEAT") for each in watched.run(1))


def test_the_viewers_address() -> None:
    url = parse_view("udp://127.0.0.1:19410")
    assert (url.kind, url.host, url.port) == (UrlKind.UDP_OUT, "127.0.0.1", 19410)
    for wrong in ("tcp://127.0.0.1:19410", "127.0.0.1:19410", "udp://127.0.0.1"):
        with pytest.raises(UrlError):
            parse_view(wrong)
