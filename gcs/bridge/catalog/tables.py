"""The whole classification: a row for every message and every MAV_CMD of the dialect.

The tables are read and put together when something is looked up for the first time: a station
without MAVLink clients never does.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Final

from gcs.bridge.catalog.row import Kind, Row, table_of

UNKNOWN: Final = "What is not in the dialect cannot be judged."


@cache
def message_rows() -> Mapping[int, Row]:
    """By message id, in order."""
    from gcs.bridge.catalog.message_dangers import DANGERS
    from gcs.bridge.catalog.message_estimator import ESTIMATOR
    from gcs.bridge.catalog.message_reports import REPORTS
    from gcs.bridge.catalog.message_requests import REQUESTS

    return table_of((*REQUESTS, *ESTIMATOR, *DANGERS, *REPORTS))


@cache
def command_rows() -> Mapping[int, Row]:
    """By MAV_CMD, in order."""
    from gcs.bridge.catalog.command_devices import DEVICES
    from gcs.bridge.catalog.command_flight import FLIGHT
    from gcs.bridge.catalog.command_items import ITEMS
    from gcs.bridge.catalog.command_setup import SETUP

    return table_of((*FLIGHT, *DEVICES, *SETUP, *ITEMS))


def message_row(msgid: int) -> Row:
    """The row of a message.  One that the dialect lacks is denied."""
    return message_rows().get(msgid) or Row(f"UNKNOWN_{msgid}", Kind.DENIED, UNKNOWN)


def command_row(command: int) -> Row:
    """The row of a MAV_CMD.  One that the dialect lacks is denied."""
    return command_rows().get(command) or Row(f"UNKNOWN_{command}", Kind.DENIED, UNKNOWN)
