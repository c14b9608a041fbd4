"""What frames the screen: header, footer, help, and the farewell."""

from __future__ import annotations

from itertools import groupby

from rich.table import Table
from rich.text import Text

from gcs.operator.text.control_text import operator_words
from gcs.tui import fleet, look
from gcs.tui.command_line import CommandLine
from gcs.tui.keymap import DEFAULT, Keymap
from gcs.tui.scene import Scene

CONTROL_COLUMNS = 26
"""What the header needs beside the name of the operator in control."""


def header(scene: Scene, columns: int) -> Text:
    """One line: who is flown, the state, and whether it is recorded."""
    seen = scene.snapshot
    left = Text(" mavgate ", "bold", end="", no_wrap=True)
    right = Text("", end="", no_wrap=True)
    if seen is None:
        left.append(" starting the link …", look.DIM)
        return left
    for mark in fleet.marks(seen):
        style = look.BAD if mark.lost else look.SEVERITY.get(mark.severity, look.BAD)
        number = f"[{mark.sysid}]" if mark.shown else f" {mark.sysid} "
        left.append(number, f"bold reverse {style}" if mark.shown else style)
    left.append(f" {seen.vehicle or 'no vehicle'}  ", look.PLAIN)
    left.append(f" {seen.state} ", f"reverse {look.SEVERITY.get(seen.severity, look.BAD)}")
    if scene.lost:
        left.append(f"  LINK LOST {_whole(seen.heartbeat_age_s)} s ", look.BAD)
    if not scene.fence_on:
        left.append("  FENCE OFF ", look.BAD)
    if not scene.in_control:
        left.append(f"  control: {_operator(scene, columns - left.cell_len)} ", look.WARN)
    if seen.recording:
        name = seen.log_path.replace("\\", "/").rsplit("/", 1)[-1]
        right.append("● ", look.BAD).append(f"{seen.recorded_mb:.1f} MB ", look.DIM)
        # The log's name is the first to go where there is no room: it is told at the end.
        if left.cell_len + right.cell_len + len(name) + 2 <= columns:
            right.append(f"{name} ", look.DIM)
    else:
        right.append("NOT RECORDED ", look.BAD)
    gap = columns - left.cell_len - right.cell_len
    return Text.assemble(left, " " * max(1, gap), right, end="", no_wrap=True)


def alarms(scene: Scene, columns: int) -> Text:
    """One line, there while anything is not acknowledged."""
    words = scene.alarms.words()
    standing = any(each.standing for each in scene.alarms.open)
    ends = "  n: noted "
    if len(words) + len(ends) + 3 > columns:
        words = words[: columns - len(ends) - 5] + " …"
    line = f" ▲ {words}".ljust(columns - len(ends)) + ends
    return Text(line, look.ALARM if standing else look.ALARM_OVER, no_wrap=True, end="")


def typing(line: CommandLine, columns: int) -> Text:
    """In place of the keys while a line is typed: what it may become, and the way out."""
    out = Text(" Esc leaves, Enter sends ", look.PLAIN, no_wrap=True, end="", overflow="ellipsis")
    if line.prompt == "/":
        out = Text(" Esc shows all again, Enter keeps what was found ", look.PLAIN, end="")
    out.append(" Esc Esc or Ctrl-Space ABORT", look.BAD)
    offers = line.hint() or ("Tab completes, ↑ ↓ earlier lines" if line.prompt == ":" else "")
    return Text.assemble((f" {offers}"[:columns], look.PENDING), "\n", out)


def question(scene: Scene) -> Text:
    """Before the operator of an armed vehicle leaves it."""
    count = 1 if scene.snapshot is None else fleet.flying(scene.snapshot)
    what, leave = (
        "The vehicle is in the air.",
        "Leave it?  It is told to hold, and nobody flies it then.",
    )
    if count > 1:
        what = f"{count} vehicles are in the air."
        leave = "Leave them?  They are told to hold, and nobody flies them then."
    elif not count:
        what = "The motors are armed, on the ground."
        leave = "Leave?  They stay armed until the vehicle disarms by itself; disarm first."
    return Text.assemble(
        (f"{what}\n\n", "bold"),
        f"{leave}\n\n",
        ("q or y", look.PENDING), " leaves    ",
        ("any other key", look.PENDING), " stays    ",
        ("Space", look.BAD), " ABORT",
        justify="center",
    )  # fmt: skip


def _operator(scene: Scene, columns: int) -> str:
    """Who is in control, with its program where there is room beside the size of the record."""
    operator = scene.snapshot.in_control if scene.snapshot else None
    whole = operator_words(operator, scene.talk.number)
    if len(whole) + CONTROL_COLUMNS <= columns:
        return whole
    return operator_words(operator, scene.talk.number, short=True)


def _whole(age_s: float | None) -> str:
    return "?" if age_s is None else f"{age_s:.0f}"


def footer(columns: int, keymap: Keymap = DEFAULT) -> Text:
    """The keys with a footer word, on as many lines as it takes."""
    lines = Text(end="", no_wrap=True)
    used = 0
    items = [(key.shown, key.footer, key.loud) for key in keymap.keys if key.footer]
    for shown, word, loud in ((keymap.moves, "move", False), *items):
        size = len(shown) + len(word) + 3
        if used and used + size > columns:
            lines.append("\n")
            used = 0
        lines.append(f" {shown}", look.BAD if loud else look.PENDING)
        lines.append(f" {word} ", look.BAD if loud else look.PLAIN)
        used += size
    return lines


def help_table(keymap: Keymap = DEFAULT) -> Table:
    """Every key, a row each, in two columns: as few rows as 80x24 has."""
    rows: list[tuple[Text, Text]] = []
    for title, keys in keymap.sections:
        rows.append((Text(), Text(title, "bold")))
        for told, group in groupby(keys, key=lambda key: key.help):
            rows.append((Text(_together([key.shown for key in group]), look.PENDING), Text(told)))
    half = (len(rows) + 1) // 2
    page = Table.grid(padding=(0, 3))
    columns = [Table.grid(padding=(0, 1)) for _ in range(2)]
    for n, (shown, told) in enumerate(rows):
        shown.justify = "right"
        columns[n // half].add_row(shown, told)
    page.add_row(*columns)
    return page


def _together(shown: list[str]) -> str:
    """Keys that do the same in other directions: `⇧↑↓←→`."""
    begin = shown[0][0]
    if len(shown) == 1 or not all(key.startswith(begin) for key in shown):
        return " ".join(shown)
    return begin + "".join(key.removeprefix(begin) for key in shown)


def farewell(scene: Scene) -> Text:
    """While the station holds the vehicle and closes the log."""
    state = scene.snapshot.state if scene.snapshot else "-"
    return Text.assemble(
        ("Leaving.\n\n", "bold"),
        "Waiting until the vehicle is seen holding and the log is closed ",
        (f"({state}).", look.DIM),
        justify="center",
    )
