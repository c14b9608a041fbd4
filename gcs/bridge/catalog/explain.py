"""The classification in words: `gcs bridge --explain NAME`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.bridge.catalog.row import Kind, Row
from gcs.bridge.catalog.tables import command_rows, message_rows

PREFIX: Final = "MAV_CMD_"

WHAT_IS_DONE: Final = {
    Kind.HARMLESS: "forwarded to the vehicle, unchanged",
    Kind.POINTING: "forwarded for the client in control, or for any while nobody is",
    Kind.MOTION: "a request of the client, which the gate decides as it does every operator's",
    Kind.CONFIGURATION: "decided by [bridge] of the policy; by default the strict way",
    Kind.DENIED: "refused, and the client is told; unless `extra_harmless` of [bridge] names it",
    Kind.CARRIER: "the command in it decides",
    Kind.LOCAL: "kept at the gate, never forwarded",
}


def explain(name: str) -> Row:
    """The row of what a person calls "DO_REPOSITION", "mav_cmd_do_reposition", "PARAM_SET" or "22".

    A number is a command's first, because commands are what people have numbers of.  Raises
    KeyError with a sentence that names close ones.
    """
    return _found(name)[2]


def explanation(name: str) -> str:
    """Some lines for a person: what it is, what the gate does with it, and why.

    Raises KeyError as `explain` does.
    """
    word, number, row = _found(name)
    prefix = PREFIX if word == "command" else ""
    return (
        f"{prefix}{row.name}, {word} {number}: {row.kind}\n"
        f"  from a client: {WHAT_IS_DONE[row.kind]}\n"
        f"  why: {row.why}"
    )


def _found(name: str) -> tuple[str, int, Row]:
    """What it is, its number, its row."""
    wanted = name.strip().upper()
    number = int(wanted) if wanted.isdecimal() else None
    tables: tuple[tuple[str, Mapping[int, Row]], ...] = (
        ("command", command_rows()),
        ("message", message_rows()),
    )
    for word, table in tables:
        if number is not None and number in table:
            return word, number, table[number]
    bare = wanted.removeprefix(PREFIX)
    for word, table in tables:
        for key, row in table.items():
            if row.name == bare and (word == "command" or bare == wanted):
                return word, key, row
    raise KeyError(_unknown(name, bare))


def _unknown(name: str, bare: str) -> str:
    import difflib  # only a wrong name needs it

    names = [row.name for table in (command_rows(), message_rows()) for row in table.values()]
    close = difflib.get_close_matches(bare, names, n=4)
    hint = f"; close to it: {', '.join(close)}" if close else ""
    return f"{name!r} is no message and no command of the dialect, so it is denied{hint}"
