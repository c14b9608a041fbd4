"""What a `mavgate.toml` says, read strictly, and the file that `gcs config init` writes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import msgspec

from gcs import toml
from gcs.resources import POLICIES
from gcs.shell.endpoints import EndpointError, parse_endpoint
from gcs.tui.keymap import DEFAULT, Keymap, KeymapError, keymap, name_of, sign

LONGEST_TIMEOUT_S = 86_400.0


class Settings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Each key of the file; None where it says nothing.  Paths are absolute."""

    links: tuple[str, ...] | None = None
    policy: str | None = None
    log_dir: str | None = None
    timeout_s: Annotated[float, msgspec.Meta(ge=0.1, le=LONGEST_TIMEOUT_S)] | None = None
    keys: dict[str, tuple[str, ...]] | None = None


@dataclass(frozen=True, slots=True)
class SettingsFile:
    """One file, and where in it what stands."""

    settings: Settings
    document: toml.Document

    def line(self, *at: str) -> int:
        return self.document.line(at)

    @property
    def keymap(self) -> Keymap:
        return keymap(self.settings.keys or {})


def parse(text: str, path: Path) -> SettingsFile:
    """Raises TomlError: unknown keys, wrong types, what is no link, keys that are two actions'."""
    document = toml.read(text, str(path))
    return SettingsFile(_settings(document, document.data, path), document)


def errors_of(text: str, path: Path) -> list[toml.TomlError]:
    """What is wrong with each key by itself, and then with all together."""
    try:
        document = toml.read(text, str(path))
    except toml.TomlError as error:
        return [error]
    keys = document.data.get("keys")
    tables = keys if isinstance(keys, dict) else {}
    parts = [{key: value} for key, value in document.data.items() if not (key == "keys" and tables)]
    parts += [{"keys": {action: names}} for action, names in tables.items()]
    found: dict[str, toml.TomlError] = {}
    for part in (*parts, document.data):
        try:
            _settings(document, part, path)
        except toml.TomlError as error:
            found.setdefault(str(error), error)
    return list(found.values())


def _settings(document: toml.Document, data: Mapping[str, object], path: Path) -> Settings:
    settings = document.convert(Settings, data)
    for number, link in enumerate(settings.links or ()):
        try:
            parse_endpoint(link)
        except EndpointError as error:
            raise document.error(("links", number), str(error), error.hint) from None
    if settings.links == ():
        raise document.error(("links",), "names no link", "leave the key out")
    try:
        keymap(settings.keys or {})
    except KeymapError as error:
        raise document.error(("keys", error.action), error.what, error.hint) from None
    beside = path.absolute().parent
    policy, log_dir = settings.policy, settings.log_dir
    if policy is not None and policy not in POLICIES:
        policy = str(beside / policy)
    if log_dir is not None:
        log_dir = str(beside / log_dir)
    return msgspec.structs.replace(settings, policy=policy, log_dir=log_dir)


def template(link: str) -> str:
    """A file that changes nothing: every key with its default, as a comment."""
    return "\n".join([*_HEAD.format(link=link).splitlines(), *_keys(), ""])


_HEAD = """\
# mavgate.toml: what gcs does where no option says otherwise. Each line that begins with # is the
# default; take the # away to change it. `gcs config show` tells what holds, and why. Policy and
# folder are looked for beside this file.

# links = ["{link}"]   # where vehicles are: --link
# policy = "default"   # what the gate allows: default, lab, demo, or a file: --policy
# log_dir = "logs"     # where flights are recorded: --log-dir
# timeout_s = 10       # seconds to wait for a vehicle: --timeout

# [keys]               # of the keyboard station, by action; a key may be only one action's\
"""


def _keys() -> Sequence[str]:
    return [
        f"# {name_of(key)} = [{', '.join(_quoted(sign(name)) for name in key.names)}]"
        for key in DEFAULT.keys
    ]


def _quoted(name: str) -> str:
    return '"' + name.replace("\\", "\\\\") + '"'
