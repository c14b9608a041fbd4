"""One vehicle: what it reports, its gate, its commands, its settings and its missions.

All that is per vehicle is here and in the parts that this composes; what is per link is in
`links.py`, per client in `requests.py`, and what is per session in `session.py`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from gcs.config import StationConfig
from gcs.gate import effects, inputs
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind, Level
from gcs.gate.machine.arming import why_not_arm
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import Control, State
from gcs.protocol import arm_authorizer
from gcs.protocol.autopilot import Autopilot, autopilot_of
from gcs.protocol.effects import Address, Heard, Send
from gcs.protocol.sequence import SequenceTracker
from gcs.protocol.vehicle_control import VehicleControl
from gcs.report import FenceShape, ParamItem, SetpointItem
from gcs.session import recorded, settings, teller
from gcs.session.commands import Commands
from gcs.session.delay import Delay
from gcs.session.discovery import Discovery
from gcs.session.effects import Record
from gcs.session.events import EVENT_MESSAGES, Events
from gcs.session.failsafes import limits_of
from gcs.session.gate_port import GatePort, condition
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.interpreted_messages import (
    CAMERA_MESSAGES,
    INTERPRETED,
    MISSION_MESSAGES,
    PARAMETER_MESSAGES,
    PLACE_MESSAGES,
    of_autopilot,
)
from gcs.session.jobs.job import VehicleView
from gcs.session.missions import Missions, still_paused
from gcs.session.orbits import Orbits
from gcs.session.position_health import GPS_SILENT_NS
from gcs.session.presence import STATE_MESSAGES, Presence
from gcs.session.reasons import Reasons
from gcs.session.return_places import ReturnPlaces
from gcs.session.roster import Roster
from gcs.session.screen import lost_pct
from gcs.session.setpoints import attitude_target, setpoint
from gcs.session.settings import Settings
from gcs.session.telemetry import Telemetry
from gcs.session.thrust_meaning import with_thrust_meaning
from gcs.session.times import Times
from gcs.session.updates import updates
from gcs.session.watch import Watch
from gcs.session.words import Words, logged
from gcs.session.work import AskMission, AskOrbit, CheckStart, Log, PlaceFence, ToGate, Work
from gcs.wire import messages as m
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Component
from gcs.wire.messages import CommandLong

ORIGIN_PATIENCE_NS = 10_000_000_000
"""How long a vehicle may take to tell its origin before that is a condition."""

NODE = "link"

ALIVE: Final[Sequence[Work]] = (ToGate(inputs.MessageSeen()),)
"""What the gate is to hear of any frame of the autopilot, now and then."""
MOST_IN_TURN: Final = 100
"""Frames that are counted as one: fewer than half of the ring of sequence numbers."""


class Vehicle:
    """One vehicle that a session flies; `telemetry` is None until it is heard."""

    def __init__(
        self,
        config: StationConfig,
        policy: Policy,
        times: Times,
        now_ns: int,
        *,
        shown: bool = True,
    ) -> None:
        """`shown`: it is the one that the screens of operators show."""
        self._config = config
        self._shown = shown
        self._times = times
        gone_ns = round(times.policy(policy).heartbeat_age_s * 1e9)
        self._start_ns = now_ns
        own = self._own = Address(config.sysid, config.compid)
        self._port = GatePort(times.policy(policy), now_ns, shown=shown)
        self._commands = Commands(own, times)
        self._discovery = Discovery(times)
        self._settings = Settings(
            own,
            times,
            limits_of(policy, own.sysid),
            reads_thrust=policy.stream.tilt_deg > 0.0,
        )
        self._missions = Missions(own, times)
        self._returns = ReturnPlaces(own, times)
        self._orbits = Orbits(times)
        self._words = Words(times)
        self._events = Events(own, self._words, times)
        self._control = VehicleControl(own)
        self._roster = Roster(config.target_sysid, times, gone_ns)
        self._reasons = Reasons(self._words, times)
        self._met_ns = 0
        self._parameters: dict[str, float] = {}
        self._presence = Presence(times, gone_ns)
        self._watch = Watch(policy, times)
        self.telemetry: Telemetry | None = None
        self.mission_paused = False
        """A mission was stopped by a hold, and nothing else was flown since."""

    # ------------------------------------------------------------------------------ reading

    @property
    def deadline_ns(self) -> int | None:
        """When some part's wait is over; the gate itself lives on ticks."""
        talking = (self._commands, self._settings, self._missions, self._returns)
        parts = (*talking, self._words, self._events, self._reasons)
        times = [part.deadline_ns for part in parts]
        return min((time for time in times if time is not None), default=None)

    @property
    def gate(self) -> Gate:
        """To look at, not to handle."""
        return self._port.gate

    @property
    def bad_home(self) -> Refusal | None:
        """Why its home is outside the fence, where its start was looked at."""
        return self._port.bad_home

    @property
    def bad_start(self) -> Refusal | None:
        """Why the place where it stands at the start is outside the fence."""
        return self._port.bad_start

    @property
    def sysid(self) -> int:
        """0 before it is heard."""
        return self.telemetry.sysid if self.telemetry else 0

    @property
    def links(self) -> list[int]:
        """The link that it is answered on; none before it is heard."""
        return [] if self.telemetry is None else [self.telemetry.link]

    @property
    def _of(self) -> str:
        """In names in the record, of which the first vehicle's are plain."""
        return "" if self._shown else f"-{self.sysid}"

    @property
    def fence_shapes(self) -> list[FenceShape]:
        """The fence as the verifier stands on it; empty before it is placed."""
        return self._port.fence_shapes

    @property
    def parameters(self) -> Mapping[str, float]:
        """Those of its parameters that are known."""
        return self._parameters

    @property
    def losses(self) -> SequenceTracker:
        """Frames that were lost on the way."""
        return self._presence.losses

    @property
    def mission_total(self) -> int | None:
        return self._missions.total

    @property
    def plan_transfer(self) -> bool:
        """The station reads or writes a plan of the vehicle, or is about to."""
        return self._missions.busy or self._returns.reading

    @property
    def mission_items(self) -> int:
        """Items of the verified mission on board; 0 where there is none."""
        return self._missions.items

    @property
    def land_starts(self) -> tuple[int, ...]:
        """The DO_LAND_START items of that mission."""
        return self._missions.land_starts

    def _view(self, telemetry: Telemetry) -> VehicleView:
        return VehicleView(telemetry, self.gate.state, self._port.policy)

    # ------------------------------------------------------------------------------- frames

    def passes(self, link: int, frames: Sequence[Frame], now_ns: int) -> bool:
        """Good frames of messages that are not in `INTERPRETED`: counted, and not decoded.

        True: the gate is to hear that the vehicle lives.
        """
        telemetry = self.telemetry
        if telemetry is None:
            return False
        own = [frame for frame in frames if frame.sysid == telemetry.sysid]
        if not own:
            return False
        self._presence.number_all(own, now_ns)
        telemetry.count_frames(len(own), now_ns)
        of_autopilot = telemetry.compid in [frame.compid for frame in own]
        return of_autopilot and self._alive(telemetry, link, now_ns)

    def _alive(self, telemetry: Telemetry, link: int, now_ns: int) -> bool:
        """A frame of its autopilot came; whether the gate is to hear of it."""
        if telemetry.heard_ns == now_ns == telemetry.link_ns:
            return False  # the datagram's first frame has told it
        self._presence.choose_link(telemetry, link, now_ns)
        return self._presence.alive(telemetry, now_ns)

    def in_turn(self, link: int, frames: Sequence[Frame], now_ns: int) -> Sequence[Work] | None:
        """Good frames that came together, all of its autopilot and each the next one: counted.

        What the gate is to hear of that.  None where they are any others, or very many: then
        nothing was counted.
        """
        telemetry = self.telemetry
        if telemetry is None or len(frames) > MOST_IN_TURN:
            return None
        if not self._presence.all_in_turn((telemetry.sysid, telemetry.compid), frames, now_ns):
            return None
        telemetry.count_frames(len(frames), now_ns)
        return ALIVE if self._alive(telemetry, link, now_ns) else ()

    def counted(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """One of those that `in_turn` has counted, of this vehicle or of another that has a radio
        of its own: that tells of the link."""
        work: list[Work] = []
        message = decode(frame) if frame.msgid in INTERPRETED else None
        telemetry = self.telemetry
        if message is None or telemetry is None:
            return work
        if isinstance(message, m.Heartbeat):
            work += self._discover(link, frame, message, now_ns)
        elif isinstance(message, m.RadioStatus):
            work += self._watch.radio(message, now_ns)
        if frame.sysid != telemetry.sysid:
            return work
        state = type(message) in STATE_MESSAGES
        if state and self._presence.overtaken(frame, message, self._presence.number_of(frame)):
            return work
        return work + self._interpreted(telemetry, frame, message, now_ns)

    def placed(self, frame: Frame, now_ns: int) -> list[Work]:
        """The same of one that tells where the vehicle is: nothing else of it is changed by that,
        and nobody waits for it."""
        message, telemetry = decode(frame), self.telemetry
        if message is None or telemetry is None:
            return []
        return self._updated(telemetry, message, now_ns)

    def frame(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """A good frame of anybody on `link`; what is not our vehicle's changes nothing."""
        work: list[Work] = []
        message = decode(frame) if frame.msgid in INTERPRETED else None
        if isinstance(message, m.Heartbeat):
            work += self._discover(link, frame, message, now_ns)
        telemetry = self.telemetry
        if isinstance(message, m.RadioStatus):
            work += self._watch.radio(message, now_ns)
        if telemetry is None or frame.sysid != telemetry.sysid:
            return work
        number = self._presence.number(frame, now_ns)
        telemetry.count_frames(1, now_ns)
        if frame.compid == telemetry.compid and self._alive(telemetry, link, now_ns):
            work += ALIVE
        if message is not None and not self._presence.overtaken(frame, message, number):
            work += self._interpreted(telemetry, frame, message, now_ns)
        return work

    def _interpreted(
        self, telemetry: Telemetry, frame: Frame, message: m.Message, now_ns: int
    ) -> list[Work]:
        before = telemetry.armed, telemetry.mode_name, telemetry.landed
        heard = Heard(frame.sysid, frame.compid, message)
        work = self._heard(telemetry, heard, now_ns)
        if before != (telemetry.armed, telemetry.mode_name, telemetry.landed):
            work.append(Record(recorded.status(telemetry, lost_pct(self.losses))))
        return work

    def _heard(self, telemetry: Telemetry, heard: Heard, now_ns: int) -> list[Work]:
        work: list[Work] = []
        message = heard.message
        if type(message) in PLACE_MESSAGES:
            own = heard.compid == telemetry.compid
            return self._updated(telemetry, message, now_ns) if own else []
        if isinstance(message, m.CommandAck):
            answered = self._commands.heard(heard, now_ns)
            work += self._reasons.explained(answered, telemetry.custom_mode, now_ns)
        elif type(message) in PARAMETER_MESSAGES:
            work += self._learn(self._settings.heard(heard, telemetry, now_ns), telemetry)
            work += self._returns.heard(heard, telemetry, now_ns)
            work += self._of_missions(
                self._missions.heard(heard, self._view(telemetry), now_ns), now_ns
            )
        elif type(message) in MISSION_MESSAGES:
            work += self._returns.heard(heard, telemetry, now_ns)
            work += self._of_missions(
                self._missions.heard(heard, self._view(telemetry), now_ns), now_ns
            )
        elif isinstance(message, m.CommandLong):
            work += self._authorized(telemetry, heard, message, now_ns)
        elif isinstance(message, m.Statustext):
            work += logged(self._words.text(heard.compid, message, now_ns))
        elif isinstance(message, m.AutopilotVersion):
            work.append(Record(recorded.vehicle(telemetry, message, self._of)))
        elif isinstance(message, m.ControlStatus):
            if text := self._control.heard(message):
                level = Level.WARNING if self._control.another else Level.INFO
                work.append(Log(level, NODE, text))
        elif type(message) in EVENT_MESSAGES and heard.compid == telemetry.compid:
            work += self._events.heard(heard, now_ns)
        if heard.compid != telemetry.compid and type(message) not in CAMERA_MESSAGES:
            return work
        if heard.compid == telemetry.compid:
            work += self._watch.heard(message, now_ns)
        return [*work, *self._updated(telemetry, message, now_ns), *_accuracy(telemetry)]

    def _updated(self, telemetry: Telemetry, message: m.Message, now_ns: int) -> list[Work]:
        """What the vehicle reports of itself, into `telemetry`."""
        work: list[Work] = []
        for update in updates(message, telemetry, now_ns):
            work.append(update)
            match update:
                case ToGate(inputs.PositionSeen(reset=True)):
                    work = [*self._missions.forget(), *work, *_accuracy(telemetry)]
                case ToGate(inputs.HomeSeen()) | PlaceFence():
                    work += self._returns.placed(telemetry)
        return work

    def _authorized(
        self, telemetry: Telemetry, heard: Heard, asked: m.CommandLong, now_ns: int
    ) -> list[Work]:
        """The vehicle asks whether it may arm, where it is set up to ask this station."""
        asker = Address(heard.sysid, heard.compid)
        refusal = why_not_arm(self._port.policy, self.gate.memory, now_ns)
        troubles = [
            "" if refusal is None else refusal.sentence,
            self._settings.without_fence(telemetry, fence_plan=self._missions.fence_on_board),
            self._missions.unverified,
        ]
        answer = arm_authorizer.answer(asked, asker, self._own, [each for each in troubles if each])
        if answer is None:
            return []
        self._commands.deny_arming("" if answer.granted else answer.text)
        level = Level.INFO if answer.granted else Level.WARNING
        return [Send(answer.ack), Log(level, teller.NODE, answer.text)]

    # ---------------------------------------------------------------------------- discovery

    def _discover(self, link: int, frame: Frame, beat: m.Heartbeat, now_ns: int) -> list[Work]:
        """Choose our vehicle: the first autopilot that is heard, or the one that was named."""
        if not of_autopilot(beat) or frame.compid != Component.AUTOPILOT1:
            return []
        work: list[Work] = []
        if self._roster.heard(frame.sysid, frame.compid, beat, now_ns):
            names = ", ".join(self._roster.names(now_ns))
            level = Level.INFO if self._config.target_sysid else Level.WARNING
            work.append(Log(level, NODE, f"several vehicles are heard: {names}"))
        wanted = self._config.target_sysid
        if wanted not in (0, frame.sysid):
            return work
        telemetry = self.telemetry
        if telemetry is None:
            autopilot = autopilot_of(beat.autopilot, beat.type)
            telemetry = Telemetry(frame.sysid, frame.compid, autopilot, link)
            telemetry.mav_autopilot, telemetry.mav_type = beat.autopilot, beat.type
            telemetry.delay = Delay(self._times)
            telemetry.rx_window_start_ns = telemetry.link_ns = now_ns
            telemetry.position_age_ns = round(self._port.policy.position_age_s * 1e9)
            self._met_ns = now_ns
            self.telemetry = telemetry
            work += self._port.meet(telemetry, now_ns)
            news = f"vehicle {telemetry.label} on link {link}"
        elif telemetry.sysid == frame.sysid and (
            telemetry.was_gone or self._presence.is_gone(telemetry, now_ns)
        ):
            self._presence.back(telemetry, now_ns)
            news = f"vehicle {telemetry.label} is back"
            telemetry.forget_place()
            work += self._missions.forget()
            work.append(PlaceFence())
        else:
            return work
        work.append(Log(Level.INFO, NODE, news))
        self._discovery.start()
        self._events.start(Address(telemetry.sysid, telemetry.compid))
        work += self._learn(self._settings.start(telemetry, now_ns), telemetry)
        work += self._returns.start(telemetry, busy=self._missions.busy, now_ns=now_ns)
        return work + self._ask_for_missing(telemetry, now_ns)

    def _learn(self, found: Iterable[settings.Found], telemetry: Telemetry) -> list[Work]:
        """What the vehicle's own settings say."""
        work: list[Work] = []
        for item in found:
            match item:
                case Send():
                    work.append(item)
                case settings.ParameterKnown(name, value):
                    self._parameters[name] = value
                    work.append(Record(ParamItem(telemetry.sysid, name, value)))
                case settings.ReturnHeightKnown(up_m):
                    telemetry.return_up_m, telemetry.return_told = up_m, True
                    if up_m is not None:
                        work.append(ToGate(inputs.ReturnHeightSeen(up_m)))
                case settings.ReturnTypeKnown(kind):
                    work += self._returns.returns_by(kind, telemetry)
                case settings.AcceptanceKnown(radius_m):
                    telemetry.acceptance_m = radius_m
                    work += _accuracy(telemetry)
                case settings.ClimbEndKnown(within_m):
                    work.append(ToGate(inputs.ClimbEndSeen(within_m)))
                case settings.FailsafesKnown(weak, every):
                    telemetry.failsafes = every
                    head = "the vehicle's own failsafes: "
                    text = head + ("; ".join(weak) or "all on")
                    work.append(condition(Condition.VEHICLE_FAILSAFE_WEAK, bool(weak), text))
                    work.append(Log(Level.INFO, NODE, head + "; ".join(every or weak)))
        return work

    def _ask_for_missing(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        commands = self._discovery.missing(telemetry, now_ns)
        return [work for c in commands for work in self._commands.send_own(c, now_ns)]

    # --------------------------------------------------------------------------------- time

    def wake(self, now_ns: int) -> list[Work]:
        """Some part's deadline has passed."""
        work = self._commands.wake(self.telemetry, now_ns) + logged(self._words.wake(now_ns))
        work += self._events.wake(now_ns)
        if self.telemetry is not None:
            work += self._reasons.wake(self.telemetry.custom_mode, now_ns)
            work += self._learn(self._settings.wake(self.telemetry, now_ns), self.telemetry)
            missions = self._missions.wake(self._view(self.telemetry), now_ns)
            work += self._of_missions(missions, now_ns)
            busy = self._missions.busy
            work += self._returns.wake(self.telemetry, busy=busy, now_ns=now_ns)
        return work

    def rally_points_change(self, now_ns: int) -> list[Work]:
        """A client's message that changes them goes to the vehicle."""
        if self.telemetry is None:
            return []
        return self._of_missions(self._returns.changed(self.telemetry, now_ns), now_ns)

    def _of_missions(self, work: list[Work], now_ns: int) -> list[Work]:
        """What a job does, and what follows for the places where a return may end."""
        telemetry = self.telemetry
        if telemetry is None:
            return work
        busy = self._missions.busy
        return work + self._returns.follow(work, telemetry, busy=busy, now_ns=now_ns)

    def second(self, now_ns: int) -> list[Work]:
        """Once a second: ask for what is missing, and record how the vehicle is."""
        telemetry = self.telemetry
        if telemetry is None:
            return []
        work: list[Work] = []
        if not self._presence.is_gone(telemetry, now_ns):
            work += self._ask_for_missing(telemetry, now_ns)
        if now_ns >= telemetry.delay.ask_at_ns:
            target = telemetry.sysid, telemetry.compid
            work.append(Send(m.Timesync(0, telemetry.delay.ask(now_ns), *target)))
        if now_ns - telemetry.position_ns <= telemetry.position_age_ns:
            work += telemetry.health.gps_silent(self._times.real_ns(GPS_SILENT_NS), now_ns)
        missing = telemetry.origin is None and now_ns - self._met_ns > self._times.real_ns(
            ORIGIN_PATIENCE_NS
        )
        work += self._of_missions([], now_ns)
        work += self._watch.second(self.losses, now_ns)
        text = "the vehicle has not told its origin (GPS_GLOBAL_ORIGIN)"
        work.append(condition(Condition.ORIGIN_MISSING, missing, text))
        return [*work, Record(recorded.status(telemetry, lost_pct(self.losses)))]

    def send_own(self, commands: Iterable[CommandLong], now_ns: int) -> list[Work]:
        """Harmless commands of the station's own, such as for a stream."""
        return [work for each in commands for work in self._commands.send_own(each, now_ns)]

    def ask_for_streams(self, msgids: Iterable[int], now_ns: int) -> list[Work]:
        """Ask once more for streams that the gate needs."""
        if self.telemetry is None:
            return []
        return self.send_own(self._discovery.again(self.telemetry, msgids), now_ns)

    def remind(self) -> list[Work]:
        """The gate's state once more, for the record; before a vehicle is heard, of the one that
        is expected, where its number is known."""
        sysid = self.sysid or self._config.expected_sysid
        return [*teller.reminder(self.gate, sysid)] if sysid else []

    def predicted_stop(self) -> list[Work]:
        """Where it would come to rest if it were told to stop now, for the record.  In flight."""
        return [] if self.telemetry is None else self._port.predicted_stop(self.telemetry)

    # ----------------------------------------------------------------------------- requests

    def refusal(self, now_ns: int) -> Refusal | None:
        """Why nothing at all can be asked of it; None where the gate or a job is to answer."""
        refusal = self._roster.refusal(now_ns)
        telemetry = self.telemetry
        if refusal is None and telemetry is not None and not telemetry.autopilot.commanded:
            what = f"{telemetry.label} is watched and recorded"
            sentence = f"this station flies multirotors with PX4 or ArduPilot only; {what}"
            return Refusal(Code.UNSUPPORTED_VEHICLE, sentence)
        return refusal

    def for_operators(self, now_ns: int) -> tuple[Autopilot | None, Refusal | None]:
        """Its autopilot, None before it is heard; and why nothing at all can be asked of it."""
        return self.telemetry.autopilot if self.telemetry else None, self.refusal(now_ns)

    def heard_vehicles(self, now_ns: int) -> list[str]:
        """The names of all that are heard."""
        return self._roster.names(now_ns)

    def listening(self, now_ns: int) -> bool:
        """Whether it may still turn out that there are several vehicles (one of our own is alone),
        or the return height or rally points, which a return needs, are still on their way."""
        several = self._config.sim is None and self._roster.listening(now_ns)
        if several or self.telemetry is None:
            return several
        return not self.telemetry.return_told or self._returns.first_time

    def ask_mission(self, asked: AskMission, now_ns: int) -> list[Work]:
        """A mission transfer, or the start of the mission on board."""
        state, policy = self.gate.state, self._port.policy
        work = self._missions.ask(
            asked.request_id,
            asked.ask,
            self.telemetry,
            state,
            policy,
            now_ns,
            asked.plan,
            asked.kind,
        )
        return self._ask_for_control(now_ns) + self._of_missions(work, now_ns)

    def ask_orbit(self, asked: AskOrbit, now_ns: int) -> list[Work]:
        """An orbit, which is verified here before the gate is asked for its stream."""
        return self._ask_for_control(now_ns) + self._orbits.ask(
            asked, self.telemetry, self.gate, self._port.policy, now_ns
        )

    def orbit_sample(self, in_control: int, now_ns: int) -> list[Work]:
        """The next sample of the orbit that is flown, if it is that of the operator in control."""
        return self._orbits.tick(in_control, self.telemetry, self.gate, self._port.policy, now_ns)

    def streamed_by(self, client: int) -> list[Work]:
        """An operator sends samples of its own: an orbit of its is not flown any more."""
        return self._orbits.streams_itself(client)

    def _ask_for_control(self, now_ns: int) -> list[Work]:
        """Of a vehicle that has operator control, and obeys another station or nobody yet."""
        if self.telemetry is None:
            return []
        address = Address(self.telemetry.sysid, self.telemetry.compid)
        command = self._control.before_command(address, now_ns)
        return [] if command is None else self._commands.send_own(command, now_ns)

    def file(self, news: FileRead | FileWritten, now_ns: int) -> list[Work]:
        if self.telemetry is None:
            return []
        work = self._missions.file(news, self._view(self.telemetry), now_ns)
        return self._of_missions(work, now_ns)

    def stop_transfer(self, request_id: int) -> list[Work]:
        """End the mission transfer of that request; nothing where none is under way."""
        return self._missions.stop(request_id)

    def leave(self) -> list[Work]:
        """The session ends: a mission job that is under way ends with it; what the flight stood on
        is attached to the record."""
        released: list[Work] = []
        if self.telemetry is not None:
            address = Address(self.telemetry.sysid, self.telemetry.compid)
            command = self._control.release(address)
            released = [] if command is None else [Send(command)]
        return [
            *self._missions.leave(),
            *released,
            *recorded.stood_on(self._parameters, self.fence_shapes, self._of),
        ]

    # --------------------------------------------------------------------------------- gate

    def ask_gate(self, given: inputs.Input, now_ns: int) -> list[Work]:
        gate = self._port.gate
        before = gate.state
        if isinstance(given, inputs.StreamSeen) and self.telemetry is not None:
            given = with_thrust_meaning(given, self.telemetry.autopilot, self._parameters)
        work = [*self._port.handle(given, now_ns), *self._missions.overruled(given)]
        self.mission_paused = still_paused(self.mission_paused, before, gate.state)
        return work

    def carry_out(
        self, effect: effects.Effect | PlaceFence | CheckStart, now_ns: int
    ) -> list[Work]:
        """What the gate decided, put into practice."""
        match effect:
            case effects.SendSetpoint(permit):
                assert self.telemetry is not None
                made = setpoint if permit.attitude is None else attitude_target
                message = made(self.telemetry, permit, self._start_ns, now_ns)
                self.telemetry.count_setpoint(now_ns)
                if permit.pos_ned is None:
                    return [Send(message)]  # a velocity or an attitude: there is no place to draw
                sent = SetpointItem(self.telemetry.sysid, permit.pos_ned, permit.yaw_rad)
                return [Send(message), Record(sent)]
            case effects.SendCommand():
                assert self.telemetry is not None
                self._reasons.asked(effect.kind, now_ns)
                asked = self._ask_for_control(now_ns)
                return asked + self._commands.send(effect, self.telemetry, now_ns)
            case effects.CancelCommand(request_id, kind):
                return self._commands.cancel(request_id, kind, now_ns)
            case PlaceFence():
                return self._port.place_fence(self.telemetry)
            case CheckStart():
                self._port.check_start(effect)
                return []
            case effects.Outcome():
                self._orbits.ended(effect.request_id)
                return [effect]
            case effects.StreamVerdict():
                return [effect]
            case effects.Verdict():
                self._orbits.decided(effect, self.gate, self._port.policy, now_ns)
                return self._port.tell(effect, self.sysid)
            case _:
                return self._port.tell(effect, self.sysid)

    def hold_without_gate(self, now_ns: int) -> list[Work]:
        """The last resort: HOLD, past a gate that may be broken, where control was ours.

        A return or a landing goes on: it is the safer state.
        """
        comes_down = self.gate.state in (State.RETURNING, State.LANDING)
        if self.telemetry is None or self.gate.control is Control.NONE or comes_down:
            return []
        hold = effects.SendCommand(0, CommandKind.HOLD, now_ns)
        return self._commands.send(hold, self.telemetry, now_ns)


def _accuracy(telemetry: Telemetry) -> list[Work]:
    """How near to a goal is there, as far as the vehicle tells; where that is news to the gate."""
    health, acceptance_m = telemetry.health, telemetry.acceptance_m
    seen = inputs.AccuracySeen(health.accuracy_h_m, acceptance_m)
    if seen == telemetry.accuracy_told:
        return []
    telemetry.accuracy_told = seen
    return [ToGate(seen)]
