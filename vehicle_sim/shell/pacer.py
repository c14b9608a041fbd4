"""The loop: sockets and the clock on one side, the world on the other.

    wait for sockets until the deadline, drain, world.handle, send

Where the machine cannot live as fast as asked, the pacer's clock slips behind the real one,
which is said, rather than making up for it in a burst.  What it has to make up for is lived in
short turns of simulated time, with a look at the sockets after each: a command that comes meanwhile
is carried out then, and not seconds of the vehicle's time later.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from vehicle_sim.shell.endpoints import Endpoint
from vehicle_sim.shell.parent import ParentPipe
from vehicle_sim.shell.readable import ReadableSockets
from vehicle_sim.simulation.world import Input, Log, Transmit, Wake, World

SLIP_NS: Final = 100_000_000
TURN_NS: Final = 100_000_000
"""Of simulated time: no more is lived between two looks at the sockets."""
SAID_EVERY_NS: Final = 5_000_000_000
WORTH_SAYING_NS: Final = 500_000_000
"""Less than this is a hiccup of the machine."""
LIFELINE_GRACE_NS: Final = 200_000_000
PACE_NOTED_NS: Final = 500_000_000
PACE_OVER_NS: Final = 2_000_000_000
"""The factor that is reported is the mean over about this long."""

_STOP: Final = -1
_LIFELINE: Final = -2


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


class Pace:
    """How fast simulated time passes."""

    def __init__(self, start_ns: int) -> None:
        self._start_ns = start_ns
        self._marks = [(start_ns, 0)]  # real, simulated

    def note(self, real_ns: int, time_ns: int) -> None:
        self._marks.append((real_ns, time_ns))
        while len(self._marks) > 2 and real_ns - self._marks[1][0] > PACE_OVER_NS:
            del self._marks[0]

    @property
    def reached(self) -> float:
        """Simulated seconds per second, lately."""
        (real_ns, time_ns), (now_ns, then_ns) = self._marks[0], self._marks[-1]
        return (then_ns - time_ns) / (now_ns - real_ns) if now_ns > real_ns else 0.0


@dataclass(frozen=True, slots=True)
class Redraw:
    """Somebody who wants to show the pace, about so often in real time."""

    every_ns: int
    show: Callable[[Pace], None]


class Pacer:
    """Runs one world until it is told to stop."""

    def __init__(
        self,
        world: World,
        endpoints: Sequence[Endpoint],
        start_ns: int,
        log: Callable[[Log], None],
        stop: Stop,
        lifeline: ParentPipe | None = None,
        hear: Callable[[bytes], None] | None = None,
        redraw: Redraw | None = None,
    ) -> None:
        """The end of the `lifeline` ends the run; what it says goes to `hear`."""
        self._world = world
        self._endpoints = endpoints
        self._restless = [endpoint for endpoint in endpoints if endpoint.restless]
        self._log = log
        self._stop = stop
        self._lifeline = lifeline
        self._hear = hear
        self._redraw = redraw
        self._redraw_ns = redraw.every_ns if redraw is not None else PACE_NOTED_NS
        self._drawn_ns = start_ns
        self._ends_ns: int | None = None
        self._slipped_ns = 0
        self._turn_ns = world.wall_ns(TURN_NS)
        self._start_ns = start_ns
        self._last_ns = start_ns
        self._said_ns = start_ns
        self._said_slip_ns = 0
        self.pace: Final = Pace(start_ns)
        self._watch: Final = ReadableSockets()
        self._watch.add(stop.sleeper, _STOP)
        if lifeline is not None:
            self._watch.add(lifeline, _LIFELINE)
        for endpoint in endpoints:
            endpoint.attach(self._watch)

    def run(self) -> int:
        """The exit code."""
        self._feed(self._due_inputs(), self._now())
        try:
            while self._stop.code is None:
                wait_ns = max(0, self._world.deadline_ns + self._slipped_ns - monotonic_ns())
                ready = self._watch.ready(wait_ns * 1e-9)
                now_ns = self._now()
                inputs = self._due_inputs()
                for source, owner in ready:
                    if owner >= 0:
                        inputs += self._endpoints[owner].read(source)
                    elif owner == _LIFELINE and self._lifeline is not None:
                        self._feel(self._lifeline, now_ns)
                self._feed(inputs, now_ns)
                self._show()
                if self._ends_ns is not None and now_ns >= self._ends_ns:
                    return 0
            return self._stop.code
        finally:
            self._watch.close()

    @property
    def mean_pace(self) -> float:
        """Simulated seconds per second since the start."""
        lived_ns = monotonic_ns() - self._start_ns
        return self._world.time_ns / lived_ns if lived_ns else 0.0

    def _now(self) -> int:
        """The pacer's wall time: the real one, less what it has slipped; at most a turn on."""
        real_ns = monotonic_ns()
        late_ns = real_ns - self._slipped_ns - self._last_ns - SLIP_NS
        if late_ns > 0:
            self._slipped_ns += late_ns
            behind_ns = self._slipped_ns - self._said_slip_ns
            if behind_ns > WORTH_SAYING_NS and real_ns - self._said_ns > SAID_EVERY_NS:
                self._said_ns, self._said_slip_ns = real_ns, self._slipped_ns
                text = (
                    f"cannot keep up: {self._slipped_ns / 1e9:.1f} s behind in all, "
                    f"{self.pace.reached:.2f} times real time lately"
                )
                self._log(Log("warning", "pacer", text))
        self._last_ns = min(real_ns - self._slipped_ns, self._last_ns + self._turn_ns)
        return self._last_ns

    def _due_inputs(self) -> list[Input]:
        return [given for endpoint in self._restless for given in endpoint.idle(monotonic_ns())]

    def _feed(self, inputs: list[Input], now_ns: int) -> None:
        for given in inputs or [Wake()]:
            for output in self._world.handle(given, now_ns):
                if isinstance(output, Transmit):
                    self._endpoints[output.link].send(output.peer, output.data)
                else:
                    self._log(output)

    def _show(self) -> None:
        real_ns = monotonic_ns()
        if real_ns - self._drawn_ns < self._redraw_ns:
            return
        self._drawn_ns = real_ns
        self.pace.note(real_ns, self._world.time_ns)
        if self._redraw is not None:
            self._redraw.show(self.pace)

    def _feel(self, lifeline: ParentPipe, now_ns: int) -> None:
        said = lifeline.read()
        if said:
            if self._hear is not None:
                self._hear(said)
            return
        self._watch.drop(lifeline)
        self._lifeline = None
        self._ends_ns = now_ns + LIFELINE_GRACE_NS
