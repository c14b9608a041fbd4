"""What the vehicle says in words: its texts joined from their pieces, and its reasons for a no.

A STATUSTEXT longer than 50 characters comes in chunks.  PX4 ends a text that it also sends as an
EVENT with a TAB; where that text is lost, the event, which is asked for again, is told instead.
Reasons come as texts (ArduPilot's "Arm: ...", "PreArm: ...", PX4's "... denied") and as PX4's
events, before the COMMAND_ACK or right after it: a refusal waits a moment for them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Final

from gcs.gate.effects import CommandKind, Level
from gcs.gate.inputs import CommandEnded
from gcs.protocol.px4_event_words import WordedEvent, worded
from gcs.protocol.px4_events import ArmingChecks
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, Work
from gcs.wire.ids import Severity
from gcs.wire.messages import Event, Statustext

CHUNK_LENGTH: Final = 50
"""A chunk that is shorter is the last one."""
CHUNK_WAIT_NS: Final = 1_000_000_000
"""How long the other chunks of a text are waited for; what is there is told then."""
LOST: Final = "…"
"""In the place of a chunk that was lost."""

TEXT_WAIT_NS: Final = 1_000_000_000
"""An event is told in words where its text came neither so long before it nor so long after."""

REASON_AGE_NS: Final = 1_000_000_000
"""A warning is taken as the reason of a refusal that follows within this time."""
PREARM_AGE_NS: Final = 40_000_000_000
"""ArduPilot repeats its pre-arm texts every 30 s (ArduCopter, from memory)."""
PREARM: Final = ("PreArm: ", "Preflight Fail: ")
ARM: Final = ("Arm: ", "Arming denied", "Transition denied")
KEPT: Final = 20


STATUSTEXT_LEVEL: Final = {
    Severity.EMERGENCY: Level.FATAL,
    Severity.ALERT: Level.ERROR,
    Severity.CRITICAL: Level.ERROR,
    Severity.ERROR: Level.ERROR,
    Severity.WARNING: Level.WARNING,
    Severity.NOTICE: Level.INFO,
    Severity.INFO: Level.INFO,
    Severity.DEBUG: Level.DEBUG,
}

REASON_WAIT_NS: Final = 150_000_000
"""How long a refusal waits for its reason: ArduPilot's text may leave a moment after its answer."""
WAITS_FOR_REASONS: Final = frozenset(
    {CommandKind.ARM, CommandKind.TAKE_OFF, CommandKind.START_MISSION, CommandKind.SET_MODE}
)
"""What nobody is stopped by: no refused hold, landing or disarming waits for words."""


@dataclass(frozen=True, slots=True)
class Said:
    """One whole text; `severity` is MAV_SEVERITY as it came."""

    severity: int
    text: str


@dataclass(frozen=True, slots=True)
class _Untold:
    """An event whose text may still come, or came just before."""

    event: WordedEvent
    heard_ns: int


@dataclass(slots=True)
class _Pieces:
    severity: int
    until_ns: int
    chunks: dict[int, str] = field(default_factory=dict)
    last_seq: int | None = None

    @property
    def whole(self) -> bool:
        return self.last_seq is not None and len(self.chunks) == self.last_seq + 1

    def text(self) -> str:
        """In order, with a mark where chunks are missing."""
        end = max(self.chunks) + 1 if self.last_seq is None else self.last_seq + 1
        text = "".join(self.chunks.get(seq, LOST) for seq in range(end))
        return text if self.last_seq is not None else text + LOST


