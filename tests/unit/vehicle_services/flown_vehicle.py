"""A bench with the vehicle itself on it, not a fake: on the ground, armed, or in the air."""

from __future__ import annotations

import copyreg
import hashlib
from copy import deepcopy
from fractions import Fraction
from functools import cache

from tests.unit.vehicle_services.fake_vehicle import MS, Bench, S, acks, long, of
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.boot import Boot
from vehicle_sim.autopilot.interface import Geodetic, Result
from vehicle_sim.autopilot.modes import MODES, Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import PROFILES, without_camera
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import LinkSpec, World
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

# The signing of links keeps hashes: to copy a bench they are copied by their own means.
copyreg.pickle(type(hashlib.sha256()), lambda kept: (kept.copy, ()))

HOME = Geodetic(47.397742, 8.545594, 488.0)


class Flown(Bench):
    """As `Bench`; `vehicle` is an `Autopilot`."""

    def __init__(self, personality: Personality, boot: Boot = "quick", camera: bool = True) -> None:
        self.personality: Personality = personality
        self.parameters = Parameters(personality)
        self.autopilot = Autopilot(
            personality, HOME, 1, 0, self.parameters, boot=boot, camera=camera
        )
        profile = PROFILES[personality]
        if not camera:
            profile = without_camera(profile)
        server = VehicleServer(self.autopilot, profile, self.parameters, system=1, logging=False)
        self.world = World([server], [LinkSpec()], Fraction(1))
        self.now_ns = 0
        self.logs = []
        self.sequence = 0
        self.raw = b""

    def mode(self, name: str) -> None:
        assert self.autopilot.set_mode(1, MODES[self.personality][name].custom_mode) is (
            Result.ACCEPTED
        )

    def result(self, asked: m.CommandLong | m.CommandInt, wait_ns: int = 2 * S) -> int | None:
        """That of the first ack; None = none came."""
        heard = self.send(asked) + self.advance(wait_ns)
        found = [result for command, result in acks(heard) if command == asked.command]
        return found[0] if found else None

    def texts(self, heard: list[m.Message]) -> list[str]:
        return [each.text.rstrip(b"\0").decode() for each in of(heard, m.Statustext)]

    @property
    def mode_name(self) -> str:
        return self.autopilot.mode_name


def _ready(personality: Personality) -> Flown:
    """Booted; a station says that it is there."""
    bench = Flown(personality)
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    bench.advance(2 * S)
    return bench


@cache
def _ground(personality: Personality) -> Flown:
    return _ready(personality)


@cache
def _air(personality: Personality) -> Flown:
    bench = _ready(personality)
    take_off(bench)
    bench.advance(12 * S)
    return bench


def take_off(bench: Flown, up_m: float = 5.0) -> None:
    """Armed, and the command sent."""
    px4 = bench.personality == "px4"
    bench.mode("AUTO.LOITER" if px4 else "GUIDED")
    assert bench.result(long(Cmd.COMPONENT_ARM_DISARM, 1), 100 * MS) == Result.ACCEPTED
    up = HOME.alt_amsl_m + up_m if px4 else up_m
    asked = long(Cmd.NAV_TAKEOFF, 0, 0, 0, *([float("nan")] * 3 if px4 else [0.0] * 3), up)
    assert bench.result(asked, 0) == Result.ACCEPTED


def on_the_ground(personality: Personality) -> Flown:
    return deepcopy(_ground(personality))


def in_the_air(personality: Personality) -> Flown:
    """5 m over home, in HOLD (px4) or GUIDED."""
    return deepcopy(_air(personality))
