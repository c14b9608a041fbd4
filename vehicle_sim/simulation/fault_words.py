"""A fault as a sentence, for the log: what is wrong from now on, or that it is right again."""

from __future__ import annotations

from math import atan2, degrees, hypot
from typing import assert_never

from vehicle_sim.plant import faults as model
from vehicle_sim.simulation.fault_script import AnyFault, LinkFault

_NO_MOTION = model.NOTHING


def described(fault: AnyFault) -> str:
    """`the wind is 4 m/s from 180 degrees, with gusts of 1 m/s`."""
    match fault:
        case model.GpsLost(lost):
            return "GPS is lost" if lost else "GPS is back"
        case model.GpsGlitch(offset):
            if offset == _NO_MOTION:
                return "GPS is right again"
            return f"every GPS fix is off by {_vector(offset)} m (north, east, down)"
        case model.MotorFault(motor, health):
            if health == 1.0:
                return f"motor {motor} is sound again"
            return f"motor {motor} gives {_number(100.0 * health)} % of its thrust"
        case model.CellsLost(cells):
            if cells == 0.0:
                return "the battery is sound again"
            return f"the battery's voltage falls by {_number(cells)} cells"
        case model.Payload(mass_kg):
            return f"it carries {_number(mass_kg)} kg more than its data sheet says"
        case model.CentreOfMass(forward_m, right_m):
            where = f"{_number(forward_m)} m forward and {_number(right_m)} m right"
            return f"the centre of mass is {where} of the rotors' centre"
        case model.WeakBattery(resistance, capacity):
            return (
                f"the battery has {_number(resistance)} times its resistance and "
                f"{_number(capacity)} times its capacity"
            )
        case model.ThrustScale(scale):
            return f"the motors give {_number(scale)} times their thrust"
        case model.InertiaScale(scale):
            return f"the body has {_number(scale)} times its inertia"
        case model.WindChange(wind, gust_m_s):
            return _wind(wind, gust_m_s)
        case model.AccelBias(off):
            return f"the accelerometer is off by {_vector(off)} m/s2 (forward, right, down)"
        case model.GyroBias(off):
            return f"the gyroscope is off by {_vector(off)} rad/s (forward, right, down)"
        case model.BaroFault(offset_m, lost):
            wrong = f"the barometer is off by {_number(offset_m)} m"
            return "the barometer is lost" if lost else wrong
        case model.MagFault(offset, lost):
            wrong = f"the compass is off by {_vector(offset)} gauss (forward, right, down)"
            return "the compass is lost" if lost else wrong
        case model.RcLost(lost):
            return "the sticks are lost" if lost else "the sticks are back"
        case model.ClockJump(by_ns):
            return f"the clock jumps by {_number(by_ns / 1e9)} s"
        case model.Reboot():
            return "it reboots"
        case LinkFault():
            return _link(fault)
        case _:
            assert_never(fault)


def _wind(wind_ned: model.Vec3, gust_m_s: float) -> str:
    north, east, down = wind_ned
    gusts = f", with gusts of {_number(gust_m_s)} m/s" if gust_m_s else ""
    if wind_ned == _NO_MOTION:
        return f"no wind{gusts}"
    from_deg = degrees(atan2(-east, -north)) % 360.0
    falling = f", {_number(down)} m/s downwards" if down else ""
    speed = _number(hypot(north, east))
    return f"the wind is {speed} m/s from {_number(from_deg)} degrees{falling}{gusts}"


def _link(fault: LinkFault) -> str:
    which = "every link" if fault.link is None else f"link {fault.link}"
    way = {"in": " towards the vehicle", "out": " from the vehicle", "both": ""}[fault.direction]
    if fault.out:
        return f"{which} loses everything{way}"
    parts = [
        f"{verb} {_number(100.0 * rate)} %"
        for verb, rate in (
            ("loses", fault.loss),
            ("doubles", fault.duplicate),
            ("reorders", fault.reorder),
        )
        if rate
    ]
    if fault.delay_s or fault.jitter_s:
        parts.append(f"delays by {_number(fault.delay_s)} s, +-{_number(fault.jitter_s)} s")
    return f"{which} {', '.join(parts) if parts else 'is sound'}{way}"


def _vector(values: model.Vec3) -> str:
    return ", ".join(map(_number, values))


def _number(value: float) -> str:
    """Three digits, and never -0."""
    return f"{round(value, 6) + 0.0:.3g}"
