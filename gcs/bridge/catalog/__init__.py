"""What the gate does with each message and each command of a client: a total table.

A row says which kind a message or command is and why.  What the dialect lacks is denied.  Direction
is from client to vehicle; what the vehicle sends goes to clients unchanged.
"""

from gcs.bridge.catalog.explain import explain, explanation
from gcs.bridge.catalog.row import Kind, Row
from gcs.bridge.catalog.tables import command_row, message_row

__all__ = ["Kind", "Row", "command_row", "explain", "explanation", "message_row"]
