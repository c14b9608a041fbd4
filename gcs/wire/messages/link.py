"""Messages about the sender and the link itself."""

from __future__ import annotations

from typing import ClassVar

from gcs.wire.ids import MsgId
from gcs.wire.messages.base import Message


class Heartbeat(Message, frozen=True, gc=False):
    """I am here, this is what I am and what I do."""

    MSG_ID: ClassVar[MsgId] = MsgId.HEARTBEAT
    custom_mode: int
    type: int  # MAV_TYPE
    autopilot: int  # MAV_AUTOPILOT
    base_mode: int  # MAV_MODE_FLAG
    system_status: int  # MAV_STATE
    mavlink_version: int = 3


class SystemTime(Message, frozen=True, gc=False):
    """The sender's clocks."""

    MSG_ID: ClassVar[MsgId] = MsgId.SYSTEM_TIME
    time_unix_usec: int  # us
    time_boot_ms: int  # ms


class Ping(Message, frozen=True, gc=False):
    """Asks for, or is, an echo."""

    MSG_ID: ClassVar[MsgId] = MsgId.PING
    time_usec: int  # us
    seq: int
    target_system: int
    target_component: int


class Timesync(Message, frozen=True, gc=False):
    """Two stamps that tell two clocks apart."""

    MSG_ID: ClassVar[MsgId] = MsgId.TIMESYNC
    tc1: int  # ns
    ts1: int  # ns
    target_system: int = 0
    target_component: int = 0


class RequestDataStream(Message, frozen=True, gc=False):
    """The old way to ask for a group of messages at a rate."""

    MSG_ID: ClassVar[MsgId] = MsgId.REQUEST_DATA_STREAM
    req_message_rate: int  # Hz
    target_system: int
    target_component: int
    req_stream_id: int  # MAV_DATA_STREAM
    start_stop: int


class MessageInterval(Message, frozen=True, gc=False):
    """At what interval a message is sent: -1 never, 0 not available."""

    MSG_ID: ClassVar[MsgId] = MsgId.MESSAGE_INTERVAL
    interval_us: int  # us
    message_id: int


class RadioStatus(Message, frozen=True, gc=False):
    """What a telemetry radio says about its link."""

    MSG_ID: ClassVar[MsgId] = MsgId.RADIO_STATUS
    rxerrors: int
    fixed: int
    rssi: int
    remrssi: int
    txbuf: int  # %
    noise: int
    remnoise: int


class Statustext(Message, frozen=True, gc=False):
    """A line for people; `id` and `chunk_seq` join the pieces of a long one."""

    MSG_ID: ClassVar[MsgId] = MsgId.STATUSTEXT
    severity: int  # MAV_SEVERITY
    text: str
    id: int = 0
    chunk_seq: int = 0


class AutopilotVersion(Message, frozen=True, gc=False):
    """What the autopilot is and what it can do."""

    MSG_ID: ClassVar[MsgId] = MsgId.AUTOPILOT_VERSION
    capabilities: int  # MAV_PROTOCOL_CAPABILITY
    uid: int
    flight_sw_version: int
    middleware_sw_version: int
    os_sw_version: int
    board_version: int
    vendor_id: int
    product_id: int
    flight_custom_version: tuple[int, ...]  # 8
    middleware_custom_version: tuple[int, ...]  # 8
    os_custom_version: tuple[int, ...]  # 8
    uid2: tuple[int, ...] = (0,) * 18  # 18


class ProtocolVersion(Message, frozen=True, gc=False):
    """Which versions of MAVLink the sender speaks, times 100."""

    MSG_ID: ClassVar[MsgId] = MsgId.PROTOCOL_VERSION
    version: int
    min_version: int
    max_version: int
    spec_version_hash: tuple[int, ...]  # 8
    library_version_hash: tuple[int, ...]  # 8
