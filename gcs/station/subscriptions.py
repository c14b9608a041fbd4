"""Which operator is told of which MAVLink messages of the vehicle, and how often."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from gcs import ipc
from gcs.session.effects import Effect, Emit
from gcs.session.speedup_waits import Times
from gcs.vehicle.talk.discovery import message_interval
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.dialect import MESSAGES_BY_NAME
from gcs.wire.fields import fields_of
from gcs.wire.frame import Frame
from gcs.wire.messages import CommandLong

LEAST_INTERVAL_NS = 100_000_000
PATIENCE_NS = 1_200_000_000
"""A message that has not come for so long is asked for, and again after as long."""
ASKED_HZ = 2.0
MAX_MESSAGES = 64
"""Names in one subscription."""


class Subscriptions:
    """Each operator's latest `ipc.Subscribe`."""

    def __init__(self, times: Times) -> None:
        self._interval_ns = times.real_ns(LEAST_INTERVAL_NS)
        self.subscribed: dict[int, dict[int, int]] = {}
        """Of each message id that somebody has, or had, subscribed to: when which operator was told
        last."""
        self._since_ns: dict[int, int] = {}
        self._heard_ns: dict[tuple[int, int], int] = {}
        self._asked_ns: dict[tuple[int, int], int] = {}
        """Of each vehicle and message id."""
        self._patience_ns = times.real_ns(PATIENCE_NS)

    def subscribe(self, operator: int, names: list[str], now_ns: int) -> list[Effect]:
        """In place of what it had; what is no message of the dialect is told."""
        self.forget(operator)
        known = [MESSAGES_BY_NAME[name].msgid for name in names if name in MESSAGES_BY_NAME]
        for msgid in known[:MAX_MESSAGES]:
            self.subscribed.setdefault(msgid, {})[operator] = 0
            self._since_ns.setdefault(msgid, now_ns)
        unknown = [name for name in names if name not in MESSAGES_BY_NAME]
        if unknown:
            text = f"no such MAVLink message: {', '.join(unknown[:3])}"
            return [
                Emit(ipc.Trouble(text, "names are as in the dialect: BATTERY_STATUS"), operator)
            ]
        if len(known) > MAX_MESSAGES:
            text = f"{len(known)} messages subscribed to: only the first {MAX_MESSAGES} are told"
            return [Emit(ipc.Trouble(text), operator)]
        return []

    def missing(
        self, telemetry: Telemetry, shown: Callable[[int], bool], now_ns: int
    ) -> Iterator[CommandLong]:
        """SET_MESSAGE_INTERVAL for what is subscribed to and does not come by itself: many
        vehicles, ArduPilot above all, send little unasked.  `shown`: whether an operator is shown
        that vehicle."""
        for msgid, operators in self.subscribed.items():
            key = telemetry.sysid, msgid
            asked_ns = self._asked_ns.get(key, self._since_ns[msgid])
            silent = now_ns - max(self._heard_ns.get(key, 0), asked_ns) > self._patience_ns
            if silent and any(map(shown, operators)):
                self._asked_ns[key] = now_ns
                yield message_interval(telemetry, msgid, ASKED_HZ)

    def forget(self, operator: int) -> None:
        """It has left."""
        for operators in self.subscribed.values():
            operators.pop(operator, None)

    def heard(self, frame: Frame, shown: Callable[[int], bool], now_ns: int) -> list[Effect]:
        """A good frame of a vehicle: who is told of it."""
        operators = self.subscribed.get(frame.msgid)
        if not operators:
            return []
        self._heard_ns[frame.sysid, frame.msgid] = now_ns
        due = [
            each
            for each, told in operators.items()
            if now_ns - told >= self._interval_ns and shown(each)
        ]
        if not due:
            return []
        fields = fields_of(frame)
        event = ipc.MessageEvent(frame.name, now_ns, frame.sysid, frame.compid, fields)
        for operator in due:
            operators[operator] = now_ns
        return [Emit(event, operator) for operator in due]
