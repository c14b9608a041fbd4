"""What is done with one frame of a client that is for the vehicle, or for everybody.

By the kind of its message or command (`classes/`): forwarded, asked of the gate in an operator's
words (`meaning/`), judged by the guard of the vehicle's set-up (`guard/`) or refused.  What is said
of plans goes to the client's plan server (`plans/`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs import ipc
from gcs.bridge.asked_rates import AskedRates
from gcs.bridge.classes import Kind, Row, command_row, explain, message_row
from gcs.bridge.client import Exchange
from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.control import ControlServer
from gcs.bridge.dialogue import From
from gcs.bridge.effects import (
    Answers,
    AsksForStreams,
    AsksPlan,
    AsksVehicle,
    BridgeEffect,
    ChangesRallyPoints,
    Notes,
    Refuses,
    StopsPlan,
    ToVehicle,
)
from gcs.bridge.guard import verdict as guard_verdict
from gcs.bridge.guard.guard import Guard
from gcs.bridge.guard.parameters import TAKEOFF_HEIGHT
from gcs.bridge.guard.verdict import Allowed, GuardSeen, Judgement
from gcs.bridge.meaning.meaning import Forward, Reject, Sample, Seen, Settled, Sticks, Words
from gcs.bridge.meaning.translate import meaning_of
from gcs.bridge.mission_mode import MissionMode
from gcs.bridge.needed_rates import Rates, asked_anew, not_slower
from gcs.bridge.plans import effects as plan_effects
from gcs.bridge.plans.collecting import acknowledgement as mission_acknowledgement
from gcs.bridge.plans.downloads import Downloads
from gcs.bridge.plans.effects import PlanEffect
from gcs.bridge.plans.server import PLAN_MESSAGES
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.attitude import roll_pitch_yaw
from gcs.gate.effects import Level
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import ARDUPILOT, Autopilot, mode_named
from gcs.protocol.effects import Address
from gcs.protocol.parameters import BY_NAME
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Cmd, MissionResult, MissionType, ModeFlag
from gcs.wire.messages import (
    CommandInt,
    CommandLong,
    LogRequestData,
    LogRequestEnd,
    Message,
    MissionClearAll,
    MissionCount,
    MissionItem,
    MissionItemInt,
    MissionSetCurrent,
    ParamRequestRead,
    ParamValue,
    RallyPoint,
    RequestDataStream,
    SetMode,
)

_LOOKED_INTO: tuple[type[Message], ...] = (*PLAN_MESSAGES, RequestDataStream)
DECODED_IDS: Final = frozenset(kind.MSG_ID for kind in _LOOKED_INTO)
"""Messages that are looked into although they may be harmless."""
SET_MODES: Final = frozenset({Cmd.DO_SET_MODE, Cmd.DO_SET_STANDARD_MODE})
GUIDED_CURRENT: Final = frozenset({2, 3})
"""MISSION_ITEM.current of an item that ArduPilot flies to at once, or whose height it takes."""

POINTED_BY_ANOTHER: Final = Refusal(
    Code.OTHER_OPERATOR, "another client is in control, and points the camera"
)
CLIMBS: Final = frozenset({"takeoff", "mission_start"})
CLIMBING: Final = frozenset({FlightMode.TAKEOFF, FlightMode.MISSION})
HEIGHT_WRITTEN: Final = Refusal(
    Code.BUSY, f"{TAKEOFF_HEIGHT} was written, and the vehicle has not told yet what it is now"
)

Look: TypeAlias = Callable[[], Seen | None]
"""How the vehicle is at this moment; None before one is heard."""


@dataclass(frozen=True, slots=True)
class Judged:
    """`refused`: the frame goes nowhere, and is recorded as refused."""

    refused: bool
    effects: Sequence[BridgeEffect]


@dataclass(frozen=True, slots=True)
class Received:
    """One frame of a client, and who it is from and for."""

    client: Exchange
    by: From
    frame: Frame
    look: Look
    now_ns: int
    in_control: bool = False
    """The client is the one in control."""


class Judge:
    """Of everything that clients send to one vehicle."""

    def __init__(self, rules: BridgeRules, needed_hz: Rates, control: ControlServer) -> None:
        """`needed_hz`: how often the gate needs which message; `control`: who is in control."""
        self._control = control
        self._rules = rules
        self._needed_hz = needed_hz
        self._asked_rates = AskedRates(rules, needed_hz)
        self._guard: Guard | None = None
        self._downloads = Downloads()
        self._log_read = self._log_sent = False
        """A client has begun to read a log, or had it sent as it is written, since the vehicle was
        armed last."""
        self.mission_mode = MissionMode()
        self._kinds = {explain(name).name: Kind.DENIED for name in rules.extra_denied}
        self._kinds |= {explain(name).name: Kind.HARMLESS for name in rules.extra_harmless}
        """What the policy says of messages and commands by name."""

    def concerns_each(self, frame: Frame) -> bool:
        """Of a frame for all vehicles: whether each is to be judged by itself, because it would
        move them, change what they have on board, or have them send more."""
        _, message, kind = self._classified(frame)
        looked_into = message is not None and kind is not Kind.DENIED
        if looked_into and (_is_of_plan(message) or _asks_for_rate(message)):
            return True
        return kind in (Kind.MOTION, Kind.CONFIGURATION)

    def _classified(self, frame: Frame) -> tuple[Row, Message | None, Kind]:
        """Its row in the tables, the message where it is looked into, and its kind by policy."""
        row, message = message_row(frame.msgid), None
        if row.kind is not Kind.HARMLESS or frame.msgid in DECODED_IDS:
            message = decode(frame)
            if isinstance(message, CommandLong | CommandInt):
                row = command_row(message.command)
        return row, message, self._kinds.get(row.name, row.kind)

    def judge(self, given: Received) -> Judged:
        """What is done with it."""
        frame = given.frame
        row, message, kind = self._classified(frame)
        if message is not None and kind is not Kind.DENIED and _is_of_plan(message):
            return self._plan(given, message, row)
        if kind is Kind.CONFIGURATION and _is_flown_to_at_once(message):
            return self._motion(given, message, row)
        match kind:
            case Kind.HARMLESS:
                return self._forward(given, message, row)
            case Kind.POINTING:
                return self._pointing(given, message, row)
            case Kind.LOCAL if message is not None:
                about_control = self._control.handle(message, given.client, given.by, given.now_ns)
                return Judged(False, about_control)
            case Kind.LOCAL:
                return Judged(False, [])
            case Kind.DENIED | Kind.CARRIER:
                refusal = Refusal(Code.POLICY, row.why)
                return _refuse(given, message, row, refusal)
            case Kind.MOTION:
                return self._motion(given, message, row)
            case Kind.CONFIGURATION:
                return self._configuration(given, message, row)

    def _forward(self, given: Received, message: Message | None, row: Row) -> Judged:
        """What is harmless, but for the rates that the gate needs and those that fill the link."""
        if not isinstance(message, CommandLong | CommandInt | RequestDataStream):
            return Judged(False, [ToVehicle(given.frame.raw)])
        instead: Message | Refusal
        again: list[BridgeEffect] = []
        if isinstance(message, RequestDataStream):
            seen = given.look()
            obeyed = seen is not None and seen.autopilot is ARDUPILOT
            instead = self._asked_rates.group(message, given.client.number, obeyed=obeyed)
            if isinstance(instead, RequestDataStream):
                again = [AsksForStreams(tuple(asked_anew(instead, self._needed_hz)))]
        else:
            slowest = not_slower(message, self._needed_hz) or message
            instead = self._asked_rates.command(slowest, given.client.number)
        if isinstance(instead, Refusal):
            return _refuse(given, message, row, instead)
        if instead is message:
            return Judged(False, [ToVehicle(given.frame.raw), *again])
        return Judged(False, [AsksVehicle(given.by.source, instead), *again])

    def _pointing(self, given: Received, message: Message | None, row: Row) -> Judged:
        """What points a camera, and may turn the nose: not while another one flies."""
        seen = given.look()
        if seen is not None and not seen.in_control:
            return _refuse(given, message, row, POINTED_BY_ANOTHER)
        return Judged(False, [ToVehicle(given.frame.raw)])

    # ------------------------------------------------------------------------------ motion

    def _motion(self, given: Received, message: Message | None, row: Row) -> Judged:
        """What would move the vehicle becomes a request to the gate."""
        client, seen, now_ns = given.client, given.look(), given.now_ns
        if seen is None:
            return _refuse(given, message, row, Refusal(Code.NO_VEHICLE, "no vehicle is heard"))
        if message is None:
            return _refuse(given, message, row, Refusal(Code.UNSUPPORTED, row.why))
        meant = meaning_of(message, seen)
        ignored = client.sticks.news(meant) if isinstance(meant, Sticks) else ""
        told = client.dialogue.text(given.by, Level.INFO, ignored, now_ns) if ignored else []
        settled = client.settle(meant, seen, now_ns)
        if not (isinstance(meant, Sticks) and isinstance(settled, Reject)):
            chosen = self._chooses_takeoff(given, message, settled, seen)
            chosen = chosen or self._chooses_mission(given, message, settled, seen)
            if chosen:
                return Judged(False, [*told, *chosen])
            settled, forgotten = client.joined_with_choice(settled, seen, now_ns)
            told += forgotten
        judged = self._meant(given, message, row, settled, seen)
        return Judged(judged.refused, [*told, *judged.effects])

    def _chooses_takeoff(
        self, given: Received, message: Message, settled: Settled, seen: Seen
    ) -> list[BridgeEffect]:
        """A take-off that is kept until this client arms; nothing where it is not for that.

        A take-off *mode* is not kept: its client waits for a heartbeat that shows it.
        """
        if not isinstance(message, CommandLong | CommandInt):
            return []
        if message.command != Cmd.NAV_TAKEOFF or self.height_awaited:
            return []
        chosen = given.client.chooses_takeoff(settled, seen, given.by, given.now_ns)
        if chosen is None:
            return []
        return [*chosen, *given.client.dialogue.ask(given.by, message, (), given.now_ns)]

    def _chooses_mission(
        self, given: Received, message: Message, settled: Settled, seen: Seen
    ) -> list[BridgeEffect]:
        """The mode of a mission is forwarded, and its start waits for this client's arming;
        nothing where it is not for that."""
        sets_mode = isinstance(message, SetMode) or (
            isinstance(message, CommandLong | CommandInt) and message.command in SET_MODES
        )
        if not sets_mode or _arms_too(message) or not self.mission_mode.may_be_sent(given.now_ns):
            return []
        chosen = given.client.chooses_mission(settled, seen, given.by, given.now_ns)
        if chosen is None:
            return []
        self.mission_mode.sent(given.now_ns)
        return [*chosen, ToVehicle(given.frame.raw)]

    def _meant(
        self, given: Received, message: Message, row: Row, meaning: Settled, seen: Seen
    ) -> Judged:
        client, now_ns = given.client, given.now_ns
        match meaning:
            case Words(asks, note, _, answered_by):
                if self.height_awaited and any(climbs(each, seen.autopilot) for each in asks):
                    unknown = _refuse(given, message, row, HEIGHT_WRITTEN)
                    asks_for_it = asks_for_height(given.by.source, given.by.addressed)
                    return Judged(True, [*unknown.effects, asks_for_it])
                told = client.dialogue.text(given.by, Level.INFO, note, now_ns) if note else []
                asked = client.dialogue.ask(
                    given.by, message, asks, now_ns, answered_by=answered_by
                )
                return Judged(False, [*told, *asked])
            case Sample():
                return Judged(False, client.dialogue.stream(given.by, _stream(meaning)))
            case Forward():
                return Judged(False, [ToVehicle(given.frame.raw)])
            case Reject(refusal):
                return _refuse(given, message, row, refusal)

    @property
    def height_awaited(self) -> bool:
        """The least height of a climb was written just now: nobody's climb can be judged."""
        return self._guard is not None and self._guard.awaits(TAKEOFF_HEIGHT)

    # ------------------------------------------------------------------------------ set-up

    def _configuration(self, given: Received, message: Message | None, row: Row) -> Judged:
        """What would change the vehicle's set-up."""
        seen = given.look()
        if seen is None or message is None:
            return _refuse(given, message, row, Refusal(Code.POLICY, row.why))
        judged = self._guarded(message, given.by, seen, given.now_ns)
        match judged:
            case Allowed(note):
                self._log_read |= isinstance(message, LogRequestData)
                self._log_sent |= _is_command(message, Cmd.LOGGING_START)
                notes = [Notes(Level.INFO, f"{given.client.name}: {note}")] if note else []
                rally = [ChangesRallyPoints()] if isinstance(message, RallyPoint) else []
                return Judged(False, [*notes, ToVehicle(given.frame.raw), *rally])
            case guard_verdict.Refused(refusal, answers, ask_vehicle):
                by = given.by
                refused = _refuse(given, message, row, refusal)
                to_client = [Answers(by.link, by.addressed, each) for each in answers]
                to_vehicle = [AsksVehicle(by.source, each) for each in ask_vehicle]
                return Judged(True, [*refused.effects, *to_client, *to_vehicle])

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
        return [*(AsksVehicle(own, end) for end in ends), Notes(Level.INFO, text)]

    def client_lost(
        self, client: int, link: int, own: Address, vehicle: Address
    ) -> list[BridgeEffect]:
        """What it had the vehicle send is taken back, and its turn to read a plan is over."""
        self._downloads.gone(link)
        done: list[BridgeEffect] = []
        for message in self._asked_rates.client_lost(client, vehicle):
            done.append(AsksVehicle(own, message))
            if isinstance(message, RequestDataStream):
                done.append(AsksForStreams(tuple(asked_anew(message, self._needed_hz))))
        return done

    def parameter(self, message: ParamValue, autopilot: str, now_ns: int) -> list[BridgeEffect]:
        """PARAM_VALUE of the vehicle's autopilot: what has changed, for the log."""
        changed = self._guard_of(autopilot).heard(message, now_ns)
        return [] if changed is None else [Notes(changed.level, changed.text)]

    def _guard_of(self, autopilot: str) -> Guard:
        if self._guard is None:
            self._guard = Guard(self._rules, autopilot)
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

    # ------------------------------------------------------------------------------- plans

    def _plan(self, given: Received, message: Message, row: Row) -> Judged:
        """What a client says about missions, fences and rally points."""
        seen, client = given.look(), given.client
        if seen is not None and isinstance(message, MissionCount | MissionClearAll):
            judged = self._guarded(message, given.by, seen, given.now_ns)
            if isinstance(judged, guard_verdict.Refused):
                return self._configuration(given, message, row)
        busy = seen is not None and seen.plan_transfer
        reader = given.by.link, given.by.source
        held = self._downloads.holds(
            message, reader, busy, given.now_ns, in_control=given.in_control
        )
        if held:
            text = f"{row.name}: not now: {held}"
            told = client.dialogue.text(given.by, Level.INFO, text, given.now_ns)
            if self._downloads.answers(reader, given.now_ns):
                kind = getattr(message, "mission_type", MissionType.MISSION)
                no = mission_acknowledgement(given.by.source, MissionResult.ERROR, kind)
                told.append(Answers(given.by.link, given.by.addressed, no))
            return Judged(True, told)
        effects = client.plans.handle(message, given.by, given.now_ns)
        refused = any(isinstance(effect, plan_effects.Refused) for effect in effects)
        return Judged(refused, of_plan(client, effects, given.frame))


