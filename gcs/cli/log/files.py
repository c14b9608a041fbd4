"""What the commands share that read one log file and write another."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import click

from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

SOURCE = click.Path(exists=True, dir_okay=False, path_type=Path)
TARGET = click.Path(dir_okay=False, path_type=Path)


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
