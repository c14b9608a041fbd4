"""What the ground station sent, decoded by pymavlink.

Nothing here touches our own codec, frames or tables, so that a mistake in them is seen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

from pymavlink.dialects.v20 import all as dialect

Vec3 = tuple[float, float, float]

MAGIC = b"\xfd\xfe"
LOCAL_NED = 1
POSITION_ONLY = 3576
POSITION_AND_YAW = 2552


@dataclass(frozen=True, slots=True)
class SeenSetpoint:
    """SET_POSITION_TARGET_LOCAL_NED off the wire: position in metres NED, the rest as `others`."""

    time_ns: int
    pos_ned: Vec3
    yaw_rad: float
    type_mask: int
    frame: int
    others: tuple[float, ...]

    @property
    def finite(self) -> bool:
        return all(map(math.isfinite, (*self.pos_ned, self.yaw_rad, *self.others)))


@cache
def _decoder() -> Any:  # pymavlink has no types
    return dialect.MAVLink(None)


def read(data: bytes) -> Any:
    """The one message of a datagram; raises where pymavlink finds anything wrong with it.

    Between frames a receiver skips what is no magic byte (see `gcs/wire/hidden_frames.py`).
    """
    first = next((at for at, byte in enumerate(data) if byte in MAGIC), 0)
    return _decoder().decode(bytearray(data[first:]))


def setpoint_of(message: Any, time_ns: int) -> SeenSetpoint | None:
    """The message as a setpoint, if it is one."""
    if message.get_type() != "SET_POSITION_TARGET_LOCAL_NED":
        return None
    m = message
    return SeenSetpoint(
        time_ns,
        (m.x, m.y, m.z),
        m.yaw,
        m.type_mask,
        m.coordinate_frame,
        (m.vx, m.vy, m.vz, m.afx, m.afy, m.afz, m.yaw_rate),
    )


def local_position(boot_ms: int, pos_ned: Vec3, v_ned: Vec3, seq: int) -> bytes:
    """LOCAL_POSITION_NED of vehicle 1/1, packed by pymavlink."""
    mav = dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    mav.seq = seq & 0xFF
    message = dialect.MAVLink_local_position_ned_message(boot_ms, *pos_ned, *v_ned)
    return bytes(message.pack(mav))
