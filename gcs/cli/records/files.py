"""What the commands that read records share: errors in a sentence, a bar for a large file."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gcs.cli import completers
from gcs.cli.settings import usual_log_dir
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from gcs.mcap_file.reader import Progress
    from gcs.shell.stations import Description


class FileOfKind(click.Path):
    """A file that exists; a shell is offered those with one of the suffixes."""

    def __init__(self, *suffixes: str) -> None:
        super().__init__(exists=True, dir_okay=False, path_type=Path)
        self._complete = completers.files(*suffixes)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """Raises ExitError with BAD_FILE."""
        try:
            return Path(str(super().convert(value, param, ctx)))
        except click.BadParameter as error:
            hint = "gcs log info --last tells the newest record, and where it is"
            raise ExitError(ExitCode.BAD_FILE, error.message.rstrip("."), hint) from None

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        return self._complete(ctx, param, incomplete)


RECORD = FileOfKind(".mcap")
"""The type of an argument that names a record."""

LAST = click.option("--last", is_flag=True, help="The newest record of the log folder.")


def newest(files: Sequence[Path] = ()) -> Path:
    """The newest of these records, else of the log folder.  Raises ExitError if there is none."""
    folder = usual_log_dir()
    found = files or list(folder.glob("*.mcap"))
    if not found:
        raise ExitError(ExitCode.BAD_FILE, f"{folder}/: no record in it", "name one")
    begun_ns = {file: station.started_ns for file, station in _being_written().items()}

    def age(file: Path) -> int:
        """A record that is still written is as old as its station: a flight since is newer."""
        return begun_ns.get(file.resolve()) or file.stat().st_mtime_ns

    return max(found, key=age)


def still_written(file: Path) -> str:
    """That a running station writes this record, in words; empty where none does."""
    station = _being_written().get(file.resolve())
    return f"still being written by the running station of process {station.pid}" if station else ""


def _being_written() -> dict[Path, Description]:
    from gcs.operator.joined import running_stations

    return {Path(each.log_path).resolve(): each for each in running_stations() if each.log_path}


def one_record(file: Path | None, *, last: bool) -> Path:
    """FILE, or with --last the newest.  Raises UsageError where it is neither or both."""
    if file is not None and last:
        raise click.UsageError("--last is the newest record: leave out FILE, or --last")
    if file is None and not last:
        raise click.UsageError("Missing argument 'FILE'; --last is the newest record.")
    return file or newest()


def chosen(files: tuple[Path, ...], *, last: bool) -> tuple[Path, ...]:
    """FILE..., or with --last the newest of them, of the log folder where none is named.  Raises
    UsageError where it is neither."""
    if not (files or last):
        raise click.UsageError("Missing argument 'FILE...'; --last is the newest of logs/")
    return (newest(files),) if last else files


NEW_RECORD = click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="The new file; it must not exist.",
)

PROGRESS_FROM_BYTES = 20_000_000
"""Smaller files are read in less than a second."""


@contextmanager
def told(file: Path) -> Iterator[None]:
    """What can be wrong with a record becomes one sentence and exit 4."""
    from gcs.mcap_file.errors import BadRecordError

    try:
        yield
    except BadRecordError as error:
        raise ExitError(
            ExitCode.BAD_FILE,
            str(error),
            "gcs reads MCAP files, as it writes them into logs/; see gcs log import",
        ) from error
    except OSError as error:
        raise ExitError(ExitCode.BAD_FILE, f"{file}: {error.strerror or error}") from error


@contextmanager
def reading_progress(file: Path, label: str) -> Iterator[Progress | None]:
    """A bar on a terminal, for files that take over a second."""
    size = file.stat().st_size
    if size < PROGRESS_FROM_BYTES or not sys.stderr.isatty():
        yield None
        return
    with click.progressbar(length=size, label=label, file=sys.stderr) as bar:
        yield lambda read_bytes: bar.update(read_bytes - bar.pos)


@contextmanager
def writing(source: Path, output: Path) -> Iterator[None]:
    """What can be wrong with a file that is written from `source` becomes one sentence."""
    try:
        yield
    except FileExistsError as error:
        raise ExitError(
            ExitCode.USAGE, f"{output}: exists already", "choose another name"
        ) from error
    except OSError as error:
        if error.filename == str(source):
            raise
        text = f"{output}: cannot write: {error.strerror or error}"
        raise ExitError(ExitCode.RECORDER, text) from error
