"""One vehicle: what it reports, its gate, its commands, its settings and its missions.

All that is per vehicle is here and in the parts that this composes; what is per link is in
`links.py`, per client in `requests.py`, and what is per session in `session.py`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, get_args

from gcs import ipc
from gcs.config import StationConfig
from gcs.gate import effects, inputs
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind, Level
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Refusal
from gcs.gate.states import Control
from gcs.protocol.autopilot import autopilot_of
from gcs.protocol.effects import Heard, Send
from gcs.protocol.sequence import SequenceTracker
from gcs.protocol.transfer import PlanMessage
from gcs.report import FenceShape, ParamItem, SetpointItem, StatusItem
from gcs.session import discovery, teller
from gcs.session.commands import Commands
from gcs.session.discovery import Discovery
from gcs.session.effects import Record
from gcs.session.gate_port import GatePort, condition
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.jobs.job import VehicleView
from gcs.session.missions import Missions
from gcs.session.screen import lost_pct
from gcs.session.setpoints import setpoint
from gcs.session.telemetry import Telemetry
from gcs.session.updates import updates
from gcs.session.work import CheckStart, Log, PlaceFence, ToGate, Work
from gcs.wire import messages as m
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Component, MavAutopilot, MavType, Severity
from gcs.wire.messages import CommandLong

VEHICLE_GONE_NS = 3_500_000_000
LINK_SILENT_NS = 2_000_000_000
ORIGIN_PATIENCE_NS = 10_000_000_000
"""How long a vehicle may take to tell its origin before that is a condition."""

NODE = "link"

STATUSTEXT_LEVEL = {
    Severity.EMERGENCY: Level.FATAL,
    Severity.ALERT: Level.ERROR,
    Severity.CRITICAL: Level.ERROR,
    Severity.ERROR: Level.ERROR,
    Severity.WARNING: Level.WARNING,
    Severity.NOTICE: Level.INFO,
    Severity.INFO: Level.INFO,
    Severity.DEBUG: Level.DEBUG,
}

STATE_MESSAGES: Final = frozenset({m.Heartbeat, m.ExtendedSysState, m.SysStatus, m.MissionCurrent})
"""What tells a state is void once a newer one was seen; answers and events are not."""

CAMERA_MESSAGES: Final = frozenset({m.CameraImageCaptured, m.CameraFeedback})
PARAMETER_MESSAGES: Final = frozenset({m.ParamValue, m.ParamError})
MISSION_MESSAGES: Final = frozenset(
    {m.MissionCurrent, m.MissionItemReached, *get_args(PlanMessage)}
)


class Vehicle:
    """The vehicle that a session flies; `telemetry` is None until it is heard."""

    def __init__(self, config: StationConfig, policy: Policy, now_ns: int) -> None:
        self._config = config
        self._start_ns = now_ns
        self._port = GatePort(policy, config.speedup, now_ns)
        self._commands = Commands(config.sysid, config.compid, config.speedup)
        self._discovery = Discovery(config)
        self._missions = Missions(config)
        self._met_ns = 0
        self._newest: dict[tuple[int, int], int] = {}
        self._gone_ns = round(VEHICLE_GONE_NS * config.speedup)
        self.telemetry: Telemetry | None = None
        self.losses = SequenceTracker()

    # ------------------------------------------------------------------------------ reading

    @property
    def deadline_ns(self) -> int | None:
        """When some part's wait is over; the gate itself lives on ticks."""
        parts = (self._commands, self._discovery, self._missions)
        times = [part.deadline_ns for part in parts]
        return min((time for time in times if time is not None), default=None)

    @property
    def gate(self) -> Gate:
        """To look at, not to handle."""
        return self._port.gate

    @property
    def bad_start(self) -> Refusal | None:
        """Why the place where it stands at the start is outside the fence."""
        return self._port.bad_start

    @property
    def sysid(self) -> int:
        """0 before it is heard."""
        return self.telemetry.sysid if self.telemetry else 0

    @property
    def fence_shapes(self) -> list[FenceShape]:
        """The fence as the verifier stands on it; empty before it is placed."""
        return self._port.fence_shapes

    @property
    def mission_total(self) -> int | None:
        return self._missions.total

    def _view(self, telemetry: Telemetry) -> VehicleView:
        return VehicleView(telemetry, self.gate.state, self._port.policy)

    # ------------------------------------------------------------------------------- frames

    def frame(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """A good frame of anybody on `link`; what is not our vehicle's changes nothing."""
        work: list[Work] = []
        message = decode(frame)
        if isinstance(message, m.Heartbeat):
            work += self._discover(link, frame, message, now_ns)
        telemetry = self.telemetry
        if telemetry is None or frame.sysid != telemetry.sysid:
            return work
        number = self.losses.number(frame.sysid, frame.compid, frame.seq)
        self.losses.seen(frame.sysid, frame.compid, frame.seq)
        telemetry.count_frame(now_ns)
        if frame.compid == telemetry.compid:
            _choose_link(telemetry, link, now_ns)
        if message is not None and not self._overtaken(frame, message, number):
            heard = Heard(frame.sysid, frame.compid, message)
            work += self._heard(telemetry, heard, now_ns)
        return work

    def _overtaken(self, frame: Frame, message: m.Message, number: int) -> bool:
        """A state that is older than one of the same kind that has come: void."""
        if type(message) not in STATE_MESSAGES:
            return False
        key = (frame.compid, frame.msgid)
        newest = self._newest.get(key)
        if newest is not None and number <= newest:
            return True
        self._newest[key] = number
        return False

    def _heard(self, telemetry: Telemetry, heard: Heard, now_ns: int) -> list[Work]:
        work: list[Work] = []
        message = heard.message
        if isinstance(message, m.CommandAck):
            work += self._commands.heard(heard, now_ns)
        elif type(message) in PARAMETER_MESSAGES:
            work += self._settings(self._discovery.heard(heard, telemetry, now_ns), telemetry)
        elif type(message) in MISSION_MESSAGES:
            work += self._missions.heard(heard, self._view(telemetry), now_ns)
        elif isinstance(message, m.Statustext):
            level = STATUSTEXT_LEVEL.get(Severity(message.severity & 7), Level.INFO)
            work.append(Log(level, "vehicle", message.text))
        if heard.compid != telemetry.compid and type(message) not in CAMERA_MESSAGES:
            return work
        for update in updates(message, telemetry, now_ns):
            match update:
                case ToGate(inputs.PositionSeen(reset=True)):
                    work += self._missions.forget()
            work.append(update)
        return work

    # ---------------------------------------------------------------------------- discovery

    def _discover(self, link: int, frame: Frame, beat: m.Heartbeat, now_ns: int) -> list[Work]:
        """Choose our vehicle: the first autopilot that is heard, or the one that was named."""
        if beat.type == MavType.GCS or beat.autopilot == MavAutopilot.INVALID:
            return []
        wanted = self._config.target_sysid
        if wanted not in (0, frame.sysid) or frame.compid != Component.AUTOPILOT1:
            return []
        telemetry = self.telemetry
        work: list[Work] = []
        if telemetry is None:
            telemetry = Telemetry(frame.sysid, frame.compid, autopilot_of(beat.autopilot), link)
            telemetry.rx_window_start_ns = telemetry.link_ns = now_ns
            telemetry.position_age_ns = round(self._port.policy.position_age_s * 1e9)
            self._met_ns = now_ns
            self.telemetry = telemetry
            work += self._port.meet(telemetry, now_ns)
            news = f"vehicle {telemetry.label} on link {link}"
        elif telemetry.sysid == frame.sysid and now_ns - telemetry.heartbeat_ns > self._gone_ns:
            news = f"vehicle {telemetry.label} is back"
            telemetry.forget_place()
            self.losses.restart(frame.sysid, frame.compid)
            work += self._missions.forget()
            work.append(PlaceFence())
        else:
            return []
        work.append(Log(Level.INFO, NODE, news))
        work += self._settings(self._discovery.start(telemetry, now_ns), telemetry)
        return work + self._ask_for_missing(telemetry, now_ns)

    def _settings(self, found: Iterable[discovery.Found], telemetry: Telemetry) -> list[Work]:
        work: list[Work] = []
        for item in found:
            match item:
                case Send():
                    work.append(item)
                case discovery.ParameterKnown(name, value):
                    work.append(Record(ParamItem(telemetry.sysid, name, value)))
                case discovery.SettingsKnown(weak, return_up_m):
                    text = "the vehicle's own failsafes: " + ("; ".join(weak) or "all on")
                    work.append(condition(Condition.VEHICLE_FAILSAFE_WEAK, bool(weak), text))
                    if not weak:
                        work.append(Log(Level.INFO, NODE, text))
                    if return_up_m is not None:
                        telemetry.return_up_m = return_up_m
                        work.append(ToGate(inputs.ReturnHeightSeen(return_up_m)))
        return work

    def _ask_for_missing(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        commands = self._discovery.missing(telemetry, now_ns)
        return [work for c in commands for work in self._commands.send_own(c, now_ns)]

    # --------------------------------------------------------------------------------- time

    def wake(self, now_ns: int) -> list[Work]:
        """Some part's deadline has passed."""
        work = self._commands.wake(self.telemetry, now_ns)
        if self.telemetry is not None:
            found = self._discovery.wake(self.telemetry, now_ns)
            work += self._settings(found, self.telemetry)
            work += self._missions.wake(self._view(self.telemetry), now_ns)
        return work

    def second(self, now_ns: int) -> list[Work]:
        """Once a second: ask for what is missing, and record how the vehicle is."""
        telemetry = self.telemetry
        if telemetry is None:
            return []
        work: list[Work] = []
        if now_ns - telemetry.heartbeat_ns <= self._gone_ns:
            work += self._ask_for_missing(telemetry, now_ns)
        missing = telemetry.origin is None and now_ns - self._met_ns > ORIGIN_PATIENCE_NS
        text = "the vehicle has not told its origin (GPS_GLOBAL_ORIGIN)"
        work.append(condition(Condition.ORIGIN_MISSING, missing, text))
        status = StatusItem(
            telemetry.sysid,
            bool(telemetry.armed),
            telemetry.mode_name,
            telemetry.landed.name,
            telemetry.battery_pct,
            telemetry.battery_v,
            telemetry.rx_hz,
            lost_pct(self.losses),
        )
        return [*work, Record(status)]

    def send_own(self, commands: Iterable[CommandLong], now_ns: int) -> list[Work]:
        """Harmless commands of the station's own, such as for a stream."""
        return [work for each in commands for work in self._commands.send_own(each, now_ns)]

    def remind(self) -> list[Work]:
        """The gate's state once more, for the record."""
        return [] if self.telemetry is None else [*teller.reminder(self.gate, self.sysid)]

    # ----------------------------------------------------------------------------- requests

    def ask_mission(self, request_id: int, ask: ipc.Ask, now_ns: int) -> list[Work]:
        """A mission transfer, or the start of the mission on board."""
        state, policy = self.gate.state, self._port.policy
        return self._missions.ask(request_id, ask, self.telemetry, state, policy, now_ns)

    def file(self, news: FileRead | FileWritten, now_ns: int) -> list[Work]:
        if self.telemetry is None:
            return []
        return self._missions.file(news, self._view(self.telemetry), now_ns)

    def stop_transfer(self, request_id: int) -> list[Work]:
        """End the mission transfer of that request; nothing where none is under way."""
        return self._missions.stop(request_id)

    def leave(self) -> list[Work]:
        """The session ends: a mission job that is under way ends with it."""
        return self._missions.leave()

    # --------------------------------------------------------------------------------- gate

    def ask_gate(self, given: inputs.Input, now_ns: int) -> list[Work]:
        return self._port.handle(given, now_ns)

    def carry_out(
        self, effect: effects.Effect | PlaceFence | CheckStart, now_ns: int
    ) -> list[Work]:
        """What the gate decided, put into practice."""
        match effect:
            case effects.SendSetpoint(permit):
                assert self.telemetry is not None
                message = setpoint(self.telemetry, permit, self._start_ns, now_ns)
                assert permit.pos_ned is not None
                self.telemetry.count_setpoint(now_ns)
                sent = SetpointItem(self.telemetry.sysid, permit.pos_ned, permit.yaw_rad)
                return [Send(message), Record(sent)]
            case effects.SendCommand():
                assert self.telemetry is not None
                return self._commands.send(effect, self.telemetry, now_ns)
            case effects.CancelCommand(request_id, kind):
                return self._commands.cancel(request_id, kind, now_ns)
            case PlaceFence():
                return self._port.place_fence(self.telemetry)
            case CheckStart():
                self._port.check_start(effect)
                return []
            case effects.Outcome():
                return [effect]
            case _:
                return self._port.tell(effect, self.sysid)

    def hold_without_gate(self, now_ns: int) -> list[Work]:
        """The last resort: HOLD, past a gate that may be broken, where control was ours."""
        if self.telemetry is None or self.gate.control is Control.NONE:
            return []
        hold = effects.SendCommand(0, CommandKind.HOLD, now_ns)
        return self._commands.send(hold, self.telemetry, now_ns)


def _choose_link(telemetry: Telemetry, link: int, now_ns: int) -> None:
    """Answer where it is heard; another link takes over only once that one is silent."""
    if link == telemetry.link or now_ns - telemetry.link_ns > LINK_SILENT_NS:
        telemetry.link, telemetry.link_ns = link, now_ns