def climbs(ask: ipc.Ask, autopilot: Autopilot) -> bool:
    """Whether it makes the vehicle take off, or may do so."""
    mode = mode_named(autopilot, ask.mode) if ask.word == "mode" else None
    return ask.word in CLIMBS or (mode is not None and mode.meaning in CLIMBING)


def asks_for_height(source: Address, vehicle: Address) -> AsksVehicle:
    """The answer is read by the gate as well."""
    return AsksVehicle(
        source, ParamRequestRead(BY_NAME, vehicle.sysid, vehicle.compid, TAKEOFF_HEIGHT)
    )


def of_plan(
    client: Exchange, effects: Sequence[PlanEffect], frame: Frame | None = None
) -> list[BridgeEffect]:
    """What a client's plan server wants; `frame` is what it was given, if it was one."""
    done: list[BridgeEffect] = []
    for effect in effects:
        match effect:
            case Answers():
                done.append(effect)
            case plan_effects.Upload(plan):
                done.append(_ask_plan(client, "mission_upload", plan.source, plan.kind, plan))
            case plan_effects.Clear(kind):
                done.append(_ask_plan(client, "mission_clear", "", kind, None))
            case plan_effects.Withdraw(reason):
                done.append(StopsPlan(client.number, client.plan_ask, reason))
            case plan_effects.Pass() if frame is not None:
                done.append(ToVehicle(frame.raw))
            case plan_effects.Refused(name, refusal):
                ask = ipc.Ask(client.dialogue.number(), name.lower())  # answered already
                done.append(Refuses(client.number, ask, refusal))
    return done


