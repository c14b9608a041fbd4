"""One vehicle's MAVLink side, composed: what comes in on a channel, and what time brings.

A *channel* is one peer on one link, and has its own stream rates.  Messages for other systems or
components are not for us; target 0 is for everybody.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from vehicle_sim.autopilot.interface import (
    CommandDone,
    CommandSent,
    HomeChanged,
    ImageCaptured,
    MissionReached,
    Result,
    StatusText,
    Vehicle,
    VehicleEvent,
)
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.effects import Client, Effect, Note, Report, Send
from vehicle_sim.flight_log.log_directory import LogDirectory
from vehicle_sim.flight_log.recorder import Recorder
from vehicle_sim.services import param_pack
from vehicle_sim.services.clocks import ping, timesync
from vehicle_sim.services.commands.commands import Commands
from vehicle_sim.services.commands.operator_control import OperatorControl, with_operator_control
from vehicle_sim.services.commands.ports import CommandContext
from vehicle_sim.services.events.events import EventServer
from vehicle_sim.services.events.metadata import metadata_of
from vehicle_sim.services.ftp.ftp import FtpServer
from vehicle_sim.services.logs import LogServer
from vehicle_sim.services.manual import manual_input
from vehicle_sim.services.missions.mission import MissionServer
from vehicle_sim.services.parameters import ParameterServer
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.setpoints import (
    BadSetpointError,
    attitude_setpoint,
    global_setpoint,
    local_setpoint,
)
from vehicle_sim.services.stream_sets import Change, LinkMode, StreamSets, unasked
from vehicle_sim.services.streams import NEVER, Streams
from vehicle_sim.services.telemetry.info import Info
from vehicle_sim.services.telemetry.telemetry import heartbeat
from vehicle_sim.services.texts import in_chunks, status_text
from vehicle_sim.storage.store import MemoryStore, Store
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

COMPONENT: Final = 1
GROUND_STATION: Final = 6  # MAV_TYPE_GCS
ACK_OF_SET_MODE: Final = 11  # ArduPilot acks SET_MODE under the message's own number
PX4_STORAGE: Final = "/fs/microsd"
"""What stands before a log's path on a board's card; a simulation's log is told without it."""
REACHED_EVERY_NS: Final = 100_000_000
REFUSAL_NOTED_EVERY_NS: Final = 1_000_000_000

LEVELS: Final = ("fatal", "fatal", "error", "error", "warning", "info", "info", "debug")
"""By MAV_SEVERITY."""


