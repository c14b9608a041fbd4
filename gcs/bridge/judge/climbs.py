"""Climbs while the take-off height that a client has written is not known yet."""

from __future__ import annotations

from typing import Final

from gcs import ipc
from gcs.bridge.effects import AsksVehicle
from gcs.bridge.setup_policy.parameters import TAKEOFF_HEIGHT
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import Autopilot, mode_named
from gcs.protocol.effects import Address
from gcs.protocol.parameters import BY_NAME
from gcs.wire.messages import ParamRequestRead

CLIMBS: Final = frozenset({"takeoff", "mission_start"})
CLIMBING: Final = frozenset({FlightMode.TAKEOFF, FlightMode.MISSION})
HEIGHT_WRITTEN: Final = Refusal(
    Code.BUSY, f"{TAKEOFF_HEIGHT} was written, and the vehicle has not told yet what it is now"
)


def climbs(ask: ipc.Ask, autopilot: Autopilot) -> bool:
    """Whether it makes the vehicle take off, or may do so."""
    mode = mode_named(autopilot, ask.mode) if ask.word == "mode" else None
    return ask.word in CLIMBS or (mode is not None and mode.meaning in CLIMBING)


def asks_for_height(source: Address, vehicle: Address) -> AsksVehicle:
    """The answer is read by the gate as well."""
    return AsksVehicle(
        source, ParamRequestRead(BY_NAME, vehicle.sysid, vehicle.compid, TAKEOFF_HEIGHT)
    )
