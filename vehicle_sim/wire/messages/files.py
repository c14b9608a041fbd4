"""Files: MAVLink FTP, and where a component's metadata is to be had.

As in `tasks`: one named tuple a message, fields in wire order.
"""

from __future__ import annotations

from typing import NamedTuple


class FileTransferProtocol(NamedTuple):
    target_network: int
    target_system: int
    target_component: int
    payload: bytes


class ComponentMetadata(NamedTuple):
    time_boot_ms: int
    file_crc: int
    uri: bytes
