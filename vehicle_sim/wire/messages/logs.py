"""Flight logs on board and their download.

One named tuple a message, fields in wire order, values as MAVLink has them (units and frames are
the dialect's).  `char[n]` and `uint8_t[n]` are `bytes`, shorter ones are padded with zeros.
"""

from __future__ import annotations

from typing import NamedTuple


class LogRequestList(NamedTuple):
    start: int
    end: int
    target_system: int
    target_component: int


class LogEntry(NamedTuple):
    time_utc: int
    size: int
    id: int
    num_logs: int
    last_log_num: int


class LogRequestData(NamedTuple):
    ofs: int
    count_: int
    id: int
    target_system: int
    target_component: int


class LogData(NamedTuple):
    ofs: int
    id: int
    count_: int
    data: bytes


class LogErase(NamedTuple):
    target_system: int
    target_component: int


class LogRequestEnd(NamedTuple):
    target_system: int
    target_component: int
