"""A conversation with a link: ask, follow each request to its end, leave in good order.

`--plain`, the one-shot commands and the demo all talk through this; what they print is the
affair of the `watch` that they pass in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import msgspec

from gcs import ipc
from gcs.cli import words
from gcs.cli.exits import Exit, Fail
from gcs.gate.refusal import Code
from gcs.gate.states import LandedState, State
from gcs.shell.client import LinkDown, Polled, Readable

LEAVE_WAIT_S = 20.0
SETTLE_WAIT_S = 3.0
POLL_S = 0.5
UNKNOWN_LANDED = ("", LandedState.UNDEFINED.name)


class Link(Protocol):
    """What a conversation needs of a link; `LinkClient` is one."""

    def send(self, command: ipc.Command) -> bool: ...
    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled: ...
    def now_s(self) -> float: ...
    def close(self) -> LinkDown: ...


class Interrupt(Readable, Protocol):
    """Where a Ctrl-C is noted; `Interrupts` is one."""

    name: str

    def forget(self) -> None: ...


class Interrupted(Exception):  # noqa: N818  a wish to leave, not an error
    """The operator pressed Ctrl-C, or the process was told to end."""


@dataclass(slots=True)
class Asked:
    """One request on its way: settled once refused, superseded, or ended."""

    ask: ipc.Ask
    label: str
    verdict: ipc.VerdictEvent | None = None
    ending: ipc.EndingEvent | None = None

    @property
    def settled(self) -> bool:
        if self.ending is not None:
            return True
        return self.verdict is not None and self.verdict.outcome != "accepted"

    @property
    def completed(self) -> bool:
        return self.ending is not None and self.ending.ended == "complete"

    @property
    def exit(self) -> Exit:
        """What a one-shot command exits with because of it."""
        if self.completed:
            return Exit.DONE
        if self.verdict is None or self.ending is not None or not self.settled:
            vehicle_said_no = self.ending is not None and self.ending.code == Code.VEHICLE_REFUSED
            return Exit.REFUSED_BY_VEHICLE if vehicle_said_no else Exit.NOT_COMPLETED
        return _EXIT_OF_REFUSAL.get(self.verdict.code, Exit.REFUSED_BY_GATE)


_EXIT_OF_REFUSAL: dict[str, Exit] = {
    Code.NO_VEHICLE: Exit.NO_LINK,
    Code.VEHICLE_REFUSED: Exit.REFUSED_BY_VEHICLE,
    Code.NO_ANSWER: Exit.NOT_COMPLETED,
    Code.BAD_MISSION: Exit.BAD_FILE,
    Code.RECORDER_DOWN: Exit.RECORDER,
    "BAD_REQUEST": Exit.USAGE,  # the session's word for what is no request at all
}

Watch = Callable[[ipc.Event, Asked | None], None]
"""Told of every event, with the request it belongs to where there is one."""


class Dialogue:
    """One operator, one link.  Raises `Interrupted` from whatever waits, and `Fail` where the
    link dies before it said good-bye."""

    def __init__(self, link: Link, interrupts: Interrupt, watch: Watch) -> None:
        self._link = link
        self._interrupts = interrupts
        self._watch = watch
        self._leaving = False
        self._asked: dict[int, Asked] = {}
        self.hello: ipc.Hello | None = None
        self.snapshot: ipc.Snapshot | None = None
        self.trouble: ipc.Trouble | None = None
        self.down: LinkDown | None = None

    # ------------------------------------------------------------------------- waiting

    def until(
        self,
        done: Callable[[], bool],
        timeout_s: float | None = None,
        also: Sequence[Readable] = (),
    ) -> list[Readable]:
        """Follow the link until `done()`, the time is over, or one of `also` is readable."""
        start_s = self._link.now_s()
        while not done():
            left_s = POLL_S
            if timeout_s is not None:
                left_s = min(left_s, timeout_s - (self._link.now_s() - start_s))
                if left_s <= 0:
                    break
            ready = self.poll(left_s, also)
            if ready:
                return ready
        return []

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> list[Readable]:
        """Hear what there is, waiting at most `timeout_s`; which of `also` is readable."""
        polled = self._link.poll(timeout_s, (*also, self._interrupts))
        for heard in polled.heard:
            if isinstance(heard, LinkDown):
                self.down = heard
            else:
                self._hear(heard)
        if self.down is not None and not self._leaving:
            raise self._death()
        if self._interrupts.name and not self._leaving:
            raise Interrupted(self._interrupts.name)
        return [source for source in polled.ready if source is not self._interrupts]

    def connect(self, timeout_s: float) -> ipc.Snapshot:
        """Wait for a vehicle with a position, a home and a landed state.

        Fails with NO_LINK where none is heard.  A vehicle that was heard but is not complete in
        time is given back as it is: the gate knows best what it can still do.
        """
        self.until(self._position_known, timeout_s)
        if self.snapshot is None or not self.snapshot.vehicle:
            where = ", ".join(self.hello.endpoints) if self.hello else "the link"
            raise Fail(
                Exit.NO_LINK,
                f"no vehicle heard within {timeout_s:g} s ({where})",
                "start one with `vehicle-sim`, use `gcs fly --sim`, or name the link with --link",
            )
        self.until(self._can_be_judged, SETTLE_WAIT_S)
        return self.snapshot

    # -------------------------------------------------------------------------- asking

    def ask(self, ask: ipc.Ask, label: str = "") -> Asked:
        """Send one request; it is followed from here on."""
        number = len(self._asked) + 1
        asked = Asked(msgspec.structs.replace(ask, id=number), label or words.label(ask))
        self._asked[number] = asked
        self._link.send(asked.ask)
        return asked

    def settle(self, asked: Asked, timeout_s: float | None = None) -> Asked:
        """Wait until `asked` is refused, superseded or ended."""
        self.until(lambda: asked.settled, timeout_s)
        return asked

    def perform(self, request: words.Request, label: str = "") -> list[Asked]:
        """Send its asks one after the other, each once the one before is complete."""
        done: list[Asked] = []
        for ask in request.asks:
            alone = len(request.asks) == 1
            done.append(self.settle(self.ask(ask, label if alone else "")))
            if not done[-1].completed:
                break
        return done

    def take_control(self) -> Asked | None:
        """Take control of a vehicle that flies without us; None where there is no need."""
        assert self.snapshot is not None
        if self.snapshot.state == State.EXTERNAL.name:
            return self.settle(self.ask(ipc.Ask(0, "control")))
        if self.snapshot.state == State.HOLDING.name:
            return self.settle(self.ask(ipc.Ask(0, "resume")))
        return None

    def first_failure(self) -> Exit:
        """The exit code of the first request that was not completed, DONE where all were."""
        return next((asked.exit for asked in self._asked.values() if asked.exit), Exit.DONE)

    # ------------------------------------------------------------------------- leaving

    def leave(self, reason: str = "quit") -> LinkDown:
        """Say good-bye and wait: the link holds the vehicle first.  A second Ctrl-C lets go."""
        self._leaving = True
        self._interrupts.forget()
        if self.down is None:
            self._link.send(ipc.Leave(reason))
        self.until(lambda: self.down is not None or bool(self._interrupts.name), LEAVE_WAIT_S)
        return self._link.close()

    # ------------------------------------------------------------------------ internals

    def _hear(self, event: ipc.Event) -> None:
        asked: Asked | None = None
        match event:
            case ipc.Hello():
                self.hello = event
            case ipc.Snapshot():
                self.snapshot = event
            case ipc.VerdictEvent():
                asked = self._asked.get(event.id)
                if asked is not None:
                    asked.verdict = event
            case ipc.EndingEvent():
                asked = self._asked.get(event.id)
                if asked is not None:
                    asked.ending = event
            case ipc.ProgressEvent():
                asked = self._asked.get(event.id)
            case ipc.Trouble():
                self.trouble = event
            case _:
                pass
        self._watch(event, asked)

    def _position_known(self) -> bool:
        seen = self.snapshot
        return seen is not None and bool(seen.vehicle) and seen.pos_enu is not None

    def _can_be_judged(self) -> bool:
        """Before that a vehicle on the ground and one in the air look alike to the gate."""
        seen = self.snapshot
        if seen is None or seen.home_enu is None:
            return False
        return seen.landed not in UNKNOWN_LANDED and seen.state != State.STALE.name

    def _death(self) -> Fail:
        return death(self.down, self.trouble)


def death(down: LinkDown | None, trouble: ipc.Trouble | None) -> Fail:
    """Why the link ended although nobody asked it to."""
    if trouble is not None and trouble.exit_code:
        return Fail(trouble.exit_code, trouble.text, trouble.hint)
    if down is not None and down.bye is not None:
        return Fail(down.bye.exit_code or Exit.BUG, down.bye.sentence)
    code = None if down is None else down.exit_code
    tail = down.stderr_tail if down is not None else ""
    return Fail(
        Exit.BUG,
        f"the link process died (exit code {code}); the vehicle's own failsafe acts now",
        f"its last words:\n{tail}" if tail else "it left no word",
    )


def final_exit(down: LinkDown) -> int:
    """What the link itself says the exit code is: its good-bye's, or BUG where it gave none."""
    return Exit.BUG if down.bye is None else down.bye.exit_code
