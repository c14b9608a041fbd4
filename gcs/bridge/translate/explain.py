"""What the gate makes of a message or command, in words: `gcs bridge --explain NAME`."""

from __future__ import annotations

from gcs.bridge.translate.commands import COMMANDS
from gcs.bridge.translate.translate import MESSAGES
from gcs.wire.ids import Cmd


def meaning_explanation(name: str) -> str | None:
    """One line about the message or command whose row is called `name`; None where it asks the
    gate for nothing."""
    says = {Cmd(number).name: row.says for number, row in COMMANDS.items()}
    says |= {row.name: row.says for row in MESSAGES.values()}
    return f"  the gate makes of it: {says[name]}" if name in says else None
