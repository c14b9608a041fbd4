"""`gcs config`: what `mavgate.toml` says, whether it is right, and a first one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gcs.cli import settings
from gcs.cli.options import AS_JSON, LOG_DIR, POLICY, TIMEOUT, with_options
from gcs.config import DEFAULT_LINK
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError, error_lines

if TYPE_CHECKING:
    from collections.abc import Iterator

DEFAULTS: dict[str, Any] = {
    "links": [DEFAULT_LINK],
    "policy": POLICY.default,
    "log_dir": LOG_DIR.default,
    "timeout_s": TIMEOUT.default,
}


@click.group()
def config() -> None:
    """The file mavgate.toml: links, policy, log folder, keys, timeout.

    The user's file lies in the platform's folder of settings, the project's in the working folder
    or the nearest above it. The project's values go before the user's, options before both.
    """


@config.command(epilog="Example: gcs config show --json")
@with_options(AS_JSON)
def show(as_json: bool) -> None:
    """Each value that holds here, and where it comes from."""
    import msgspec

    found = list(_values())
    if as_json:
        places = [{"level": each.level, "path": str(each.path)} for each in settings.places()]
        values = [
            {
                "key": key,
                "value": value.value,
                "from": value.origin.level if value.origin else "default",
                "file": str(value.origin.path) if value.origin else "",
                "line": value.line,
            }
            for key, value in found
        ]
        click.echo(msgspec.json.encode({"files": places, "values": values}).decode())
        return
    shown = [(key, _text(value.value), _origin(value)) for key, value in found]
    widths = [max(len(row[column]) for row in shown) for column in (0, 1)]
    for key, text, origin in shown:
        click.echo(f"{key:<{widths[0]}}  {text:<{widths[1]}}  {origin}")
    if not settings.places():
        click.echo(f"no file: {settings.user_place().path}, or {settings.NAME} in a folder above")


def _values() -> Iterator[tuple[str, settings.Value]]:
    for name in settings.KEYS:
        found = settings.configured(name)
        yield name, found or settings.Value(DEFAULTS[name], None)
    for action, value in settings.configured_keys().items():
        yield f"keys.{action}", value


def _text(value: object) -> str:
    return ", ".join(value) if isinstance(value, list | tuple) else str(value)


def _origin(value: settings.Value) -> str:
    return f"{value.origin.path}:{value.line}" if value.origin else "default"


@config.command(
    epilog="Example: gcs config check mavgate.toml\n\n"
    "Exit codes: 0 in order, 3 there is no file, 4 a file is wrong."
)
@click.argument("files", nargs=-1, type=click.Path(path_type=Path), metavar="[FILE]...")
def check(files: tuple[Path, ...]) -> None:
    """Whether FILE, or each file that counts here, is right, its policy included."""
    from gcs.policy_file import PolicyFileError, load_policy

    paths = files or tuple(place.path for place in settings.places())
    if not paths:
        hint = "gcs config init writes one"
        raise ExitError(ExitCode.BAD_FILE, f"there is no {settings.NAME} here or above", hint)
    wrong = False
    for path in paths:
        errors = settings.errors_of(path)
        if not errors:
            read = settings.read(path)
            try:
                load_policy(read.settings.policy or "default")
            except PolicyFileError as error:
                text = f"{path}:{read.line('policy')}: policy: {error}"
                errors = [ExitError(ExitCode.BAD_FILE, text, error.hint)]
        for each in errors:
            click.echo("\n".join(error_lines(str(each), each.hint)), err=True)
        if not errors:
            click.echo(f"{path}: in order")
        wrong = wrong or bool(errors)
    if wrong:
        click.get_current_context().exit(ExitCode.BAD_FILE)
    settings.configured_keymap()


@config.command(epilog="Example: gcs config init --user")
@click.option("--user", is_flag=True, help="The user's file, in place of one in this folder.")
def init(user: bool) -> None:
    """Write a mavgate.toml that changes nothing: every key with its default, as a comment."""
    from gcs.cli.settings_file import template

    path = settings.user_place().path if user else Path(settings.NAME)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("x", encoding="utf-8") as file:
            file.write(template(DEFAULT_LINK))
    except FileExistsError:
        hint = "gcs config check looks whether it is right"
        raise ExitError(ExitCode.USAGE, f"{path}: exists already", hint) from None
    except OSError as error:
        raise ExitError(ExitCode.RECORDER, f"{path}: {error.strerror}") from error
    click.echo(f"{path}: written; gcs config show tells what holds")
