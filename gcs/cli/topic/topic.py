"""`gcs topic`: what is on a link or in a record, topic by topic."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gcs.cli.options import AS_JSON, with_options
from gcs.cli.topic.reading import (
    Started,
    condition_of,
    decoded,
    ended_by_hand,
    nothing_heard,
    refuse_unknown,
    selected,
    selectors,
    value_of,
)
from gcs.cli.topic.source import FROM, LAST, LINK, LOG, SECONDS, TO, Where, print_now

if TYPE_CHECKING:
    from gcs.topics.rates import Crossings, Intervals, Rate
    from gcs.topics.selector import Path as FieldPath
    from gcs.topics.selector import Selector
    from gcs.topics.topic import Fields, Heard, Topic

LISTEN_S = 3.0
"""How long `list` and `info` listen on a link, where nobody says."""
EVERY_S = 1.0
"""How often `hz` prints on a link."""
ABOUT = """\
A topic is a MAVLink message of one component, /mavlink/1/1/ATTITUDE, or one of the record's own,
/vehicle/1/state. ATTITUDE alone means that of every component, ATTITUDE.roll one field of it; * and
? stand for any characters.

Without --log or --last it listens: to what the running station records, as it records it, or, where
none runs, on the link itself, without sending anything.
"""


@click.group(epilog=ABOUT)
def topic() -> None:
    """Messages on a link or in a record: list, echo, hz, info, show.

    Example: gcs topic hz LOCAL_POSITION_NED
    """
    import signal

    signal.signal(signal.SIGINT, signal.default_int_handler)


# ----------------------------------------------------------------------------------- list


@topic.command("list", epilog="Example: gcs topic list --last")
@click.argument("topics", nargs=-1, metavar="[TOPIC]...")
@with_options(LOG, LAST, LINK, SECONDS, FROM, TO, AS_JSON)
def list_topics(
    topics: tuple[str, ...],
    log_file: Path | None,
    last: bool,
    links: tuple[str, ...],
    seconds: float | None,
    from_s: float | None,
    to_s: float | None,
    as_json: bool,
) -> None:
    """The topics, their rates and types; on a link, after 3 s of listening (-t).

    A frame that a bridge passed on is counted once.
    """
    import msgspec

    from gcs.topics.rates import LIST_SPAN_S, Crossings, Intervals

    wanted = selectors(topics)
    found: dict[str, tuple[Topic, Intervals]] = {}
    where = Where(log_file, last, links, from_s, to_s)
    with ended_by_hand():
        crossings = Crossings(each_topic=True)
        for heard, _ in selected(where.heard(seconds or LISTEN_S), wanted):
            if not crossings.counts(heard):
                continue
            one = found.setdefault(heard.topic.name, (heard.topic, Intervals.over(None)))
            one[1].add(heard.time_ns)
    rows = [(each, times, times.rate(LIST_SPAN_S)) for _, (each, times) in sorted(found.items())]
    if not rows:
        raise nothing_heard(where, wanted)
    if as_json:
        told = [
            {"topic": e.name, "type": e.schema, "messages": t.total, "hz": r.hz if r else None}
            for e, t, r in rows
        ]
        click.echo(msgspec.json.encode(told).decode())
        return
    width = max(len(each.name) for each, _, _ in rows)
    click.echo(f"{'topic':{width}}  {'messages':>8}  {'Hz':>7}  type")
    for each, times, rate in rows:
        hz = f"{rate.hz:7.1f}" if rate else "      -"
        click.echo(f"{each.name:{width}}  {times.total:8d}  {hz}  {each.schema}")


# ----------------------------------------------------------------------------------- echo


@topic.command(epilog="Example: gcs topic echo LOCAL_POSITION_NED --filter 'z < -5' -n 1 --last")
@click.argument("topics", nargs=-1, required=True, metavar="TOPIC[.FIELD]...")
@click.option("-n", "count", type=click.IntRange(min=1), metavar="N", help="End after N messages.")
@click.option("--filter", "condition", metavar="EXPR", help="Only messages for which it is true.")
@with_options(LOG, LAST, LINK, SECONDS, FROM, TO, AS_JSON)
def echo(
    topics: tuple[str, ...],
    count: int | None,
    condition: str | None,
    log_file: Path | None,
    last: bool,
    links: tuple[str, ...],
    seconds: float | None,
    from_s: float | None,
    to_s: float | None,
    as_json: bool,
) -> None:
    """Print messages, or one field of them a line.

    EXPR compares fields, as in 'z < -5 and abs(vx) > 1', and enum values by their names, as in
    'system_status == MAV_STATE_ACTIVE'.
    """
    wanted = selectors(topics)
    keep = condition_of(condition)
    where = Where(log_file, last, links, from_s, to_s)
    refuse_unknown(wanted, where)
    printed = 0
    started = Started(where.heard(seconds))
    with ended_by_hand():
        for heard, fields, paths in decoded(started.heards(), wanted, keep):
            printed += 1  # first: Ctrl-C may come while it is printed
            for line in _echoed(
                heard, fields, paths, started.at_ns, as_json, several=len(wanted) > 1
            ):
                print_now(line)
            if count is not None and printed >= count:
                return
    if not printed and keep is None:
        raise nothing_heard(where, wanted)


def _echoed(
    heard: Heard,
    fields: Fields,
    paths: Sequence[FieldPath],
    start_ns: int,
    as_json: bool,
    *,
    several: bool,
) -> Iterator[str]:
    """The lines of one message; `paths` are the fields that are wanted of it, () for all."""
    import msgspec

    from gcs.topics.selector import path_text
    from gcs.topics.text import message_lines, value_text

    name = heard.topic.name
    if as_json:
        told: dict[str, Any] = {"topic": name, "time_ns": heard.time_ns}
        if all(paths):
            told["values"] = {path_text(path)[1:]: value_of(heard, fields, path) for path in paths}
        else:
            told["fields"] = fields
        yield msgspec.json.encode(told).decode()
    elif all(paths):
        for path in paths:
            text = value_text(value_of(heard, fields, path))
            yield f"{name}{path_text(path)}: {text}" if several else text
    else:
        yield f"# {name}  {(heard.time_ns - start_ns) / 1e9:.3f} s"
        yield from message_lines(heard.topic, fields)
        yield "---"


# ------------------------------------------------------------------------------------- hz


@topic.command(epilog="Example: gcs topic hz LOCAL_POSITION_NED -w 500")
@click.argument("topics", nargs=-1, required=True, metavar="TOPIC...")
@click.option(
    "-w",
    "--window",
    type=click.IntRange(min=2),
    metavar="N",
    help="Of the newest N messages; of a record, of every N in a row.  [default: 10000; of a "
    "record, all]",
)
@with_options(LOG, LAST, LINK, SECONDS, FROM, TO, AS_JSON)
def hz(
    topics: tuple[str, ...],
    window: int | None,
    log_file: Path | None,
    last: bool,
    links: tuple[str, ...],
    seconds: float | None,
    from_s: float | None,
    to_s: float | None,
    as_json: bool,
) -> None:
    """The rate of TOPIC: mean, and shortest, longest and spread of the times between messages.

    Judged on the times at which a station received them, not on when this program hears of them.
    A frame that a bridge passed on is counted once.
    """
    from gcs.topics.rates import DEFAULT_WINDOW, Crossings, Intervals

    wanted = selectors(topics)
    where = Where(log_file, last, links, from_s, to_s)
    refuse_unknown(wanted, where)
    kept = window if window is not None or where.recorded else DEFAULT_WINDOW
    found: dict[str, Intervals] = {}
    since: dict[str, int] = {}
    crossings = Crossings()
    next_s = time.monotonic() + EVERY_S
    with ended_by_hand():
        for heard in where.heard(seconds):
            for name in _names(heard, wanted, crossings):
                times = found.setdefault(name, Intervals.over(kept))
                times.add(heard.time_ns if heard else 0)
                since[name] = since.get(name, 0) + 1
                if where.recorded and kept is not None and times.total % kept == 0:
                    _print_rate(name, times.rate(), as_json, alone=False)
            if not where.recorded and time.monotonic() >= next_s:
                next_s += EVERY_S
                _print_rates(found, since, as_json)
                since.clear()
    if not found:
        raise nothing_heard(where, wanted)
    if since and not where.recorded:
        _print_rates(found, since, as_json)
    if where.recorded and kept is None:
        for name, times in sorted(found.items()):
            _print_rate(name, times.rate(), as_json, alone=len(found) == 1)


def _names(heard: Heard | None, wanted: Sequence[Selector], crossings: Crossings) -> list[str]:
    """The topic's name, if it is wanted and the message counts."""
    if heard is None or not crossings.counts(heard):
        return []
    if not any(one.path_in(heard.topic.name) is not None for one in wanted):
        return []
    return [heard.topic.name]


