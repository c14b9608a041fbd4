"""What the operator and the record are told, in short tuples.

Only here do the session's tests know how such a fact is written down.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeAlias, TypeVar

from gcs import ipc
from gcs.report import FrameItem, FramesItem, RecordItem
from gcs.session.effects import Effect, Emit, Finish, ReadFile, Record, WriteFile
from gcs.session.work import TellOperator, ToScreens

E = TypeVar("E")
Told: TypeAlias = Iterable[object]
"""Effects, or any work with effects in it."""

INFO, WARNING, ERROR, FATAL = 2, 3, 4, 5


def events(effects: Told, kind: type[E]) -> list[E]:
    """What the operator's screen is told, of one kind."""
    told = (
        effect.event for effect in effects if isinstance(effect, Emit | TellOperator | ToScreens)
    )
    return [event for event in told if isinstance(event, kind)]


def recorded(effects: Told, kind: str) -> list[Any]:
    """What the record is told, of one kind by its name: `FrameItem`, `InputItem`..."""
    items = (
        item
        for effect in effects
        if isinstance(effect, Record)
        for item in (one_by_one(effect.item) if kind == "FrameItem" else [effect.item])
    )
    return [item for item in items if type(item).__name__ == kind]


def one_by_one(item: RecordItem) -> list[RecordItem]:
    """Frames that were recorded in a row, each as an item of its own."""
    if isinstance(item, FramesItem):
        return [FrameItem(item.link, item.direction, raw) for raw in item.raws]
    return [item]


def separately(effects: Iterable[Effect]) -> list[Effect]:
    """The same, with every frame that was recorded as an effect of its own."""
    done: list[Effect] = []
    for effect in effects:
        if isinstance(effect, Record):
            done += [Record(item) for item in one_by_one(effect.item)]
        else:
            done.append(effect)
    return done


def verdicts(effects: Told) -> list[tuple[int, str, str]]:
    """(the client's number, accepted | refused | superseded, code)."""
    return [(e.id, e.outcome, e.code) for e in events(effects, ipc.VerdictEvent)]


def outcomes(effects: Told) -> list[tuple[int, str, str]]:
    """(the client's number, complete | aborted..., code)."""
    return [(e.id, e.ended, e.code) for e in events(effects, ipc.EndingEvent)]


def lines(effects: Told) -> list[tuple[int, str]]:
    """(level, text) of the log."""
    return [(e.level, e.text) for e in events(effects, ipc.LogEvent)]


def log(effects: Told) -> str:
    """All lines of the log."""
    return "\n".join(text for _, text in lines(effects))


def states(effects: Told) -> list[str]:
    """The states of the gate that were entered."""
    return [e.after for e in events(effects, ipc.StateEvent)]


def troubles(effects: Told) -> list[ipc.Trouble]:
    return events(effects, ipc.Trouble)


def snapshots(effects: Told) -> list[ipc.Snapshot]:
    return events(effects, ipc.Snapshot)


def finishes(effects: Told) -> list[Finish]:
    return [effect for effect in effects if isinstance(effect, Finish)]


def files(effects: Told) -> list[ReadFile | WriteFile]:
    return [effect for effect in effects if isinstance(effect, ReadFile | WriteFile)]


def frames(effects: Told) -> list[tuple[int, int, bytes]]:
    """(link, 0 received | 1 sent, bytes) of every frame in the record."""
    items = recorded(effects, "FrameItem")
    return [(i.link, int(i.direction), i.raw) for i in items]
