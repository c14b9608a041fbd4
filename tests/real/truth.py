"""What the simulation says: where the vehicle is, never where it believes to be.

HIL_STATE_QUATERNION of PX4's SIH, SIM_STATE of ArduCopter's SITL.  Positions are east, north, up in
metres, of where it stood when the first message came; times are the vehicle's own, since boot.
"""

import math
from dataclasses import dataclass
from typing import Any

Vector = tuple[float, float, float]
RADIUS_M = 6_378_137.0
MESSAGES = {"HIL_STATE_QUATERNION": 115, "SIM_STATE": 108}


@dataclass(frozen=True)
class Sample:
    at_s: float
    position_enu: Vector
    velocity_enu: Vector
    tilt_deg: float = 0.0
    yaw_deg: float = 0.0  # of the nose, clockwise from north

    @property
    def speed_m_s(self) -> float:
        return math.hypot(*self.velocity_enu)


class Truth:
    """Takes the messages of a link; `samples` are all that told the truth."""

    def __init__(self) -> None:
        self.samples: list[Sample] = []
        self.origin: Vector | None = None  # latitude, longitude, metres
        self.clock_s = 0.0

    def take(self, message: Any) -> None:
        match message.get_type():
            case "LOCAL_POSITION_NED" | "ATTITUDE":
                self.clock_s = message.time_boot_ms / 1e3
                return
            case "HIL_STATE_QUATERNION":
                w, x, y, z = message.attitude_quaternion
                yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
                tilt = math.acos(max(-1.0, min(1.0, 1.0 - 2.0 * (x * x + y * y))))
                velocity = (message.vy / 100.0, message.vx / 100.0, -message.vz / 100.0)
                place = (message.lat / 1e7, message.lon / 1e7, message.alt / 1e3)
            case "SIM_STATE":
                tilt, yaw = math.acos(math.cos(message.roll) * math.cos(message.pitch)), message.yaw
                velocity = (message.ve, message.vn, -message.vd)
                place = (message.lat_int / 1e7, message.lon_int / 1e7, message.alt)
            case _:
                return
        if self.origin is None:
            self.origin = place
        position = self.enu(*place)
        self.samples.append(
            Sample(self.clock_s, position, velocity, math.degrees(tilt), math.degrees(yaw))
        )

    def enu(self, lat: float, lon: float, alt_m: float) -> Vector:
        assert self.origin is not None
        lat0, lon0, alt0 = self.origin
        east = math.radians(lon - lon0) * RADIUS_M * math.cos(math.radians(lat0))
        return (east, math.radians(lat - lat0) * RADIUS_M, alt_m - alt0)

    @property
    def now(self) -> Sample:
        return self.samples[-1]
