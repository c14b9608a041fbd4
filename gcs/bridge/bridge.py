"""The bridge: all MAVLink clients of one station, before its vehicles.

Who is there (`peers/client.py`), where frames go (`routing.py`), what is done with each (`judge/`),
and what is answered (`dialogue.py`). Frames of the vehicle's side are not decoded here.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs import ipc
from gcs.bridge.addressing import Given, Judges, LookAt
from gcs.bridge.armings import Armings
from gcs.bridge.catalog import Kind, message_row
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import (
    AboutVehicle,
    AsksVehicle,
    BridgeEffect,
    ForwardToLink,
    Joined,
    LogLine,
    Lost,
    Reply,
)
from gcs.bridge.judge.climbs import asks_for_height, climbs
from gcs.bridge.judge.plans import of_plan
from gcs.bridge.judge.received import Judged
from gcs.bridge.peers.client import Client, Exchange, of_vehicle
from gcs.bridge.peers.client_heartbeats import ClientHeartbeats
from gcs.bridge.peers.control import ControlServer
from gcs.bridge.peers.refused_addresses import RefusedAddresses, WhyNotOurs, nobody_else
from gcs.bridge.peers.unheard_clients import Unheard
from gcs.bridge.peers.unverified_clients import Unverified
from gcs.bridge.rates.needed_rates import Rates
from gcs.bridge.rates.thinned_streams import ThinnedStreams
from gcs.bridge.routing import Routes, target_of
from gcs.gate.effects import Level
from gcs.gate.policy.policy import BridgeRules
from gcs.protocol.autopilot import Autopilot
from gcs.protocol.effects import Address
from gcs.protocol.enforced_sysid import Hears
from gcs.protocol.transfers.transfer import Timing
from gcs.wire.frame import Frame
from gcs.wire.ids import MsgId
from gcs.wire.messages import ParamSet, ParamValue

FIRST_NUMBER: Final = 1000
"""MAVLink clients have numbers from here up; operators of the local socket have smaller ones."""


class Bridge:
    """All MAVLink clients of one station.  Vehicles are told apart by their system ids."""

    def __init__(
        self,
        own: Address,
        rules: BridgeRules,
        needed_hz: Rates,
        silent_ns: int,
        timing: Timing,
        deadman_ns: int,
    ) -> None:
        """`own` is what the station calls itself; `needed_hz` is how often the gate needs which
        message; a client that is silent for `silent_ns` is lost; `timing` is of the plans that
        clients send; one sample of their setpoint streams counts for `deadman_ns`."""
        self._own = own
        self._control = ControlServer()
        self._thinned = ThinnedStreams(needed_hz)
        self._judges = Judges(rules, needed_hz, self._control, self._thinned)
        self._silent_ns = silent_ns
        self._timing = timing
        self._deadman_ns = deadman_ns
        self._rate_hz = rules.client_rate_hz
        self.routes = Routes()
        self.unverified = Unverified()
        """Of the links that are there, those of peers who have not shown that they have the key."""
        self._by_link: dict[int, Client] = {}
        self._by_number: dict[int, Client] = {}
        self._next_number = FIRST_NUMBER
        self._refused_addresses = RefusedAddresses(own)
        self._heartbeats = ClientHeartbeats(self.routes)
        self._unheard = Unheard()
        self._in_control = 0
        self.armings = Armings(self._judges, self._exchanges)

    # --------------------------------------------------------------------- come and go

    def came(
        self, link: int, name: str, *, verified: bool = True, named: bool = False
    ) -> list[BridgeEffect]:
        """A peer is there; it is a client with its first good frame.  Not `verified`: it is sent
        nothing but heartbeats before that.  `named` by the user: nobody need be there yet."""
        self._by_link[link] = Client(link, name, self._timing, self._deadman_ns, named=named)
        if not verified:
            return [*self.unverified.come(link, name)]
        self.routes.open(link)
        how = "is sent to, and not heard yet" if named else "has connected"
        return [LogLine(Level.INFO, f"{name} {how}, on link {link}")]

    def verify(self, link: int) -> list[BridgeEffect]:
        """The first frame of a peer that was `unverified` is good."""
        self.routes.open(link)
        return [*self.unverified.verify(link, self._by_link[link].name)]

    def gone(self, link: int, reason: str) -> list[BridgeEffect]:
        """It has gone, and its link's number is free."""
        self.routes.close(link)
        self._heartbeats.gone(link)
        self._refused_addresses.gone(link)
        self._unheard.gone(link)
        client = self._by_link.pop(link, None)
        if client is None:
            return []
        if link in self.unverified:
            return [*self.unverified.go(link, client.name, reason)]
        return [
            *self._lose(client, reason),
            LogLine(Level.INFO, f"{client.name} has gone: {reason}"),
        ]

    def flooded(self, link: int, dropped: int) -> list[BridgeEffect]:
        """It sends more than it may; so many datagrams were not looked at."""
        client = self._by_link.get(link)
        if client is None:
            return []
        client.dropped.count += dropped
        return [
            LogLine(Level.WARNING, f"{client.name} sends too much: {dropped} datagrams dropped")
        ]

    def second(self, vehicles: Sequence[Address], now_ns: int) -> list[BridgeEffect]:
        """Once a second: whoever says nothing any more is lost, and who sends too much is told, in
        the name of the first of `vehicles`: QGroundControl shows no text of anybody else (from
        memory)."""
        effects: list[BridgeEffect] = [*self.unverified.second()]
        speaker = vehicles[0] if vehicles else self._own
        for client in self._by_link.values():
            client.received.count(0, now_ns)
            client.sent.count(0, now_ns)
            if client.joined and now_ns - client.heard_ns > self._silent_ns:
                effects += self._lose(client, f"silent for {self._silent_ns / 1e9:.0f} s")
            if client.link not in self.unverified:
                flooded = client.dropped.due_text(self._rate_hz, now_ns)
                effects += [Reply(client.link, speaker, text) for text in flooded]
        return effects

    def ask_again(self, look: LookAt, now_ns: int) -> list[BridgeEffect]:
        """Once a second: what was held back, and its client does not ask for again by itself."""
        effects: list[BridgeEffect] = []
        for asked in self._judges.asked_once(now_ns):
            client = self._by_link[asked.by.link]
            given = Given(client, asked.frame, look, self._in_control, now_ns)
            effects += self._judges.judge(given, [asked.autopilot]).effects
        return effects

    def hears_alone(self, vehicle: Address, hears: Hears) -> list[BridgeEffect]:
        """Once a second, of a vehicle that does not hear everybody: who is not heard is told."""
        effects: list[BridgeEffect] = []
        for client in self._by_number.values():
            sysids = [sysid for sysid, _ in self.routes.components(client.link)]
            effects += self._unheard.told(client, sysids, vehicle, hears)
        return effects

    def _lose(self, client: Client, reason: str) -> list[BridgeEffect]:
        if not client.joined:
            return []
        client.joined = False
        self._thinned.forget(client.link)
        del self._by_number[client.number]
        self._control.forget(client.number)
        taken_back = self._judges.client_lost(client, self._own)
        held = [
            done for each in client.exchanges for done in of_vehicle(each, each.take_mode_back())
        ]
        return [*held, Lost(client.number, reason), *taken_back]

    def _meet(self, client: Client, frame: Frame) -> list[BridgeEffect]:
        client.begin(self._next_number)
        self._next_number += 1
        self._by_number[client.number] = client
        told = [LogLine(Level.INFO, f"{client.name} has connected")] if client.named else []
        return [
            Joined(client.number, f"MAVLink {frame.sysid}/{frame.compid}, {client.name}"),
            *told,
        ]

    def name_of_link(self, link: int) -> str:
        """Of the client on it; else empty."""
        return self._by_link[link].name if link in self._by_link else ""

    # -------------------------------------------------------------------- from clients

    def from_client(
        self,
        link: int,
        frame: Frame,
        vehicles: Sequence[Address],
        look: LookAt,
        now_ns: int,
        why_not_ours: WhyNotOurs = nobody_else,
    ) -> Judged:
        """A good frame on a client's link; `vehicles` are the autopilots that were met, and `look`
        tells of one, by its system id, how it is; `why_not_ours` is asked of other systems."""
        client = self._by_link[link]
        client.received.count(1, now_ns)
        refused = self._refused_addresses.of_sender(client, frame, vehicles, now_ns)
        if refused is not None:
            client.refused += 1
            return Judged(True, refused)
        client.heard_ns = now_ns
        effects: list[BridgeEffect] = [] if client.joined else self._meet(client, frame)
        self.routes.heard(link, frame.sysid, frame.compid)
        sysid, _ = target_of(frame)
        addressed = [each for each in vehicles if sysid in (0, each.sysid)]
        if sysid and not addressed:
            judged = self._elsewhere(client, frame, sysid, vehicles, why_not_ours)
        else:
            given = Given(client, frame, look, self._in_control, now_ns)
            judged = self._judges.judge(given, addressed)
        if frame.msgid == MsgId.HEARTBEAT:
            effects += self._heartbeats.go_round(client, frame, now_ns)
        client.refused += judged.refused
        return Judged(judged.refused, [*effects, *judged.effects])

    def _elsewhere(
        self,
        client: Client,
        frame: Frame,
        sysid: int,
        vehicles: Sequence[Address],
        why_not_ours: WhyNotOurs,
    ) -> Judged:
        """A frame for a system that is no vehicle of ours: another client, or nobody."""
        links = self.routes.between_clients(frame, client.link)
        if links and message_row(frame.msgid).kind is not Kind.DENIED:
            return Judged(False, [ForwardToLink(link, frame.raw) for link in links])
        if sysid == self._own.sysid:
            answered = self._refused_addresses.of_own(client, frame)
            return Judged(bool(answered), answered)
        refused = self._refused_addresses.of_target(client, frame, vehicles, why_not_ours(sysid))
        return Judged(True, refused)

    @property
    def deadline_ns(self) -> int | None:
        """When `wake` is due."""
        times = [each.plans.deadline_ns for each in self._exchanges()]
        times += [each.chosen_until_ns for each in self._exchanges()]
        return min((time for time in times if time is not None), default=None)

    def wake(self, now_ns: int) -> list[BridgeEffect]:
        """`deadline_ns` has passed."""
        done: list[BridgeEffect] = []
        for each in self._exchanges():
            due_ns = each.plans.deadline_ns
            if due_ns is not None and due_ns <= now_ns:
                done += of_vehicle(each, of_plan(each, each.plans.wake(now_ns)))
            until_ns = each.chosen_until_ns
            if until_ns is not None and until_ns <= now_ns:
                done += of_vehicle(each, each.wake(now_ns))
        return done

    def _exchanges(self, vehicle: int | None = None) -> list[Exchange]:
        """Of all clients that are there, with one vehicle or with all."""
        return [
            each
            for client in self._by_number.values()
            for each in client.exchanges
            if vehicle in (None, each.vehicle)
        ]

    # --------------------------------------------------------------------- for clients

    def from_vehicle(
        self, frames: Sequence[Frame], now_ns: int
    ) -> Sequence[tuple[int, Sequence[bytes], Sequence[bytes]]]:
        """What goes to which client link of frames that came together from the vehicle's side, as
        they are and in their order; and which of these are left out, as that client asked for
        fewer."""
        shares = self.routes.shares(frames)
        if self.unverified:
            shares = [*shares, *self.unverified.shares(frames)]
        left_out = self._thinned.left_out(frames, now_ns)
        done = [(link, raws, left_out.get(link, ())) for link, raws in shares]
        for link, raws, fewer in done:
            self._by_link[link].sent.count(len(raws) - len(fewer), now_ns)
        return done

    def parameter(
        self, message: ParamValue, autopilot: str, vehicle: int, now_ns: int
    ) -> list[BridgeEffect]:
        """PARAM_VALUE of a vehicle's autopilot."""
        return self._judges.of(vehicle).set_up.parameter(message, autopilot, now_ns)

    def written_by_station(
        self, message: ParamSet, autopilot: str, vehicle: int, now_ns: int
    ) -> None:
        """The station sends a PARAM_SET of its own, for an operator."""
        self._judges.of(vehicle).set_up.written_by_station(message, autopilot, now_ns)

    def armed(self, vehicle: Address) -> list[BridgeEffect]:
        """Once a second, of every vehicle that is armed."""
        ended = self._judges.of(vehicle.sysid).set_up.armed(self._own, vehicle)
        return [AboutVehicle(vehicle.sysid, tuple(ended))]

    def held_back(
        self, command: ipc.Command, autopilot: Autopilot, vehicle: Address
    ) -> AsksVehicle | None:
        """A climb of any operator cannot be judged until the vehicle has answered this."""
        if not isinstance(command, ipc.Ask):
            return None
        awaited = self._judges.of(vehicle.sysid).set_up.height_awaited
        held = awaited and climbs(command, autopilot)
        return asks_for_height(self._own, vehicle) if held else None

    def told(self, number: int, event: ipc.Event, vehicle: int, now_ns: int) -> list[BridgeEffect]:
        """What the station tells a client as an operator, of what it asked of a vehicle."""
        client = self._by_number.get(number)
        if client is None:
            return []
        if not isinstance(event, ipc.VerdictEvent | ipc.EndingEvent):
            return of_vehicle(client.at(vehicle), self._told(client.at(vehicle), event, now_ns))
        # By its number, which is one of the client's, the exchange knows what it is about.
        return [
            done
            for each in client.exchanges
            for done in of_vehicle(each, self._told(each, event, now_ns))
        ]

    @staticmethod
    def _told(client: Exchange, event: ipc.Event, now_ns: int) -> list[BridgeEffect]:
        match event:
            case ipc.VerdictEvent(id=ask_id) if ask_id == client.plan_ask:
                if event.outcome != "accepted":
                    client.plan_ask = 0
                return of_plan(client, client.plans.decided(event, now_ns))
            case ipc.EndingEvent(id=ask_id) if ask_id == client.plan_ask:
                client.plan_ask = 0
                return of_plan(client, client.plans.ended(event, now_ns))
            case ipc.Trouble(text) if client.plan_ask:
                return of_plan(client, client.plans.finding(text, now_ns))
            case _:
                return client.dialogue.told(event, now_ns)

    def asked(self, number: int, vehicle: int, now_ns: int) -> list[BridgeEffect]:
        """The operator `number`, a client or not, asks the gate of a vehicle for something."""
        done: list[BridgeEffect] = []
        for each in self._exchanges(vehicle):
            if each.number != number:
                each.dialogue.forget()
                done += of_vehicle(
                    each, each.forget_choice("another one asks for something", now_ns)
                )
        return done

    def leave(self) -> list[BridgeEffect]:
        """The session ends: the mode of a mission that a client has set is taken back now."""
        return [
            done for each in self._exchanges() for done in of_vehicle(each, each.take_mode_back())
        ]

    def command_answered(self, operation: int, result: int, now_ns: int) -> list[BridgeEffect]:
        """The vehicle answered a command that the gate sent; `operation` is the request's."""
        effects: list[BridgeEffect] = []
        for each in self._exchanges():
            effects += each.dialogue.command_answered(operation, result, now_ns)
        return effects

    def warn(self, level: Level, text: str, vehicle: Address, now_ns: int) -> list[BridgeEffect]:
        """Tell all clients what the gate warns of, in the vehicle's name."""
        return self._to_all(vehicle, level, f"gate: {text}", now_ns)

    def control_changed(
        self, number: int, name: str, vehicles: Sequence[Address], now_ns: int
    ) -> list[BridgeEffect]:
        """Who is in control, all clients read; `number` is 0 for nobody."""
        self._in_control = number
        self._control.changed(number, self._sysid_of(number))
        who = f"in control: {name}" if number else "nobody is in control"
        effects: list[BridgeEffect] = []
        for each in self._exchanges():
            if each.number != number:
                effects += of_vehicle(each, each.control_lost(who, now_ns))
        for vehicle in vehicles:
            effects += self._to_all(vehicle, Level.INFO, f"gate: {who}", now_ns)
        return effects

    def control_status(self, vehicles: Sequence[Address]) -> list[BridgeEffect]:
        """Who is in control, by the protocol's own message, for the clients that understand it."""
        told = [c for c in self._by_number.values() if self._control.speaks(c.number)]
        status = self._control.status
        return [Reply(client.link, vehicle, status) for client in told for vehicle in vehicles]

    def _sysid_of(self, number: int) -> int:
        """What the operator in control calls itself: a client by its system id, an operator of the
        station by the station's."""
        client = self._by_number.get(number)
        if client is None:
            return self._own.sysid if number else 0
        heard = self.routes.components(client.link)
        return heard[0][0] if heard else 0

    def _to_all(self, vehicle: Address, level: Level, text: str, now_ns: int) -> list[BridgeEffect]:
        effects: list[BridgeEffect] = []
        for client in self._by_number.values():
            to = From(client.link, Address(0, 0), vehicle)
            effects += client.at(vehicle.sysid).dialogue.text(to, level, text, now_ns)
        return effects

    def name(self, number: int) -> str:
        """Of a client that is there; else empty."""
        client = self._by_number.get(number)
        return client.name if client else ""

    def status(self, now_ns: int) -> list[ipc.BridgeClient]:
        """Every client, for a person to look at."""
        return [
            ipc.BridgeClient(
                client=client.number if client.joined else 0,
                link=client.link,
                name=client.name,
                ids=[f"{s}/{c}" for s, c in self.routes.components(client.link)],
                rx_hz=client.received.hz,
                tx_hz=client.sent.hz,
                refused=client.refused,
                dropped=client.dropped.count,
                in_control=client.joined and client.number == self._in_control,
                silent_s=(now_ns - client.heard_ns) / 1e9 if client.heard_ns else 0.0,
                verified=client.link not in self.unverified,
            )
            for client in self._by_link.values()
        ]
