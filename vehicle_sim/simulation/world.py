"""Vehicles, links and time: the whole simulation as one pure machine.

`handle(input, now_ns)` takes the wall time of the pacer; simulated time is
(now - start) * speedup, exactly in integers, lived in whole steps.  What is sent depends on the
inputs and their times alone, never on how many steps one call happened to cover.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final, assert_never

from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.services.streams import NEVER
from vehicle_sim.simulation.channels import DATAGRAM_BYTES, Connection
from vehicle_sim.simulation.fault_script import AnyFault, LinkFault, Schedule, Timed
from vehicle_sim.simulation.impairment import NEVER_NS, Direction, Impairment
from vehicle_sim.simulation.switchboard import Switchboard
from vehicle_sim.simulation.traffic import (
    Datagram,
    Input,
    Joined,
    Left,
    LinkSpec,
    Log,
    Output,
    Peer,
    Transmit,
    Wake,
)
from vehicle_sim.simulation.view import View
from vehicle_sim.wire.signing import SigningKey
from vehicle_sim.wire.split import Counters

__all__ = [
    "DATAGRAM_BYTES",
    "Connection",
    "Datagram",
    "Direction",
    "Impairment",
    "Input",
    "Joined",
    "Left",
    "LinkSpec",
    "Log",
    "Output",
    "Peer",
    "SigningKey",
    "Transmit",
    "Wake",
    "World",
]

_DIRECTIONS: Final = {
    "in": Direction.TO_VEHICLE,
    "out": Direction.FROM_VEHICLE,
    "both": None,
}
STEPS_AHEAD_NS: Final = 20_000_000
"""The longest sleep: what the vehicle says unasked is at most this late, in wall time."""


class World:
    """See the module.  `start_ns` is the wall time at which simulated time is 0."""

    def __init__(
        self,
        vehicles: Sequence[VehicleServer],
        links: Sequence[LinkSpec],
        speedup: Fraction = Fraction(1),
        start_ns: int = 0,
        *,
        signing: SigningKey | None = None,
        unix_start_ns: int = 0,
        seed: int = 0,
        faults: tuple[Timed, ...] = (),
        viewer: Peer | None = None,
    ) -> None:
        """All vehicles share one key.  `unix_start_ns` is what `start_ns` is since 1970, for
        signatures; `seed` is that of the links' impairments; `faults` happen at their times;
        `viewer` is sent the truth, on a link whose number comes after the others'."""
        if len({server.vehicle.dt_ns for server in vehicles}) != 1:
            raise ValueError("all vehicles of a world take steps of the same length")
        self._servers = tuple(vehicles)
        self._numbers = {server: number for number, server in enumerate(self._servers)}
        self._links = tuple(links)
        # Fractions are exact and slow: the two integers are as exact.
        self._numerator, self._denominator = speedup.numerator, speedup.denominator
        self._start_ns = start_ns
        self._dt_ns = self._servers[0].vehicle.dt_ns
        self._steps_ahead = max(1, int(STEPS_AHEAD_NS * speedup) // self._dt_ns)
        self._steps = 0
        self._engines = tuple(dict.fromkeys(server.vehicle.engine for server in vehicles))
        # Which servers have something to do after which step; one too many does no harm.
        self._agenda: dict[int, set[int]] = {1: set(range(len(self._servers)))}
        self._board = Switchboard(vehicles, links, signing, unix_start_ns - start_ns, seed)
        self._view = (
            View(self._servers, len(self._links), viewer, speedup) if viewer is not None else None
        )
        self._schedule = Schedule(faults)
        self._fault_ns = self._schedule.due_ns(NEVER_NS)
        self._bad_links: list[LinkFault] = []
        self._greeted = False

    @property
    def time_ns(self) -> int:
        """Simulated time."""
        return self._steps * self._dt_ns

    def wall_ns(self, time_ns: int) -> int:
        """How long that much simulated time takes on the wall."""
        return time_ns * self._denominator // self._numerator

    def counters(self, link: int, peer: Peer) -> Counters | None:
        """What was heard from a peer, good and bad."""
        return self._board.counters(link, peer)

    @property
    def links(self) -> tuple[Connection, ...]:
        """Who is connected, in the order of their coming."""
        return self._board.connections

    def impair(self, link: int | None, direction: Direction | None, impairment: Impairment) -> None:
        """From now on, on one link or all, in one direction or both; what is under way stays so."""
        self._board.impair(link, direction, impairment)

    def inject(self, fault: AnyFault, system: int | None) -> bool:
        """Let it happen now, to one vehicle or (None) to all; False = no such vehicle or link."""
        if isinstance(fault, LinkFault):
            if fault.link is not None and fault.link >= len(self._links):
                return False
            self.impair(fault.link, _DIRECTIONS[fault.direction], _impairment(fault))
            sound = fault.ended()
            self._bad_links = [each for each in self._bad_links if each.ended() != sound]
            self._bad_links += [] if fault == sound else [fault]
            return True
        hit = [server for server in self._servers if system in (None, server.system)]
        for server in hit:
            server.vehicle.inject(fault)
        return bool(hit)

    def faults(self, system: int | None) -> list[AnyFault]:
        """Those of a vehicle, or (None) of any, and of the links."""
        asked = [server for server in self._servers if system in (None, server.system)]
        of_vehicles = [fault for server in asked for fault in server.vehicle.faults]
        return [*dict.fromkeys(of_vehicles), *self._bad_links]

    def truth(self, system: int) -> Truth | None:
        """What really is; None = no such vehicle."""
        for server in self._servers:
            if server.system == system:
                return server.vehicle.truth
        return None

    @property
    def servers(self) -> tuple[VehicleServer, ...]:
        return self._servers

    @property
    def deadline_ns(self) -> int:
        """Wall time at which the next `Wake` is wanted at the latest.

        That of a step, or of the arrival of a datagram that an impaired link delays.
        """
        steps = min(self._steps + self._steps_ahead, *self._agenda)
        return min(self._wall_ns(steps), self._board.deadline_ns)

    def handle(self, given: Input, now_ns: int) -> list[Output]:
        """Live up to `now_ns`, then take the input."""
        out: list[Output] = []
        if not self._greeted:
            self._greeted = True
            for number, link in enumerate(self._links):
                for peer in link.peers:
                    self._board.join(number, peer, now_ns, out)
        while self._board.arriving and (due_ns := self._board.arrival_ns) <= now_ns:
            self._live(due_ns, out)
            self._board.arrive(due_ns, out)
            self._note_roused()
        self._live(now_ns, out)
        match given:
            case Datagram():
                if given.link < len(self._links):
                    self._board.receive(given, now_ns, out)
            case Joined():
                self._board.join(given.link, given.peer, now_ns, out)
            case Left():
                self._board.leave(given.link, given.peer, out)
            case Wake():
                pass
            case _:
                assert_never(given)
        self._note_roused()
        return out

    def _live(self, now_ns: int, out: list[Output]) -> None:
        """All steps that are over by then, and what leaves a slow link meanwhile."""
        steps = (now_ns - self._start_ns) * self._numerator // (self._denominator * self._dt_ns)
        board, agenda, view = self._board, self._agenda, self._view
        while self._steps < steps:
            self._steps = step = self._steps + 1
            if board.departing:
                board.depart(self._wall_ns(step), out)
            if step * self._dt_ns >= self._fault_ns:
                self._inject_due(out)
            for engine in self._engines:
                engine.step()
            wanted = agenda.pop(step, None)
            if wanted:
                wall_ns = self._wall_ns(step)
                for number in sorted(wanted):
                    server = self._servers[number]
                    board.emit(server, server.step(wall_ns), wall_ns, out)
                    self._plan(number)
            if view is not None and self.time_ns >= view.due_ns:
                out += view.step(self.time_ns)
                agenda.setdefault(-(-view.due_ns // self._dt_ns), set())
        if board.departing:
            board.depart(now_ns, out)

    def _inject_due(self, out: list[Output]) -> None:
        for timed in self._schedule.due(self.time_ns):
            who = "" if timed.system is None else f"vehicle {timed.system}: "
            done = self.inject(timed.fault, timed.system)
            level, but = ("info", "") if done else ("warning", ", but there is no such thing")
            out.append(Log(level, "faults", f"{who}{timed.fault.described()}{but}"))
        self._fault_ns = self._schedule.due_ns(NEVER_NS)

    def _plan(self, number: int) -> None:
        """Put the server's next doings on the agenda."""
        server = self._servers[number]
        step = min(server.vehicle.due_step, -(-server.stream_due_ns // self._dt_ns))
        if server.deadline_ns < NEVER:
            step = min(step, self._steps_until(server.deadline_ns))
        if step <= self._steps or server.touched:
            step = self._steps + 1
        self._agenda.setdefault(step, set()).add(number)

    def _note_roused(self) -> None:
        """What came in is looked at after the next step."""
        for server in self._board.active():
            if server.touched:
                self._plan(self._numbers[server])

    def _wall_ns(self, steps: int) -> int:
        """When that step is over: the first nanosecond that reaches it."""
        return self._start_ns - (-steps * self._dt_ns * self._denominator // self._numerator)

    def _steps_until(self, wall_ns: int) -> int:
        """Number of the first step that is over at that time or later."""
        steps_ns = (wall_ns - self._start_ns) * self._numerator
        return -(-steps_ns // (self._denominator * self._dt_ns))


def _impairment(fault: LinkFault) -> Impairment:
    """An outage without an end: the fault that ends it comes from the schedule."""
    return Impairment(
        loss=fault.loss,
        duplicate=fault.duplicate,
        reorder=fault.reorder,
        delay_ns=round(fault.delay_s * 1e9),
        jitter_ns=round(fault.jitter_s * 1e9),
        outage_until_ns=NEVER_NS if fault.out else 0,
    )
