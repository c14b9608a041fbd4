"""`gcs graph`: who sends what to whom."""

from __future__ import annotations

from pathlib import Path

import click

from gcs.cli.options import AS_JSON, with_options
from gcs.cli.topic.source import FROM, LAST, LINK, LOG, SECONDS, TO, Where
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

LISTEN_S = 5.0
TEXT_FLOWS = 12


@click.command(
    epilog="Examples: gcs graph --last  |  gcs graph --log FILE --svg -o flight.svg\n\n"
    "Without --log or --last it listens for 5 s (-t): to what the running station records, or, "
    "where none runs, on the link itself."
)
@with_options(LOG, LAST, LINK, SECONDS, FROM, TO)
@click.option("--all", "whole", is_flag=True, help="Text: every kind of message, not the first 12.")
@click.option("--dot", is_flag=True, help="Print DOT, for Graphviz.")
@click.option("--svg", is_flag=True, help="Print a picture.")
@with_options(AS_JSON)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Write it there instead of printing it.",
)
def graph(
    log_file: Path | None,
    last: bool,
    links: tuple[str, ...],
    seconds: float | None,
    from_s: float | None,
    to_s: float | None,
    whole: bool,
    dot: bool,
    svg: bool,
    as_json: bool,
    output: Path | None,
) -> None:
    """Operators, gate, vehicles and recorder, and what passes between them, with rates."""
    import signal

    import msgspec

    from gcs.cli.running import station_for
    from gcs.cli.settings import usual_links
    from gcs.graph.svg import as_svg
    from gcs.graph.text import as_dot, as_text
    from gcs.graph.traffic import Traffic

    signal.signal(signal.SIGINT, signal.default_int_handler)
    if dot + svg + as_json > 1:
        raise click.UsageError("one of --dot, --svg, --json")
    where = Where(log_file, last, links, from_s, to_s)
    if where.recorded:
        traffic = Traffic(recorded=True, where=where.path.name)
    else:
        found = station_for(links or usual_links(), anywhere=not links)
        name = Path(found.log_path).name if found else ", ".join(links or usual_links())
        traffic = Traffic(recorded=found is not None, where=name)
    heard_any = False
    try:
        for heard in where.heard(seconds or LISTEN_S, traffic.learn):
            if heard is not None:
                heard_any = True
                traffic.hear(heard)
    except KeyboardInterrupt:
        click.echo(err=True)
    if not heard_any:
        if where.recorded:
            raise ExitError(ExitCode.BAD_FILE, f"{where.path}: no message in it")
        raise ExitError(ExitCode.NO_VEHICLE, f"{traffic.where}: nothing was heard")
    made = traffic.graph()
    if svg:
        text = as_svg(made)
    elif as_json:
        text = msgspec.json.encode(made).decode() + "\n"
    else:
        lines = as_dot(made) if dot else as_text(made, 10_000 if whole else TEXT_FLOWS)
        text = "\n".join(lines) + "\n"
    if output is None:
        click.echo(text, nl=False)
        return
    try:
        output.write_text(text, encoding="utf-8")
    except OSError as error:
        told = f"{output}: cannot write: {error.strerror or error}"
        raise ExitError(ExitCode.RECORDER, told) from error
