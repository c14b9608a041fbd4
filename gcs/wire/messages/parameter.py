"""The parameter protocol."""

from __future__ import annotations

from typing import ClassVar

from gcs.wire.ids import MsgId
from gcs.wire.messages.base import Message


class ParamRequestRead(Message, frozen=True, gc=False):
    """Send me one parameter: by name if `param_index` is -1."""

    MSG_ID: ClassVar[MsgId] = MsgId.PARAM_REQUEST_READ
    param_index: int
    target_system: int
    target_component: int
    param_id: str


class ParamRequestList(Message, frozen=True, gc=False):
    """Send me all parameters."""

    MSG_ID: ClassVar[MsgId] = MsgId.PARAM_REQUEST_LIST
    target_system: int
    target_component: int


class ParamValue(Message, frozen=True, gc=False):
    """A parameter; how integers travel in `param_value` is up to the autopilot."""

    MSG_ID: ClassVar[MsgId] = MsgId.PARAM_VALUE
    param_value: float
    param_count: int
    param_index: int
    param_id: str
    param_type: int  # MAV_PARAM_TYPE


class ParamSet(Message, frozen=True, gc=False):
    """Change a parameter."""

    MSG_ID: ClassVar[MsgId] = MsgId.PARAM_SET
    param_value: float
    target_system: int
    target_component: int
    param_id: str
    param_type: int  # MAV_PARAM_TYPE


class ParamError(Message, frozen=True, gc=False):
    """Why a parameter was neither sent nor changed."""

    MSG_ID: ClassVar[MsgId] = MsgId.PARAM_ERROR
    param_index: int
    target_system: int
    target_component: int
    param_id: str
    error: int  # MAV_PARAM_ERROR
