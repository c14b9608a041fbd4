"""The demo's flight as a table: what is asked, what is said about it, what must come of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from gcs.cli.dialogue import Asked, Dialogue
from gcs.cli.typed import parse_line
from gcs.cli.words import Request

STEP_WAIT_S: Final = 40.0
COMPLETE: Final = "complete"
ABORTED: Final = "aborted OPERATOR"
BUSY: Final = "refused BUSY"
OUTSIDE: Final = "refused OUTSIDE_FENCE"


@dataclass(frozen=True, slots=True)
class Step:
    """One request.  `{mission}` in the line stands for the mission file.

    Where `wait` is False the next step follows `pause_s` after the verdict, while this one is
    still under way.  A step that has something to `say` opens a paragraph: it begins when
    everything before has ended.
    """

    line: str
    expect: str = COMPLETE
    say: str = ""
    wait: bool = True
    pause_s: float = 0.0


SCRIPT: Final[tuple[Step, ...]] = (
    Step("arm", say="Motors on, and up: a take-off takes control and ends in a hover."),
    Step("takeoff 2"),
    Step("control"),
    Step("goto 1 0 2", say="The lab's goals, each verified before it is flown."),
    Step("goto 1 1 3"),
    Step("goto 0 1 2"),
    Step("goto 500 0 2", OUTSIDE, "A goal outside the fence: it never reaches the vehicle."),
    Step("photo", say="Taking a picture: a move that arrives meanwhile is refused.", wait=False),
    Step("goto 0 0 2", BUSY),
    Step(
        "goto 12 1 2",
        ABORTED,
        "A longer move; another one on top of it is refused; then an abort.",
        wait=False,
        pause_s=1.0,
    ),
    Step("goto 0 0 2", BUSY),
    Step("abort"),
    Step("resume", say="After an abort the vehicle holds until an explicit resume."),
    Step("goto 0 0 2"),
    Step("mission upload {mission}", say="A mission file: verified whole, uploaded, read back."),
    Step("mission start"),
    Step("land", say="Down again."),
    Step("disarm"),
)


@dataclass(slots=True)
class Flown:
    """A step and what became of it."""

    step: Step
    asked: Asked

    @property
    def came_to(self) -> str:
        """`complete`, `refused BUSY`, `aborted OPERATOR`, ..., in the words of `expect`."""
        verdict, ending = self.asked.verdict, self.asked.ending
        if ending is not None:
            code = "" if ending.ended == COMPLETE else ending.code
            return f"{ending.ended} {code}".rstrip()
        if verdict is None:
            return "no answer"
        if verdict.outcome == "accepted":
            return "not completed"
        return f"{verdict.outcome} {verdict.code}".rstrip()

    @property
    def as_expected(self) -> bool:
        return self.came_to == self.step.expect


def finish(dialogue: Dialogue, flown: Sequence[Flown]) -> None:
    """Wait until all that was asked has ended."""
    for one in flown:
        dialogue.settle(one.asked, STEP_WAIT_S)


def perform(dialogue: Dialogue, step: Step, mission_path: str) -> Flown:
    """Ask for it and wait as the step says."""
    line = parse_line(step.line.format(mission=f'"{mission_path}"'))
    assert line is not None
    assert isinstance(line.action, Request)
    asked = dialogue.ask(line.action.asks[0])
    if step.wait:
        dialogue.settle(asked, STEP_WAIT_S)
    else:
        dialogue.until(lambda: asked.verdict is not None, STEP_WAIT_S)
        dialogue.until(lambda: asked.settled, step.pause_s)
    return Flown(step, asked)
