"""A stop that is asked for once and is for several vehicles."""

from __future__ import annotations

import msgspec

from gcs import ipc
from gcs.gate.effects import OutcomeKind, Ruling


class StopOfSeveral:
    """Each vehicle has a verdict and an ending of its own, in the record; the operator is answered
    once: accepted with the first that accepts it, ended when none is under way any more.

    It is complete if all are; else it ends as the first did that is not.
    """

    def __init__(self, count: int) -> None:
        self._left = count
        self._accepted = False
        self._refused: ipc.VerdictEvent | None = None
        self._endings: list[ipc.EndingEvent] = []

    def verdict(self, sysid: int, event: ipc.VerdictEvent) -> list[ipc.Event]:
        """What the operator is told when one vehicle has its verdict."""
        if event.outcome == Ruling.ACCEPTED.value:
            first, self._accepted = not self._accepted, True
            return [event] if first else []
        named = msgspec.structs.replace(event, sentence=f"vehicle {sysid}: {event.sentence}")
        self._refused = self._refused or named
        sentence = f"vehicle {sysid}: refused: {event.sentence}"
        aborted = OutcomeKind.ABORTED.value
        return self._over(ipc.EndingEvent(event.id, event.word, aborted, event.code, sentence))

    def ending(self, sysid: int, event: ipc.EndingEvent) -> list[ipc.Event]:
        """The same, when one has ended."""
        sentence = f"vehicle {sysid}: {event.sentence}"
        return self._over(msgspec.structs.replace(event, sentence=sentence))

    def _over(self, event: ipc.EndingEvent) -> list[ipc.Event]:
        self._left -= 1
        self._endings.append(event)
        if self._left:
            return []
        if not self._accepted:
            assert self._refused is not None
            return [self._refused]
        complete = OutcomeKind.COMPLETE.value
        undone = [each for each in self._endings if each.ended != complete]
        all_did = f"all {len(self._endings)} vehicles"
        return [undone[0] if undone else msgspec.structs.replace(event, sentence=all_did)]
