"""A vehicle that moves by a known rule, its recorder, and the two readers that serve as oracles."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from pymavlink.DFReader import DFReader_binary

from tests.unit.vehicle_services.fake_vehicle import MS, FakeVehicle, S
from vehicle_sim.autopilot.interface import Estimate, VehicleEvent
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.effects import Effect
from vehicle_sim.flight_log.log_directory import LogDirectory
from vehicle_sim.flight_log.recorder import Recorder
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.telemetry.telemetry import STATE
from vehicle_sim.storage.store import MemoryStore, Store
from vehicle_sim.wire import messages as m

START_S = 1_714_555_000
"""2024-05-01 09:16:40 UTC."""


class Moving(FakeVehicle):
    """Speed and heading can be set too."""

    v_ned: Vec3 = (1.0, 0.0, 0.0)
    heading_rad = 0.0

    @property
    def estimate(self) -> Estimate:
        return super().estimate._replace(v_ned=self.v_ned, heading_rad=self.heading_rad)


class Flight:
    """Position is (t, 2 t, -t / 2) metres at t seconds; everything else stays."""

    def __init__(
        self,
        personality: Personality = "px4",
        store: Store | None = None,
        start_s: int = START_S,
        enabled: bool = True,
    ) -> None:
        self.vehicle = Moving()
        self.parameters = Parameters(personality)
        self.store: Store = store if store is not None else MemoryStore()
        self.shelf = LogDirectory(self.store, personality)
        self.notes: list[Effect] = []
        profile = PROFILES[personality]
        self.recorder = Recorder(
            self.vehicle,
            self.parameters,
            self.shelf,
            (7, profile.flight_sw_version),
            start_s * S,
            enabled,
        )

    def advance(self, ns: int, *events: VehicleEvent) -> None:
        """`events` happen in the first step."""
        end_ns = self.vehicle.time_ns + ns
        pending = list(events)
        while self.vehicle.time_ns < end_ns:
            self.vehicle.step()
            t = self.vehicle.time_ns / S
            self.vehicle.pos_ned = (t, 2.0 * t, -t / 2.0)
            self.notes += self.recorder.step(pending)
            pending = []

    def fly(self, ns: int = 2 * S, *events: VehicleEvent) -> None:
        """Armed for so long, on the ground for a second before and after."""
        self.advance(1 * S)
        self.vehicle.armed = True
        self.advance(ns, *events)
        self.vehicle.armed = False
        self.advance(1 * S)

    @property
    def logs(self) -> list[bytes]:
        return [self.store.read(log.path, 0, log.size) for log in self.recorder.logs()]

    def gps(self) -> m.GpsRawInt:
        built = STATE[m.IDS[m.GpsRawInt]](self.vehicle, PROFILES["px4"])
        assert isinstance(built, m.GpsRawInt)
        return built


def read_dataflash(log: bytes, at: Path) -> tuple[DFReader_binary, list[Any]]:
    """pymavlink's reader, closed but with its flight modes known, and every record in order."""
    file = at / "log.bin"
    file.write_bytes(log)
    with DFReader_binary(str(file)) as reader:
        reader.flightmode_list()
        records = []
        while (record := reader.recv_msg()) is not None:
            records.append(record)
    return reader, records


def read_ulog(log: bytes) -> Any:
    """pyulog's reader."""
    from pyulog import ULog

    return ULog(io.BytesIO(log), disable_str_exceptions=False)


__all__ = ["MS", "START_S", "Flight", "S", "read_dataflash", "read_ulog"]
