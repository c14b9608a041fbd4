"""`gcs log export`: records, and other logs, into files for other programs."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import click

from gcs.cli.log.files import SOURCE, TARGET, Target, new_file, told
from gcs.cli.record_files import reading_progress
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.logfile.exports.track import Track

Progress: TypeAlias = Callable[[int], None] | None


@click.command("export")
@click.argument("file", type=SOURCE)
@click.option(
    "-o", "--output", required=True, type=TARGET, help="The new file; its suffix is the format."
)
@click.option("--message", metavar="NAME", help="For .csv and .parquet: only this kind of message.")
def export_log(file: Path, output: Path, message: str | None) -> None:
    """Write FILE as .tlog, .csv, .parquet, .kml or .gpx, by the suffix of the new file.

    .tlog: the frames of a record; an imported .tlog comes out byte for byte. .csv and .parquet:
    each kind of message in a file of its own (flight.ATTITUDE.csv), or the one of --message. .kml
    and .gpx: where each vehicle was. FILE is a record, or a .tlog, .BIN or .ulg as it is.

    Examples: gcs log export flight.mcap -o flight.tlog  |
    gcs log export flight.tlog -o attitude.csv --message ATTITUDE
    """
    suffix = output.suffix.lower()
    write = _FORMATS.get(suffix)
    if write is None:
        raise click.UsageError(f"{output}: the suffix must be one of {', '.join(_FORMATS)}")
    if message is not None and suffix not in _BY_KIND:
        raise click.UsageError(f"--message is for {' and '.join(_BY_KIND)}")
    with told(file), reading_progress(file, "exporting") as bar:
        write(file, output, message, bar)


def _tlog(file: Path, output: Path, message: str | None, bar: Progress) -> None:
    from gcs.logfile.exports.tlog import export_tlog

    with new_file(output) as target:
        done = export_tlog(file, target, bar)
    click.echo(f"{output}: {done.frames} frames")
    if done.garbage_bytes:
        click.echo(f"with {done.garbage_bytes} damaged bytes of the file that it came from")
    if done.left_out:
        click.echo(f"left out: {done.left_out} refused frames and pieces of garbage")
    if done.damaged:
        click.echo(f"{done.damaged} damaged parts of {file} were skipped")


def _csv(file: Path, output: Path, message: str | None, bar: Progress) -> None:
    from gcs.logfile.exports.csv import export_csv

    with ExitStack() as files:

        def open_file(name: str) -> Target:
            return files.enter_context(new_file(_of_kind(output, name, message)))

        counts = export_csv(file, open_file, message, bar)
    for name, count in sorted(counts.items()):
        click.echo(f"{_of_kind(output, name, message)}: {count} messages")


def _of_kind(output: Path, name: str, message: str | None) -> Path:
    return output if message else output.with_suffix(f".{name}{output.suffix}")


def _kml(file: Path, output: Path, message: str | None, bar: Progress) -> None:
    from gcs.logfile.exports.maps import write_kml
    from gcs.logfile.exports.track import tracks_of

    _map(file, output, tracks_of(file, bar), write_kml)


def _gpx(file: Path, output: Path, message: str | None, bar: Progress) -> None:
    from gcs.logfile.exports.maps import write_gpx
    from gcs.logfile.exports.track import tracks_of

    _map(file, output, tracks_of(file, bar), write_gpx)


def _map(
    file: Path,
    output: Path,
    tracks: list[Track],
    write: Callable[[str, list[Track], Target], None],
) -> None:
    with new_file(output) as target:
        write(file.name, tracks, target)
    for track in tracks:
        click.echo(f"{output}: {track.name}, {len(track)} points")


def _parquet(file: Path, output: Path, message: str | None, bar: Progress) -> None:
    try:
        from gcs.logfile.exports.parquet import export_parquet
    except ModuleNotFoundError as error:
        hint = "pip install 'mavgate[parquet]'"
        raise ExitError(ExitCode.USAGE, "Parquet needs the package pyarrow", hint) from error
    with ExitStack() as files:

        def open_file(name: str) -> Target:
            return files.enter_context(new_file(_of_kind(output, name, message)))

        counts = export_parquet(file, open_file, message, bar)
    for name, count in sorted(counts.items()):
        click.echo(f"{_of_kind(output, name, message)}: {count} messages")


_FORMATS = {".tlog": _tlog, ".csv": _csv, ".parquet": _parquet, ".kml": _kml, ".gpx": _gpx}
_BY_KIND = (".csv", ".parquet")
