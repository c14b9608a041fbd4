"""The vehicles that a client's frame reaches, and what each makes of it.

A frame for one system is judged for that vehicle; one for all (target system 0, or no target) is
judged for each vehicle where it would move or change them, or have them send more, and else goes
out once on each link.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import AboutVehicle
from gcs.bridge.judge.judge import Judge
from gcs.bridge.judge.received import Judged, Look, Received
from gcs.bridge.peers.client import Client
from gcs.bridge.peers.control import ControlServer
from gcs.bridge.rates.needed_rates import Rates
from gcs.bridge.rates.thinned_streams import ThinnedStreams
from gcs.bridge.routing import TARGETS, readdressed, target_of
from gcs.bridge.translate.meaning import Seen
from gcs.gate.policy.policy import BridgeRules
from gcs.protocol.effects import Address
from gcs.wire.frame import Frame
from gcs.wire.ids import Component

NO_VEHICLE: Final = Address(0, Component.AUTOPILOT1)
"""Stands for the vehicle before one is heard."""

LookAt: TypeAlias = Callable[[int], Seen | None]
"""How the vehicle with that system id is; None before it is heard."""


@dataclass(frozen=True, slots=True)
class Given:
    """A frame of a client; `in_control` is the number of the client that is, 0 for none."""

    client: Client
    frame: Frame
    look: LookAt
    in_control: int
    now_ns: int


class Judges:
    """One for each vehicle, by its system id."""

    def __init__(
        self, rules: BridgeRules, needed_hz: Rates, control: ControlServer, thinned: ThinnedStreams
    ) -> None:
        """`needed_hz`: how often the gate needs which message; `control`: who is in control;
        `thinned`: how often which client wants what the gate needs, of all vehicles."""
        self._thinned = thinned
        self._rules = rules
        self._needed_hz = needed_hz
        self._control = control
        self._by_sysid: dict[int, Judge] = {}

    def of(self, sysid: int) -> Judge:
        """What judges everything that is for that vehicle."""
        found = self._by_sysid.get(sysid)
        if found is None:
            found = Judge(self._rules, self._needed_hz, self._control, self._thinned)
            self._by_sysid[sysid] = found
        return found

    def client_lost(self, client: Client, own: Address) -> list[AboutVehicle]:
        """What a client had the vehicles send is taken back, and its turn to read is over."""
        done = []
        for sysid, judge in self._by_sysid.items():
            vehicle = Address(sysid, Component.AUTOPILOT1)
            effects = judge.client_lost(client.number, client.link, own, vehicle)
            if effects:
                done.append(AboutVehicle(sysid, tuple(effects)))
        return done

    def asked_once(self, now_ns: int) -> list[Received]:
        """What was held back, of any vehicle, and is to be judged once more."""
        return [each for judge in self._by_sysid.values() for each in judge.asked_once(now_ns)]

    def judge(self, given: Given, vehicles: Sequence[Address]) -> Judged:
        """A frame that reaches these vehicles; none: no vehicle is heard yet.

        What would move or change several is judged for each, as if it had been sent to that one
        alone; where the message has no target, one refusal is for all.
        """
        first = vehicles[0] if vehicles else NO_VEHICLE
        for_all = target_of(given.frame)[0] == 0 and self.of(first.sysid).concerns_each(given.frame)
        if len(vehicles) <= 1:
            # Not to whoever else hears the link, and was not judged.
            alone = bool(vehicles) and for_all
            frame = readdressed(given.frame, first.sysid) if alone else given.frame
            return _at(first, self._for_one(given, frame, first))
        if not for_all:
            return self._for_one(given, given.frame, first)
        if given.frame.msgid not in TARGETS:
            return self._for_all_or_none(given, vehicles)
        done = [
            (each, self._for_one(given, readdressed(given.frame, each.sysid), each))
            for each in vehicles
        ]
        effects = [effect for each, judged in done for effect in _at(each, judged).effects]
        return Judged(all(judged.refused for _, judged in done), effects)

    def _for_all_or_none(self, given: Given, vehicles: Sequence[Address]) -> Judged:
        """A frame that cannot name a vehicle: the first refusal is for all, and nobody is asked
        after it, as whoever refuses expects to be told what became of that."""
        judged = None
        for each in vehicles:
            for_this = self._for_one(given, given.frame, each)
            if for_this.refused:
                return _at(each, for_this)
            judged = judged or for_this
        assert judged is not None
        return judged

    def _for_one(self, given: Given, frame: Frame, vehicle: Address) -> Judged:
        client = given.client
        _, compid = target_of(frame)
        addressed = Address(vehicle.sysid, compid or vehicle.compid)
        received = Received(
            client.at(vehicle.sysid),
            From(client.link, Address(frame.sysid, frame.compid), addressed),
            frame,
            self._look(given, vehicle.sysid),
            given.now_ns,
            vehicle,
            client.number == given.in_control,
        )
        return self.of(vehicle.sysid).judge(received)

    def _look(self, given: Given, sysid: int) -> Look:
        """How the vehicle is, with what is this client's."""

        def seen() -> Seen | None:
            found = given.look(sysid)
            if found is None:
                return None
            return replace(
                found,
                in_control=given.in_control in (0, given.client.number),
                manual_modes=self._rules.manual_modes,
                has_sticks=given.client.at(sysid).sticks.heard(given.now_ns),
            )

        return seen


def _at(vehicle: Address, judged: Judged) -> Judged:
    """The same, as that vehicle's."""
    effects = judged.effects
    return Judged(judged.refused, [AboutVehicle(vehicle.sysid, tuple(effects))] if effects else [])
