"""Commands on their way to one vehicle: each is put in its autopilot's words and has one answer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from gcs.gate.effects import CommandKind, Level, SendCommand
from gcs.gate.inputs import CommandEnded
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.sentences import result_word
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import CannotCommandError, WantedCommand, command_long_for
from gcs.protocol.command import ACK_WAIT_NS, WORK_WAIT_NS, CommandClient
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
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, Work
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Result
from gcs.wire.messages import CommandLong

NODE = "link"
SHOWN_BY: Final[Mapping[CommandKind, FlightMode]] = {
    CommandKind.RETURN: FlightMode.RETURN,
    CommandKind.LAND: FlightMode.LAND,
    CommandKind.START_MISSION: FlightMode.MISSION,
    CommandKind.TAKE_OFF: FlightMode.TAKEOFF,
}
"""Those after which a flight follows.  Others end with the heartbeat that shows them.  That of an
ArduCopter which takes off in GUIDED shows nothing."""

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

TRIED_UNTIL_DEADLINE = frozenset({CommandKind.LAND, CommandKind.RETURN})
"""Doing it late, or again, is not dangerous: on a link with a round trip of seconds it is repeated
for as long as the gate awaits its mode.  A late arm or take-off would be, and a hold is commanded
again by the gate."""

URGENT = frozenset(
    {CommandKind.HOLD, CommandKind.LAND, CommandKind.DISARM, CommandKind.FORCE_DISARM}
)

NOT_YET = frozenset({Result.TEMPORARILY_REJECTED, Result.FAILED})
"""What an autopilot that is still starting says (px4 the first, ardupilot the second)."""
REPEATED = frozenset({CommandKind.ARM, CommandKind.GUIDED})
"""Right after boot both are answered like that."""
REPEAT_AFTER_NS = 500_000_000
"""Such an answer ends nothing yet: the command is repeated, but never past its deadline."""

UNANSWERED_TOKEN = 0
"""The token of the station's own commands: the gate is not told how they end."""
OWN_COMMAND_NS = 10_000_000_000


@dataclass(frozen=True, slots=True)
class _Repeat:
    """A command that was answered "not yet": when it is due again, and what it was answered."""

    due_ns: int
    token: int
    result: int


