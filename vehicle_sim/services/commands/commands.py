"""COMMAND_LONG and COMMAND_INT: one table, one final ack for each frame.

A frame is a *retry* if it repeats the last one of the same sender and command: the same frame
again (a duplicate on the way: equal sequence number), or the same parameters with a
`confirmation` above 0 within `RETRY_NS`.  A retry has no second effect: while the command is in
progress it is answered IN_PROGRESS, afterwards with the result that the first one had.  When a
command ends, each frame that was answered IN_PROGRESS gets its final ack.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.interface import CommandDone, Result
from vehicle_sim.autopilot.modes import by_number
from vehicle_sim.effects import Client, Effect, Note, Send
from vehicle_sim.services.commands.calibration import CALIBRATION
from vehicle_sim.services.commands.failures import FAILURE
from vehicle_sim.services.commands.flight import CHANGE_MODE, FLIGHT
from vehicle_sim.services.commands.info import INFO
from vehicle_sim.services.commands.operator_control import OPERATOR
from vehicle_sim.services.commands.orders import Answer, Order, from_int, from_long
from vehicle_sim.services.commands.payload import PAYLOAD
from vehicle_sim.services.commands.ports import CommandContext, CommandEntry, RefusedError
from vehicle_sim.services.texts import status_text
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

RETRY_NS: Final = 3_500_000_000
"""MAVSDK repeats after 0.5 s, QGroundControl after 3 s."""

REMEMBERED_MAX: Final = 256
"""Senders and commands, the oldest forgotten first."""

TABLE: Final[dict[Cmd, CommandEntry]] = {
    **FLIGHT,
    **INFO,
    **FAILURE,
    **PAYLOAD,
    **CALIBRATION,
    **OPERATOR,
}
"""Every command that this vehicle understands; all others are UNSUPPORTED."""


@dataclass(slots=True)
class _Memory:
    """The last frame of one sender and command."""

    asked: m.CommandLong | m.CommandInt  # with confirmation 0
    sequence: int
    heard_ns: int
    result: Result
    owed: int = 0  # frames answered IN_PROGRESS that wait for their final ack
    acked: bool = True


class Commands:
    """Wall time goes in; acks, and what follows them, come out."""

    def __init__(self, context: CommandContext) -> None:
        self._context = context
        self._memory: dict[tuple[Client, int], _Memory] = {}

    def handle(
        self, client: Client, sequence: int, asked: m.CommandLong | m.CommandInt, now_ns: int
    ) -> list[Effect]:
        confirmation = 0
        if isinstance(asked, m.CommandLong):
            confirmation = asked.confirmation
            asked = asked._replace(confirmation=0)
        key = (client, asked.command)
        known = self._memory.get(key)
        if known is not None and _is_retry(known, asked, sequence, confirmation, now_ns):
            known.sequence, known.heard_ns = sequence, now_ns
            known.owed += known.result is Result.IN_PROGRESS
            return [self._ack(client, asked.command, known.result)] if known.acked else []
        order = (
            from_long(client, asked)
            if isinstance(asked, m.CommandLong)
            else from_int(client, asked)
        )
        refused_before = known is not None and known.result is Result.UNSUPPORTED
        answer = self._answer(order, refused_before)
        while len(self._memory) >= REMEMBERED_MAX:
            del self._memory[next(iter(self._memory))]
        owed = int(answer.result is Result.IN_PROGRESS)
        if owed and known is not None:
            owed += known.owed
        self._memory[key] = _Memory(asked, sequence, now_ns, answer.result, owed, answer.acked)
        ack = [self._ack(client, asked.command, answer.result)] if answer.acked else []
        return [*ack, *answer.after]

    def refuse(self, client: Client, command: int, result: Result = Result.FAILED) -> list[Effect]:
        """FAILED: it was sent to a component that there is not."""
        return [self._ack(client, command, result)]

    def done(self, event: CommandDone) -> list[Effect]:
        """A command that was IN_PROGRESS has ended."""
        effects: list[Effect] = []
        for (client, command), known in self._memory.items():
            if command == event.command and known.result is Result.IN_PROGRESS:
                final = self._ack(client, command, event.result)
                effects += [final] * known.owed
                known.result, known.owed, known.acked = event.result, 0, True
        return effects

    def forget(self, channel: int) -> None:
        """The channel is gone."""
        self._memory = {
            key: known for key, known in self._memory.items() if key[0].channel != channel
        }

    def _answer(self, order: Order, refused_before: bool) -> Answer:
        """`refused_before`: it was UNSUPPORTED before; MAVSDK asks for ever."""
        known = order.command in Cmd.__members__.values()
        profile = self._context.profile
        entry = TABLE.get(Cmd(order.command)) if known else None
        if order.command in profile.ignored_commands:
            return Answer(Result.UNSUPPORTED, acked=False)
        absent = profile.absent.get(Cmd(order.command)) if known else None
        if absent is not None:
            return Answer(absent, (Note("debug", f"nothing carries out {order.command}"),))
        if entry is None or entry.only not in (None, profile.name):
            note = Note(
                "debug" if refused_before else "warning",
                f"command {order.command} is not supported",
            )
            return Answer(Result.UNSUPPORTED, (note,))
        if entry.place and not order.global_frame:
            return self._wrong_frame(order)
        try:
            return entry.handler(self._context, order.located if entry.place else order)
        except RefusedError as refusal:
            level = "debug" if order.command in INFO else "warning"
            note = Note(level, f"{Cmd(order.command).name} refused: {refusal}")
            return Answer(refusal.result, (note,))

    def _wrong_frame(self, order: Order) -> Answer:
        """Of DO_REPOSITION it is recorded how each refuses a frame without coordinates.

        ArduCopter looks first whether it is in GUIDED, or may change to it.
        """
        profile = self._context.profile
        if order.command != Cmd.DO_REPOSITION:
            return Answer(Result.UNSUPPORTED_MAV_FRAME)
        if not profile.names_wrong_frame:
            return Answer(Result.UNSUPPORTED)
        mode = by_number(profile.name, self._context.vehicle.custom_mode)
        guided = mode is not None and mode.name == "GUIDED"
        if not guided and not (order.whole(order.p2) or 0) & CHANGE_MODE:
            return Answer(Result.DENIED)
        text = f"Unknown mavlink coordinate frame {order.frame}"
        return Answer(Result.DENIED, (Send(None, status_text(profile, 6, text)),))

    def _ack(self, client: Client, command: int, result: Result) -> Send:
        ack = m.CommandAck(
            command=command,
            result=result,
            progress=255 if result is Result.IN_PROGRESS else 0,
            target_system=client.system,
            target_component=client.component,
        )
        return Send(client.channel, ack)


def _is_retry(
    known: _Memory,
    asked: m.CommandLong | m.CommandInt,
    sequence: int,
    confirmation: int,
    now_ns: int,
) -> bool:
    """Compared by `repr`, to which one NaN equals another."""
    return (
        now_ns - known.heard_ns <= RETRY_NS
        and (confirmation > 0 or sequence == known.sequence)
        and repr(known.asked) == repr(asked)
    )
