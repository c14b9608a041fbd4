"""What the commands of `gcs topic` share: which messages are meant, decoded, and what is wrong."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.cli.topic.source import Heards, Where
    from gcs.topics.filters import Filter
    from gcs.topics.selector import Path as FieldPath
    from gcs.topics.selector import Selector
    from gcs.topics.topic import Fields, Heard, Topic, Value


class Started:
    """Passes messages on, and keeps the time of the first."""

    def __init__(self, heards: Heards) -> None:
        self._heards = heards
        self.at_ns = 0

    def heards(self) -> Heards:
        for heard in self._heards:
            if heard is not None and not self.at_ns:
                self.at_ns = heard.time_ns
            yield heard


def selectors(topics: Sequence[str]) -> list[Selector]:
    """Raises UsageError, also for a file in the place of a topic: no link would ever send it."""
    from gcs.topics.selector import Selector, SelectorError

    for each in topics:
        if "." in each and Path(each).is_file():
            hint = f"a record is named by --log: --log {each}"
            raise ExitError(ExitCode.USAGE, f"{each} is a file, not a topic", hint)
    try:
        return [Selector.parse(text) for text in topics]
    except SelectorError as error:
        raise _usage(error, error.hint) from error


def condition_of(condition: str | None) -> Filter | None:
    """Raises UsageError."""
    from gcs.topics.filters import Filter, FilterError

    try:
        return None if condition is None else Filter(condition)
    except FilterError as error:
        raise _usage(error, error.hint) from error


def _keeps(keep: Filter, topic: Topic, fields: Fields) -> bool:
    from gcs.topics.filters import FilterError

    try:
        return keep(topic, fields)
    except FilterError as error:
        raise _usage(error, error.hint) from error


def _usage(error: Exception, hint: str) -> ExitError:
    return ExitError(ExitCode.USAGE, str(error), hint)


def selected(
    heards: Heards, wanted: Sequence[Selector], idle: Callable[[], None] | None = None
) -> Iterator[tuple[Heard, list[FieldPath]]]:
    """Messages of the topics that are wanted, and which fields of them; without any, all."""
    known: dict[str, list[FieldPath]] = {}
    for heard in heards:
        if heard is not None:
            name = heard.topic.name
            paths = known.get(name)
            if paths is None:
                each = [one.path_in(name) for one in wanted]
                paths = known[name] = [path for path in each if path is not None]
            if paths or not wanted:
                yield heard, paths
        if idle is not None:
            idle()


def decoded(
    heards: Heards,
    wanted: Sequence[Selector],
    keep: Filter | None = None,
    idle: Callable[[], None] | None = None,
) -> Iterator[tuple[Heard, Fields, list[FieldPath]]]:
    """The same with their fields, where the condition `keep` holds.

    Messages that cannot be decoded are passed over and counted.  Raises ExitError where that are
    all, and for a condition that names what is not there.
    """
    from gcs.topics.topic import DecodeError

    passed_over: dict[str, tuple[int, str]] = {}
    any_decoded = False
    for heard, paths in selected(heards, wanted, idle):
        name = heard.topic.name
        try:
            fields = heard.fields()
        except DecodeError as error:
            passed_over[name] = (passed_over.get(name, (0, ""))[0] + 1, str(error))
            continue
        any_decoded = True
        if keep is None or _keeps(keep, heard.topic, fields):
            yield heard, fields, paths
    told = [f"{name}: {count} messages: {why}" for name, (count, why) in passed_over.items()]
    if told and not any_decoded:
        hint = "gcs topic list tells types; MAVLink, JSON and /log are decoded"
        raise ExitError(ExitCode.BAD_FILE, told[0], hint)
    for line in told:
        click.echo(f"gcs: passed over: {line}", err=True)


def value_of(heard: Heard, fields: Fields, path: FieldPath) -> Value:
    from gcs.topics.selector import SelectorError, value_at

    try:
        return value_at(fields, path, heard.topic.message)
    except SelectorError as error:
        if not heard.topic.is_mavlink:
            return None  # a JSON topic leaves out what is not known
        raise _usage(error, error.hint) from error


def nothing_heard(where: Where, wanted: Sequence[Selector]) -> ExitError:
    """Nothing that was wanted was there."""
    names = ", ".join(each.text for each in wanted) or "a message"
    if where.recorded:
        hint = _near(wanted) or f"gcs topic list --log {where.path} lists its topics"
        return ExitError(ExitCode.BAD_FILE, f"{where.path}: no {names} in it", hint)
    hint = _near(wanted) or "gcs topic list tells what is"
    return ExitError(ExitCode.NO_VEHICLE, f"{names}: not heard", hint)


def refuse_unknown(wanted: Sequence[Selector], where: Where) -> None:
    """What is written as MAVLink's names are, and is none of them, need not be waited for on a
    link.  Raises ExitError."""
    from gcs.wire.dialect import MESSAGES_BY_NAME

    for each in wanted if not where.recorded else ():
        name = each.topic.rpartition("/")[2]
        if re.fullmatch("(?!UNKNOWN)[A-Z][A-Z0-9_]+", name) and name not in MESSAGES_BY_NAME:
            hint = _near([each]) or "gcs topic list tells what is sent"
            text = f"{each.text}: MAVLink has no message of that name"
            raise ExitError(ExitCode.USAGE, text, hint)


def _near(wanted: Sequence[Selector]) -> str:
    """The dialect's name that somebody may have meant."""
    import difflib

    from gcs.wire.dialect import MESSAGES_BY_NAME

    for each in wanted:
        name = each.topic.rpartition("/")[2].upper()
        if name not in MESSAGES_BY_NAME:
            near = difflib.get_close_matches(name, MESSAGES_BY_NAME, n=1)
            return f"did you mean {near[0]!r}?" if near else ""
    return ""


@contextmanager
def ended_by_hand() -> Iterator[None]:
    """Ctrl-C ends what listens in good order: what was heard until then counts."""
    try:
        yield
    except KeyboardInterrupt:
        click.echo()
