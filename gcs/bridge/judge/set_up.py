"""What would change the vehicle's set-up: the guard's judgement put into practice."""

from __future__ import annotations

from gcs.bridge.catalog import Row
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import (
    AsksVehicle,
    BridgeEffect,
    ChangesRallyPoints,
    ForwardToVehicle,
    LogLine,
    Reply,
)
from gcs.bridge.judge.received import Judged, Received, refuse
from gcs.bridge.setup_policy.guard import Guard
from gcs.bridge.setup_policy.parameters import TAKEOFF_HEIGHT
from gcs.bridge.setup_policy.verdict import Allowed, GuardSeen, Judgement, Refused
from gcs.bridge.translate.meaning import Seen
from gcs.gate.effects import Level
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd
from gcs.wire.messages import (
    CommandInt,
    CommandLong,
    LogRequestData,
    LogRequestEnd,
    Message,
    ParamSet,
    ParamValue,
    RallyPoint,
)


class SetUpJudge:
    """Of what clients would change of one vehicle."""

    def __init__(self, rules: BridgeRules) -> None:
        self._rules = rules
        self._guard: Guard | None = None
        self._guards = ""
        """The autopilot that it is for; another vehicle may come to have the number."""
        self._log_read = self._log_sent = False
        """A client has begun to read a log, or had it sent as it is written, since the vehicle was
        armed last."""

    def judge(self, given: Received, message: Message | None, row: Row) -> Judged:
        """What is done with it."""
        seen = given.look()
        if seen is None or message is None:
            return refuse(given, message, row, Refusal(Code.POLICY, row.why))
        judged = self._guarded(message, given.by, seen, given.now_ns)
        if isinstance(judged, Allowed) and isinstance(message, RallyPoint):
            bad = seen.why_not_rally(message)
            judged = judged if bad is None else Refused(bad)
        match judged:
            case Allowed(note):
                self._log_read |= isinstance(message, LogRequestData)
                self._log_sent |= _is_command(message, Cmd.LOGGING_START)
                notes = [LogLine(Level.INFO, f"{given.client.name}: {note}")] if note else []
                rally = [ChangesRallyPoints()] if isinstance(message, RallyPoint) else []
                return Judged(False, [*notes, ForwardToVehicle(given.frame.raw), *rally])
            case Refused():
                return _refuse(given, message, row, judged)

    def refuses(self, given: Received, message: Message, row: Row, seen: Seen) -> Judged | None:
        """What is done with it where it is refused; None where somebody else is to judge it."""
        judged = self._guarded(message, given.by, seen, given.now_ns)
        return _refuse(given, message, row, judged) if isinstance(judged, Refused) else None

    @property
    def height_awaited(self) -> bool:
        """The least height of a climb was written just now: nobody's climb can be judged."""
        return self._guard is not None and self._guard.awaits(TAKEOFF_HEIGHT)

    def written_by_station(self, message: ParamSet, autopilot: str, now_ns: int) -> None:
        """The station sends a PARAM_SET of its own."""
        self._guard_of(autopilot).written_by_station(message, now_ns)

    def parameter(self, message: ParamValue, autopilot: str, now_ns: int) -> list[BridgeEffect]:
        """PARAM_VALUE of the vehicle's autopilot: what has changed, for the log."""
        changed = self._guard_of(autopilot).heard(message, now_ns)
        return [] if changed is None else [LogLine(changed.level, changed.text)]

    def armed(self, own: Address, vehicle: Address) -> list[BridgeEffect]:
        """The vehicle is armed: a log that a client began to read on the ground is not read on,
        where the policy has it so, nor is one sent on that was sent as it is written."""
        read, sent = self._log_read, self._log_sent
        if not (read or sent) or self._rules.downloads == "forward":
            return []
        self._log_read = self._log_sent = False
        ends: list[Message] = []
        if read:
            ends.append(LogRequestEnd(vehicle.sysid, vehicle.compid))
        if sent:
            ends.append(_command(Cmd.LOGGING_STOP, vehicle))
        text = "the vehicle is armed: the reading of its log is ended (policy: bridge.downloads)"
        return [*(AsksVehicle(own, end) for end in ends), LogLine(Level.INFO, text)]

    def _guard_of(self, autopilot: str) -> Guard:
        if self._guard is None or self._guards != autopilot:
            self._guard, self._guards = Guard(self._rules, autopilot), autopilot
        return self._guard

    def _guarded(self, message: Message, by: From, seen: Seen, now_ns: int) -> Judgement:
        at = GuardSeen(
            by.source,
            by.addressed,
            seen.armed,
            seen.on_ground,
            seen.max_takeoff_up_m,
            seen.in_control,
            now_ns,
        )
        return self._guard_of(seen.autopilot.name).judge(message, at)


def _refuse(given: Received, message: Message, row: Row, judged: Refused) -> Judged:
    """With what the client is answered, and what the vehicle is asked for in its place."""
    by = given.by
    refused = refuse(given, message, row, judged.refusal)
    to_client = [Reply(by.link, by.addressed, each) for each in judged.answers]
    to_vehicle = [AsksVehicle(by.source, each) for each in judged.ask_vehicle]
    return Judged(True, [*refused.effects, *to_client, *to_vehicle])


def _is_command(message: Message, command: Cmd) -> bool:
    return isinstance(message, CommandLong | CommandInt) and message.command == command


def _command(command: Cmd, vehicle: Address) -> CommandLong:
    """Without parameters."""
    return CommandLong(*(0.0,) * 7, command, vehicle.sysid, vehicle.compid, 0)