class VehicleServer:
    """All services of one vehicle.  Pure; wall time comes in with every call."""

    def __init__(
        self,
        vehicle: Vehicle,
        profile: Profile,
        parameters: Parameters,
        system: int,
        speedup: Fraction = Fraction(1),
        unix_start_ns: int = 0,
        store: Store | None = None,
        logging: bool = True,
        phase_ns: int = 0,
        stream_sets: StreamSets | None = None,
        operator_control: bool = False,
    ) -> None:
        """`store` holds the vehicle's files; `logging`: flights are logged in it; `phase_ns`
        shifts the times of its streams; `stream_sets`: what is sent unasked, if not the usual;
        `operator_control`: one station at a time commands."""
        self.vehicle: Final = vehicle
        self.store: Final = store if store is not None else MemoryStore()
        self.system = system
        self._operator_control = OperatorControl() if operator_control else None
        if operator_control:
            profile = with_operator_control(profile)
        self._profile = profile
        self._speedup = speedup
        self._phase_ns = phase_ns
        self._stream_sets = stream_sets if stream_sets is not None else unasked(profile)
        self._missions = MissionServer(vehicle, profile)
        self._given = parameters
        self._parameters = ParameterServer(parameters, profile)
        metadata = metadata_of(profile.name) if profile.component_metadata else None
        # Where nobody is told how far they have come, there are no events.
        counted = m.IDS[m.CurrentEventSequence] in self._stream_sets.by_mode[LinkMode.NORMAL]
        self._events = EventServer(vehicle, parameters, profile.events and counted)
        control = self._operator_control
        self._info = Info(
            vehicle,
            profile,
            system,
            unix_start_ns,
            self._missions.plan_ids,
            metadata,
            self._events.current_sequence if self._events.on else None,
            control.status if control is not None else None,
        )
        packed = {param_pack.PATH: param_pack.param_pack(parameters)}
        self._ftp = FtpServer(self.store, metadata.files if metadata is not None else packed)
        self._recorder = Recorder(
            vehicle,
            parameters,
            LogDirectory(self.store, profile.name),
            (system, profile.flight_sw_version),
            unix_start_ns,
            logging,
        )
        self._logs = LogServer(vehicle, profile, self._recorder)
        self._streams: dict[int, Streams] = {}
        self._commands = Commands(
            CommandContext(
                vehicle,
                profile,
                self._info,
                self._streams,
                control.asked if control is not None else None,
            )
        )
        self._clock_ns = vehicle.clock_ns
        self._due_ns = NEVER
        self.deadline_ns = NEVER
        """In wall time: what the other side's silence brings."""
        self.touched = True  # since the last step: something may have changed
        self._seen = self._look()
        self._reached: list[tuple[int, int]] = []  # (due in vehicle's time, seq)
        self._noted_ns = -REFUSAL_NOTED_EVERY_NS
        self._clock_ns = 0  # it goes back with a reboot

    @property
    def unsigned_allowed(self) -> frozenset[int]:
        return self._profile.unsigned_allowed

    @property
    def mode_name(self) -> str:
        return self._info.mode_name

    def heartbeat(self) -> m.Heartbeat:
        return heartbeat(self.vehicle, self._profile)

    # ---------------------------------------------------------------------------- channels

    def open(self, channel: int, mode: LinkMode = LinkMode.NORMAL) -> list[Effect]:
        """A peer that was not there before: it is told at once who and where we are."""
        self._streams[channel] = Streams(
            self._profile,
            self._stream_sets.by_mode[mode],
            self._info.streamable,
            self._speedup,
            self.vehicle.time_ns,
            self._phase_ns,
            groups=self._stream_sets.groups,
        )
        for name, stream in self._profile.rate_parameters.items():
            rate_hz = int(self._given.get(name))
            if rate_hz:
                asked = m.RequestDataStream(rate_hz, 0, 0, stream, 1)
                self._streams[channel].request(asked, self.vehicle.time_ns)
        self.touched = True
        self._schedule()
        built = (self._info.build(m.IDS[kind]) for kind in self._stream_sets.greeting)
        return [Send(channel, message) for message in built if message is not None]

    def close(self, channel: int) -> None:
        self._streams.pop(channel, None)
        self.touched = True
        self._commands.forget(channel)
        self._missions.forget(channel)
        self._parameters.forget(channel)
        self._logs.forget(channel)
        self._ftp.forget(channel)
        self._schedule()

    # --------------------------------------------------------------------------- messages

    def handle(
        self, client: Client, sequence: int, message: m.Message, wall_ns: int
    ) -> list[Effect]:
        """One message from a client."""
        if not self._is_for_us(message) or not self._obeys(client):
            return []
        self.touched = True
        self.vehicle.wall(wall_ns)
        control = self._operator_control
        if control is None or control.admits(client, self.system, message):
            effects = self._dispatch(client, sequence, message, wall_ns)
        else:
            effects = self._not_in_control(client, message)
        self._schedule()
        return effects

    def _not_in_control(self, client: Client, message: m.Message) -> list[Effect]:
        """Commands are refused; what is no command is not answered."""
        if isinstance(message, m.CommandLong | m.CommandInt):
            return self._commands.refuse(client, message.command, Result.NOT_IN_CONTROL)
        return []

    def _obeys(self, client: Client) -> bool:
        """ArduPilot's SYSID_ENFORCE: nobody but its own ground station is heard."""
        own = self._given.rules.own_station
        if own is None or self._given.get("SYSID_ENFORCE") == 0:
            return True
        return client.system in (self.system, int(self._given.get(own)))

    def _counts(self, client: Client) -> bool:
        """Whose heartbeats keep the station's failsafe away: ArduPilot's own station's alone."""
        own = self._given.rules.own_station
        return own is None or client.system == int(self._given.get(own))

    def _is_for_us(self, message: m.Message) -> bool:
        system = getattr(message, "target_system", 0)
        component = getattr(message, "target_component", 0)
        if isinstance(message, (m.Ping, m.Timesync)):
            return system in (0, self.system)
        if isinstance(message, (m.CommandLong, m.CommandInt)):
            # Both answer for components that are not there.
            return system == self.system or (system == 0 and component in (0, COMPONENT))
        return system in (0, self.system) and component in (0, COMPONENT)

    def _dispatch(
        self, client: Client, sequence: int, message: m.Message, wall_ns: int
    ) -> list[Effect]:
        match message:
            case m.Heartbeat():
                if message.type == GROUND_STATION and self._counts(client):
                    self.vehicle.gcs_heard(wall_ns)
                    self._events.station_heard(wall_ns)
                return []
            case m.CommandLong() | m.CommandInt():
                other = message.target_component not in (0, COMPONENT)
                if other and self._profile.refuses_other_components:
                    return self._commands.refuse(client, message.command)
                effects = self._commands.handle(client, sequence, message, wall_ns)
                if message.command == Cmd.RUN_PREARM_CHECKS:
                    effects += self._events.check(wall_ns)
                return effects
            case (
                m.SetPositionTargetLocalNed()
                | m.SetPositionTargetGlobalInt()
                | m.SetAttitudeTarget()
            ):
                return self._setpoint(client, message, wall_ns)
            case (
                m.ManualControl()
                | m.RcChannelsOverride()
                | m.FollowTarget()
                | m.GlobalPositionInt()
            ):
                manual_input(self.vehicle, self._given, self.system, client, message, wall_ns)
                return []
            case m.CommandAck():
                if message.target_system == self.system:
                    self.vehicle.command_acked(
                        message.command, message.result, message.progress, message.result_param2
                    )
                return []
            case m.SetMode():
                return self._set_mode(client, message)
            case m.MissionCount() | m.MissionWritePartialList():
                return self._missions.count(client, message, wall_ns, sequence)
            case m.MissionItemInt() | m.MissionItem():
                return self._missions.item(client, message, wall_ns)
            case m.MissionAck():
                return self._missions.answered(client, message, wall_ns)
            case m.MissionRequestList():
                return self._missions.request_list(client, message)
            case m.MissionRequest() | m.MissionRequestInt():
                return self._missions.request(client, message)
            case m.MissionClearAll():
                return self._missions.clear(client, message)
            case m.MissionSetCurrent():
                refused = self._missions.set_current(client, message)
                current = self._info.mission_current()
                return refused or ([] if current is None else [Send(None, current)])
            case m.ParamRequestList():
                banner = self._profile.banner
                texts = [Send(None, status_text(self._profile, 6, text)) for text in banner]
                return [*texts, *self._parameters.request_list(client, wall_ns)]
            case m.ParamRequestRead():
                return self._parameters.read(client, message)
            case m.ParamSet():
                return self._parameters.set(client, message, wall_ns)
            case m.FileTransferProtocol():
                return self._ftp.handle(client, message, wall_ns)
            case m.LogRequestList() | m.LogRequestData() | m.LogErase() | m.LogRequestEnd():
                return self._logs.handle(client, message, wall_ns)
            case m.RequestDataStream():
                self._streams[client.channel].request(message, self.vehicle.time_ns)
                return []
            case m.RequestEvent():
                return self._events.request(client, message)
            case m.Timesync():
                return [*timesync(client, message, self.vehicle.clock_ns)]
            case m.Ping():
                return [*ping(client, message)]
            case _:
                # What vehicles say to each other and to ground stations.
                return []

    def _setpoint(
        self,
        client: Client,
        asked: m.SetPositionTargetLocalNed | m.SetPositionTargetGlobalInt | m.SetAttitudeTarget,
        wall_ns: int,
    ) -> list[Effect]:
        try:
            match asked:
                case m.SetAttitudeTarget():
                    self.vehicle.set_attitude(attitude_setpoint(asked))
                case m.SetPositionTargetLocalNed():
                    self.vehicle.set_setpoint(local_setpoint(self.vehicle, self._profile, asked))
                case m.SetPositionTargetGlobalInt():
                    self.vehicle.set_setpoint(global_setpoint(self.vehicle, self._profile, asked))
        except BadSetpointError as refusal:
            if wall_ns - self._noted_ns < REFUSAL_NOTED_EVERY_NS:
                return []
            self._noted_ns = wall_ns
            return [Note("warning", f"setpoint of {client.system} refused: {refusal}")]
        self._events.setpoint_heard(wall_ns)
        return []

    def _set_mode(self, client: Client, asked: m.SetMode) -> list[Effect]:
        result = self.vehicle.set_mode(asked.base_mode, asked.custom_mode)
        if not self._profile.acks_set_mode:
            return []
        ack = m.CommandAck(
            ACK_OF_SET_MODE,
            result,
            target_system=client.system,
            target_component=client.component,
        )
        return [Send(client.channel, ack)]

    # ------------------------------------------------------------------------------- time

    @property
    def stream_due_ns(self) -> int:
        """In the vehicle's own time: when something is to be said, or to be recorded, unasked."""
        reached_ns = self._reached[0][0] if self._reached else NEVER
        return min(self._due_ns, self._recorder.due_ns, reached_ns)

    def step(self, wall_ns: int) -> list[Effect]:
        """After a step of the engine: the vehicle decides, and says what there is to say.

        Wanted after the vehicle's `due_step`, at `stream_due_ns` and `deadline_ns`, and where the
        server was `touched`; at any other step it does nothing.
        """
        self.touched = False
        vehicle = self.vehicle
        vehicle.wall(wall_ns)
        vehicle.live()
        events = vehicle.events()
        now_ns, clock_ns = vehicle.time_ns, vehicle.clock_ns
        effects = self._recorder.step(events)
        opened = self._recorder.opened()
        if opened is not None and self._profile.tells_log_path:
            events.append(StatusText(6, f"[logger] .{opened.removeprefix(PX4_STORAGE)}"))
        for event in events:
            effects += self._event(event)
        if self._reached and now_ns >= self._reached[0][0]:
            effects.append(Send(None, m.MissionItemReached(self._reached.pop(0)[1])))
        effects += self._changes()
        if clock_ns < self._clock_ns:
            self.system = self._info.system = int(self._given.si(Quantity.SYSTEM_ID))
            self._events.restart()
        effects += self._events.step(wall_ns)
        self._clock_ns = clock_ns
        if wall_ns >= self.deadline_ns:
            effects += self._missions.tick(wall_ns)
            effects += self._parameters.tick(wall_ns)
            effects += self._logs.tick(wall_ns)
            effects += self._ftp.tick(wall_ns)
            self._schedule()
        if now_ns >= self._due_ns:
            effects += self._stream(now_ns)
        return effects

    def _stream(self, now_ns: int) -> list[Effect]:
        effects: list[Effect] = []
        next_ns = NEVER
        built: dict[int, m.Message | None] = {}
        rows: dict[tuple[int, ...], list[m.Message]] = {}
        for channel, streams in self._streams.items():
            numbers = streams.due(now_ns)
            if numbers:
                row = rows.get(numbers)
                if row is None:
                    row = rows[numbers] = self._row(numbers, built)
                effects.append(Report(channel, row))
            next_ns = min(next_ns, streams.next_ns)
        self._due_ns = next_ns
        return effects

    def _row(self, numbers: tuple[int, ...], built: dict[int, m.Message | None]) -> list[m.Message]:
        """Each message is built once, for all channels."""
        for number in numbers:
            if number not in built:
                built[number] = self._info.build(number)
        return [message for number in numbers if (message := built[number]) is not None]

    def _schedule(self) -> None:
        """When time is to bring something next."""
        self._due_ns = min((streams.next_ns for streams in self._streams.values()), default=NEVER)
        self.deadline_ns = min(
            self._missions.deadline_ns,
            self._parameters.deadline_ns,
            self._logs.deadline_ns,
            self._ftp.deadline_ns,
        )

    def _event(self, event: VehicleEvent) -> list[Effect]:
        now_ns = self.vehicle.time_ns
        match event:
            case StatusText():
                return [
                    *(Send(None, each) for each in in_chunks(self._profile, event, now_ns)),
                    *self._events.said(event.text),
                    Note(LEVELS[event.severity], event.text),
                ]
            case ImageCaptured():
                note = Note("info", f"image {event.index} captured")
                return [*(Send(None, image) for image in self._info.captured(event)), note]
            case MissionReached():
                # Every item is told at least once; only of the last one the repeats go on.
                self._reached = [
                    (now_ns + turn * REACHED_EVERY_NS, event.seq)
                    for turn in range(1, self._profile.reached_repeats)
                ]
                reached = Send(None, m.MissionItemReached(event.seq))
                return [reached, Note("info", f"mission item {event.seq} reached")]
            case HomeChanged():
                home = self._info.build(m.IDS[m.HomePosition])
                return [Send(None, home)] if home is not None else []
            case CommandDone():
                return self._commands.done(event)
            case CommandSent(command, p1, system):
                return [Send(None, _command(command, p1, system))]

    def _look(self) -> tuple[bool, int, bool]:
        return (self.vehicle.armed, self.vehicle.custom_mode, self.vehicle.origin is not None)

    def _changes(self) -> list[Effect]:
        """What nobody asked for but everybody wants to know: arming, mode, origin.

        A heartbeat is sent at once, unless the stream sets say otherwise: under speed-up the next
        one is far.
        """
        seen = self._look()
        if seen == self._seen:
            return []
        armed, custom_mode, has_origin = self._seen
        self._seen = seen
        effects: list[Effect] = []
        changed: set[Change] = set()
        if seen[0] != armed:
            changed.add("arming")
            effects.append(Note("info", "armed" if seen[0] else "disarmed"))
        if seen[1] != custom_mode:
            changed.add("mode")
            effects.append(Note("info", f"mode {self._info.mode_name}"))
        if changed & self._stream_sets.beats_at_once:
            beat = self._info.build(m.IDS[m.Heartbeat])
            effects.extend([Send(None, beat)] if beat is not None else [])
        if seen[2] and not has_origin:
            origin = self._info.build(m.IDS[m.GpsGlobalOrigin])
            if origin is not None:
                effects.append(Send(None, origin))
        return effects


def _command(command: int, p1: float, system: int) -> m.CommandLong:
    """Sent on every link; system 0 = for everybody who listens."""
    return m.CommandLong(p1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, command, system, 0, 0)