def _ask_plan(
    client: Exchange, word: str, source: str, kind: MissionType, plan: ClientPlan | None
) -> AsksPlan:
    client.plan_ask = client.dialogue.number()
    ask = ipc.Ask(client.plan_ask, word, path=source, vehicle=client.vehicle)
    return AsksPlan(client.number, ask, kind, plan)


def _is_command(message: Message, command: Cmd) -> bool:
    return isinstance(message, CommandLong | CommandInt) and message.command == command


def _command(command: Cmd, vehicle: Address) -> CommandLong:
    """Without parameters."""
    return CommandLong(*(0.0,) * 7, command, vehicle.sysid, vehicle.compid, 0)


def _arms_too(message: Message) -> bool:
    """A mode with MAV_MODE_FLAG_SAFETY_ARMED: MAVLink's old way to arm in the same message."""
    if isinstance(message, SetMode):
        return bool(message.base_mode & ModeFlag.SAFETY_ARMED)
    if not isinstance(message, CommandLong | CommandInt) or message.command != Cmd.DO_SET_MODE:
        return False
    return math.isfinite(message.param1) and bool(int(message.param1) & ModeFlag.SAFETY_ARMED)


def _asks_for_rate(message: Message | None) -> bool:
    """Whether it is counted in `AskedRates`, of which every vehicle has its own."""
    if isinstance(message, CommandLong | CommandInt):
        return message.command == Cmd.SET_MESSAGE_INTERVAL
    return isinstance(message, RequestDataStream)


