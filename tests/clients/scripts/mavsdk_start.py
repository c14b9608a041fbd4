"""MAVSDK 4 waits for a vehicle that is yet to start, loses it, and finds it again.

Run: python mavsdk_start.py udpin://127.0.0.1:14540 [again]
Prints the time of each event in nanoseconds since 1970.
"""

from __future__ import annotations

import sys
import time

from mavsdk import ComponentType, Configuration, LogLevel, Mavsdk, log_subscribe
from mavsdk.plugins.telemetry import Telemetry
from mavsdk_station import PATIENT_S, until


def told(event: str) -> None:
    print(event, time.time_ns(), flush=True)


def main(url: str, again: bool) -> None:
    log_subscribe(lambda level, message, file, line: level < LogLevel.ERROR)
    sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    sdk.add_any_connection(url)
    told("waiting")
    system = sdk.first_autopilot(PATIENT_S)
    assert system is not None, "no autopilot"
    told("heard")
    telemetry = Telemetry(system)
    until(lambda: telemetry.health().is_armable and telemetry.health_all_ok(), "armable")
    told("armable")
    if again:
        until(lambda: not system.is_connected(), "lost")
        told("lost")
        until(system.is_connected, "back")
        told("back")
        until(telemetry.health_all_ok, "healthy again")
        told("healthy")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:] == ["again"])