class Words:
    """The texts and events of one vehicle."""

    def __init__(self, times: Times) -> None:
        self._times = times
        self._coming: dict[tuple[int, int], _Pieces] = {}
        self._lately: deque[tuple[int, Said]] = deque(maxlen=KEPT)
        self._untold: list[_Untold] = []
        self._text_wait_ns = times.real_ns(TEXT_WAIT_NS)
        self._checks = ArmingChecks()

    @property
    def deadline_ns(self) -> int | None:
        """When a text of which chunks are missing is told as it is, or an event in place of its
        text."""
        texts = [pieces.until_ns for pieces in self._coming.values()]
        events = [untold.heard_ns + self._text_wait_ns for untold in self._untold]
        return min(texts + events, default=None)

    def text(self, compid: int, message: Statustext, now_ns: int) -> list[Said]:
        """A STATUSTEXT of the component `compid`: the texts that are whole now."""
        if message.id == 0:
            return self._say(message.severity, message.text, now_ns)
        key = compid, message.id
        pieces = self._coming.get(key)
        if pieces is None:
            until_ns = now_ns + self._times.real_ns(CHUNK_WAIT_NS)
            pieces = self._coming[key] = _Pieces(message.severity, until_ns)
        pieces.chunks[message.chunk_seq] = message.text
        if len(message.text) < CHUNK_LENGTH:
            pieces.last_seq = message.chunk_seq
        if not pieces.whole:
            return []
        del self._coming[key]
        return self._say(pieces.severity, pieces.text(), now_ns)

    def wake(self, now_ns: int) -> list[Said]:
        due = [key for key, pieces in self._coming.items() if now_ns >= pieces.until_ns]
        said: list[Said] = []
        for key in due:
            pieces = self._coming.pop(key)
            said += self._say(pieces.severity, pieces.text(), now_ns)
        waiting, self._untold = self._untold, []
        for untold in waiting:
            if now_ns < untold.heard_ns + self._text_wait_ns:
                self._untold.append(untold)
            elif not self._text_came(untold):
                said += self._say(untold.event.severity, untold.event.text, now_ns)
        return said

    def event(self, message: Event, now_ns: int) -> None:
        """An EVENT, in its order.  `wake` tells it where its text does not come."""
        self._checks.heard(message)
        event = worded(message)
        if event is not None:
            self._untold.append(_Untold(event, now_ns))

    def _text_came(self, untold: _Untold) -> bool:
        since_ns = untold.heard_ns - self._text_wait_ns
        return any(
            time_ns >= since_ns and said.text.startswith(untold.event.begins)
            for time_ns, said in self._lately
        )

    def _say(self, severity: int, text: str, now_ns: int) -> list[Said]:
        said = Said(severity, text.rstrip())
        if not said.text:
            return []
        self._lately.append((now_ns, said))
        return [said]

    # ----------------------------------------------------------------------------- reasons

    def reasons(self, now_ns: int) -> str:
        """Why a command was refused just now: the warnings of the last second."""
        since_ns = now_ns - self._times.real_ns(REASON_AGE_NS)
        texts = [
            said.text
            for time_ns, said in self._lately
            if time_ns >= since_ns and said.severity <= Severity.WARNING
        ]
        texts += [
            untold.event.text
            for untold in self._untold
            if untold.event.severity <= Severity.WARNING and not self._text_came(untold)
        ]
        return "; ".join(dict.fromkeys(texts))

    def reasons_not_to_arm(self, custom_mode: int, since_ns: int, now_ns: int) -> str:
        """Why arming was refused, asked for since `since_ns`; else what it warned of just now."""
        return self.against_arming(custom_mode, since_ns, now_ns) or self.reasons(now_ns)

    def against_arming(self, custom_mode: int, since_ns: int, now_ns: int) -> str:
        """What it has said against an arming, asked for since `since_ns` or not: texts, and failed
        arming checks."""
        prearm_ns = now_ns - self._times.real_ns(PREARM_AGE_NS)
        texts = [
            said.text.partition(": ")[2] or said.text
            for time_ns, said in self._lately
            if (time_ns >= since_ns and said.text.startswith(ARM))
            or (time_ns >= prearm_ns and said.text.startswith(PREARM))
        ]
        texts += self._checks.against_arming(custom_mode)
        return "; ".join(dict.fromkeys(texts))


def logged(said: Iterable[Said]) -> list[Log]:
    """The vehicle's texts as lines of the log, as severe as it says."""
    return [
        Log(STATUSTEXT_LEVEL[Severity(each.severity & 7)], "vehicle", each.text) for each in said
    ]


class Reasons:
    """Adds to each refusal what the vehicle said against it."""

    def __init__(self, words: Words, times: Times) -> None:
        self._words = words
        self._wait_ns = times.real_ns(REASON_WAIT_NS)
        self._arm_asked_ns = 0
        self._waiting: tuple[tuple[int, CommandEnded], ...] = ()

    @property
    def deadline_ns(self) -> int | None:
        """When a refusal has waited long enough."""
        return min((due_ns for due_ns, _ in self._waiting), default=None)

    def asked(self, kind: CommandKind, now_ns: int) -> None:
        """A command is on its way: what is said from now on may be about it."""
        if kind is CommandKind.ARM:
            self._arm_asked_ns = now_ns

    def explained(self, work: Iterable[Work], custom_mode: int, now_ns: int) -> list[Work]:
        """`work` with the reasons of the refusals in it; one that has none yet comes later.

        `custom_mode` is the vehicle's mode, as its heartbeat shows it.
        """
        explained: list[Work] = []
        for item in work:
            match item:
                case GateInput(CommandEnded(kind=kind, result=result) as ended) if result:
                    text = self._text(kind, custom_mode, now_ns)
                    if text or kind not in WAITS_FOR_REASONS:
                        explained.append(GateInput(replace(ended, text=text)))
                    else:
                        self._waiting = *self._waiting, (now_ns + self._wait_ns, ended)
                case _:
                    explained.append(item)
        return explained

    def wake(self, custom_mode: int, now_ns: int) -> list[Work]:
        """The refusals that have waited long enough."""
        due = [ended for due_ns, ended in self._waiting if now_ns >= due_ns]
        self._waiting = tuple(item for item in self._waiting if now_ns < item[0])
        texts = (self._text(ended.kind, custom_mode, now_ns) for ended in due)
        return [
            GateInput(replace(ended, text=text)) for ended, text in zip(due, texts, strict=True)
        ]

    def _text(self, kind: CommandKind, custom_mode: int, now_ns: int) -> str:
        if kind is CommandKind.ARM:
            return self._words.reasons_not_to_arm(custom_mode, self._arm_asked_ns, now_ns)
        return self._words.reasons(now_ns)
