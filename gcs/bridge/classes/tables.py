"""The whole classification: a row for every message and every MAV_CMD of the dialect."""

from __future__ import annotations

from typing import Final

from gcs.bridge.classes.command_devices import DEVICES
from gcs.bridge.classes.command_flight import FLIGHT
from gcs.bridge.classes.command_items import ITEMS
from gcs.bridge.classes.command_setup import SETUP
from gcs.bridge.classes.message_dangers import DANGERS
from gcs.bridge.classes.message_estimator import ESTIMATOR
from gcs.bridge.classes.message_reports import REPORTS
from gcs.bridge.classes.message_requests import REQUESTS
from gcs.bridge.classes.row import Kind, Row, table_of

MESSAGE_ROWS: Final = table_of((*REQUESTS, *ESTIMATOR, *DANGERS, *REPORTS))
"""By message id, in order."""

COMMAND_ROWS: Final = table_of((*FLIGHT, *DEVICES, *SETUP, *ITEMS))
"""By MAV_CMD, in order."""

UNKNOWN: Final = "What is not in the dialect cannot be judged."


def message_row(msgid: int) -> Row:
    """The row of a message.  One that the dialect lacks is denied."""
    return MESSAGE_ROWS.get(msgid) or Row(f"UNKNOWN_{msgid}", Kind.DENIED, UNKNOWN)


def command_row(command: int) -> Row:
    """The row of a MAV_CMD.  One that the dialect lacks is denied."""
    return COMMAND_ROWS.get(command) or Row(f"UNKNOWN_{command}", Kind.DENIED, UNKNOWN)
