"""What the rows of the table share: outcomes, common branches, and the plain cells.

Read a cell from the top: the first branch whose guards hold is the one.
"""

from __future__ import annotations

from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.rules import Answer, Branch, Cell, Do, End, Guard
from gcs.gate.refusal import Code
from gcs.gate.states import State

COMPLETE: Final = End(OutcomeKind.COMPLETE)
STOPPED: Final = End(OutcomeKind.ABORTED, Code.OPERATOR)
MISSED: Final = End(OutcomeKind.TIMED_OUT, Code.DEADLINE)
SILENT: Final = End(OutcomeKind.TIMED_OUT, Code.NO_ANSWER)
DENIED: Final = End(OutcomeKind.ABORTED, Code.VEHICLE_REFUSED)
SEVERE: Final = End(OutcomeKind.ABORTED, Code.SEVERITY)
DESERTED: Final = End(OutcomeKind.ABORTED, Code.OPERATOR_LOST)
MOVED: Final = End(OutcomeKind.ABORTED, Code.HOME_MOVED)
JUDGED: Final = End(OutcomeKind.ABORTED, judged=True)
TAKEN: Final = End(OutcomeKind.TAKEN_OVER, Code.MODE_CHANGED)

GONE: Final = Branch(when=(Guard.OPERATOR_GONE,), refuse=Code.OPERATOR_LOST)
"""Nobody is there any more to want this: a late request withdraws no hold."""

imposs: Final[Cell] = ()
stay: Final[Cell] = (Branch(),)
done: Final[Cell] = (Branch(answer=Answer.DONE),)
sile: Final[Cell] = (Branch(ends=SILENT),)

RETAKE: Final = (Guard.AIRBORNE, Guard.SEVERITY_PERMITS, Guard.HERE_CLEARS)
"""What it takes to end a take-off or a mission in HOVERING."""


def refuse(code: Code) -> Cell:
    """Refused, whatever else."""
    return (Branch(refuse=code),)


def hold_then(end: End) -> Branch:
    """End the request so, command HOLD, and stay in HOLDING until somebody resumes."""
    return Branch(ends=end, do=(Do.HOLD,), to=State.HOLDING)


def release_then(end: End, to: State) -> Branch:
    """The vehicle does something else than we asked: end the request, let control go."""
    return Branch(ends=end, do=(Do.RELEASE,), to=to)


def grounded(end: End) -> Branch:
    """Still on the ground, with a take-off or a mission under way: give it up."""
    return Branch(when=(Guard.ON_GROUND,), ends=end, do=(Do.RELEASE,), to=State.GROUNDED)


def give_up(end: End) -> Branch:
    """As `grounded`, and what was commanded may come yet: hold what it may fly, and disarm."""
    do = (Do.RELEASE, Do.HOLD_BLIND, Do.DISARM)
    return Branch(when=(Guard.ON_GROUND,), ends=end, do=do, to=State.GROUNDED)


def let_go(end: End, *when: Guard) -> Cell:
    """STALE: no verified point is left to stream to; hold, and come back to HOLDING."""
    return (Branch(when=when, ends=end, do=(Do.LET_GO, Do.HOLD)), Branch())


def lose_control(end: End) -> Branch:
    """Control could not be taken; our command may yet take effect, so the vehicle is held."""
    return Branch(when=(Guard.TAKING,), ends=end, do=(Do.RELEASE, Do.HOLD_ONCE), to=State.EXTERNAL)


sile_ho: Final[Cell] = (lose_control(SILENT), Branch())
