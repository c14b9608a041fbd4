"""Flight scripts for the whole session: the test turns the clock and speaks for the vehicle."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from gcs import ipc
from gcs.config import StationConfig
from gcs.frames import Vec3
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.session.effects import Effect
from gcs.session.inputs import Datagram, Input, OperatorLine, Wake
from gcs.session.setup import Setup
from gcs.station.session import Session
from tests.unit.station import told, wire
from tests.unit.station.wire import MS_NS, SECOND_NS, START_NS, Message

TICK_NS = 50 * MS_NS


class Script:
    """One session.  Every effect stays in `told`, with the time at which it came."""

    def __init__(
        self,
        *,
        policy: Policy = DEFAULT,
        config: StationConfig | None = None,
        endpoints: tuple[str, ...] = ("udpin://127.0.0.1:14540",),
        streams: frozenset[int] = frozenset(),
        waiting: frozenset[int] = frozenset(),
        log_path: str = "logs/a.mcap",
    ) -> None:
        self.now_ns = START_NS
        setup = Setup(
            config or StationConfig(), "test", policy, "", endpoints, log_path, streams, waiting
        )
        self.session = Session(setup, START_NS)
        self.timed: list[tuple[int, Effect]] = []
        self.sender = wire.Sender()
        self.reporting = False
        self.acknowledged = {511, 512}
        """SET_MESSAGE_INTERVAL and REQUEST_MESSAGE; the other commands are the test's to answer."""
        self.armed = False
        self.mode = wire.LOITER
        self.landed = wire.ON_GROUND
        self.pos_ned: Vec3 = (0.0, 0.0, 0.0)
        self._ticks = 0
        self._last_id = 0

    # --------------------------------------------------------------------------- inputs

    def feed(self, given: Input) -> list[Effect]:
        """One input, now."""
        effects = self.session.handle(given, self.now_ns)
        self.timed += [(self.now_ns, effect) for effect in effects]
        if self.reporting:
            for message in wire.sent(effects, "COMMAND_LONG"):
                if message.command in self.acknowledged:
                    self.hear(wire.ack(message.command))
        return effects

    def hear(self, *messages: Message, link: int = 0, mavlink1: bool = False) -> list[Effect]:
        """Messages of the vehicle, a datagram each."""
        frames = [self.sender.frame(message, mavlink1=mavlink1) for message in messages]
        return [effect for raw in frames for effect in self.feed(Datagram(link, raw))]

    def say(self, command: ipc.Command, client: int = 1) -> list[Effect]:
        return self.feed(OperatorLine(client, command))

    def ask(
        self,
        word: str,
        *,
        up_m: float | None = None,
        goal_enu: ipc.Maybe3 | None = None,
        path: str = "",
        mode: str = "",
        client: int = 1,
        operation: int = 0,
    ) -> int:
        """One request; its number."""
        self._last_id += 1
        ask = ipc.Ask(self._last_id, word, goal_enu, up_m=up_m, path=path, mode=mode)
        self.say(msgspec.structs.replace(ask, operation=operation), client)
        return self._last_id

    def report(self, link: int = 0) -> list[Effect]:
        """The vehicle says how it is: mode, on the ground or not, and where."""
        boot_ms = self.now_ns // MS_NS
        return self.hear(
            wire.heartbeat(armed=self.armed, mode=self.mode),
            wire.landed(self.landed),
            wire.position(boot_ms, self.pos_ned),
            link=link,
        )

    def wake(self, *, late_ms: float = 0.0) -> list[Effect]:
        """Let time pass to the session's deadline, and so much more."""
        self.now_ns = self.session.deadline_ns + round(late_ms * MS_NS)
        return self.feed(Wake())

    def run(self, seconds: float) -> list[Effect]:
        """Let time pass; the vehicle reports ten times a second where it does at all."""
        before = len(self.timed)
        until_ns = self.now_ns + round(seconds * SECOND_NS)
        while self.session.deadline_ns <= until_ns:
            self.now_ns = self.session.deadline_ns
            self._ticks += 1
            if self.reporting and self._ticks % 2 == 0:
                self.report()
            self.feed(Wake())
        self.now_ns = until_ns
        return [effect for _, effect in self.timed[before:]]

    # ------------------------------------------------------------------------- situations

    def met(self) -> Script:
        """A px4 on the ground, its home, origin and place known, in the record's first second."""
        self.reporting = True
        self.hear(wire.heartbeat(), wire.origin(), wire.home())
        self.run(0.5)
        return self

    def flying(self, up_m: float = 5.0) -> Script:
        """Flown by somebody else."""
        self.armed, self.landed = True, wire.IN_AIR
        self.mode, self.pos_ned = wire.POSCTL, (0.0, 0.0, -up_m)
        self.met()
        assert self.state == "EXTERNAL"
        return self

    def hovering(self, up_m: float = 5.0) -> Script:
        """Flown by us."""
        self.flying(up_m)
        self.ask("control")
        self.run(1.2)
        self.hear(wire.ack(176))  # DO_SET_MODE
        self.mode = wire.OFFBOARD
        self.run(0.3)
        assert self.state == "HOVERING"
        return self

    # -------------------------------------------------------------------------------- looks

    @property
    def told(self) -> list[Effect]:
        return [effect for _, effect in self.timed]

    @property
    def state(self) -> str:
        return self.session.gate.state.name

    @property
    def conditions(self) -> set[str]:
        return {condition.value for condition in self.session.gate.conditions}

    def times_ns(self, of: Callable[[Effect], bool]) -> list[int]:
        """When such effects came."""
        return [time_ns for time_ns, effect in self.timed if of(effect)]

    def sent(self, kind: str = "") -> list[Message]:
        return wire.sent(self.told, kind)

    def forget(self) -> None:
        """Look only at what comes from here on."""
        self.timed.clear()


def is_frame(kind: str) -> Callable[[Effect], bool]:
    """Whether an effect puts a message of that kind on the wire."""
    return lambda effect: bool(wire.sent([effect], kind))


def is_snapshot(effect: Effect) -> bool:
    return bool(told.snapshots([effect]))


def is_finish(effect: Effect) -> bool:
    return bool(told.finishes([effect]))
