"""MAVLink messages that are plotted or shown as they are: attitude and rates and what was wanted of
them, motors, sticks, wind, accelerations, the build, parameters' places, the mission's items."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import atan2, degrees, hypot

from gcs.flight_report.facts import (
    Acceleration,
    Build,
    Clock,
    Fact,
    Field,
    Fix,
    PlanItem,
    Rotation,
    Sample,
)
from gcs.flight_report.readers.mavlink_fields import Read, numbers
from gcs.flight_report.sampled import MOTORS, WANTED
from gcs.record.derived.vehicle_json import euler_deg
from gcs.wire.ids import Cmd

MILLI_G = 9.80665e-3
_IMU_KINDS = ("acc", "gyro", "mag")
_UNUSED_US = 0xFFFF
_NO_RATES, _NO_ATTITUDE = 0b111, 0b1000_0000
"""ATTITUDE_TARGET.type_mask."""
_PLACES = frozenset(
    {
        Cmd.NAV_WAYPOINT,
        Cmd.NAV_LOITER_UNLIM,
        Cmd.NAV_LOITER_TURNS,
        Cmd.NAV_LOITER_TIME,
        Cmd.NAV_LAND,
        Cmd.NAV_SPLINE_WAYPOINT,
    }
)
_ABOVE_HOME = frozenset({3, 6})
_AMSL = frozenset({0, 5})
"""MAV_FRAME of a global place."""


def percent(us: float) -> float | None:
    """Of a pulse's width, 1,000 to 2,000 microseconds."""
    return (us - 1000.0) / 10.0 if 800.0 <= us <= 2200.0 else None


def stick(us: float) -> float | None:
    """-100 to 100 per cent."""
    return (us - 1500.0) / 5.0 if 800.0 <= us <= 2200.0 else None


def wind(east_m_s: float, north_m_s: float) -> Sample:
    """Of the way that the air moves."""
    speed_m_s = hypot(east_m_s, north_m_s)
    return Sample("wind", (speed_m_s, degrees(atan2(-east_m_s, -north_m_s)) % 360.0))


def _attitude() -> Read:
    read = numbers(
        "ATTITUDE",
        *("time_boot_ms", "roll", "pitch", "yaw", "rollspeed", "pitchspeed", "yawspeed"),
    )

    def facts(data: bytes) -> list[Fact]:
        boot_ms, roll, pitch, yaw, *rates = read(data)
        return [
            Clock(boot_ms / 1e3),
            Sample("attitude", (degrees(roll), degrees(pitch), degrees(yaw) % 360.0)),
            Sample("rates", tuple(map(degrees, rates))),
        ]

    return facts


def _attitude_target() -> Read:
    read = numbers(
        "ATTITUDE_TARGET",
        *("q", "body_roll_rate", "body_pitch_rate", "body_yaw_rate", "type_mask"),
    )

    def facts(data: bytes) -> list[Fact]:
        w, x, y, z, *rates, mask = read(data)
        wanted: list[Fact] = []
        if not int(mask) & _NO_ATTITUDE and (w or x or y or z):
            wanted.append(Sample("attitude", euler_deg((w, x, y, z)), WANTED, leads=False))
        if not int(mask) & _NO_RATES:
            wanted.append(Sample("rates", tuple(map(degrees, rates)), WANTED, leads=False))
        return wanted

    return facts


def _position_target() -> Read:
    read = numbers("POSITION_TARGET_LOCAL_NED", "x", "y", "z", "type_mask")

    def facts(data: bytes) -> list[Fact]:
        north, east, down, mask = read(data)
        if int(mask) & 0b111:
            return []
        return [Sample("place", (east, north, -down), WANTED, leads=False)]

    return facts


def _servo_output() -> Read:
    read = numbers("SERVO_OUTPUT_RAW", "port", *(f"servo{n}_raw" for n in range(1, MOTORS + 1)))

    def facts(data: bytes) -> list[Fact]:
        port, *pulses = read(data)
        return [] if port else [Sample("motors", tuple(map(percent, pulses)))]

    return facts


def _rc_channels(message: str) -> Callable[[], Read]:
    def make() -> Read:
        read = numbers(message, *(f"chan{n}_raw" for n in range(1, 5)))

        def facts(data: bytes) -> list[Fact]:
            values = tuple(map(stick, read(data)))
            return [] if values.count(None) == len(values) else [Sample("sticks", values)]

        return facts

    return make


def _manual_control() -> Read:
    read = numbers("MANUAL_CONTROL", "y", "x", "z", "r")

    def facts(data: bytes) -> list[Fact]:
        roll, pitch, throttle, yaw = read(data)
        return [Sample("sticks", (roll / 10, pitch / 10, throttle / 5 - 100.0, yaw / 10))]

    return facts


