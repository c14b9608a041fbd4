"""The vehicle's refusals with its reasons, which may come a moment after its answer."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from gcs.gate.effects import CommandKind
from gcs.gate.inputs import CommandEnded
from gcs.session.speedup_waits import Times
from gcs.session.work import ToGate, Work
from gcs.vehicle.talk.vehicle_texts import Words

REASON_WAIT_NS: Final = 150_000_000
"""How long a refusal waits for its reason: ArduPilot's text may leave a moment after its answer."""
WAITS_FOR_REASONS: Final = frozenset(
    {CommandKind.ARM, CommandKind.TAKE_OFF, CommandKind.START_MISSION, CommandKind.SET_MODE}
)
"""What nobody is stopped by: no refused hold, landing or disarming waits for words."""


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
                case ToGate(CommandEnded(kind=kind, result=result) as ended) if result:
                    text = self._text(kind, custom_mode, now_ns)
                    if text or kind not in WAITS_FOR_REASONS:
                        explained.append(ToGate(replace(ended, text=text)))
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
        return [ToGate(replace(ended, text=text)) for ended, text in zip(due, texts, strict=True)]

    def _text(self, kind: CommandKind, custom_mode: int, now_ns: int) -> str:
        if kind is CommandKind.ARM:
            return self._words.reasons_not_to_arm(custom_mode, self._arm_asked_ns, now_ns)
        return self._words.reasons(now_ns)
