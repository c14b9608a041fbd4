"""Messages of the autopilots' own logs that are plotted or shown as they are.

Fields: ArduPilot wiki, Log Messages; PX4's msg folder, 1.14 and before.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import degrees, hypot

from gcs.flight_report.facts import (
    Acceleration,
    Build,
    Fact,
    Field,
    Fix,
    Parameter,
    PlanItem,
    Rotation,
    Sample,
)
from gcs.flight_report.readers.mavlink_samples import percent, stick, wind
from gcs.flight_report.readers.packed_fields import PackedFields, Read, Value
from gcs.flight_report.sampled import MOTORS, WANTED
from gcs.frames import Vec3
from gcs.record.derived.vehicle_json import euler_deg

_MakeRead = Callable[[PackedFields], Read]
_ABOVE_HOME = frozenset({3, 6})
_PLACES = frozenset({16, 17, 18, 19, 21, 82})
"""Commands to a place (MAV_CMD)."""


def _deg(radians: float | None) -> float | None:
    return None if radians is None else degrees(radians)


# ---------------------------------------------------------------------- ArduPilot's DataFlash


def _both(plot: str, measured: tuple[str, ...], wanted: tuple[str, ...]) -> _MakeRead:
    """What is measured and what was wanted of it, in one message."""

    def make(fields: PackedFields) -> Read:
        read = fields.values(*measured, *wanted)
        return lambda data: [Sample(plot, read(data))]

    return make


def _pulses(plot: str, count: int, of: Callable[[float], float | None]) -> _MakeRead:
    def make(fields: PackedFields) -> Read:
        read = fields.values(*(f"C{n}" for n in range(1, count + 1)))
        return lambda data: [Sample(plot, tuple(of(v or 0.0) for v in read(data)))]

    return make


def _imu(fields: PackedFields) -> Read:
    instance = fields.value("I")
    accelerations = _vector(fields, "AccX", "AccY", "AccZ")
    rates = _vector(fields, "GyrX", "GyrY", "GyrZ")

    def facts(data: bytes) -> list[Fact]:
        return [] if instance(data) else _inertial(accelerations(data), rates(data))

    return facts


def _mag(fields: PackedFields) -> Read:
    instance, read = fields.value("I"), _vector(fields, "MagX", "MagY", "MagZ")

    def facts(data: bytes) -> list[Fact]:
        milligauss = read(data)
        return [] if instance(data) or milligauss is None else [Field(hypot(*milligauss) / 1e3)]

    return facts


def _vector(fields: PackedFields, *names: str) -> Callable[[bytes], Vec3 | None]:
    """None where one of the three is not known."""
    read = fields.values(*names)

    def vector(data: bytes) -> Vec3 | None:
        x, y, z = read(data)
        return None if x is None or y is None or z is None else (x, y, z)

    return vector


def _inertial(acceleration: Vec3 | None, rates: Vec3 | None) -> list[Fact]:
    facts: list[Fact] = []
    if acceleration is not None:
        facts.append(Acceleration(acceleration))
    if rates is not None:
        facts.append(Rotation(rates))
    return facts


def _ekf_wind(fields: PackedFields) -> Read:
    core, north, east = fields.value("C"), fields.value("VWN"), fields.value("VWE")

    def facts(data: bytes) -> list[Fact]:
        v_north, v_east = north(data), east(data)
        # Without a drag model it stays 0: that is no wind that was measured.
        if core(data) or not v_north or not v_east:
            return []
        return [wind(v_east, v_north)]

    return facts


def _parm(fields: PackedFields) -> Read:
    value, default = fields.value("Value"), fields.value("Default")
    return lambda data: [Parameter(fields.text("Name", data), value(data), default(data))]


def _ver(fields: PackedFields) -> Read:
    board = fields.value("APJ", "BT")

    def facts(data: bytes) -> list[Fact]:
        number = board(data)
        return [Build(fields.text("FWS", data), f"board {number:.0f}" if number else "")]

    return facts


def _pos(fields: PackedFields) -> Read:
    read = fields.values("Lat", "Lng", "Alt", "RelHomeAlt")

    def facts(data: bytes) -> list[Fact]:
        lat, lon, alt, above = read(data)
        if lat is None or lon is None or alt is None or above is None:
            return []
        return [Fix(lat, lon, alt, above)]

    return facts


def _cmd(fields: PackedFields) -> Read:
    read = fields.values("CNum", "CId", "Lat", "Lng", "Alt", "Frame")

    def facts(data: bytes) -> list[Fact]:
        seq, command, lat, lon, alt, frame = read(data)
        if seq is None or alt is None or command not in _PLACES or not lat or not lon:
            return []
        return [PlanItem(0, int(seq), lat, lon, alt, frame in _ABOVE_HOME)]

    return facts


# ----------------------------------------------------------------------------------- PX4's ULog


def _quaternion(name: str, first: int, leads: bool) -> _MakeRead:
    def make(fields: PackedFields) -> Read:
        read = fields.values(*(f"{name}_{n}" for n in range(4)))

        def facts(data: bytes) -> list[Fact]:
            w, x, y, z = read(data)
            if w is None or x is None or y is None or z is None:
                return []
            return [Sample("attitude", euler_deg((w, x, y, z)), first, leads)]

        return facts

    return make


def _rates(names: tuple[str, ...], first: int, leads: bool) -> _MakeRead:
    def make(fields: PackedFields) -> Read:
        read = fields.values(*names)
        return lambda data: [Sample("rates", tuple(map(_deg, read(data))), first, leads)]

    return make


def _place(fields: PackedFields) -> Read:
    read = fields.values("y", "x", "z")

    def facts(data: bytes) -> list[Fact]:
        east, north, down = read(data)
        return [
            Sample("place", (east, north, None if down is None else -down), WANTED, leads=False)
        ]

    return facts


def _motors(fields: PackedFields) -> Read:
    read = fields.values(*(f"control_{n}" for n in range(MOTORS)))
    return lambda data: [
        Sample("motors", tuple(None if v is None else 100.0 * v for v in read(data)))
    ]


def _sticks(fields: PackedFields) -> Read:
    each: tuple[Value, ...] = tuple(
        fields.value(*names)
        for names in (("roll", "y"), ("pitch", "x"), ("throttle", "z"), ("yaw", "r"))
    )

    def facts(data: bytes) -> list[Fact]:
        values = [read(data) for read in each]
        return [Sample("sticks", tuple(None if v is None else 100.0 * v for v in values))]

    return facts


def _wind(fields: PackedFields) -> Read:
    north, east = fields.value("windspeed_north"), fields.value("windspeed_east")

    def facts(data: bytes) -> list[Fact]:
        v_north, v_east = north(data), east(data)
        return [] if v_north is None or v_east is None else [wind(v_east, v_north)]

    return facts


def _sensor_combined(fields: PackedFields) -> Read:
    accelerations = _vector(fields, *(f"accelerometer_m_s2_{n}" for n in range(3)))
    rates = _vector(fields, *(f"gyro_rad_{n}" for n in range(3)))
    return lambda data: _inertial(accelerations(data), rates(data))


def _magnetometer(fields: PackedFields) -> Read:
    read = _vector(fields, *(f"magnetometer_ga_{n}" for n in range(3)))

    def facts(data: bytes) -> list[Fact]:
        gauss = read(data)
        return [] if gauss is None else [Field(hypot(*gauss))]

    return facts


def _defaults(fields: PackedFields) -> Read:
    value = fields.value("value")
    return lambda data: [Parameter(fields.text("name", data), None, value(data))]


_XYZ = ("xyz_0", "xyz_1", "xyz_2")
ONBOARD_SAMPLES: Mapping[tuple[str, str], _MakeRead] = {
    ("dataflash", "ATT"): _both(
        "attitude", ("Roll", "Pitch", "Yaw"), ("DesRoll", "DesPitch", "DesYaw")
    ),
    ("dataflash", "RATE"): _both("rates", ("R", "P", "Y"), ("RDes", "PDes", "YDes")),
    ("dataflash", "RCOU"): _pulses("motors", MOTORS, percent),
    ("dataflash", "RCIN"): _pulses("sticks", 4, stick),
    ("dataflash", "IMU"): _imu,
    ("dataflash", "MAG"): _mag,
    ("dataflash", "XKF2"): _ekf_wind,
    ("dataflash", "NKF2"): _ekf_wind,
    ("dataflash", "PARM"): _parm,
    ("dataflash", "VER"): _ver,
    ("dataflash", "POS"): _pos,
    ("dataflash", "CMD"): _cmd,
    ("ulog", "vehicle_attitude_0"): _quaternion("q", 0, True),
    ("ulog", "vehicle_attitude_setpoint_0"): _quaternion("q_d", WANTED, False),
    ("ulog", "vehicle_angular_velocity_0"): _rates(_XYZ, 0, True),
    ("ulog", "vehicle_rates_setpoint_0"): _rates(("roll", "pitch", "yaw"), WANTED, False),
    ("ulog", "vehicle_local_position_setpoint_0"): _place,
    ("ulog", "actuator_motors_0"): _motors,
    ("ulog", "manual_control_setpoint_0"): _sticks,
    ("ulog", "wind_0"): _wind,
    ("ulog", "wind_estimate_0"): _wind,
    ("ulog", "sensor_combined_0"): _sensor_combined,
    ("ulog", "vehicle_magnetometer_0"): _magnetometer,
    ("ulog", "parameter_defaults"): _defaults,
}
