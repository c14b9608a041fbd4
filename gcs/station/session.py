"""The composition: everything that reaches the station, and everything that leaves it.

`handle(input, now_ns) -> effects`; no socket, no clock, no file.  Bytes become frames (`links.py`),
frames what the vehicle reports (`vehicle.py`), that becomes inputs of its gate (`gate_port.py`),
what the gate decides becomes commands and setpoints; and all of it becomes the record.
"""

from __future__ import annotations

from typing import assert_never

from gcs import ipc
from gcs.bridge.effects import (
    AboutVehicle,
    AsksForStreams,
    AsksPlan,
    AsksVehicle,
    ChangesRallyPoints,
    ClientRefused,
    ClientRequest,
    ForwardToLink,
    ForwardToVehicle,
    Joined,
    LogLine,
    Lost,
    Reply,
    StopsPlan,
)
from gcs.exit_codes import ExitCode
from gcs.gate import effects as gate_effects
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind, Level
from gcs.gate.inputs import PositionSeen, Requested, Tick
from gcs.gate.machine.gate import Gate
from gcs.gate.requests import EndStream
from gcs.protocol.effects import Address, Send
from gcs.session import announcements
from gcs.session.effects import Effect, Emit, Finish
from gcs.session.inputs import (
    ClientCame,
    ClientFlooded,
    ClientGone,
    Datagram,
    DiskLow,
    FileRead,
    FileWritten,
    Input,
    LinkEvent,
    OperatorGone,
    OperatorJoined,
    OperatorLine,
    OperatorNoise,
    OtherInput,
    RecorderChanged,
    RecorderGrew,
    RuleSaid,
    SignalCame,
    SimGone,
    SimLine,
    Wake,
)
from gcs.session.requests import FIRST
from gcs.session.setup import Setup
from gcs.session.speedup_waits import Times
from gcs.session.work import (
    STATION,
    AskGate,
    AskMission,
    AskOrbit,
    AskReader,
    AskSpeed,
    CheckStart,
    EndSession,
    ForOwner,
    GateInput,
    GiveVerdict,
    Log,
    OrbitSample,
    PlaceFence,
    SecondDue,
    SnapshotDue,
    StopTransfer,
    StreamOver,
    TellOperator,
    ToScreens,
    Work,
    condition,
)
from gcs.station.bridge_port import BridgePort
from gcs.station.ending import Ending
from gcs.station.fleet.separation import Separation
from gcs.station.frame_intake import FramesRaisedError, Incoming
from gcs.station.links import Links
from gcs.station.operator_lines import line
from gcs.station.operators import Operators
from gcs.station.preflight import Itself, before_arming, report
from gcs.station.queue import WorkQueue
from gcs.station.shown import RecordKept, Shown
from gcs.station.signatures import NO_KEYS, Keys, Signatures
from gcs.station.ticks import Ticks
from gcs.station.vehicles import FIRST as FIRST_SLOT
from gcs.station.vehicles import Vehicles
from gcs.station.waiting_for_vehicle import WaitingForVehicle
from gcs.vehicle.record_items import fault, introduction, recorded, sim_line
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.vehicle import Vehicle
from gcs.wire.messages import ParamSet

OTHER_STATION_NS = 5_000_000_000
"""How long after its last frame a station with our id still counts as there."""

NODE = "link"
MAX_FAULTS = 10
SNAPSHOTS_A_LOOK = 5
"""Whoever started a bridge only looks: alone, it is shown one snapshot of so many, two a second."""


