"""The loop: sockets and the clock on one side, the world on the other.

    select(sockets, deadline - now), drain, world.handle, send

Where the machine cannot live as fast as asked, the pacer's clock slips behind the real one,
which is said, rather than making up for it in a burst.
"""

from __future__ import annotations

import select
import socket
import time
from collections.abc import Callable, Sequence
from typing import Final

from vehicle_sim.world import Input, Log, Transmit, Wake, World

from .endpoints import Endpoint
from .lifeline import Lifeline

SLIP_NS: Final = 100_000_000
SAID_EVERY_NS: Final = 5_000_000_000
LIFELINE_GRACE_NS: Final = 200_000_000


def monotonic_ns() -> int:
    return time.monotonic_ns()


class Stop:
    """A request to end, from a signal: `code` is the exit code.

    The pair of sockets wakes the loop, as `signal.set_wakeup_fd` has it.
    """

    def __init__(self) -> None:
        self.code: int | None = None
        self.waker, self.sleeper = socket.socketpair()
        self.waker.setblocking(False)
        self.sleeper.setblocking(False)

    def close(self) -> None:
        self.waker.close()
        self.sleeper.close()


class Pacer:
    """Runs one world until it is told to stop."""

    def __init__(
        self,
        world: World,
        endpoints: Sequence[Endpoint],
        start_ns: int,
        log: Callable[[Log], None],
        stop: Stop,
        lifeline: Lifeline | None = None,
    ) -> None:
        """The end of the `lifeline` ends the run."""
        self._world = world
        self._endpoints = endpoints
        self._log = log
        self._stop = stop
        self._lifeline = lifeline
        self._ends_ns: int | None = None
        self._slipped_ns = 0
        self._last_ns = start_ns
        self._said_ns = start_ns

    def run(self) -> int:
        """The exit code."""
        self._feed(self._due_inputs(), self._now())
        while self._stop.code is None:
            by_socket = {
                each.fileno(): (each, endpoint)
                for endpoint in self._endpoints
                for each in endpoint.sockets()
            }
            watched = [*by_socket, self._stop.sleeper.fileno()]
            if self._lifeline is not None:
                watched.append(self._lifeline.fileno())
            wait_ns = max(0, self._world.deadline_ns + self._slipped_ns - monotonic_ns())
            ready, _, _ = select.select(watched, [], [], wait_ns * 1e-9)
            now_ns = self._now()
            inputs = self._due_inputs()
            for number in ready:
                if number in by_socket:
                    each, endpoint = by_socket[number]
                    inputs += endpoint.read(each)
                elif self._lifeline is not None and number == self._lifeline.fileno():
                    self._feel(self._lifeline, now_ns)
            self._feed(inputs, now_ns)
            if self._ends_ns is not None and now_ns >= self._ends_ns:
                return 0
        return self._stop.code

    def _now(self) -> int:
        """The pacer's wall time: the real one, less what it has slipped."""
        real_ns = monotonic_ns()
        late_ns = real_ns - self._slipped_ns - self._last_ns - SLIP_NS
        if late_ns > 0:
            self._slipped_ns += late_ns
            if real_ns - self._said_ns > SAID_EVERY_NS:
                self._said_ns = real_ns
                text = f"cannot keep up: {self._slipped_ns / 1e9:.1f} s behind in all"
                self._log(Log("warning", "pacer", text))
        self._last_ns = real_ns - self._slipped_ns
        return self._last_ns

    def _due_inputs(self) -> list[Input]:
        return [given for endpoint in self._endpoints for given in endpoint.idle(monotonic_ns())]

    def _feed(self, inputs: list[Input], now_ns: int) -> None:
        for given in inputs or [Wake()]:
            for output in self._world.handle(given, now_ns):
                if isinstance(output, Transmit):
                    self._endpoints[output.link].send(output.peer, output.data)
                else:
                    self._log(output)

    def _feel(self, lifeline: Lifeline, now_ns: int) -> None:
        if lifeline.ended():
            self._lifeline = None
            self._ends_ns = now_ns + LIFELINE_GRACE_NS
