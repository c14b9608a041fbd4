"""A record cut into turns: one input, and all that was recorded of it and of what it led to.

A turn begins with the input's own message: one on `/session/input`, or a frame or garbage that a
link received.  What is recorded of one input has log_times without a gap; before the next input
there is one.  Reads of a stream that end within a frame are announced (`Pieces`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import TypeAlias

import msgspec

from gcs.audit.inputs import CannotReadError, Kept, datagram_of, kept_of
from gcs.audit.messages import INPUT_TOPIC, Attachments, InputMessage, Stored
from gcs.audit.seals import Altered, Missing, SealCheck
from gcs.record.parts import PartBegan, Seal
from gcs.session.inputs import ClientCame, Input
from gcs.vehicle.record_items import FaultKept, Pieces, Start


class RecorderTurn(Enum):
    """What the recorder does by the clock: repeat a state, write what belongs at the end."""

    TICK = "RecordTick"
    END = "RecordEnd"


@dataclass(frozen=True, slots=True)
class Unreadable:
    """An input that cannot be given to a session, and why."""

    why: str


Given: TypeAlias = Input | FaultKept | RecorderTurn | Unreadable


@dataclass(slots=True)
class Turn:
    """`given` was handled at `now_ns`; `messages` is what was recorded of that, in order."""

    now_ns: int
    given: Given
    messages: list[Stored] = field(default_factory=list)
    start: Start | None = None
    """The set-up, with the first input."""
    cut: bool = False
    """The record breaks off in it: there may have been more messages."""


class NoStartError(Exception):
    """The record does not begin with what a session is made with: `why`, and a `hint`."""

    def __init__(self, why: str, hint: str) -> None:
        super().__init__(why)
        self.hint = hint


@dataclass(slots=True)
class _Open:
    """The turn that is being read."""

    turn: Turn
    link: int = -1
    """Of a datagram or a read."""
    pieces: Pieces | None = None
    """As they were announced."""
    parts: list[Stored] = field(default_factory=list)
    """Its frames and garbage."""

    @property
    def wants_more(self) -> bool:
        return self.pieces is not None and len(self.parts) < self.pieces.items


class Turns:
    """`for turn in Turns(...)`; then look at `altered`, `missing`, `closed`."""

    def __init__(self, messages: Iterable[Stored], attachments: Attachments) -> None:
        self._messages = messages
        self._attachments = attachments
        self._seals = SealCheck()
        self._rests: dict[int, bytes] = {}
        self._clients: set[int] = set()
        """Links of MAVLink clients."""
        self._before: list[Stored] = []
        self._start: Start | None = None
        self._open: _Open | None = None
        self._last_ns = 0
        self.altered: list[Altered] = []
        self.missing: Missing | None = None
        """Where the record has a hole; nothing is read after it."""
        self.closed = False
        """The recorder was closed in order."""
        self.lost_input = False
        """The last input breaks off: it is left out."""

    def __iter__(self) -> Iterator[Turn]:
        """Raises NoStartError."""
        for message in self._messages:
            if self._seals.repeats:
                self._seals.message(message)
                continue
            kind, kept = self._kept(message)
            if isinstance(kept, PartBegan):
                self.missing = self._part(kept, message)
            else:
                self._checked(kept, message)
                if self._begins(message, kept):
                    yield from self._close(cut=False)
                    self._open = self._new(message, kind, kept)
                self._take(message, kept)
                self._last_ns = message.log_time_ns
            if self.missing is not None:
                break
        if self._start is None:
            raise NoStartError(
                "it holds no set-up of a session", "gcs log info tells what it holds"
            )
        yield from self._close(cut=not self.closed)

    # ------------------------------------------------------------------------------- reading

    def _kept(self, message: Stored) -> tuple[str, Kept | Unreadable | None]:
        """What the message says on `/session/input`; None for any other topic."""
        if message.topic != INPUT_TOPIC:
            return "", None
        try:
            said = msgspec.json.decode(message.data, type=InputMessage)
        except (msgspec.MsgspecError, UnicodeDecodeError) as error:
            return "", Unreadable(str(error))
        try:
            return said.kind, kept_of(said.kind, said.data, self._attachments)
        except CannotReadError as error:
            if said.kind == "Setup" and self._start is None:
                hint = "it was recorded before mavgate kept all that an audit needs"
                raise NoStartError(f"its set-up cannot be read: {error}", hint) from error
            return said.kind, Unreadable(str(error))

    def _part(self, part: PartBegan, message: Stored) -> Missing | None:
        if self._start is None:
            hint = f"name all files of {part.of} in one command, the first one first"
            raise NoStartError(f"it is part {part.part} of {part.of}, not its beginning", hint)
        return self._seals.begins_part(part, message)

    def _checked(self, kept: Kept | Unreadable | None, message: Stored) -> None:
        if isinstance(kept, Seal):
            match self._seals.seal(kept, message.log_time_ns):
                case Missing() as missing:
                    self.missing = missing
                case Altered() as altered:
                    self.altered.append(altered)
        self._seals.message(message)

    # -------------------------------------------------------------------------------- turns

    def _begins(self, message: Stored, kept: Kept | Unreadable | None) -> bool:
        """Whether an input begins here.  The set-up is recorded before the first one."""
        if isinstance(kept, Start):
            self._start = kept
            return False
        if self._start is None:
            return False
        if kept is not None:
            return True
        return message.came_in and not self._continues(message)

    def _continues(self, message: Stored) -> bool:
        """Whether a frame or garbage is one more of the datagram that is being read."""
        if self._open is None or self._open.link != _link(message):
            return False
        if self._open.pieces is not None:
            return self._open.wants_more
        return message.log_time_ns == self._last_ns + 1

    def _new(self, message: Stored, kind: str, kept: Kept | Unreadable | None) -> _Open:
        turn = Turn(message.log_time_ns, Unreadable("it breaks off"))
        if self._before:
            # The first input is handled with the set-up, at the same time.
            turn.start, turn.messages, self._before = self._start, self._before, []
            turn.now_ns = next(m.log_time_ns for m in turn.messages if m.topic == INPUT_TOPIC)
        match kept:
            case None:
                return self._datagram(turn, _link(message), None)
            case Pieces():
                return self._datagram(turn, kept.link, kept)
            case Seal():
                turn.given = RecorderTurn(kind)
                self.closed |= turn.given is RecorderTurn.END
            case Start() | PartBegan():
                raise AssertionError("neither begins a turn")
            case _:
                turn.given = kept
        return _Open(turn)

    def _datagram(self, turn: Turn, link: int, pieces: Pieces | None) -> _Open:
        assert self._start is not None
        if link not in self._clients and not 0 <= link < len(self._start.setup.endpoints):
            turn.given = Unreadable(f"there is no link {link}")
            return _Open(turn)
        return _Open(turn, link, pieces)

    def _take(self, message: Stored, kept: Kept | Unreadable | None) -> None:
        if self._open is None:
            self._before.append(message)
            return
        if kept is None and message.came_in and self._open.link >= 0:
            self._open.parts.append(message)
        self._open.turn.messages.append(message)

    def _close(self, *, cut: bool) -> Iterator[Turn]:
        """The turn that was open, whole."""
        if self._open is None:
            return
        turn, link, parts = self._open.turn, self._open.link, self._open.parts
        if cut and self._open.wants_more:
            self.lost_input = True
            return
        if isinstance(turn.given, ClientCame):
            self._clients.add(turn.given.link)
            self._rests.pop(turn.given.link, None)  # another one had this number before
        if link >= 0:
            pieces = self._open.pieces or Pieces(link, len(parts))
            try:
                turn.given = datagram_of(pieces, parts, self._rests.get(link, b""))
            except CannotReadError as error:
                turn.given = Unreadable(str(error))
            self._rests[link] = pieces.rest
        turn.cut = cut
        yield turn


def _link(message: Stored) -> int:
    """-1 where it names none."""
    try:
        return message.link
    except ValueError:
        return -1
