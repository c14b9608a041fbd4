"""What a flight's script looks at: events, records, and the bytes that were on the wire."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from gcs import ipc
from gcs.gate.condition import Condition
from gcs.gate.states import State
from gcs.report import GarbageItem, RecordItem
from gcs.station.session import Session
from tests.loopback import pymavlink_decoder
from tests.loopback.pymavlink_decoder import SeenSetpoint

E = TypeVar("E", bound=ipc.Event)
R = TypeVar("R", bound=RecordItem)

START_NS = 1_700_000_000_000_000_000


@dataclass(frozen=True, slots=True)
class Sent:
    """A datagram, when it left."""

    time_ns: int
    data: bytes


class Looks:
    """Everything that a flight remembers, and ways to ask for it."""

    session: Session

    def __init__(self) -> None:
        self.now_ns = START_NS
        self.events: list[ipc.Event] = []
        self.event_times_ns: list[int] = []
        self.records: list[tuple[int, RecordItem]] = []
        self.sent: list[Sent] = []
        self.received: list[Sent] = []

    @property
    def state(self) -> State:
        return self.session.gate.state

    def is_in(self, state: State) -> bool:
        """Whether the machine is in `state` (a call: a type checker must not remember it)."""
        return self.state is state

    @property
    def conditions(self) -> tuple[Condition, ...]:
        return self.session.gate.conditions

    @property
    def home_ned(self) -> pymavlink_decoder.Vec3 | None:
        """Home in the local frame, as the session knows it."""
        return self.session.telemetry.home_ned if self.session.telemetry else None

    @property
    def elapsed_s(self) -> float:
        return (self.now_ns - START_NS) / 1e9

    def of(self, kind: type[E]) -> list[E]:
        """Every event of one kind so far; snapshots are not kept."""
        return [event for event in self.events if isinstance(event, kind)]

    def recorded(self, kind: type[R], since_ns: int = 0) -> list[R]:
        """Every record item of one kind so far."""
        return [item for t, item in self.records if isinstance(item, kind) and t >= since_ns]

    def verdicts(self, ask_id: int) -> list[ipc.VerdictEvent]:
        return [event for event in self.of(ipc.VerdictEvent) if event.id == ask_id]

    def endings(self, ask_id: int) -> list[ipc.EndingEvent]:
        return [event for event in self.of(ipc.EndingEvent) if event.id == ask_id]

    def outcome(self, ask_id: int) -> str | None:
        """The ending; or `refused CODE` or `superseded CODE`; None while it is open."""
        for ending in self.endings(ask_id):
            return ending.ended if ending.ended == "complete" else f"{ending.ended} {ending.code}"
        for verdict in self.verdicts(ask_id):
            if verdict.outcome != "accepted":
                return f"{verdict.outcome} {verdict.code}".strip()
        return None

    def states(self, since_ns: int = 0) -> list[str]:
        """The states that were entered, in order."""
        return [
            event.after
            for event, time_ns in zip(self.events, self.event_times_ns, strict=True)
            if isinstance(event, ipc.StateEvent) and time_ns >= since_ns
        ]

    def told(self) -> list[str]:
        """The last log lines, for a failing test's message."""
        return [line.text for line in self.of(ipc.LogEvent)][-8:]

    def lines(self, node: str, since_ns: int = 0) -> list[str]:
        """Log lines of one node."""
        return [
            line.text
            for line in self.of(ipc.LogEvent)
            if line.node == node and line.time_ns >= since_ns
        ]

    def setpoints(self, since_ns: int = 0) -> list[SeenSetpoint]:
        """Every setpoint that left, as pymavlink reads it."""
        seen = []
        for sent in self.sent:
            if sent.time_ns >= since_ns:
                setpoint = pymavlink_decoder.setpoint_of(
                    pymavlink_decoder.read(sent.data), sent.time_ns
                )
                if setpoint is not None:
                    seen.append(setpoint)
        return seen

    def sent_types(self, since_ns: int = 0) -> list[str]:
        """MAVLink names of what left, in order."""
        return [
            str(pymavlink_decoder.read(sent.data).get_type())
            for sent in self.sent
            if sent.time_ns >= since_ns
        ]

    def sent_commands(self, command: int, since_ns: int = 0) -> list[Sent]:
        """The COMMAND_LONGs of one MAV_CMD that left."""
        return [
            sent
            for sent in self.sent
            if sent.time_ns >= since_ns
            and (m := pymavlink_decoder.read(sent.data)).get_type() == "COMMAND_LONG"
            and m.command == command
        ]

    def troubles(self) -> list[ipc.Trouble]:
        return self.of(ipc.Trouble)

    def garbage(self) -> list[GarbageItem]:
        """What came in and was no frame."""
        return self.recorded(GarbageItem)
