"""The bridge of one station, and what it is to know of the vehicle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import msgspec

from gcs import ipc
from gcs.bridge.bridge import Bridge
from gcs.bridge.effects import (
    AsksPlan,
    AsksVehicle,
    BridgeEffect,
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
from gcs.bridge.judge.received import Judged
from gcs.bridge.peers.link_loops import LEFT_OUT_NS, Loops
from gcs.bridge.translate.meaning import Seen
from gcs.config import StationConfig
from gcs.gate.condition import Severity
from gcs.gate.effects import CommandKind, Level
from gcs.gate.inputs import CommandEnded, HeartbeatSeen, Input, LandedSeen, Requested
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.step_context import REFUSED_LINE, REFUSED_STREAM_LINE
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Refusal
from gcs.gate.requests import Arm
from gcs.gate.states import LandedState
from gcs.protocol.effects import Address
from gcs.protocol.enforced_sysid import hears_alone
from gcs.session import announcements
from gcs.session.effects import Effect, Emit, LeaveOutPeer
from gcs.session.speedup_waits import Times
from gcs.session.work import Log, Work
from gcs.station.fleet.separation import Separation
from gcs.station.links import Counts, Links
from gcs.station.operator_lines import line
from gcs.station.operators import Operators
from gcs.station.seen import seen_of
from gcs.station.signatures import Signatures
from gcs.station.vehicles import Vehicles
from gcs.vehicle.missions.missions import timing_of
from gcs.vehicle.missions.return_places import why_not_rally_point
from gcs.vehicle.snapshot import bridge_row, lost_pct
from gcs.vehicle.talk.commands import shown_commands
from gcs.vehicle.talk.discovery import needed_hz
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.vehicle import Vehicle
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Result
from gcs.wire.messages import ParamSet, ParamValue

NODE = "link"
UNASKED = "it was disarmed and is armed now, and no client of this bridge asked for it"


class BridgePort:
    """Between the session and its MAVLink clients.

    Where it is not `open`, nobody asks it or its bridge anything about the vehicles."""

    def __init__(
        self,
        config: StationConfig,
        endpoints: Sequence[str],
        policy: Policy,
        times: Times,
        vehicles: Vehicles,
        separation: Separation,
        operators: Operators,
        links: Links,
    ) -> None:
        rules = policy.bridge
        own = Address(config.sysid, config.compid)
        silent_ns = times.real_ns(round(rules.client_gone_s * 1e9))
        deadman_ns = round(times.policy(policy).stream.deadman_s * 1e9)
        timing = timing_of(times)
        self.bridge = Bridge(own, rules, needed_hz(times), silent_ns, timing, deadman_ns)
        self._vehicles = vehicles
        self._separation = separation
        self._operators = operators
        self._links = links
        self._policy = policy
        self._max_takeoff_up_m = policy.takeoff.max_up_m
        self._stream = policy.stream
        self._endpoints = endpoints
        self.open = config.bridge or bool(config.clients)
        """Whether MAVLink clients can come.  Whether any is there now does not count: what the
        vehicles do meanwhile is kept for whoever comes next."""
        self._before: list[tuple[int, int]] = [(0, 0)] * len(endpoints)
        self._before_ns = 0
        self._told_in_control = 0
        self.loops = Loops(own)

    def from_client(self, link: int, frame: Frame, now_ns: int) -> Judged:
        """A good frame on a client's link."""
        vehicles = self._vehicles.addresses
        look = partial(self._seen, now_ns)
        why_not = partial(self._vehicles.why_not_ours, now_ns=now_ns)
        return self.bridge.from_client(link, frame, vehicles, look, now_ns, why_not)

    def beat(self, frame: Frame, now_ns: int) -> list[Work]:
        """A HEARTBEAT on a vehicle's link: far too many of one autopilot are a loop of links."""
        if Address(frame.sysid, frame.compid) not in self._vehicles.addresses:
            return []
        return [*self.loops.beat(frame.sysid, self.bridge.routes.links, now_ns)]

    def came_back(self, link: int, frame: Frame, now_ns: int) -> list[Work] | None:
        """A frame in the station's own name on a vehicle's link; None where a client's link was not
        sent it."""
        loop = self.loops.came_back(frame, now_ns)
        if loop is None or loop.told:
            return None if loop is None else []
        at, name = loop.client_link, self.bridge.name_of_link(loop.client_link)
        if loop.goes_on:
            self.bridge.routes.close(at)
            text = (
                f"the loop of links goes on: nothing that vehicles say is sent to {name} any more; "
                "take the --client that leads back out of one of them, and start it again"
            )
            return [Log(Level.ERROR, NODE, text)]
        place, _, _ = self._endpoints[link].partition(", receive")
        text = (
            f"a loop of links: what is sent to {name}, a client on link {at}, comes in again on "
            f"link {link} ({place}): two bridges or routers send to one another; take the --client "
            "that leads back out of one of them"
        )
        if link in self._vehicles.links:
            return [Log(Level.ERROR, NODE, text), LeaveOutPeer(link, frame.raw, LEFT_OUT_NS)]
        self.loops.left_out[link] = now_ns
        self._links.wait_for_peer(link)
        left_out = (
            f"link {link} is left out, until it has been silent for {LEFT_OUT_NS / 1e9:.0f} s"
        )
        return [Log(Level.ERROR, NODE, text), Log(Level.INFO, NODE, left_out)]

    def _seen(self, now_ns: int, sysid: int) -> Seen | None:
        """How that vehicle is; None before it is heard."""
        vehicle = self._vehicles.of_sysid(sysid)
        if vehicle is None or vehicle.telemetry is None:
            return None
        seen = seen_of(vehicle.telemetry, vehicle.gate, vehicle.parameters, self._max_takeoff_up_m)
        return replace(
            seen,
            plan_transfer=vehicle.plan_transfer,
            not_on_board=vehicle.not_on_board,
            mission_paused=vehicle.mission_paused,
            stream=self._stream,
            mission_items=vehicle.missions.items,
            land_starts=vehicle.missions.land_starts,
            clears_takeoff=partial(_clears_takeoff, vehicle.gate),
            why_not_rally=partial(why_not_rally_point, self._policy, vehicle.telemetry),
            why_not_resume=partial(vehicle.why_not_resume, now_ns),
            why_not_go_to=vehicle.why_not_go_to,
            hears=vehicle.hears_component,
        )

    def parameter(self, frame: Frame, now_ns: int) -> list[BridgeEffect]:
        """PARAM_VALUE on a vehicle's link: what it says of what clients have written."""
        vehicle = self._vehicles.of_sysid(frame.sysid)
        telemetry = None if vehicle is None else vehicle.telemetry
        if telemetry is None or frame.compid != telemetry.compid:
            return []
        message = decode(frame)
        if not isinstance(message, ParamValue):
            return []
        autopilot = telemetry.autopilot.name
        return self.bridge.parameter(message, autopilot, telemetry.sysid, now_ns)

    def station_writes(self, message: ParamSet, telemetry: Telemetry, now_ns: int) -> None:
        """The station sends a PARAM_SET of its own: its change is nobody else's."""
        autopilot = telemetry.autopilot.name
        self.bridge.written_by_station(message, autopilot, telemetry.sysid, now_ns)

    def before_gate(self, given: Input, sysid: int, now_ns: int) -> list[BridgeEffect]:
        """The vehicle's own answer to a command is what the client is answered, too, or the mode
        that it shows; and what one asks for, the answers to the others are older than."""
        if isinstance(given, Requested):
            if isinstance(given.request, Arm):
                self.bridge.armings.asked(sysid, now_ns)
            return self.bridge.asked(self._operators.operator_of(given.request_id), sysid, now_ns)
        if isinstance(given, HeartbeatSeen):
            done = self._armed_unasked(given, sysid, now_ns)
            if given.armed:
                done += self.bridge.armings.seen(sysid, now_ns)
            self.bridge.armings.shown(given.mode_name, sysid, now_ns, armed=given.armed)
            vehicle = self._vehicles.of_sysid(sysid)
            for request_id in [] if vehicle is None else shown_commands(vehicle.gate, given.mode):
                done += self.bridge.command_answered(request_id, Result.ACCEPTED, now_ns)
            return done
        if isinstance(given, LandedSeen) and given.landed is not LandedState.ON_GROUND:
            return self.bridge.armings.not_standing(
                sysid, "it does not stand on the ground", now_ns
            )
        if isinstance(given, CommandEnded) and given.result is not None:
            if given.kind is CommandKind.ARM and given.result != Result.ACCEPTED:
                self.bridge.armings.refused(sysid)
            return self.bridge.command_answered(given.request_id, given.result, now_ns)
        return []

    def _armed_unasked(self, seen: HeartbeatSeen, sysid: int, now_ns: int) -> list[BridgeEffect]:
        """Told where the vehicle has become armed and the gate has not asked it to.  Whether a
        pilot armed it, another station or the vehicle itself no message tells."""
        vehicle = self._vehicles.of_sysid(sysid)
        if vehicle is None or vehicle.telemetry is None:
            return []
        outstanding = vehicle.gate.memory.outstanding
        asked = any(kind is CommandKind.ARM for _, kind in outstanding)
        if not self.bridge.armings.unasked(sysid, armed=seen.armed, asked=asked):
            return []
        address = Address(sysid, vehicle.telemetry.compid)
        note = LogLine(Level.WARNING, UNASKED)
        return [note, *self.bridge.warn(Level.WARNING, UNASKED, address, now_ns)]

    def second(
        self, now_ns: int, counts: Sequence[Counts], signatures: Signatures
    ) -> list[BridgeEffect | Emit]:
        """Once a second: who is lost, and how it stands for whoever watches the bridge."""
        vehicles = self._vehicles.addresses
        done: list[BridgeEffect | Emit] = [*self.bridge.second(vehicles, now_ns)]
        done += self.bridge.ask_again(partial(self._seen, now_ns), now_ns)
        done += self.bridge.control_status(vehicles)
        for each in self._vehicles:
            telemetry = each.telemetry
            if telemetry is None:
                continue
            address = Address(telemetry.sysid, telemetry.compid)
            if telemetry.armed:
                done += self.bridge.armed(address)
            hears = hears_alone(telemetry.autopilot.name, each.parameters)
            if hears is not None:
                done += self.bridge.hears_alone(address, hears)
        clients = [
            msgspec.structs.replace(
                client, signed=signatures.told(client.link, verified=client.verified)
            )
            for client in self.bridge.status(now_ns)
        ]
        return [*done, self.status(now_ns, counts, clients)]

    def status(
        self, now_ns: int, counts: Sequence[Counts], clients: Sequence[ipc.BridgeClient] = ()
    ) -> Emit:
        """The vehicles, links and clients in short; of several vehicles without a bridge, too."""
        links = self._link_rows(now_ns, counts)
        rows = [
            bridge_row(each.gate, each.telemetry, each.presence.losses, now_ns)
            for each in self._vehicles
            if each.telemetry is not None
        ]
        return Emit(ipc.BridgeStatus(now_ns, links, [*clients], rows))

    def _link_rows(self, now_ns: int, counts: Sequence[Counts]) -> list[ipc.BridgeLink]:
        """The links that vehicles are on, with their rates since the last time."""
        span_s = (now_ns - self._before_ns) / 1e9
        rows = [
            ipc.BridgeLink(
                number,
                name,
                (count.received - before[0]) / span_s if self._before_ns else 0.0,
                (count.sent - before[1]) / span_s if self._before_ns else 0.0,
                self._lost_pct(number),
            )
            for number, (name, count, before) in enumerate(
                zip(self._endpoints, counts, self._before, strict=True)
            )
        ]
        self._before = [(count.received, count.sent) for count in counts]
        self._before_ns = now_ns
        return rows

    def _lost_pct(self, link: int) -> float:
        """The worst of the vehicles that are answered there; of all where none is."""
        here = [each for each in self._vehicles if link in each.links] or [*self._vehicles]
        return max(lost_pct(each.presence.losses) for each in here)

    def as_operator(
        self,
        item: Joined | Lost | ClientRequest | ClientRefused | AsksPlan | StopsPlan | LogLine | Emit,
        vehicle: Vehicle,
        now_ns: int,
    ) -> list[Work]:
        """What a MAVLink client does as an operator, and what it is told as one, about `vehicle`
        where it is about one."""
        match item:
            case Joined(client, name):
                return self._operators.join(client, name, hold_on_leave=True)
            case Lost(client, reason):
                return self._operators.lost(client, reason)
            case ClientRequest(client, command):
                parts = self._operators, self._vehicles, self._separation, self.bridge
                return [line(*parts, client, command, now_ns)]
            case ClientRefused(client, ask, refusal):
                return self._operators.refuse(client, ask, refusal)
            case AsksPlan():
                return self._operators.ask_plan(item, vehicle.refusal(now_ns), now_ns)
            case StopsPlan():
                return self._operators.stop_plan(item)
            case LogLine(level, text):
                return [Log(level, NODE, text)]
            case Emit(event, client):
                return [*self.bridge.told(client, event, vehicle.sysid, now_ns)]

    def pass_on(
        self,
        item: ForwardToVehicle | AsksVehicle | ForwardToLink | Reply,
        links: Sequence[int],
        now_ns: int,
    ) -> list[Effect]:
        """Frames between clients and vehicles, which are answered on `links`."""
        match item:
            case ForwardToLink(link, raw):
                return self._links.pass_on(link, raw, now_ns)
            case Reply(link, source, message):
                return self._links.send_as(source, link, message, now_ns)
            case ForwardToVehicle(raw):
                return [
                    sent
                    for link in links
                    for sent in self._links.pass_on(link, raw, now_ns, foreign=True)
                ]
            case AsksVehicle(source, message):
                return [
                    sent
                    for link in links
                    for sent in self._links.send_as(source, link, message, now_ns)
                ]

    def logged(self, line: Log, vehicle: Vehicle, now_ns: int) -> list[BridgeEffect]:
        """What a vehicle's gate warns of, the clients read too; of a refusal only the one who
        asked."""
        telemetry = vehicle.telemetry
        if line.node != announcements.NODE or line.level < Level.WARNING or telemetry is None:
            return []
        if line.text.startswith((REFUSED_LINE, REFUSED_STREAM_LINE)):
            return []
        address = Address(telemetry.sysid, telemetry.compid)
        return self.bridge.warn(line.level, line.text, address, now_ns)

    def control(self, in_control: ipc.OperatorInfo | None, now_ns: int) -> list[BridgeEffect]:
        """Tell the clients where another one is in control than before."""
        number = in_control.client if in_control else 0
        if number == self._told_in_control or self._vehicles.first.telemetry is None:
            return []
        self._told_in_control = number
        name = in_control.name if in_control else ""
        return self.bridge.control_changed(number, name, self._vehicles.addresses, now_ns)


def _clears_takeoff(gate: Gate, up_m: float) -> bool:
    """Whether the gate would let it climb, if it were armed; asked on the ground."""
    memory = gate.memory
    if gate.severity >= Severity.HOLD or memory.verifier is None or memory.pos_ned is None:
        return False
    return not isinstance(memory.verifier.takeoff(up_m, memory.pos_ned), Refusal)
