"""What every MAVSDK 4 script here begins with: one station, connected, its warnings printed.

with Station("udpin://127.0.0.1:14540") as station:
    telemetry, action = Telemetry(station.system), Action(station.system)
"""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable
from types import TracebackType

from mavsdk import ComponentType, Configuration, LogLevel, Mavsdk, log_subscribe
from mavsdk.plugins.telemetry import Telemetry

EARTH_M_PER_DEG = 111_194.93
PATIENT_S = 60.0
TOLD_TWICE_S = 0.5
ANSWER_S = 2.0
"""MAVSDK asks again after so long, three times, instead of 0.5 s: on a slow machine the vehicle is
late."""


class Station:
    """A ground station and the first autopilot that it hears."""

    def __init__(self, url: str) -> None:
        log_subscribe(_print_trouble)
        self.sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        _set_timeout_s(self.sdk, ANSWER_S)
        self.sdk.add_any_connection(url)
        self.system = self.sdk.first_autopilot(PATIENT_S)
        assert self.system is not None, f"no autopilot at {url}"

    def __enter__(self) -> Station:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.sdk.destroy()


def until(condition: Callable[[], bool], what: str, timeout_s: float = PATIENT_S) -> None:
    """Waits; a script that waits in vain ends with an AssertionError."""
    end_s = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end_s, f"not within {timeout_s:g} s: {what}"
        time.sleep(0.01)


def refusal(call: Callable[..., object], *args: object) -> str:
    """The name of the result with which MAVSDK refuses a call."""
    try:
        call(*args)
    except Exception as error:  # noqa: BLE001  # every plugin has an error class of its own
        result = getattr(error, "result", None)
        return str(result.name) if result is not None else repr(error)
    return "SUCCESS"


def told_twice(call: Callable[..., object], *args: object) -> None:
    """Sets a parameter.  PX4 tells a change twice, and MAVSDK warns where the second telling meets
    its next request."""
    call(*args)
    time.sleep(TOLD_TWICE_S)


def ask_for_streams(telemetry: Telemetry) -> None:
    """ArduPilot sends next to nothing before it is asked."""
    for set_rate in (
        telemetry.set_rate_attitude_euler,
        telemetry.set_rate_battery,
        telemetry.set_rate_gps_info,
        telemetry.set_rate_health,
        telemetry.set_rate_landed_state,
        telemetry.set_rate_position,
        telemetry.set_rate_position_velocity_ned,
        telemetry.set_rate_unix_epoch_time,
    ):
        set_rate(10.0)


def ned_m(telemetry: Telemetry) -> tuple[float, float, float]:
    here = telemetry.position_velocity_ned().position
    return (here.north_m, here.east_m, here.down_m)


def _set_timeout_s(sdk: Mavsdk, seconds: float) -> None:
    """`Mavsdk::set_timeout_s` of C++, for which Python has no word."""
    sdk._lib.mavsdk_set_timeout_s(ctypes.c_void_p(sdk._handle), ctypes.c_double(seconds))


def _print_trouble(level: LogLevel, message: str, file: str | None, line: int) -> bool:
    if level >= LogLevel.WARN:
        print(f"{level.name}: {message}", flush=True)
    return True
