"""The kind of a client's frame decides what is done with it: every kind, once.

By its message or command (`catalog/`) it is forwarded, refused, or given to one of the others here:
what would move the vehicle (`motion.py`), change its set-up (`set_up.py`), or is about plans
(`plans.py`).
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.catalog import Kind, Row, command_row, message_row
from gcs.bridge.effects import AsksForStreams, AsksVehicle, BridgeEffect, ForwardToVehicle
from gcs.bridge.judge.motion import MotionJudge
from gcs.bridge.judge.plans import PlanJudge
from gcs.bridge.judge.received import Judged, Received, refuse
from gcs.bridge.judge.set_up import SetUpJudge
from gcs.bridge.judge.target_component import why_not_component
from gcs.bridge.mission_mode import MissionMode
from gcs.bridge.peers.control import ControlServer
from gcs.bridge.plans.server import PLAN_MESSAGES
from gcs.bridge.rates.asked_rates import AskedRates
from gcs.bridge.rates.needed_rates import Rates, asked_anew, not_slower
from gcs.bridge.rates.thinned_streams import ThinnedStreams
from gcs.bridge.setup_policy.names import DENIED_BY_NAME, kinds_by_name
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.autopilot import ARDUPILOT
from gcs.protocol.effects import Address
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.hidden_frames import hides_frame
from gcs.wire.ids import Cmd
from gcs.wire.messages import (
    CommandInt,
    CommandLong,
    Message,
    MissionItem,
    MissionItemInt,
    MissionSetCurrent,
    RequestDataStream,
)

_LOOKED_INTO: tuple[type[Message], ...] = (*PLAN_MESSAGES, RequestDataStream)
DECODED_IDS: Final = frozenset(kind.MSG_ID for kind in _LOOKED_INTO)
"""Messages that are looked into although they may be harmless."""
GUIDED_CURRENT: Final = frozenset({2, 3})
"""MISSION_ITEM.current of an item that ArduPilot flies to at once, or whose height it takes."""

HIDES_A_FRAME: Final = Refusal(
    Code.POLICY,
    "a whole message stands in its bytes, which a vehicle that lost one byte would take",
)
POINTED_BY_ANOTHER: Final = Refusal(
    Code.OTHER_OPERATOR, "another client is in control, and points the camera"
)


class Judge:
    """Of everything that clients send to one vehicle."""

    def __init__(
        self, rules: BridgeRules, needed_hz: Rates, control: ControlServer, thinned: ThinnedStreams
    ) -> None:
        """`needed_hz`: how often the gate needs which message; `control`: who is in control;
        `thinned`: how often which client wants what the gate needs."""
        self._thinned = thinned
        self._control = control
        self._needed_hz = needed_hz
        self._asked_rates = AskedRates(rules, needed_hz)
        self.set_up = SetUpJudge(rules)
        self.mission_mode = MissionMode()
        self._motion = MotionJudge(self.set_up, self.mission_mode)
        self._plans = PlanJudge(self.set_up)
        self._kinds = kinds_by_name(rules)
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
        if hides_frame(frame.raw):
            return refuse(given, message, row, HIDES_A_FRAME)
        if message is not None and kind is not Kind.DENIED and _is_of_plan(message):
            return self._plans.judge(given, message, row)
        if kind in (Kind.MOTION, Kind.CONFIGURATION):
            nobody = why_not_component(given, message)
            if nobody is not None:
                return refuse(given, message, row, nobody)
        if kind is Kind.CONFIGURATION and _is_flown_to_at_once(message):
            return self._motion.judge(given, message, row)
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
                by_name = row.name in self._kinds
                refusal = DENIED_BY_NAME if by_name else Refusal(Code.POLICY, row.why)
                return refuse(given, message, row, refusal)
            case Kind.MOTION:
                return self._motion.judge(given, message, row)
            case Kind.CONFIGURATION:
                return self.set_up.judge(given, message, row)

    def asked_once(self, now_ns: int) -> list[Received]:
        """What was held back and is to be judged once more."""
        return self._plans.asked_once(now_ns)

    def _forward(self, given: Received, message: Message | None, row: Row) -> Judged:
        """What is harmless, but for the rates that the gate needs and those that fill the link."""
        if not isinstance(message, CommandLong | CommandInt | RequestDataStream):
            return Judged(False, [ForwardToVehicle(given.frame.raw)])
        instead: Message | Refusal
        again: list[BridgeEffect] = []
        obeyed = True
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
            return refuse(given, message, row, instead)
        self._thinned.asked(given.by.link, given.by.addressed, message, obeyed=obeyed)
        if instead is message:
            return Judged(False, [ForwardToVehicle(given.frame.raw), *again])
        return Judged(False, [AsksVehicle(given.by.source, instead), *again])

    def _pointing(self, given: Received, message: Message | None, row: Row) -> Judged:
        """What points a camera, and may turn the nose: not while another one flies."""
        seen = given.look()
        if seen is not None and not seen.in_control:
            return refuse(given, message, row, POINTED_BY_ANOTHER)
        return Judged(False, [ForwardToVehicle(given.frame.raw)])

    def client_lost(
        self, client: int, link: int, own: Address, vehicle: Address
    ) -> list[BridgeEffect]:
        """What it had the vehicle send is taken back, and its turn to read a plan is over."""
        self._plans.gone(link)
        done: list[BridgeEffect] = []
        for message in self._asked_rates.client_lost(client, vehicle):
            done.append(AsksVehicle(own, message))
            if isinstance(message, RequestDataStream):
                done.append(AsksForStreams(tuple(asked_anew(message, self._needed_hz))))
        return done


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
