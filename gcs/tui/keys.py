"""THE keys: one table that feeds the bindings, the footer and the help.

Directions are named by what the vehicle does.  Keys that move only change the pending goal;
nothing is sent before Enter, but in velocity mode.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Key:
    """`names` as Textual calls them, the first one first; `shown` as the operator reads it.

    `footer` is the short word in the footer, empty for keys that only the help lists.
    """

    names: tuple[str, ...]
    shown: str
    action: str
    help: str
    footer: str = ""
    loud: bool = False


ABORT: Final = "request('abort')"
ABORT_IN_A_LINE: Final = "ctrl+@"
"""Ctrl-Space, as Textual calls it."""
ALWAYS: Final = {ABORT_IN_A_LINE: ABORT, "ctrl+c": "leave"}
"""Keys that act even while a line is typed, whatever keys a user has chosen."""

SECTIONS: Final[tuple[tuple[str, tuple[Key, ...]], ...]] = (
    (
        "Pending goal",
        (
            Key(("up", "w"), "↑ w", "move('north')", "north"),
            Key(("down", "s"), "↓ s", "move('south')", "south"),
            Key(("left", "a"), "← a", "move('west')", "west"),
            Key(("right", "d"), "→ d", "move('east')", "east"),
            Key(("pageup", "r"), "PgUp r", "move('up')", "up"),
            Key(("pagedown", "f"), "PgDn f", "move('down')", "down"),
            Key(("left_square_bracket",), "[", "turn(-15)", "yaw left 15°"),
            Key(("right_square_bracket",), "]", "turn(15)", "yaw right 15°"),
            Key(("backslash",), "\\", "free_yaw", "yaw left to the autopilot"),
            Key(("x",), "x", "step", "step 0.1, 0.5, 1, 5, 10 m", "step"),
            Key(("v",), "v", "here", "to where the vehicle is"),
        ),
    ),
    (
        "Send",
        (
            Key(("enter",), "Enter", "send", "go to the pending goal", "send"),
            Key(
                ("space", "escape"),
                "Space",
                ABORT,
                "abort: stop this one (Esc too)",
                "ABORT",
                loud=True,
            ),
            Key(("A",), "A", "stop_all", "abort every vehicle"),
            Key(("h",), "h", "request('hold')", "hold in its own mode", "hold"),
            Key(("e",), "e", "request('resume')", "resume: hover under control", "resume"),
            Key(("c",), "c", "request('control')", "take control of it in flight", "control"),
            Key(("m",), "m", "request('arm')", "arm the motors", "arm"),
            Key(("M",), "M", "request('disarm')", "disarm on the ground"),
            Key(
                ("t",),
                "t",
                "take_off",
                "take off, 1.5 m at least",
                "take off",
            ),
            Key(("l",), "l", "request('land')", "land where it is", "land"),
            Key(("b",), "b", "request('rtl')", "back home and land", "home"),
            Key(("p",), "p", "request('photo')", "take a picture"),
            Key(("i",), "i", "fly_mission", "fly the mission (--mission)", "mission"),
            Key(("y",), "y", "velocity", "fly by velocity: step in m/s"),
            Key(("k",), "k", "switch_fence", "fence off and on (lab only)"),
        ),
    ),
    (
        "Station",
        (
            Key(("colon",), ":", "words", "type any word; Tab, ↑, Esc", "words"),
            Key(("tab",), "Tab", "next_vehicle", "show the next vehicle"),
            Key(("P",), "P", "preflight", "preflight: what fails"),
            Key(("I",), "I", "items", "mission panel, and back"),
            Key(("n",), "n", "acknowledge", "acknowledge the alarms"),
            Key(("o",), "o", "request('station_take')", "take over from another one"),
            Key(("plus", "equals_sign"), "+", "zoom(-1)", "map: closer"),
            Key(("minus",), "-", "zoom(1)", "map: farther"),
            Key(("shift+up",), "⇧↑", "pan('north')", "map: pan (a click: goal)"),
            Key(("shift+down",), "⇧↓", "pan('south')", "map: pan (a click: goal)"),
            Key(("shift+left",), "⇧←", "pan('west')", "map: pan (a click: goal)"),
            Key(("shift+right",), "⇧→", "pan('east')", "map: pan (a click: goal)"),
            Key(("z",), "z", "fit", "map: fit by itself"),
            Key(("slash",), "/", "search", "search the log; Esc ends it"),
            Key(("g",), "g", "log_level", "log: info, warnings, debug"),
            Key(("question_mark", "f1"), "?", "help", "this help", "help"),
            Key(
                ("q", "ctrl+c", "ctrl+q"),
                "q",
                "leave",
                "quit: held first; flying: q q",
                "quit",
            ),
        ),
    ),
)
