"""`gcs log import` and `export`: logs of other programs into records, and records into files for
other programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, TypeAlias

import click

from gcs.cli.records.files import FileOfKind, reading_progress
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.logfile.exports.track import Track
    from gcs.logfile.imports.result import Imported

SOURCE = FileOfKind(".tlog", ".bin", ".log", ".ulg", ".mcap")
TARGET = click.Path(dir_okay=False, path_type=Path)
Progress: TypeAlias = Callable[[int], None] | None
ExportKinds: TypeAlias = (
    "Callable[[Path, Callable[[str], Target], str | None, Progress], dict[str, int]]"
)


@click.command("import")
@click.argument("file", type=SOURCE)
@click.option("-o", "--output", required=True, type=TARGET, help="The new record (.mcap).")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def import_log(file: Path, output: Path, as_json: bool) -> None:
    """Make a record of FILE, a .tlog, an ArduPilot .BIN or .log (its text form) or a PX4 .ulg.

    All of it is kept, each kind of message on a topic of its own, damaged stretches too. Position,
    attitude, status, parameters and texts are on the topics of our own flights as well, so that the
    same layouts show it.

    Example: gcs log import flight.tlog -o flight.mcap
    """
    import json

    from gcs.logfile.imports.formats import importer_of
    from gcs.mcap_file.batch_writer import BatchWriter

    with told(file):
        run = importer_of(file)
        with new_file(output) as target, reading_progress(file, "importing") as bar:
            writer = BatchWriter(target)
            found = run(file, writer, bar)
            writer.finish()
    if as_json:
        values = {
            "path": str(output),
            "format": found.format,
            "read": found.read,
            "kinds": found.kinds,
            "garbage_bytes": found.garbage_bytes,
            "garbage_stretches": found.garbage_stretches,
            "garbage_at": found.garbage_at,
            "late": found.late,
            "messages": found.messages,
            "seconds": found.seconds,
        }
        click.echo(json.dumps(values))
        return
    _print_imported(found, output)


def _print_imported(found: Imported, output: Path) -> None:
    click.echo(
        f"{output}: {found.read} messages of {len(found.kinds)} kinds in {found.seconds:.1f} s, "
        f"from a {found.format}"
    )
    if found.garbage_stretches:
        click.echo(f"kept too: {found.damage}")
    if found.late:
        click.echo(f"{found.late} messages have times that do not fit to those around them")


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
    and .gpx: where each vehicle was. FILE is a record, or a .tlog, .BIN, .log or .ulg as it is.

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

    _each_kind(file, output, message, bar, export_csv)


def _parquet(file: Path, output: Path, message: str | None, bar: Progress) -> None:
    try:
        from gcs.logfile.exports.parquet import export_parquet
    except ModuleNotFoundError as error:
        hint = "pip install 'mavgate[parquet]'"
        raise ExitError(ExitCode.USAGE, "Parquet needs the package pyarrow", hint) from error
    _each_kind(file, output, message, bar, export_parquet)


def _each_kind(
    file: Path, output: Path, message: str | None, bar: Progress, export: ExportKinds
) -> None:
    with ExitStack() as files:

        def open_file(name: str) -> Target:
            return files.enter_context(new_file(_of_kind(output, name, message)))

        counts = export(file, open_file, message, bar)
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


_FORMATS = {".tlog": _tlog, ".csv": _csv, ".parquet": _parquet, ".kml": _kml, ".gpx": _gpx}
_BY_KIND = (".csv", ".parquet")


# ---------------------------------------------------------- one file is read, another written


@contextmanager
def told(source: Path) -> Iterator[None]:
    """What can be wrong with a log becomes one sentence and exit 4."""
    from gcs.mcap_file.errors import BadLogError

    try:
        yield
    except BadLogError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from error
    except OSError as error:
        raise ExitError(ExitCode.BAD_FILE, f"{source}: {error.strerror or error}") from error


@contextmanager
def new_file(path: Path) -> Iterator[Target]:
    """A file that must not exist yet; it is removed again where its writing ends in an error."""
    try:
        file = open(path, "xb")  # noqa: SIM115  closed below, before it may be removed
    except FileExistsError as error:
        raise ExitError(ExitCode.USAGE, f"{path}: exists already", "choose another name") from error
    except OSError as error:
        raise cannot_write(path, error) from error
    try:
        yield Target(file, path)
        file.close()
    except BaseException:
        file.close()
        path.unlink(missing_ok=True)
        raise


class Target:
    """A file whose errors are told as its own, not as those of the source."""

    def __init__(self, file: BinaryIO, path: Path) -> None:
        self._file = file
        self._path = path

    def write(self, data: bytes) -> int:
        try:
            return self._file.write(data)
        except OSError as error:
            raise cannot_write(self._path, error) from error


def cannot_write(path: Path, error: OSError) -> ExitError:
    return ExitError(ExitCode.RECORDER, f"{path}: cannot write: {error.strerror or error}")