def _wind() -> Read:
    read = numbers("WIND", "direction", "speed")

    def facts(data: bytes) -> list[Fact]:
        direction, speed = read(data)
        return [Sample("wind", (speed, direction % 360.0))]

    return facts


def _wind_cov() -> Read:
    read = numbers("WIND_COV", "wind_x", "wind_y")

    def facts(data: bytes) -> list[Fact]:
        north, east = read(data)
        return [wind(east, north)]

    return facts


def _imu(message: str, m_s2: float, rest: float) -> Callable[[], Read]:
    """What one unit is of the accelerations, and of the rates (rad/s) and the field (gauss)."""

    def make() -> Read:
        axes = "xyz"
        read = numbers(message, *(f"{axis}{kind}" for kind in _IMU_KINDS for axis in axes))

        def facts(data: bytes) -> list[Fact]:
            x, y, z, p, q, r, *field = read(data)
            return [
                Acceleration((m_s2 * x, m_s2 * y, m_s2 * z)),
                Rotation((rest * p, rest * q, rest * r)),
                # Without a compass they are 0.
                *([Field(rest * hypot(*field))] if any(field) else []),
            ]

        return facts

    return make


def version_text(packed: int) -> str:
    """`flight_sw_version`: major, minor, patch, and FIRMWARE_VERSION_TYPE, 255 for a release."""
    major, minor, patch, kind = (packed >> shift & 0xFF for shift in (24, 16, 8, 0))
    kinds = {0: " dev", 64: " alpha", 128: " beta", 192: " rc", 255: ""}
    return f"{major}.{minor}.{patch}{kinds.get(kind, '')}"


def _autopilot_version() -> Read:
    read = numbers(
        "AUTOPILOT_VERSION", "flight_sw_version", "board_version", "flight_custom_version"
    )

    def facts(data: bytes) -> list[Fact]:
        version, board, *custom = (int(value) for value in read(data))
        custom_bytes = bytes(custom)
        # PX4 sends the hash backwards as a number, ArduPilot its letters.
        letters = custom_bytes.rstrip(b"\0")
        hash_ = letters.decode("ascii") if letters.isalnum() else custom_bytes[::-1].hex()[:8]
        firmware = f"{version_text(version)} ({hash_})" if any(custom) else version_text(version)
        return [Build(firmware, f"board {board >> 16}" if board >> 16 else "")]

    return facts


def _global_position() -> Read:
    read = numbers("GLOBAL_POSITION_INT", "lat", "lon", "alt", "relative_alt")

    def facts(data: bytes) -> list[Fact]:
        lat, lon, amsl_mm, rel_mm = read(data)
        return [Fix(lat / 1e7, lon / 1e7, amsl_mm / 1e3, rel_mm / 1e3)] if lat or lon else []

    return facts


def _mission_item(message: str, scale: float) -> Callable[[], Read]:
    def make() -> Read:
        read = numbers(
            message,
            *("target_system", "seq", "command", "frame", "mission_type", "x", "y", "z"),
        )

        def facts(data: bytes) -> list[Fact]:
            target, seq, command, frame, kind, lat, lon, alt_m = read(data)
            known = frame in _ABOVE_HOME or frame in _AMSL
            if kind or command not in _PLACES or not known or not (lat or lon):
                return []
            place = (lat * scale, lon * scale, alt_m)
            return [PlanItem(int(target), int(seq), *place, frame in _ABOVE_HOME)]

        return facts

    return make


PLAN_READERS: Mapping[str, Callable[[], Read]] = {
    "MISSION_ITEM_INT": _mission_item("MISSION_ITEM_INT", 1e-7),
    "MISSION_ITEM": _mission_item("MISSION_ITEM", 1.0),
}
"""Of messages that a station sends as well."""

SAMPLE_READERS: Mapping[str, Callable[[], Read]] = {
    "ATTITUDE": _attitude,
    "ATTITUDE_TARGET": _attitude_target,
    "POSITION_TARGET_LOCAL_NED": _position_target,
    "SERVO_OUTPUT_RAW": _servo_output,
    "RC_CHANNELS": _rc_channels("RC_CHANNELS"),
    "RC_CHANNELS_RAW": _rc_channels("RC_CHANNELS_RAW"),
    "MANUAL_CONTROL": _manual_control,
    "WIND": _wind,
    "WIND_COV": _wind_cov,
    "HIGHRES_IMU": _imu("HIGHRES_IMU", 1.0, 1.0),
    "RAW_IMU": _imu("RAW_IMU", MILLI_G, 1e-3),
    "AUTOPILOT_VERSION": _autopilot_version,
    "GLOBAL_POSITION_INT": _global_position,
}
