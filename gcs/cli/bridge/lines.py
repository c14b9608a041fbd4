"""`gcs bridge` on a pipe: a line for each decision, log line and change, and a status now and then.

Decisions and status go to standard output, the log to standard error.
"""

from __future__ import annotations

from collections.abc import Callable

from gcs import ipc
from gcs.cli.bridge import text as bridge_text
from gcs.operator.text import event_text

Printer = Callable[[str], None]
STATUS_EVERY_NS = 10_000_000_000


class BridgeLines:
    """A `Display` that prints."""

    def __init__(self, out: Printer, err: Printer, *, min_level: int, as_json: bool) -> None:
        """`as_json`: every event as it came, to `out`; nothing else there."""
        self._out, self._err = out, err
        self._min_level = min_level
        self._as_json = as_json
        self._seen: ipc.Snapshot | None = None
        self._status_ns = 0
        self._status_clients: list[str] | None = None
        self._status_before: ipc.BridgeStatus | None = None

    def event(self, event: ipc.Event) -> None:
        if self._as_json:
            self._out(ipc.encode(event).decode().rstrip())
            return
        match event:
            case ipc.Hello():
                for where in event.endpoints:
                    self._err(f"vehicle: {where}")
                for where in event.client_ports:
                    self._err(f"clients: {where}")
                self._err(f"policy: {event.policy}; log: {event.log_path or 'none'}")
            case ipc.Snapshot():
                if event.vehicle and (self._seen is None or not self._seen.vehicle):
                    self._out(f"vehicle: {bridge_text.vehicle_line(event)}")
                self._seen = event
            case ipc.BridgeStatus():
                self._status(event)
            case ipc.BridgeDecision():
                before = self._status_before
                several = before is not None and len(before.vehicles) > 1
                self._out(bridge_text.decision_line(event, several=several))
            case ipc.StateEvent():
                how = f"control {event.control}, severity {event.severity}"
                self._out(f"state: {event.before} -> {event.after} ({event.event}), {how}")
            case ipc.LogEvent() if event.level >= self._min_level:
                self._err(event_text.log_line(event))
            case ipc.Trouble() if not event.exit_code:
                self._err("\n".join(event_text.trouble_lines(event)))
            case _:
                pass

    def _status(self, status: ipc.BridgeStatus) -> None:
        """Every ten seconds, and when a client has come or gone."""
        for line in bridge_text.moves(self._status_before, status):
            self._out(line)
        self._status_before = status
        clients = [each.name for each in status.clients]
        if clients != self._status_clients or status.time_ns >= self._status_ns:
            self._status_clients = clients
            self._status_ns = status.time_ns + STATUS_EVERY_NS
            self._out(bridge_text.status_line(status, self._seen))

    def draw(self) -> None:
        """Everything has been printed as it came."""
