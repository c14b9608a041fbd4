"""What the vehicle says in words: its texts joined from their pieces, and its reasons for a no.

A STATUSTEXT longer than 50 characters comes in chunks.  PX4 ends a text that it also sends as an
EVENT with a TAB.  Reasons come as texts (ArduPilot's "Arm: ...", "PreArm: ...", PX4's "... denied")
and as PX4's events, before the COMMAND_ACK or right after it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Final

from gcs.gate.effects import Level
from gcs.protocol.px4_events import ArmingChecks
from gcs.session.times import Times
from gcs.session.work import Log
from gcs.wire.ids import Severity
from gcs.wire.messages import Event, Statustext

CHUNK_LENGTH: Final = 50
"""A chunk that is shorter is the last one."""
CHUNK_WAIT_NS: Final = 1_000_000_000
"""How long the other chunks of a text are waited for; what is there is told then."""
LOST: Final = "…"
"""In the place of a chunk that was lost."""

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


@dataclass(frozen=True, slots=True)
class Said:
    """One whole text; `severity` is MAV_SEVERITY as it came."""

    severity: int
    text: str


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
        self._checks = ArmingChecks()

    @property
    def deadline_ns(self) -> int | None:
        """When a text of which chunks are missing is told as it is."""
        return min((pieces.until_ns for pieces in self._coming.values()), default=None)

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
        return said

    def event(self, message: Event) -> None:
        """An EVENT; the texts that go with others of them come too."""
        self._checks.heard(message)

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
        return "; ".join(dict.fromkeys(texts))

    def reasons_not_to_arm(self, custom_mode: int, since_ns: int, now_ns: int) -> str:
        """Why arming was refused, asked for since `since_ns`: texts, and failed arming checks."""
        prearm_ns = now_ns - self._times.real_ns(PREARM_AGE_NS)
        texts = [
            said.text.partition(": ")[2] or said.text
            for time_ns, said in self._lately
            if (time_ns >= since_ns and said.text.startswith(ARM))
            or (time_ns >= prearm_ns and said.text.startswith(PREARM))
        ]
        texts += self._checks.against_arming(custom_mode)
        return "; ".join(dict.fromkeys(texts)) or self.reasons(now_ns)


def logged(said: Iterable[Said]) -> list[Log]:
    """The vehicle's texts as lines of the log, as severe as it says."""
    return [
        Log(STATUSTEXT_LEVEL[Severity(each.severity & 7)], "vehicle", each.text) for each in said
    ]
