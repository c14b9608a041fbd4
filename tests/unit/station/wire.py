"""A vehicle and a pair of eyes on the wire, both pymavlink's: nothing of our own codec is in them.

Numbers are MAVLink's (common.xml) and, for modes, those of PX4's px4_custom_mode.h.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from typing import Any

from pymavlink.dialects.v20 import all as mavlink

from gcs.frames import Vec3
from gcs.session.effects import Transmit

SECOND_NS = 1_000_000_000
MS_NS = 1_000_000
START_NS = 100 * SECOND_NS

PX4, ARDUPILOT, GENERIC, NO_AUTOPILOT = 12, 3, 0, 8
QUADROTOR, GCS = 2, 6
ON_GROUND, IN_AIR = 1, 2
OFFBOARD, POSCTL = 6 << 16, 3 << 16
LOITER, MISSION = 4 << 16 | 3 << 24, 4 << 16 | 4 << 24

HOME_DEG = (47.397742, 8.545594)
HOME_AMSL_M = 488.0

Message = Any  # pymavlink has no types


class Sender:
    """One component: numbers its frames and packs them, for MAVLink 2 or 1."""

    def __init__(self, sysid: int = 1, compid: int = 1) -> None:
        self.sysid, self.compid = sysid, compid
        self.seq = 0
        self._mav = mavlink.MAVLink(None, srcSystem=sysid, srcComponent=compid)

    def frame(self, message: Message, *, mavlink1: bool = False) -> bytes:
        self._mav.seq = self.seq
        self.seq = (self.seq + 1) & 0xFF
        return bytes(message.pack(self._mav, force_mavlink1=mavlink1))


def heartbeat(
    autopilot: int = PX4,
    *,
    armed: bool = False,
    mode: int = LOITER,
    status: int = 4,
    type_: int = QUADROTOR,
) -> Message:
    base_mode = 1 | (128 if armed else 0)
    return mavlink.MAVLink_heartbeat_message(type_, autopilot, base_mode, mode, status, 3)


def landed(state: int) -> Message:
    return mavlink.MAVLink_extended_sys_state_message(0, state)


def position(boot_ms: int, pos_ned: Vec3, v_ned: Vec3 = (0.0, 0.0, 0.0)) -> Message:
    return mavlink.MAVLink_local_position_ned_message(boot_ms, *pos_ned, *v_ned)


def origin() -> Message:
    lat, lon = (round(degrees * 1e7) for degrees in HOME_DEG)
    return mavlink.MAVLink_gps_global_origin_message(lat, lon, round(HOME_AMSL_M * 1e3))


def home() -> Message:
    """At the origin."""
    lat, lon = (round(degrees * 1e7) for degrees in HOME_DEG)
    rest = (0.0, 0.0, 0.0, [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0)
    return mavlink.MAVLink_home_position_message(lat, lon, round(HOME_AMSL_M * 1e3), *rest)


def system(*, armable: bool) -> Message:
    """SYS_STATUS: the pre-arm check (MAV_SYS_STATUS_PREARM_CHECK) is there, and healthy or not."""
    prearm = 0x10000000
    rest = (0, 16_000, -1, 90, 0, 0, 0, 0, 0, 0)
    return mavlink.MAVLink_sys_status_message(prearm, prearm, prearm if armable else 0, *rest)


def picture(index: int) -> Message:
    """CAMERA_IMAGE_CAPTURED: it worked."""
    place = (0, 0, 0, 0, [1.0, 0.0, 0.0, 0.0])
    return mavlink.MAVLink_camera_image_captured_message(0, 0, 0, *place, index, 1, b"")


def ack(command: int, result: int = 0) -> Message:
    return mavlink.MAVLink_command_ack_message(command, result)


def mission_count(items: int, kind: int = 0) -> Message:
    """How many items of a mission, or of another plan, are on board, for the ground station."""
    return mavlink.MAVLink_mission_count_message(255, 190, items, kind)


RALLY = 2
"""MAV_MISSION_TYPE_RALLY"""


def no_rally_points() -> Message:
    return mission_count(0, RALLY)


def text(severity: int, words: str, id: int = 0, chunk_seq: int = 0) -> Message:
    return mavlink.MAVLink_statustext_message(severity, words.encode(), id, chunk_seq)


def int_param(name: str, value: int) -> Message:
    """PX4's way: the integer's bytes in the place of the float."""
    (as_float,) = struct.unpack("<f", struct.pack("<i", value))
    return mavlink.MAVLink_param_value_message(name.encode(), as_float, 6, 900, 1)


def float_param(name: str, value: float) -> Message:
    return mavlink.MAVLink_param_value_message(name.encode(), value, 9, 900, 1)


def no_param(name: str, to: tuple[int, int] = (255, 190)) -> Message:
    """PARAM_ERROR: it does not exist."""
    return mavlink.MAVLink_param_error_message(*to, name.encode(), -1, 1)


def read(raw: bytes) -> Message:
    """The one frame in `raw`; raises where pymavlink finds anything wrong with it."""
    return mavlink.MAVLink(None).decode(bytearray(raw))


def sent(effects: Iterable[object], kind: str = "", link: int | None = None) -> list[Message]:
    """What left, in order: of one kind (`HEARTBEAT`), on one link."""
    transmits = [effect for effect in effects if isinstance(effect, Transmit)]
    messages = [read(t.data) for t in transmits if link is None or t.link == link]
    return [message for message in messages if kind in ("", message.get_type())]
