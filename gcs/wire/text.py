"""Text that comes from outside, as it may be shown: on a terminal, on a page, in a log line."""

from __future__ import annotations

from typing import Final

_KEPT: Final = frozenset("\t")
"""PX4 ends a text with it that it also sends as an event."""
_BLANK: Final = frozenset("\n\r\u2028\u2029")


def clean(text: str) -> str:
    """The text without what a terminal or a viewer would obey.

    Line ends become blanks, other characters that are not printable U+FFFD: C0 and C1 controls (so
    that no escape sequence is one), and those of the direction of writing.  Its length stays.
    """
    if text.isprintable():
        return text
    return "".join(map(_shown, text))


def _shown(letter: str) -> str:
    if letter.isprintable() or letter in _KEPT:
        return letter
    return " " if letter in _BLANK else "\N{REPLACEMENT CHARACTER}"
