"""`mavgate.toml`: what a user, or a project, has otherwise than the defaults of the options.

The user's file lies in the platform's folder of settings, the project's in the working folder or
the nearest above it.  The project's values go before the user's, and options before both.  A file
is read when a command needs one of its values, and not before: most need none.
"""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import click

from gcs.config import DEFAULT_LINK
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError, error_lines

if TYPE_CHECKING:
    from gcs.cli.settings_file import SettingsFile
    from gcs.tui.keymap import Keymap

NAME = "mavgate.toml"
ROOT = 0
"""Of a file that an administrator has made for all."""
KEYS = ("links", "policy", "log_dir", "timeout_s")
"""Of the file, but for the table [keys]."""
Level = Literal["user", "project"]


class Place(NamedTuple):
    """One of the files, whether it exists or not."""

    level: Level
    path: Path


class Value(NamedTuple):
    """What holds, and the file that says it; None: it is the default."""

    value: Any
    origin: Place | None
    line: int = 0


def user_place() -> Place:
    return Place("user", Path(click.get_app_dir("mavgate")) / NAME)


def project_place() -> Place | None:
    """The nearest file, from the working folder upwards; the user's own is not one."""
    try:
        here = Path.cwd()
    except OSError:
        return None  # the folder was removed
    found = next((each / NAME for each in (here, *here.parents) if (each / NAME).is_file()), None)
    return None if found is None or found == user_place().path else Place("project", found)


def places() -> list[Place]:
    """The files that exist, the one that counts most first."""
    project, user = project_place(), user_place()
    return [*([project] if project else []), *([user] if user.path.is_file() else [])]


def read(path: Path) -> SettingsFile:
    """Raises ExitError with BAD_FILE: what is wrong, file, line and hint."""
    from gcs import toml
    from gcs.cli.settings_file import parse

    try:
        _refuse_strangers(path)
        return parse(toml.decode(path.read_bytes(), str(path)), path)
    except toml.TomlError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from error
    except OSError as error:
        raise ExitError(ExitCode.BAD_FILE, f"{path}: {error.strerror}") from error


def errors_of(path: Path) -> list[ExitError]:
    """All that is wrong with a file; `read` tells the first of it."""
    from gcs import toml
    from gcs.cli.settings_file import errors_of

    try:
        read(path)
    except ExitError as first:
        try:
            found = errors_of(toml.decode(path.read_bytes(), str(path)), path)
        except (toml.TomlError, OSError):
            found = []
        return [ExitError(ExitCode.BAD_FILE, str(each), each.hint) for each in found] or [first]
    return []


def _refuse_strangers(path: Path) -> None:
    """A file in a folder above may be anybody's, and says what the gate allows."""
    if os.name != "posix" or path.stat().st_uid in (os.getuid(), ROOT):
        return
    hint = "its policy would count for yours; copy it, or work elsewhere"
    raise ExitError(ExitCode.BAD_FILE, f"{path}: belongs to another user", hint)


@cache
def _loaded(paths: tuple[Place, ...]) -> tuple[tuple[Place, SettingsFile], ...]:
    return tuple((place, read(place.path)) for place in paths)


def configured(name: str) -> Value | None:
    """What a file says of `name`; None where none does.

    Raises ExitError with BAD_FILE, but not for a stop, which no error in a file may keep back.
    """
    found = places()
    if not found:
        return None
    try:
        files = _loaded(tuple(found))
    except ExitError as error:
        if not _stops():
            raise
        _tell_once(str(error), error.hint)
        return None
    for place, file in files:
        value = getattr(file.settings, name)
        if value is not None:
            return Value(value, place, file.line(name))
    return None


def configured_keys() -> dict[str, Value]:
    """The keys of each action that a file names; the project's go before the user's."""
    keys: dict[str, Value] = {}
    for place, file in reversed(_loaded(tuple(places()))):
        for action, names in (file.settings.keys or {}).items():
            keys[action] = Value(names, place, file.line("keys", action))
    return keys


def configured_keymap() -> Keymap:
    """The keys of the screen.  Raises ExitError where two files give one key to two actions."""
    from gcs.tui.keymap import KeymapError, keymap

    keys = configured_keys()
    try:
        return keymap({action: value.value for action, value in keys.items()})
    except KeymapError as error:
        origin, line = keys[error.action].origin, keys[error.action].line
        assert origin is not None
        text = f"{origin.path}:{line}: keys.{error.action}: {error.what}"
        raise ExitError(ExitCode.BAD_FILE, text, error.hint) from error


def _stops() -> bool:
    from gcs.request_words import STOPS

    context = click.get_current_context(silent=True)
    return context is not None and context.info_name in STOPS


@cache
def _tell_once(text: str, hint: str) -> None:
    click.echo("\n".join(error_lines(f"{text} (left out, as this is a stop)", hint)), err=True)


def usual_links() -> list[str]:
    """Where vehicles are, if no link is named."""
    found = configured("links")
    return [DEFAULT_LINK] if found is None else list(found.value)


def usual_log_dir() -> Path:
    """Where records are looked for, if none is named."""
    found = configured("log_dir")
    return Path("logs" if found is None else found.value)


class Configured(click.Option):
    """An option whose default a file may change; its help shows the default without one."""

    def __init__(self, *args: Any, setting: str, **attributes: Any) -> None:
        super().__init__(*args, **attributes)
        self._setting = setting

    def get_default(self, ctx: click.Context, call: bool = True) -> Any:
        # Not for a help or a completion, which no error in a file is to spoil.
        found = configured(self._setting) if call and not ctx.resilient_parsing else None
        return super().get_default(ctx, call) if found is None else found.value
