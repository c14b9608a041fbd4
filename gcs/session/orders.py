"""The gate's commands on their way: each becomes the autopilot's own command and has one answer."""

from __future__ import annotations

from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.inputs import CommandEnded
from gcs.protocol.autopilot import CannotAskError, Order, ask
from gcs.protocol.command import ACK_WAIT_NS, CommandClient
from gcs.protocol.effects import (
    Address,
    CommandEffect,
    Finished,
    Heard,
    InProgress,
    LateAck,
    Send,
    Submit,
    Wake,
    Withdraw,
)
from gcs.session.telemetry import Telemetry
from gcs.wire.ids import Result
from gcs.wire.messages import CommandLong, Message

NEEDS_PERMIT = frozenset(
    {
        CommandKind.ARM,
        CommandKind.GUIDED,
        CommandKind.LAND,
        CommandKind.RETURN,
        CommandKind.SET_MODE,
        CommandKind.START_MISSION,
        CommandKind.TAKE_OFF,
    }
)
"""What sets a vehicle in motion leaves only with the gate's permit."""

ONE_TRY = frozenset({CommandKind.PHOTO})
"""Doing it twice would take two pictures of a vehicle that does not look at the number."""

URGENT = frozenset(
    {CommandKind.HOLD, CommandKind.LAND, CommandKind.DISARM, CommandKind.FORCE_DISARM}
)

NOT_YET = frozenset({Result.TEMPORARILY_REJECTED, Result.FAILED})
"""What an autopilot that is still starting says (px4 the first, ardupilot the second)."""
PATIENT = frozenset({CommandKind.ARM, CommandKind.GUIDED})
"""Right after boot both are answered like that."""
ASK_AGAIN_NS = 500_000_000
"""Its answer is no outcome yet: it is asked again, but never past the order's deadline."""

GREETING_TOKEN = 0
"""Commands that nobody waits for."""


Out = Message | CommandEnded | str
"""A message to send, an order's end for the gate, or a line for the log."""