def _print_rates(found: dict[str, Intervals], since: dict[str, int], as_json: bool) -> None:
    if not since and not as_json:
        print_now("no new messages")
    for name, times in sorted(found.items()):
        if since.get(name):
            _print_rate(name, times.rate(), as_json, alone=len(found) == 1)
        elif since and not as_json:
            print_now(f"{name}  no new messages")


def _print_rate(name: str, rate: Rate | None, as_json: bool, *, alone: bool) -> None:
    import msgspec

    if as_json:
        measured = msgspec.structs.asdict(rate) if rate else {"hz": None}
        print_now(msgspec.json.encode({"topic": name, **measured}).decode())
        return
    text = (
        f"average rate: {rate.hz:.3f}  min: {rate.min_s:.4f} s  max: {rate.max_s:.4f} s  "
        f"std dev: {rate.std_dev_s:.5f} s  window: {rate.window}"
        if rate
        else "one message, no rate"
    )
    print_now(text if alone else f"{name}  {text}")


# ----------------------------------------------------------------------------------- info


@topic.command(epilog="Example: gcs topic info EXTENDED_SYS_STATE")
@click.argument("name", metavar="TOPIC")
@with_options(LOG, LAST, LINK, SECONDS, AS_JSON)
def info(
    name: str,
    log_file: Path | None,
    last: bool,
    links: tuple[str, ...],
    seconds: float | None,
    as_json: bool,
) -> None:
    """The fields of TOPIC with types, units and enum values; on a link or in a record who sends it.

    What a MAVLink message consists of is known without either.
    """
    import msgspec

    from gcs.topics.describe import message_info, topic_info
    from gcs.topics.rates import LIST_SPAN_S, Crossings, Intervals

    (selector,) = selectors((name,))
    known = message_info(selector.topic.rpartition("/")[2])
    where = Where(log_file, last, links)
    senders: dict[str, Intervals] = {}
    refuse_unknown([selector], where)
    looked = where.recorded or bool(links) or known is None
    if looked:
        with ended_by_hand():
            crossings = Crossings(each_topic=True)
            for heard, _ in selected(where.heard(seconds or LISTEN_S), [selector]):
                known = known or topic_info(heard.topic)
                if not crossings.counts(heard):
                    continue
                senders.setdefault(heard.topic.name, Intervals.over(None)).add(heard.time_ns)
    if known is None:
        raise nothing_heard(where, [selector])
    rates = {
        each: (times.total, times.rate(LIST_SPAN_S)) for each, times in sorted(senders.items())
    }
    if as_json:
        topics = [
            {"topic": each, "messages": total, "hz": rate.hz if rate else None}
            for each, (total, rate) in rates.items()
        ]
        told = {**msgspec.structs.asdict(known), "topics": topics}
        click.echo(msgspec.json.encode(told).decode())
        return
    click.echo(known.name if known.msgid is None else f"{known.name} (message {known.msgid})")
    for each, (total, rate) in rates.items():
        click.echo(f"  {each}: {total} messages" + (f", {rate.hz:.1f} Hz" if rate else ""))
    if looked and not rates:
        click.echo("  not heard")
    for field in known.fields:
        notes = [field.units, field.enum, "MAVLink 2 only" if field.extension else ""]
        noted = ", ".join(note for note in notes if note)
        click.echo(f"\n{field.type} {field.name}" + (f"  [{noted}]" if noted else ""), nl=False)
        for entry in field.values:
            click.echo(f"\n  {entry.value:>6}  {entry.name}", nl=False)
    click.echo()


