"""Vehicles as the bridge sees them, and clients' messages as pymavlink puts them on the wire."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from pymavlink import mavutil
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.translate.meaning import Reject, Seen, Words
from gcs.gate.airspace.projection import Origin
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.wire.codec import decode
from gcs.wire.frame import Frame, split
from gcs.wire.messages import Message

NAN = math.nan
UNSET = 2**31 - 1
COPTER_MODES = {name: number for number, name in mavutil.mode_mapping_acm.items()}
HOVERING = {PX4.name: "OFFBOARD", ARDUPILOT.name: "GUIDED"}


def flying(autopilot: Autopilot, **changed: Any) -> Seen:
    """Hovering under the gate's control 10 m above home, which is 12 m above the origin's level."""
    seen = Seen(
        autopilot=autopilot,
        origin=Origin(47.397742, 8.545594, 488.0),
        home_ned=(1.0, 2.0, -12.0),
        home_amsl_m=500.0,
        pos_ned=(1.0, 2.0, -22.0),
        v_ned=(0.0, 0.0, 0.0),
        yaw_rad=math.radians(90.0),
        on_ground=False,
        armed=True,
        mode_name=HOVERING[autopilot.name],
        goal_ned=(1.0, 2.0, -22.0),
        takeoff_up_m=2.5,
        state=State.HOVERING,
        in_control=True,
        max_speed_m_s=5.0,
        stream=DEFAULT.stream,
    )
    return replace(seen, **changed)


def standing(autopilot: Autopilot, **changed: Any) -> Seen:
    """Disarmed on the ground, at home."""
    ground: dict[str, Any] = {
        "pos_ned": (1.0, 2.0, -12.0),
        "goal_ned": None,
        "on_ground": True,
        "armed": False,
        "mode_name": "AUTO.LOITER" if autopilot is PX4 else "STABILIZE",
        "state": State.GROUNDED,
    }
    return flying(autopilot, **{**ground, **changed})


def sent(message: Any) -> Message:
    """A message of pymavlink as the bridge decodes it from the wire."""
    packed = message.pack(mavlink.MAVLink(None, srcSystem=255, srcComponent=190))
    (frame,) = split(packed)
    assert isinstance(frame, Frame)
    decoded = decode(frame)
    assert decoded is not None
    return decoded


def command_long(command: int, *params: float) -> Message:
    """COMMAND_LONG to 1/1; parameters that are left out are 0."""
    p1, p2, p3, p4, p5, p6, p7 = params + (0.0,) * (7 - len(params))
    return sent(mavlink.MAVLink_command_long_message(1, 1, command, 0, p1, p2, p3, p4, p5, p6, p7))


def command_int(
    command: int, frame: int, params: tuple[float, ...] = (), x: int = 0, y: int = 0, z: float = 0.0
) -> Message:
    """COMMAND_INT to 1/1; x and y as they are on the wire."""
    p1, p2, p3, p4 = params + (0.0,) * (4 - len(params))
    return sent(
        mavlink.MAVLink_command_int_message(1, 1, frame, command, 0, 0, p1, p2, p3, p4, x, y, z)
    )


def px4_mode(name: str) -> Message:
    """DO_SET_MODE as pymavlink's `set_mode_px4`: base mode, main mode, sub mode."""
    return command_long(176, *map(float, mavutil.px4_map[name]))


def copter_mode(name: str) -> Message:
    """As pymavlink's `set_mode_apm` for a vehicle that takes DO_SET_MODE."""
    return command_long(176, 1.0, float(COPTER_MODES[name]))


def words(meaning: object) -> list[str]:
    """The words of what is asked for."""
    assert isinstance(meaning, Words), meaning
    return [ask.word for ask in meaning.asks]


def refusal(meaning: object) -> str:
    """The code and the sentence of a refusal."""
    assert isinstance(meaning, Reject), meaning
    return f"{meaning.refusal.code}: {meaning.refusal.sentence}"


def goal(meaning: object) -> tuple[float, float, float]:
    """East, north, up of the one go-to that is asked for, last."""
    assert isinstance(meaning, Words), meaning
    wanted = meaning.asks[-1]
    assert wanted.word == "goto"
    assert wanted.goal_enu is not None
    east, north, up = wanted.goal_enu
    assert east is not None
    assert north is not None
    assert up is not None
    return (east, north, up)