class Orders:
    """All commands to the vehicle, each with exactly one end."""

    def __init__(self, sysid: int, compid: int, speedup: float = 1.0) -> None:
        self._client = CommandClient(Address(sysid, compid), round(ACK_WAIT_NS * speedup))
        self._sent: dict[int, tuple[SendCommand, CommandLong]] = {}
        self._next_token = GREETING_TOKEN + 1
        self._photo_seq = 0
        self._patient: tuple[int, int, int] | None = None
        """When to ask again, which token's order, and what it was answered."""
        self._seen: Telemetry | None = None

    @property
    def deadline_ns(self) -> int | None:
        again_ns = self._patient[0] if self._patient else None
        times = [time for time in (self._client.deadline_ns, again_ns) if time is not None]
        return min(times, default=None)

    def send(self, order: SendCommand, seen: Telemetry, now_ns: int) -> list[Out]:
        """Start what the gate asked for."""
        if order.kind in NEEDS_PERMIT and order.permit is None:
            raise PermissionError(f"{order.kind.value} needs the gate's permit")
        if order.kind is CommandKind.PHOTO:
            self._photo_seq += 1
        wanted = Order(
            order.kind,
            up_m=order.up_m + _above_home_m(seen),
            ground_amsl_m=_ground_amsl_m(seen),
            mode_name=order.mode_name,
            photo_seq=self._photo_seq,
        )
        try:
            command = ask(seen.autopilot, wanted, Address(seen.sysid, seen.compid))
        except CannotAskError as error:
            return [CommandEnded(order.request_id, order.kind, Result.UNSUPPORTED, str(error))]
        token = self._next_token
        self._next_token += 1
        self._sent[token] = order, command
        self._seen = seen
        out = self._lose_patience()
        if order.kind is CommandKind.ARM and not seen.prearm_ok:
            self._patient = now_ns + ASK_AGAIN_NS, token, Result.TEMPORARILY_REJECTED
            return [*out, "the vehicle's pre-arm checks are not through: asking a little later"]
        return out + self._submit(token, now_ns)

    def _submit(self, token: int, now_ns: int) -> list[Out]:
        order, command = self._sent[token]
        submit = Submit(
            token,
            command,
            order.deadline_ns,
            tries=1 if order.kind in ONE_TRY else 4,
            urgent=order.kind in URGENT,
        )
        return self._out(self._client.handle(submit, now_ns), now_ns)

    def cancel(self, request_id: int, kind: CommandKind, now_ns: int) -> list[Out]:
        """No further try of it leaves, and nobody is told what becomes of it."""
        tokens = [
            token
            for token, (order, _) in self._sent.items()
            if (order.request_id, order.kind) == (request_id, kind)
        ]
        out: list[Out] = []
        for token in tokens:
            del self._sent[token]
            if self._patient is not None and self._patient[1] == token:
                self._patient = None
            out += self._out(self._client.handle(Withdraw(token), now_ns), now_ns)
        return out

    def ask(self, command: CommandLong, now_ns: int) -> list[Out]:
        """A harmless command that nobody waits for."""
        submit = Submit(GREETING_TOKEN, command, now_ns + 10_000_000_000)
        return self._out(self._client.handle(submit, now_ns), now_ns)

    def heard(self, heard: Heard, now_ns: int) -> list[Out]:
        return self._out(self._client.handle(heard, now_ns), now_ns)

    def wake(self, now_ns: int) -> list[Out]:
        out = self._out(self._client.handle(Wake(), now_ns), now_ns)
        if self._patient is not None and now_ns >= self._patient[0]:
            out += self._ask_again(now_ns)
        return out

    def _ask_again(self, now_ns: int) -> list[Out]:
        """Unless the vehicle itself still says that it would not arm, and there is time to wait."""
        assert self._patient is not None
        _, token, result = self._patient
        order, _ = self._sent[token]
        again_ns = now_ns + ASK_AGAIN_NS
        unready = self._seen is not None and self._seen.prearm_ok is False
        if order.kind is CommandKind.ARM and unready and again_ns < order.deadline_ns:
            self._patient = again_ns, token, result
            return []
        self._patient = None
        return self._submit(token, now_ns)

    def _out(self, effects: list[CommandEffect], now_ns: int) -> list[Out]:
        out: list[Out] = []
        for effect in effects:
            match effect:
                case Send(message):
                    out.append(message)
                case Finished(token, _, result, text):
                    out += self._finished(token, result, text, now_ns)
                case InProgress(_, command, percent):
                    done = "" if percent is None else f", {percent} %"
                    out.append(f"command {command} is in progress{done}")
                case LateAck(_, command, result, _):
                    out.append(f"a late answer to command {command}: result {result}, not acted on")
        return out

    def _finished(self, token: int, result: int | None, text: str, now_ns: int) -> list[Out]:
        if token not in self._sent:
            return []
        order, _ = self._sent[token]
        again_ns = now_ns + ASK_AGAIN_NS
        if (
            order.kind in PATIENT
            and result is not None
            and result in NOT_YET
            and again_ns < order.deadline_ns
        ):
            out = self._lose_patience()
            self._patient = again_ns, token, result
            return [*out, f"not ready for {order.kind.value} (result {result}): asking again"]
        del self._sent[token]
        return [CommandEnded(order.request_id, order.kind, result, text)]

    def _lose_patience(self) -> list[Out]:
        """Another order takes the place of one that waits to be asked again: it ends refused."""
        if self._patient is None:
            return []
        _, token, result = self._patient
        self._patient = None
        order, _ = self._sent.pop(token)
        return [CommandEnded(order.request_id, order.kind, result)]


def _ground_amsl_m(seen: Telemetry) -> float | None:
    """Where it stands above mean sea level, from the position that the climb was verified from."""
    if seen.origin is None or seen.pos_ned is None:
        return None
    return seen.origin.alt_amsl_m - seen.pos_ned[2]


def _above_home_m(seen: Telemetry) -> float:
    """How much higher than home it stands, for an autopilot that counts a climb from home."""
    if seen.autopilot.takeoff_above_sea or seen.home_ned is None or seen.pos_ned is None:
        return 0.0
    return seen.home_ned[2] - seen.pos_ned[2]