class Commands:
    """All commands to one vehicle, each with exactly one answer for the gate."""

    def __init__(self, own: Address, times: Times) -> None:
        waits = times.real_ns(ACK_WAIT_NS), times.real_ns(WORK_WAIT_NS)
        self._client = CommandClient(own, *waits)
        self._repeat_after_ns = times.real_ns(REPEAT_AFTER_NS)
        self._own_command_ns = times.real_ns(OWN_COMMAND_NS)
        self._sent: dict[int, tuple[SendCommand, CommandLong]] = {}
        self._next_token = UNANSWERED_TOKEN + 1
        self._photo_seq = 0
        self._repeat: _Repeat | None = None
        self._arming_denied = ""

    @property
    def deadline_ns(self) -> int | None:
        repeat_ns = self._repeat.due_ns if self._repeat else None
        times = [time for time in (self._client.deadline_ns, repeat_ns) if time is not None]
        return min(times, default=None)

    def send(self, wanted: SendCommand, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """Begin what the gate asked for.  Raises PermissionError where its permit is missing."""
        if wanted.kind in NEEDS_PERMIT and wanted.permit is None:
            raise PermissionError(f"{wanted.kind.value} needs the gate's permit")
        if wanted.kind is CommandKind.PHOTO:
            self._photo_seq += 1
        abstract = WantedCommand(
            wanted.kind,
            up_m=wanted.up_m + _above_home_m(telemetry),
            ground_amsl_m=_ground_amsl_m(telemetry),
            mode_name=wanted.mode_name,
            photo_seq=self._photo_seq,
            mission_seq=wanted.seq,
        )
        try:
            target = Address(telemetry.sysid, telemetry.compid)
            command = command_long_for(telemetry.autopilot, abstract, target)
        except CannotCommandError as error:
            return [_answer(wanted, Result.UNSUPPORTED, str(error))]
        token = self._next_token
        self._next_token += 1
        self._sent[token] = wanted, command
        work = self._end_repeating()
        if wanted.kind is CommandKind.ARM:
            self._arming_denied = ""
        if wanted.kind is CommandKind.ARM and telemetry.prearm_ok is False:
            self._repeat_later(token, Result.TEMPORARILY_REJECTED, now_ns)
            text = "the vehicle's pre-arm checks are not through: asking a little later"
            return [*work, _log(text)]
        return work + self._submit(token, now_ns)

    def send_own(self, command: CommandLong, now_ns: int) -> list[Work]:
        """A harmless command of the station itself (streams, origin)."""
        submit = Submit(UNANSWERED_TOKEN, command, now_ns + self._own_command_ns)
        return self._work(self._client.handle(submit, now_ns), now_ns)

    def cancel(self, request_id: int, kind: CommandKind, now_ns: int) -> list[Work]:
        """No further try of it leaves, and the gate is told nothing of what becomes of it."""
        tokens = [
            token
            for token, (wanted, _) in self._sent.items()
            if (wanted.request_id, wanted.kind) == (request_id, kind)
        ]
        work: list[Work] = []
        for token in tokens:
            del self._sent[token]
            if self._repeat is not None and self._repeat.token == token:
                self._repeat = None
            work += self._work(self._client.handle(Withdraw(token), now_ns), now_ns)
        return work

    def deny_arming(self, text: str) -> None:
        """The vehicle has asked the station whether it may arm, and may not, because of `text`:
        its answer to the command that is under way ends that."""
        self._arming_denied = text

    def heard(self, heard: Heard, now_ns: int) -> list[Work]:
        return self._work(self._client.handle(heard, now_ns), now_ns)

    def wake(self, telemetry: Telemetry | None, now_ns: int) -> list[Work]:
        work = self._work(self._client.handle(Wake(), now_ns), now_ns)
        if self._repeat is not None and now_ns >= self._repeat.due_ns:
            work += self._repeat_now(self._repeat, telemetry, now_ns)
        return work

    # ------------------------------------------------------------------------- repetition

    def _repeat_later(self, token: int, result: int, now_ns: int) -> None:
        self._repeat = _Repeat(now_ns + self._repeat_after_ns, token, result)

    def _repeat_now(self, due: _Repeat, telemetry: Telemetry | None, now_ns: int) -> list[Work]:
        """Unless the vehicle itself still says that it would not arm, and there is time to wait."""
        wanted, _ = self._sent[due.token]
        unready = telemetry is not None and telemetry.prearm_ok is False
        in_time = now_ns + self._repeat_after_ns < wanted.deadline_ns
        if wanted.kind is CommandKind.ARM and unready and in_time:
            self._repeat_later(due.token, due.result, now_ns)
            return []
        self._repeat = None
        return self._submit(due.token, now_ns)

    def _end_repeating(self) -> list[Work]:
        """Another command takes the place of one that waits to be repeated: it ends refused."""
        if self._repeat is None:
            return []
        ended, self._repeat = self._repeat, None
        wanted, _ = self._sent.pop(ended.token)
        return [_answer(wanted, ended.result)]

    # ----------------------------------------------------------------- the command protocol

    def _submit(self, token: int, now_ns: int) -> list[Work]:
        wanted, command = self._sent[token]
        submit = Submit(
            token,
            command,
            wanted.deadline_ns,
            tries=_tries(wanted.kind),
            urgent=wanted.kind in URGENT,
        )
        return self._work(self._client.handle(submit, now_ns), now_ns)

    def _work(self, effects: list[CommandEffect], now_ns: int) -> list[Work]:
        work: list[Work] = []
        for effect in effects:
            match effect:
                case Send():
                    work.append(effect)
                case Finished(token, _, result, text):
                    work += self._finished(token, result, text, now_ns)
                case InProgress(_, command, percent):
                    done = "" if percent is None else f", {percent} %"
                    work.append(_log(f"command {command} is in progress{done}"))
                case LateAck(_, command, result, _):
                    what = f"a late answer to command {command}: {result_word(result)}"
                    work.append(_log(f"{what}, not acted on"))
        return work

    def _finished(self, token: int, result: int | None, text: str, now_ns: int) -> list[Work]:
        if token not in self._sent:
            return []
        wanted, _ = self._sent[token]
        in_time = now_ns + self._repeat_after_ns < wanted.deadline_ns
        if wanted.kind is CommandKind.ARM and self._arming_denied and result != Result.ACCEPTED:
            in_time, text = False, self._arming_denied
        if wanted.kind in REPEATED and result is not None and result in NOT_YET and in_time:
            work = self._end_repeating()
            self._repeat_later(token, result, now_ns)
            not_ready = f"not ready for {wanted.kind.value} ({result_word(result)}): asking again"
            return [*work, _log(not_ready)]
        del self._sent[token]
        return [_answer(wanted, result, text)]


def _tries(kind: CommandKind) -> int | None:
    if kind in TRIED_UNTIL_DEADLINE:
        return None
    return 1 if kind in ONE_TRY else 4


def _answer(wanted: SendCommand, result: int | None, text: str = "") -> GateInput:
    return GateInput(CommandEnded(wanted.request_id, wanted.kind, result, text))


def _log(text: str) -> Log:
    return Log(Level.DEBUG, NODE, text)


def _ground_amsl_m(telemetry: Telemetry) -> float | None:
    """Where it stands above mean sea level, from the position that the climb was verified from."""
    if telemetry.origin is None or telemetry.pos_ned is None:
        return None
    return telemetry.origin.alt_amsl_m - telemetry.pos_ned[2]


def _above_home_m(telemetry: Telemetry) -> float:
    """How much higher than home it stands, for an autopilot that counts a climb from home."""
    home_ned, pos_ned = telemetry.home_ned, telemetry.pos_ned
    if telemetry.autopilot.takeoff_above_sea or home_ned is None or pos_ned is None:
        return 0.0
    return home_ned[2] - pos_ned[2]


def shown_commands(gate: Gate, mode: FlightMode) -> list[int]:
    """The requests whose command has no answer yet, which may be lost, while a heartbeat shows
    the mode that it leads to."""
    unanswered = gate.memory.outstanding
    return [request_id for request_id, kind in unanswered if SHOWN_BY.get(kind) is mode]
