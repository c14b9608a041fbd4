"""Which messages of a vehicle are decoded and looked at; all others are counted and passed on."""

from __future__ import annotations

from typing import Final, get_args

from gcs.protocol.transfers.transfer import PlanMessage
from gcs.vehicle.health.limit_monitors import WATCH_MESSAGES
from gcs.vehicle.message_to_telemetry import UPDATE_MESSAGES
from gcs.vehicle.talk.liveness import STATE_MESSAGES
from gcs.vehicle.talk.px4_events import EVENT_MESSAGES
from gcs.wire import messages as m
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Component, MavAutopilot, MavType

CAMERA_MESSAGES: Final = frozenset({m.CameraImageCaptured, m.CameraFeedback})
PARAMETER_MESSAGES: Final = frozenset({m.ParamValue, m.ParamError})
FILE_MESSAGES: Final = frozenset({m.FileTransferProtocol, m.LogEntry, m.LogData})
MISSION_MESSAGES: Final = frozenset(
    {m.MissionCurrent, m.MissionItemReached, *get_args(PlanMessage)}
)

INTERPRETED: Final = frozenset(
    kind.MSG_ID
    for kind in (
        *UPDATE_MESSAGES,
        *PARAMETER_MESSAGES,
        *FILE_MESSAGES,
        *MISSION_MESSAGES,
        *EVENT_MESSAGES,
        *STATE_MESSAGES,
        *WATCH_MESSAGES,
        m.CommandAck,
        m.CommandLong,
        m.Statustext,
        m.AutopilotVersion,
        m.ControlStatus,
    )
)
"""Ids of the messages that a `Vehicle` does something with; the others are only counted."""

PLACE_MESSAGES: Final[frozenset[type[m.Message]]] = frozenset(
    {m.LocalPositionNed, m.Attitude, m.GlobalPositionInt}
)
"""Where it is: nearly all that is interpreted."""
PLACES: Final = frozenset(kind.MSG_ID for kind in PLACE_MESSAGES)
"""Their ids.  No part waits for them, so what they lead to tells whether a deadline has changed."""


def is_autopilot(frame: Frame) -> bool:
    """A HEARTBEAT of an autopilot, not of a ground station, a camera or a radio."""
    beat = decode(frame) if frame.compid == Component.AUTOPILOT1 else None
    return isinstance(beat, m.Heartbeat) and of_autopilot(beat)


def of_autopilot(beat: m.Heartbeat) -> bool:
    """What the heartbeat says its sender is; its component number is not looked at."""
    return beat.type != MavType.GCS and beat.autopilot != MavAutopilot.INVALID
