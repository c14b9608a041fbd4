"""Which operator is told of which MAVLink messages of the vehicle, and how often."""

from __future__ import annotations

from gcs import ipc
from gcs.session.effects import Effect, Emit
from gcs.wire.dialect import MESSAGES_BY_NAME
from gcs.wire.fields import fields_of
from gcs.wire.frame import Frame

LEAST_INTERVAL_NS = 100_000_000
MAX_MESSAGES = 64
"""Names in one subscription."""


class Subscriptions:
    """Each operator's latest `ipc.Subscribe`."""

    def __init__(self, speedup: float) -> None:
        self._interval_ns = round(LEAST_INTERVAL_NS * speedup)
        self._told_ns: dict[int, dict[int, int]] = {}
        """Message id -> client -> when it was told last."""

    def subscribe(self, client: int, names: list[str]) -> list[Effect]:
        """In place of what it had; what is no message of the dialect is told."""
        self.forget(client)
        known = [MESSAGES_BY_NAME[name].msgid for name in names if name in MESSAGES_BY_NAME]
        for msgid in known[:MAX_MESSAGES]:
            self._told_ns.setdefault(msgid, {})[client] = 0
        unknown = [name for name in names if name not in MESSAGES_BY_NAME]
        if unknown:
            text = f"no such MAVLink message: {', '.join(unknown[:3])}"
            return [Emit(ipc.Trouble(text, "names are as in the dialect: BATTERY_STATUS"), client)]
        if len(known) > MAX_MESSAGES:
            text = f"{len(known)} messages subscribed to: only the first {MAX_MESSAGES} are told"
            return [Emit(ipc.Trouble(text), client)]
        return []

    def forget(self, client: int) -> None:
        """It has left."""
        for clients in self._told_ns.values():
            clients.pop(client, None)

    def heard(self, frame: Frame, now_ns: int) -> list[Effect]:
        """A good frame of the vehicle: who is told of it."""
        clients = self._told_ns.get(frame.msgid)
        if not clients:
            return []
        due = [each for each, told in clients.items() if now_ns - told >= self._interval_ns]
        if not due:
            return []
        fields = fields_of(frame)
        event = ipc.MessageEvent(frame.name, now_ns, frame.sysid, frame.compid, fields)
        for client in due:
            clients[client] = now_ns
        return [Emit(event, client) for client in due]