def _is_of_plan(message: Message | None) -> bool:
    """An item that is to be flown to at once is no part of a plan, and neither is a jump to one."""
    if _is_flown_to_at_once(message):
        return False
    return isinstance(message, PLAN_MESSAGES) and not isinstance(message, MissionSetCurrent)


def _is_flown_to_at_once(message: Message | None) -> bool:
    """ArduPilot's go-to, or change of height, as a mission item."""
    return isinstance(message, MissionItem | MissionItemInt) and message.current in GUIDED_CURRENT


def _refuse(given: Received, message: Message | None, row: Row, refusal: Refusal) -> Judged:
    dialogue = given.client.dialogue
    return Judged(True, dialogue.refuse(given.by, message, row.name, refusal, given.now_ns))


def _stream(sample: Sample) -> ipc.Stream:
    """A sample in the operator's frame."""
    if sample.attitude is not None:
        roll, pitch, yaw = map(math.degrees, roll_pitch_yaw(sample.attitude.q_ned_from_frd))
        return ipc.Stream(
            roll_deg=roll,
            pitch_deg=pitch,
            yaw_deg=yaw,
            yaw_rate_deg_s=_degrees(sample.yaw_rate_rad_s),
            thrust=sample.attitude.thrust,
        )
    return ipc.Stream(
        pos_enu=_enu(sample.pos_ned),
        v_enu=_enu(sample.v_ned),
        a_enu=_enu(sample.a_ned),
        yaw_deg=_degrees(sample.yaw_rad),
        yaw_rate_deg_s=_degrees(sample.yaw_rate_rad_s),
    )


def _enu(triple_ned: Vec3 | None) -> ipc.Maybe3 | None:
    """East, north, up; an axis that was left out (NaN) is None."""
    if triple_ned is None:
        return None
    east, north, up = (None if math.isnan(x) else x for x in enu_from_ned(triple_ned))
    return (east, north, up)


def _degrees(angle_rad: float | None) -> float | None:
    return None if angle_rad is None else math.degrees(angle_rad)