# ----------------------------------------------------------------------------------- show


@topic.command(epilog="Example: gcs topic show LOCAL_POSITION_NED.z ATTITUDE.roll --last")
@click.argument("topics", nargs=-1, required=True, metavar="TOPIC.FIELD...")
@click.option(
    "-w",
    "--window",
    type=click.FloatRange(min=0.1, max=86_400.0),
    default=30.0,
    show_default=True,
    metavar="S",
    help="On a link: how many seconds are drawn.",
)
@click.option("--filter", "condition", metavar="EXPR", help="Only messages for which it is true.")
@with_options(LOG, LAST, LINK, SECONDS, FROM, TO)
def show(
    topics: tuple[str, ...],
    window: float,
    condition: str | None,
    log_file: Path | None,
    last: bool,
    links: tuple[str, ...],
    seconds: float | None,
    from_s: float | None,
    to_s: float | None,
) -> None:
    """Plot fields over time in the terminal, of a whole record or as they come."""
    from gcs.cli.topic.show import Plot

    wanted = selectors(topics)
    fieldless = [each.text for each in wanted if not each.path]
    if fieldless and not any("/" in text for text in fieldless):
        raise click.UsageError(f"{fieldless[0]}: name a field of it, such as ATTITUDE.roll")
    keep = condition_of(condition)
    where = Where(log_file, last, links, from_s, to_s)
    with Plot(None if where.recorded else window) as plot, ended_by_hand():
        for heard, fields, paths in decoded(where.heard(seconds), wanted, keep, plot.redraw):
            for path in paths:
                plot.add(heard, path, value_of(heard, fields, path))
    if not plot.curves:
        raise nothing_heard(where, wanted)
