"""The part of docs/bridge.md that is made of the tables of `gcs/bridge/translate`.

Run: python -m tests.unit.bridge.meaning_page, which writes it anew.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from gcs.bridge.conversation.answers import NUMBER_OF, result_of
from gcs.bridge.translate.commands import COMMANDS
from gcs.bridge.translate.meaning import Meaning, Words
from gcs.bridge.translate.modes import for_mode
from gcs.bridge.translate.translate import MESSAGES
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot, Mode
from gcs.wire.ids import Cmd
from tests.unit.bridge.vehicles import flying

PAGE = Path(__file__).parents[3] / "docs" / "bridge.md"
BEGIN = "<!-- from gcs/bridge/translate: begin -->\n"
END = "<!-- from gcs/bridge/translate: end -->\n"


def tables() -> str:
    """The page's last part."""
    lines = [
        "### Messages",
        "",
        *_table(("message", "the gate makes of it"), _messages()),
        "### Commands",
        "",
        "COMMAND_LONG and COMMAND_INT. A command that is not here is not motion, or denied:",
        "`gcs bridge --explain COMMAND` says which.",
        "",
        *_table(("command", "the gate makes of it"), _commands()),
        "### Modes",
        "",
        "Of a vehicle that flies. A mode of the sticks is refused, as nobody can say where it",
        "leads, unless `[bridge] manual_modes` names it. POSCTL, POSHOLD and LOITER of a client",
        "that sends sticks are flown by the gate: see sticks. Where `resume` would be refused, as",
        "in a return for a critical battery, a mode that means `hold`, then `resume` is refused",
        "before the hold, and stops nothing.",
        "",
        *_table(("mode", "hovering", "on hold", "returning"), _modes()),
        "### Reasons",
        "",
        "`COMMAND_ACK.result_param2` is the reason's number. Its name and sentence come as",
        "STATUSTEXT.",
        "",
        *_table(("number", "reason", "result"), _reasons()),
    ]
    return "\n".join(lines)


def _table(heads: tuple[str, ...], rows: Iterator[tuple[str, ...]]) -> Iterator[str]:
    yield _line(heads)
    yield _line(("---",) * len(heads))
    for row in rows:
        yield _line(row)
    yield ""


def _line(cells: tuple[str, ...]) -> str:
    return f"| {' | '.join(cells)} |"


def _messages() -> Iterator[tuple[str, ...]]:
    for row in MESSAGES.values():
        yield (row.name, row.says)


def _commands() -> Iterator[tuple[str, ...]]:
    for number, row in COMMANDS.items():
        yield (Cmd(number).name, row.says)


def _modes() -> Iterator[tuple[str, ...]]:
    for autopilot in (PX4, ARDUPILOT):
        for mode in autopilot.modes:
            if mode.meaning is not FlightMode.OTHER:
                states = (State.HOVERING, State.HOLDING, State.RETURNING)
                yield (mode.name, *(_asked(autopilot, mode, state) for state in states))


def _asked(autopilot: Autopilot, mode: Mode, state: State) -> str:
    return _words(for_mode(mode, flying(autopilot, state=state, mode_name="")))


def _words(meaning: Meaning) -> str:
    assert isinstance(meaning, Words)
    if [ask.word for ask in meaning.asks] == ["mode"]:
        return "refused"
    return ", then ".join(f"`{ask.word}`" for ask in meaning.asks)


def _reasons() -> Iterator[tuple[str, ...]]:
    for code, number in NUMBER_OF.items():
        yield (str(number), code.value, result_of(code).name)


def page_with(middle: str) -> str:
    """The page, that part replaced."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}{middle}{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(page_with(tables()), encoding="utf-8")