class Session:
    """Any number of operators, links and vehicles; from the first byte to `Finish`."""

    def __init__(self, setup: Setup, now_ns: int, keys: Keys = NO_KEYS) -> None:
        """`keys` are no part of the set-up, which is recorded."""
        config = setup.config
        self._setup = setup
        self._start_ns = now_ns
        self._times = Times(config.speedup)
        self._ticks = Ticks(now_ns, self._times)
        count, streams, waiting = len(setup.endpoints), setup.streams, setup.waiting
        self._signatures = Signatures(
            keys,
            config.sysid,
            config.compid,
            count,
            unsigned_taken=setup.policy.signing.unsigned == "warn",
            since_ns=now_ns,
        )
        self._links = Links(config.sysid, config.compid, count, streams, waiting, self._signatures)
        self._vehicles = Vehicles(config, setup.policy, self._times, now_ns)
        self._separation = Separation(setup.policy.separation)
        self._operators = Operators(setup, self._times)
        self._bridge = BridgePort(
            config,
            setup.endpoints,
            setup.policy,
            self._times,
            self._vehicles,
            self._separation,
            self._operators,
            self._links,
        )
        self._deadline_ns: int | None = None
        """As it was last looked up; None once something may have changed it."""
        self._parts_ns: int | None = None
        """The same without ticks."""
        self._queue = WorkQueue(self._step)
        self._incoming = Incoming(
            Address(config.sysid, config.compid),
            count,
            self._links,
            self._signatures,
            self._queue,
            self._vehicles,
            self._operators,
            self._bridge,
        )
        self._ending = Ending(setup, self._times, self._vehicles, self._operators)
        self._waiting = WaitingForVehicle(
            setup, self._times, self._vehicles, self._signatures, now_ns
        )
        self._record = RecordKept(setup.log_path)
        self._shown = Shown(setup, self._vehicles, self._operators, self._record)
        self._snapshots = 0
        """That were due."""
        self._faults = 0
        self._frames_raised = 0
        """Frames of a run that have raised, of which `fault` was not told yet."""
        self._introduced = False
        self._unfinished: Input | None = None
        """The input that is being handled: none of its effects has left yet."""

    @property
    def deadline_ns(self) -> int:
        """When `Wake` is due; no side effects."""
        if self._deadline_ns is None:
            parts_ns, port = self._vehicles.deadline_ns, self._bridge
            if port.open and (client_ns := port.bridge.deadline_ns) is not None:
                parts_ns = client_ns if parts_ns is None else min(parts_ns, client_ns)
            self._parts_ns = parts_ns
            tick_ns = self._ticks.next_ns
            self._deadline_ns = tick_ns if parts_ns is None else min(tick_ns, parts_ns)
        return self._deadline_ns

    def _waited(self, now_ns: int) -> bool:
        """Whether some part's wait is over, or a job goes on: at most ticks none does."""
        if self.deadline_ns <= now_ns and self._parts_ns is not None and self._parts_ns <= now_ns:
            return True
        return any(vehicle.plan_transfer for vehicle in self._vehicles)

    @property
    def gate(self) -> Gate:
        """The first vehicle's; to look at, not to handle."""
        return self._vehicles.first.gate

    @property
    def nothing_heard(self) -> bool:
        """No vehicle was heard, and none of our own was started: there is nothing to keep."""
        return self._vehicles.first.telemetry is None and self._setup.config.sim is None

    @property
    def telemetry(self) -> Telemetry | None:
        """The first vehicle as it reports itself, None before one is heard."""
        return self._vehicles.first.telemetry

    @property
    def vehicles(self) -> Vehicles:
        """To look at, not to handle."""
        return self._vehicles

    def handle(self, given: Input, now_ns: int) -> list[Effect]:
        """Everything that follows from `given` at `now_ns`, in order.

        Raises FramesRaisedError where single frames of a run have raised, with all the rest."""
        queue = self._queue
        self._unfinished = given
        if not self._introduced:
            self._introduced = True
            begin = [*introduction(self._setup, self._start_ns), *self._remind()]
            queue.run(begin, now_ns)
        if isinstance(given, Datagram):
            if not self._incoming.datagram(given, now_ns) and not self._ending.under_way:
                self._unfinished = None
                return queue.take()
        else:
            queue.run([*recorded(given), *self._begin(given, now_ns)], now_ns)
        if self._bridge.open:
            queue.run([*self._bridge.control(self._operators.in_control, now_ns)], now_ns)
        queue.run(self._ending.if_due(self._record.path, now_ns), now_ns)
        self._unfinished = self._deadline_ns = None
        if self._incoming.dropped:
            dropped = self._incoming.take_dropped()
            self._frames_raised = len(dropped)
            raise FramesRaisedError(queue.take(), dropped)
        return queue.take()

    def fault(self, given: Input, report: str, now_ns: int) -> list[Effect]:
        """Handling `given` raised an exception, which is a bug of ours: keep the vehicle safe.

        Bytes or words that we cannot take are dropped, logged and recorded.  Where it happens on
        the clock, or again and again, the vehicle is told to hold and the station ends.  An
        operator who has joined loses the connection instead: nobody's words end the station, and
        no MAVLink client's either.
        """
        self._queue.drop()
        self._incoming.take_dropped()
        self._deadline_ns = None
        handled, self._unfinished = self._unfinished is None, None
        if self._frames_raised:
            handled, self._frames_raised = False, self._frames_raised - 1
        visitor = isinstance(given, OperatorJoined | OperatorLine) and given.operator != FIRST
        of_client = isinstance(given, Datagram) and self._incoming.of_client(given)
        self._faults += not (visitor or of_client)
        text = f"internal error: {report.splitlines()[-1]}"
        work: list[Work] = [
            fault(given, report, handled, now_ns),
            Log(Level.FATAL, NODE, text),
        ]
        if isinstance(given, OperatorJoined | OperatorLine) and visitor:
            bye = ipc.Bye(ExitCode.BUG, "", "an internal error of the station", goes_on=True)
            work.append(Emit(bye, given.operator))
        if isinstance(given, Wake) or self._faults > MAX_FAULTS:
            self._ending.finished = True
            work += self._vehicles.each(
                lambda each: [w for w in each.hold_without_gate(now_ns) if isinstance(w, Send)]
            )
            work.append(Finish(ExitCode.BUG, "an internal error: the vehicle was told to hold"))
        self._queue.run(work, now_ns)
        return self._queue.take()

    # ----------------------------------------------------------------------------- the work

    def _begin(self, given: OtherInput, now_ns: int) -> list[Work]:
        """What an input means first; `_step` does the rest."""
        match given:
            case Wake():
                if not self._waited(now_ns):
                    return self._ticks.wake(now_ns)
                of_clients = self._bridge.bridge.wake(now_ns) if self._bridge.open else ()
                of_vehicles = self._vehicles.each(lambda each: each.wake(now_ns))
                return [*of_clients, *of_vehicles, *self._ticks.wake(now_ns)]
            case OperatorJoined():
                return self._shown.welcome(given, now_ns)
            case OperatorLine(operator, ipc.Show(sysid)):
                return self._shown.show(operator, sysid, now_ns)
            case OperatorLine(operator, ipc.Preflight() as asked):
                return [Emit(self._preflight(asked, now_ns), operator)]
            case OperatorLine(operator, command):
                bridge = self._bridge.bridge if self._bridge.open else None
                parts = self._operators, self._vehicles, self._separation, bridge
                return [line(*parts, operator, command, now_ns)]
            case OperatorNoise(operator, text):
                return [Emit(ipc.Trouble(f"not a command: {text}"), operator)]
            case OperatorGone(operator, reason):
                return self._operators.lost(operator, reason)
            case SignalCame(name):
                return self._operators.signalled(name)
            case LinkEvent(_, text, trouble):
                return [Log(Level.WARNING if trouble else Level.INFO, NODE, text)]
            case ClientCame(link, name, stream, verified, named):
                self._links.open(link, stream)
                bridge = self._bridge.bridge
                return [*bridge.came(link, name, verified=verified, named=named is True)]
            case ClientGone(link, reason):
                self._links.close(link)
                self._signatures.forget(link)
                return [*self._bridge.bridge.gone(link, reason)]
            case ClientFlooded(link, dropped):
                return [*self._bridge.bridge.flooded(link, dropped)]
            case FileRead() | FileWritten():
                return self._vehicles.each(lambda each: each.file(given, now_ns))
            case RuleSaid():
                return self._vehicles.each(lambda each: each.rule_said(given))
            case RecorderChanged():
                return self._record.changed(given)
            case RecorderGrew():
                self._record.grew(given)
                return []
            case DiskLow():
                return [self._record.disk_low(given)]
            case SimLine(text):
                return [sim_line(text, now_ns)]
            case SimGone(exit_code):
                return self._sim_gone(exit_code)
        assert_never(given)

    def _step(self, item: Work, owner: int, now_ns: int) -> list[Work]:
        """Hand one item of work to the part that it is for; `owner` is whose it is."""
        vehicle = self._vehicles.of_owner(owner)
        match item:
            case GateInput(Tick()) if owner == STATION:
                in_control = self._operators.control.in_control
                orbits = self._vehicles.orbit_samples(in_control, now_ns)
                return [*orbits, *self._vehicles.to_all(item)]
            case GateInput() if owner == STATION:
                return self._vehicles.to_all(item)
            case GateInput(given) if type(given) is PositionSeen:  # nearly all of them
                work = vehicle.ask_gate(given, now_ns)
                if len(self._vehicles) > 1:
                    work += self._separation.moved(self._vehicles, owner, now_ns)
                return work
            case GateInput(Requested(request_id, _, request)) if (
                refusal := self._separation.why_not(
                    self._vehicles, owner, request_id, request, now_ns
                )
            ):
                vehicle.orbits.refused(request_id)
                return self._operators.refuse_goal(request_id, refusal)
            case GateInput(given):
                if not self._bridge.open:
                    return vehicle.ask_gate(given, now_ns)
                answered = self._bridge.before_gate(given, vehicle.sysid, now_ns)
                return [*answered, *vehicle.ask_gate(given, now_ns)]
            case Send(message):
                telemetry = vehicle.telemetry
                if telemetry is None:
                    return []
                if isinstance(message, ParamSet) and self._bridge.open:
                    self._bridge.station_writes(message, telemetry, now_ns)
                return [*self._links.send(telemetry.link, message, now_ns)]
            case gate_effects.Outcome():
                # Whoever waits for an end looks at the vehicle next: not at how it was before.
                ended = self._operators.outcome(item, vehicle.sysid, now_ns)
                return [*self._shown.to_each_screen(now_ns), *ended]
            case gate_effects.StreamVerdict():
                return self._operators.stream_verdict(item, vehicle.sysid, now_ns)
            case gate_effects.SendCommand(kind=CommandKind.ARM) if self._bridge.open:
                self._bridge.bridge.armings.sent(vehicle.sysid, now_ns)
                return vehicle.carry_out(item, now_ns)
            case (
                gate_effects.SendSetpoint()
                | gate_effects.SendCommand()
                | gate_effects.CancelCommand()
                | gate_effects.SwitchedFence()
                | gate_effects.Verdict()
                | gate_effects.Transition()
                | gate_effects.Say()
                | PlaceFence()
                | CheckStart()
            ):
                return vehicle.carry_out(item, now_ns)
            case Log():
                prefix = self._vehicles.prefix(owner)
                told = announcements.log(item, now_ns, prefix)
                self._shown.logged(item, now_ns, prefix)
                if self._bridge.open:
                    return [*told, *self._bridge.logged(item, vehicle, now_ns)]
                return [*told]
            case AskGate(request_id, request):
                return self._operators.ask_gate(request_id, request)
            case AskMission():
                return vehicle.ask_mission(item, now_ns)
            case AskReader():
                return vehicle.readers.ask(item, vehicle.telemetry, vehicle.port.policy, now_ns)
            case AskOrbit():
                return vehicle.ask_orbit(item, now_ns)
            case AskSpeed():
                return vehicle.ask_speed(item)
            case OrbitSample(operator, sample):
                if sample is None:
                    return self._operators.end_stream(operator, vehicle.sysid)
                # A sample needs no autopilot's words.
                refusal = vehicle.refusal(now_ns)
                return self._operators.line(operator, sample, None, refusal, now_ns)
            case StopTransfer(request_id):
                return self._vehicles.each(
                    lambda each: [*each.missions.stop(request_id), *each.readers.stop(request_id)]
                )
            case StreamOver(sysid, request_id):
                slot = self._vehicles.slot_of(sysid)
                end = AskGate(request_id, EndStream())
                return [ForOwner(FIRST_SLOT if slot is None else slot, (end,))]
            case GiveVerdict():
                return self._operators.verdict(item, vehicle.sysid, now_ns)
            case TellOperator():
                return self._operators.tell(item)
            case ToScreens(event):
                return [*self._shown.to_screens(event, owner)]
            case EndSession(reason):
                # After it, as the lost operators' requests end there.
                held = self._bridge.bridge.leave()
                return [ForOwner(STATION, (*self._ending.begin(reason, now_ns), *held))]
            case SecondDue():
                return self._every_second(now_ns)
            case SnapshotDue():
                drawn = self._vehicles.each(lambda each: each.drawn())
                left_out = self._setup.config.bridge and self._operators.first_is_alone
                self._snapshots += 1
                if left_out and self._snapshots % SNAPSHOTS_A_LOOK != 1:
                    return drawn
                return [*self._shown.ten_times_a_second(now_ns), *drawn]
            case (
                Joined()
                | Lost()
                | ClientRequest()
                | ClientRefused()
                | AsksPlan()
                | StopsPlan()
                | LogLine()
                | Emit()
            ):
                return self._bridge.as_operator(item, vehicle, now_ns)
            case AboutVehicle(sysid, effects):
                slot = self._vehicles.slot_of(sysid)
                return [ForOwner(FIRST_SLOT if slot is None else slot, effects)]
            case ChangesRallyPoints() if owner == STATION:
                return self._vehicles.each(lambda each: each.rally_points_change(now_ns))
            case ChangesRallyPoints():
                return vehicle.rally_points_change(now_ns)
            case AsksForStreams() if owner == STATION:
                return self._vehicles.to_all(item)
            case AsksForStreams(msgids):
                return vehicle.ask_for_streams(msgids, now_ns)
            case ForwardToVehicle() | AsksVehicle() | ForwardToLink() | Reply():
                links = self._vehicles.links if owner == STATION else vehicle.links
                return [*self._bridge.pass_on(item, links, now_ns)]
            case _:
                raise AssertionError(f"the queue keeps {item} for itself")

    # ------------------------------------------------------------------------------ time

    def _every_second(self, now_ns: int) -> list[Work]:
        """Heartbeat, what is missing, and the slow half of the record."""
        first = self._vehicles.first
        work: list[Work] = [*self._links.heartbeat(now_ns), *self._remind()]
        if self._bridge.open:
            work += self._bridge.second(now_ns, self._links.counts, self._signatures)
        elif len(self._vehicles) > 1:
            work.append(self._bridge.status(now_ns, self._links.counts))
        work += self._signatures.second(now_ns)
        work += self._operators.second(now_ns)
        for sysid, stop in self._operators.unwatched(now_ns):
            work.append(ForOwner(self._vehicles.owner_for(sysid), tuple(stop)))
        if first.telemetry is None:
            return work + self._waiting.second(now_ns)
        if now_ns - self._incoming.other_station_ns > self._times.real_ns(OTHER_STATION_NS):
            work.append(condition(Condition.OTHER_STATION, False, "it is gone"))
        if self._setup.policy.arming.preflight == "no_fail":
            itself = self._itself(now_ns)
            work += self._vehicles.each(lambda each: before_arming(each, itself))
        work += self._vehicles.each(lambda each: each.second(now_ns))
        return [*work, *self._vehicles.each(lambda each: self._ask_for_messages(each, now_ns))]

    def _ask_for_messages(self, vehicle: Vehicle, now_ns: int) -> list[Work]:
        if vehicle.telemetry is None:
            return []
        first = vehicle is self._vehicles.first
        wanted = self._operators.missing_messages(vehicle.telemetry, now_ns, first=first)
        return vehicle.send_own(wanted, now_ns)

    def _remind(self) -> list[Work]:
        return self._vehicles.each(lambda each: each.remind())

    # ------------------------------------------------------------------------- preflight

    def _preflight(self, asked: ipc.Preflight, now_ns: int) -> ipc.PreflightReport:
        owner = self._vehicles.owner_for(asked.vehicle)
        refusal = self._vehicles.refusal(owner, now_ns) if owner == STATION else None
        return report(asked, self._vehicles.of_owner(owner), refusal, self._itself(now_ns))

    def _itself(self, now_ns: int) -> Itself:
        return Itself(
            now_ns,
            self._record.on,
            self._record.path,
            self._record.free_bytes,
            self._setup.policy.arm_requires_recording,
        )

    def _sim_gone(self, exit_code: int) -> list[Work]:
        """Before it was heard, there is nothing to wait for; later, its silence tells."""
        text = f"the vehicle's process ended by itself with exit code {exit_code}"
        log = Log(Level.ERROR, NODE, text)
        if self._vehicles.first.telemetry is not None:
            return [log]
        hint = "the lines from `sim` in the log tell why"
        return [
            log,
            Emit(ipc.Trouble(text, hint, ExitCode.NO_VEHICLE)),
            *self._ending.finish(ExitCode.NO_VEHICLE, text),
        ]
