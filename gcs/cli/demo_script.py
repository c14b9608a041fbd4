"""The demo's flight as a table: what is asked, what is said about it, what must come of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from gcs.operator.dialogue import Dialogue, TrackedRequest
from gcs.operator.line_parser import parse_line
from gcs.operator.request_words import SendRequests

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
    request: TrackedRequest

    @property
    def came_to(self) -> str:
        """`complete`, `refused BUSY`, `aborted OPERATOR`, ..., in the words of `expect`."""
        verdict, outcome = self.request.verdict, self.request.outcome
        if outcome is not None:
            code = "" if outcome.ended == COMPLETE else outcome.code
            return f"{outcome.ended} {code}".rstrip()
        if verdict is None:
            return "no answer"
        if verdict.outcome == "accepted":
            return "not completed"
        return f"{verdict.outcome} {verdict.code}".rstrip()

    @property
    def as_expected(self) -> bool:
        return self.came_to == self.step.expect


def wait_for_all(dialogue: Dialogue, flown: Sequence[Flown]) -> None:
    """Wait until every request is settled."""
    for one in flown:
        dialogue.wait_settled(one.request, STEP_WAIT_S)


def perform(dialogue: Dialogue, step: Step, mission_path: str) -> Flown:
    """Send its request and wait as the step says."""
    line = parse_line(step.line.format(mission=f'"{mission_path}"'))
    assert line is not None
    assert isinstance(line.action, SendRequests)
    request = dialogue.send(line.action.requests[0])
    if step.wait:
        dialogue.wait_settled(request, STEP_WAIT_S)
    else:
        dialogue.wait_until(lambda: request.verdict is not None, STEP_WAIT_S)
        dialogue.wait_until(lambda: request.settled, step.pause_s)
    return Flown(step, request)
