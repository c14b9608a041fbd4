"""What a shell is offered for an argument or an option's value; nothing of it is loaded before."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

Completer = Callable[[click.Context, click.Parameter, str], "list[CompletionItem]"]


def files(*suffixes: str) -> Completer:
    """Files of a kind, and folders; where a folder is all that fits, what is in it."""

    def complete(_ctx: click.Context, _param: click.Parameter, typed: str) -> list[CompletionItem]:
        return _items(_files(typed, suffixes))

    return complete


def any_file(_ctx: click.Context, _param: click.Parameter, typed: str) -> list[CompletionItem]:
    """As the shell itself does."""
    from click.shell_completion import CompletionItem

    return [CompletionItem(typed, type="file")]


def folder(_ctx: click.Context, _param: click.Parameter, typed: str) -> list[CompletionItem]:
    from click.shell_completion import CompletionItem

    return [CompletionItem(typed, type="dir")]


def missions(_ctx: click.Context, _param: click.Parameter, typed: str) -> list[CompletionItem]:
    """Mission files, and the names of those that are shipped."""
    from gcs import resources

    shipped = [name.rpartition(".")[0] for name in resources.shipped()]
    return _items([*_files(typed, resources.SUFFIXES), *_beginning(shipped, typed)])


def policies(_ctx: click.Context, _param: click.Parameter, typed: str) -> list[CompletionItem]:
    """Those that are shipped, and TOML files."""
    from gcs.resources import POLICIES

    return _items([*_beginning(POLICIES, typed), *_files(typed, (".toml",))])


def vehicles(_ctx: click.Context, _param: click.Parameter, typed: str) -> list[CompletionItem]:
    """System ids of the vehicles of running stations, with what they are."""
    from click.shell_completion import CompletionItem

    from gcs.operator.joined import running_stations

    found = {
        name.partition("/")[0]: name
        for each in running_stations()
        for name in each.vehicles or [each.vehicle]
        if name
    }
    return [CompletionItem(sysid, help=found[sysid]) for sysid in _beginning(found, typed)]


def modes(_ctx: click.Context, _param: click.Parameter, typed: str) -> list[CompletionItem]:
    """Flight modes of either autopilot."""
    from gcs.protocol.autopilot import ARDUPILOT, PX4

    names = [mode.name for autopilot in (PX4, ARDUPILOT) for mode in autopilot.modes]
    return _items(_beginning(names, typed.upper()))


def _items(values: Iterable[str]) -> list[CompletionItem]:
    from click.shell_completion import CompletionItem

    return [CompletionItem(value) for value in dict.fromkeys(values)]


def _beginning(words: Iterable[str], typed: str) -> list[str]:
    return [word for word in words if word.startswith(typed)]


def _files(typed: str, suffixes: tuple[str, ...]) -> Iterator[str]:
    head, name = os.path.split(typed)
    found = [(path, path.is_dir()) for path in _fitting(Path(head), name, suffixes)]
    if len(found) == 1 and found[0][1]:
        yield from _files(os.path.join(head, found[0][0].name, ""), suffixes)
        return
    for path, is_folder in found:
        yield os.path.join(head, path.name, "") if is_folder else os.path.join(head, path.name)


def _fitting(folder: Path, name: str, suffixes: tuple[str, ...]) -> list[Path]:
    """Files whose names begin so, hidden ones where that is typed, and folders that have any."""
    try:
        beside = sorted(Path(os.path.expanduser(folder)).iterdir())
    except OSError:
        return []
    return [
        path
        for path in beside
        if path.name.startswith(name)
        and (name.startswith(".") or not path.name.startswith("."))
        and (path.is_dir() or path.suffix.lower() in suffixes)
    ]
