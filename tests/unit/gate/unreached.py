"""Entries of the table that are never read: the event does not happen in these states.

`test_explore.py` confirms the list, both ways.  To alter such an entry changes nothing that can be
seen, and `tests/mutants` takes its mutants out of the count.  Entries without a branch
(`cannot_happen`) are not listed.

Nothing of the gate is imported: the mutants' runner imports it altered.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

HEARD_FIRST: Final = "the heartbeat that would tell it has left NO_VEHICLE before"
NO_COMMAND: Final = "no command of this kind waits for an answer there"
NO_CONTROL: Final = (
    "it is looked for where we have or take control, with something of ours to judge"
)
STREAM_BEGINS: Final = "a stream begins where no command waits for an answer, and sends none"
NO_MODE: Final = "no mode is waited for there, or a hold is, which has its own clock"
NO_HOLD: Final = "a hold is waited for in HOLDING, and in EXTERNAL where control was not taken"


@dataclass(frozen=True, slots=True)
class Unreached:
    """`event` is told by its value, the `states` by their names, with spaces between."""

    event: str
    states: str
    why: str

    @property
    def entries(self) -> list[str]:
        """As `STATE / event`, the name that mutants of an entry have."""
        return [f"{state} / {self.event}" for state in self.states.split()]


FLIGHT: Final = "TAKING_OFF HOVERING MOVING STREAMING TAKING_PICTURE FLYING_MISSION"

UNREACHED: Final = (
    Unreached("lost", "NO_VEHICLE", "it is lost already"),
    Unreached("position aged", "NO_VEHICLE", "ages are looked at of what is heard"),
    Unreached("breach predicted", "NO_VEHICLE GROUNDED EXTERNAL", NO_CONTROL),
    Unreached("clears no more", "NO_VEHICLE GROUNDED EXTERNAL", NO_CONTROL),
    Unreached("armed", "NO_VEHICLE", HEARD_FIRST),
    Unreached("armed", "TAKING_OFF", "a take-off is accepted of what is armed"),
    Unreached("disarmed", "NO_VEHICLE", HEARD_FIRST),
    Unreached("mode confirmed", "NO_VEHICLE", HEARD_FIRST),
    Unreached("mode confirmed", "MOVING STREAMING TAKING_PICTURE", NO_MODE),
    Unreached("mode overdue", "HOVERING MOVING STREAMING TAKING_PICTURE HOLDING", NO_MODE),
    Unreached("guided mode", "NO_VEHICLE", HEARD_FIRST),
    Unreached(
        "guided mode", "MOVING STREAMING TAKING_PICTURE", "it is the mode that this state has"
    ),
    Unreached("hold mode", "NO_VEHICLE", HEARD_FIRST),
    Unreached("take-off mode", "NO_VEHICLE", HEARD_FIRST),
    Unreached("mission mode", "NO_VEHICLE", HEARD_FIRST),
    Unreached("return mode", "NO_VEHICLE", HEARD_FIRST),
    Unreached("land mode", "NO_VEHICLE", HEARD_FIRST),
    Unreached("another mode", "NO_VEHICLE", HEARD_FIRST),
    Unreached("command accepted", "STREAMING", STREAM_BEGINS),
    Unreached("command refused", "STREAMING", STREAM_BEGINS),
    Unreached("command unanswered", "STREAMING", STREAM_BEGINS),
    Unreached("disarm refused", f"NO_VEHICLE {FLIGHT} HOLDING", NO_COMMAND),
    Unreached("hold refused", FLIGHT, NO_COMMAND),
    Unreached("hold unanswered", FLIGHT, NO_COMMAND),
    Unreached("deadline", "FLYING_MISSION", "a mission has no deadline"),
    Unreached("deadline", "STREAMING", "a stream has no deadline, and ends where it is silent"),
    Unreached(
        "control due",
        "NO_VEHICLE GROUNDED TAKING_OFF MOVING STREAMING TAKING_PICTURE FLYING_MISSION"
        " RETURNING LANDING HOLDING EXTERNAL",
        "control is being taken in HOVERING and STALE only",
    ),
    Unreached("hold due", f"{FLIGHT} RETURNING LANDING", NO_HOLD),
)
