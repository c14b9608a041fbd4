"""Keys that a user has chosen: each key of `keys.py` by the name of its action, with other keys."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from gcs.tui.keys import SECTIONS, Key

Sections = tuple[tuple[str, tuple[Key, ...]], ...]

_NAMES: Final = {
    "turn(-15)": "yaw_left",
    "turn(15)": "yaw_right",
    **{f"pan('{way}')": f"pan_{way}" for way in ("north", "south", "west", "east")},
    "zoom(-1)": "zoom_in",
    "zoom(1)": "zoom_out",
}
_SPECIAL: Final = (
    *("enter", "space", "escape", "tab", "backspace", "delete", "insert", "home", "end"),
    *("up", "down", "left", "right", "pageup", "pagedown"),
    *(f"f{number}" for number in range(1, 13)),
)
_TEXTUAL: Final = {
    "commercial_at": "at",
    "hyphen_minus": "minus",
    "low_line": "underscore",
    "plus_sign": "plus",
    "reverse_solidus": "backslash",
    "solidus": "slash",
}
"""Signs that Textual calls otherwise than Unicode does."""
_SHOWN: Final = {
    "up": "↑",
    "down": "↓",
    "left": "←",
    "right": "→",
    "pageup": "PgUp",
    "pagedown": "PgDn",
    "enter": "Enter",
    "space": "Space",
    "escape": "Esc",
    "tab": "Tab",
}


class KeymapError(Exception):
    """`action` cannot have the keys that it was given, and why; `hint` says what could be."""

    def __init__(self, action: str, what: str, hint: str = "") -> None:
        super().__init__(f"{action}: {what}")
        self.action, self.what, self.hint = action, what, hint


@dataclass(frozen=True, slots=True)
class Keymap:
    """The keys of one screen, in the sections of its help."""

    sections: Sections = SECTIONS

    @property
    def keys(self) -> tuple[Key, ...]:
        return tuple(key for _, keys in self.sections for key in keys)

    @property
    def actions(self) -> dict[str, str]:
        """By the name of the key as Textual calls it."""
        return {name: key.action for key in self.keys for name in key.names}

    @property
    def abort(self) -> str:
        """The one key that acts even under an open help page."""
        return next(key.names[0] for key in self.keys if name_of(key) == "abort")

    @property
    def moves(self) -> str:
        """The keys that move the pending goal, as one item of the footer."""
        shown = [self._shown(name) for name in ("north", "south", "west", "east", "up", "down")]
        return "".join(shown[:4]) + " " + " ".join(shown[4:])

    def _shown(self, action: str) -> str:
        key = next(key for key in self.keys if name_of(key) == action)
        return key.shown.split()[-1 if action in ("up", "down") else 0]


DEFAULT: Final = Keymap()


def name_of(key: Key) -> str:
    """Of its action, as a user writes it: `move('north')` is north, `request('abort')` abort."""
    quoted = re.search(r"'(\w+)'", key.action)
    return _NAMES.get(key.action, quoted[1] if quoted else key.action)


ACTIONS: Final = tuple(name_of(key) for key in DEFAULT.keys)


def keymap(changes: Mapping[str, Sequence[str]]) -> Keymap:
    """The usual keys, but those of `changes`, which are by the names of actions.

    Raises KeymapError: no such action, no such key, a key twice, an abort without a key.
    """
    chosen: dict[str, tuple[str, ...]] = {}
    for action, typed in changes.items():
        if action not in ACTIONS:
            near = difflib.get_close_matches(action, ACTIONS, n=1)
            hint = f"did you mean {near[0]}?" if near else f"actions: {', '.join(ACTIONS)}"
            raise KeymapError(action, "no such action", hint)
        if not typed and action == "abort":
            raise KeymapError(action, "has no key", "the one key that nobody can do without")
        chosen[action] = tuple(_textual(action, key) for key in typed)
    sections = tuple(
        (title, tuple(_with(key, chosen.get(name_of(key))) for key in keys))
        for title, keys in SECTIONS
    )
    _refuse_twice(Keymap(sections), chosen)
    return Keymap(sections)


def _with(key: Key, names: tuple[str, ...] | None) -> Key:
    if names is None:
        return key
    shown = " ".join(_SHOWN.get(name, sign(name)) for name in names)
    return replace(key, names=names, shown=shown)


def _refuse_twice(made: Keymap, chosen: Mapping[str, object]) -> None:
    owners: dict[str, str] = {}
    for key in made.keys:
        action = name_of(key)
        for name in key.names:
            other = owners.setdefault(name, action)
            if other != action or key.names.count(name) > 1:
                mine, theirs = (action, other) if action in chosen else (other, action)
                hint = f"give {theirs} another key, too: {theirs} = [...]"
                raise KeymapError(mine, f"the key {sign(name)} is that of {theirs}", hint)


def _textual(action: str, key: str) -> str:
    """What Textual calls a key that is written as a sign, or by its name."""
    if len(key) == 1:
        if key.isalnum():
            return key
        name = unicodedata.name(key, "").lower().replace("-", "_").replace(" ", "_")
        if name:
            return _TEXTUAL.get(name, name)
    word = key.lower()
    if word in _SPECIAL or re.fullmatch(r"ctrl\+[a-z]|shift\+(up|down|left|right)", word):
        return word
    near = difflib.get_close_matches(word, _SPECIAL, n=1)
    hint = f"did you mean {near[0]}?" if near else 'one sign such as "g" or "[", or ' + _WORDS
    raise KeymapError(action, f'"{key}" is no key', hint)


_WORDS: Final = ", ".join(_SPECIAL[:15]) + ", f1 to f12, ctrl+a"


def sign(name: str) -> str:
    """The sign of a key, as the operator reads and writes it; else its name."""
    for sign in "[]\\?+-=/.,;:'`!@#$%^&*()_{}|<>~":
        if _textual("", sign) == name:
            return sign
    return name
