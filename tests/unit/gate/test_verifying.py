"""What the machine asks of the verifier, with memories that a flight seldom leads to.

Each function is asked by itself: a fact that is missing, or too old, is a refusal of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle, Polygon, Shape
from gcs.gate.inputs import Requested
from gcs.gate.machine import verifying
from gcs.gate.machine.memory import SECOND_NS, Goal, Memory
from gcs.gate.machine.step_context import StepContext
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo, TakeOff
from gcs.gate.states import State
from tests.unit.gate.airspace import at

HOME: Vec3 = (0.0, 0.0, 0.0)
HERE = at(3, 4, 5)
NOW_NS = 100 * SECOND_NS
FENCE = verifier_for(DEFAULT, "px4", HOME, None)
GOAL = GoTo(at(10, 0, 5))


def step(facts: Mapping[str, object] | None = None, *, age_s: float = 0.2) -> StepContext:
    """All is known and the vehicle stands at `HERE`, but for the memory's fields in `facts`."""
    memory = Memory(
        "px4", pos_ned=HERE, v_ned=HOME, home_ned=HOME, return_up_m=20.0, return_places=()
    )
    memory.verifier = FENCE
    memory.pos_ns = NOW_NS - round(age_s * SECOND_NS)
    for name, value in (facts or {}).items():
        assert hasattr(memory, name)
        setattr(memory, name, value)
    made = StepContext(DEFAULT, memory, NOW_NS)
    made.requested = Requested(1, "keyboard", TakeOff(2.0))
    return made


def code(refusal: Refusal | None) -> Code | None:
    return None if refusal is None else refusal.code


QUESTIONS: dict[str, Callable[[StepContext], Refusal | None]] = {
    "position": verifying.position,
    "climb": verifying.climb,
    "goal": lambda asked: verifying.goal(asked, GOAL),
    "return": verifying.return_path,
}


class TestEveryQuestion:
    @pytest.mark.parametrize("question", QUESTIONS)
    def test_it_is_cleared_where_all_is_known(self, question: str) -> None:
        asked = step()
        assert QUESTIONS[question](asked) is None
        assert asked.evidence
        assert asked.why is None

    @pytest.mark.parametrize(
        ("question", "missing", "expected"),
        [
            ("position", "verifier", Code.NO_ORIGIN),
            ("position", "pos_ned", Code.NO_POSITION),
            ("position", "v_ned", Code.STALE),
            ("climb", "verifier", Code.NO_ORIGIN),
            ("climb", "pos_ned", Code.NO_POSITION),
            ("goal", "verifier", Code.NO_ORIGIN),
            ("goal", "pos_ned", Code.NO_ORIGIN),
            ("goal", "v_ned", Code.NO_ORIGIN),
            ("return", "verifier", Code.RTL_BLOCKED),
            ("return", "home_ned", Code.RTL_BLOCKED),
            ("return", "return_up_m", Code.RTL_BLOCKED),
            ("return", "return_places", Code.RTL_BLOCKED),
            ("return", "pos_ned", Code.RTL_BLOCKED),
        ],
    )
    def test_each_fact_that_is_missing_refuses_it(
        self, question: str, missing: str, expected: Code
    ) -> None:
        asked = step({missing: None})
        assert code(QUESTIONS[question](asked)) is expected
        assert code(asked.why) is expected

    @pytest.mark.parametrize(
        ("question", "expected"),
        [("position", Code.STALE), ("climb", Code.STALE), ("return", Code.RTL_BLOCKED)],
    )
    def test_a_position_that_is_too_old_refuses_it(self, question: str, expected: Code) -> None:
        """Older than the default's second; a goal waits for its tick, where the age is asked."""
        assert QUESTIONS[question](step(age_s=1.0)) is None
        assert code(QUESTIONS[question](step(age_s=1.01))) is expected

    def test_no_return_says_which_fact_is_missing(self) -> None:
        for missing, word in (("home_ned", "home or fence"), ("return_up_m", "return height")):
            refusal = verifying.return_path(step({missing: None}))
            assert refusal is not None
            assert word in refusal.sentence
            assert refusal.sentence.endswith("land instead")


SQUARE = ((40.0, 0.0), (0.0, 40.0), (-40.0, 0.0), (0.0, -40.0))
CIRCLE = Circle((0.0, 0.0), 150.0)
EXCLUDED = Zone("loft", False, CIRCLE, 0.0, 50.0)
RENAMED = Zone("attic", True, CIRCLE, 0.0, 50.0)


class TestWhatIsFlown:
    """A new fence has a floor 5 m up, and the vehicle flies above it."""

    LOFT = replace(FENCE, zones=(Zone("loft", True, Circle((0.0, 0.0), 150.0), 5.0, 50.0),))
    HIGH = at(3, 4, 8)

    def refusal(
        self, state: State, verifier: Verifier, was: Verifier | None = FENCE, **facts: object
    ) -> Code | None:
        memory = step({"pos_ned": self.HIGH, "state": state, **facts}).memory
        return code(verifying.refusal_of_what_is_flown(memory, verifier, was))

    @pytest.mark.parametrize(("up_m", "expected"), [(8.0, None), (4.5, Code.OUTSIDE_FENCE)])
    def test_the_top_of_a_take_off_is_above_the_floor(
        self, up_m: float, expected: Code | None
    ) -> None:
        assert self.refusal(State.TAKING_OFF, self.LOFT, top_ned=at(3, 4, up_m)) is expected

    @pytest.mark.parametrize(("up_m", "expected"), [(8.0, None), (4.5, Code.OUTSIDE_FENCE)])
    def test_so_is_the_place_that_is_held(self, up_m: float, expected: Code | None) -> None:
        held = Goal(at(3, 4, up_m), None, ())
        assert self.refusal(State.HOVERING, self.LOFT, hold=held) is expected

    @pytest.mark.parametrize(("up_m", "expected"), [(8.0, None), (4.5, Code.OUTSIDE_FENCE)])
    def test_and_the_goal(self, up_m: float, expected: Code | None) -> None:
        goal = Goal(at(30, 4, up_m), None, ())
        assert self.refusal(State.MOVING, self.LOFT, goal=goal) is expected

    @pytest.mark.parametrize("missing", ["pos_ned", "v_ned"])
    @pytest.mark.parametrize("state", [State.TAKING_OFF, State.FLYING_MISSION, State.HOVERING])
    def test_nothing_is_said_of_what_is_not_known_to_be_anywhere(
        self, state: State, missing: str
    ) -> None:
        held = Goal(at(3, 4, 4.5), None, ())
        off = None
        facts: dict[str, object] = {missing: None, "hold": held, "goal": held}
        assert self.refusal(state, self.LOFT, off, **facts) is None

    def test_a_mission_goes_on_under_the_fence_that_it_was_verified_by(self) -> None:
        assert self.refusal(State.FLYING_MISSION, FENCE, FENCE) is None

    @pytest.mark.parametrize(
        "was", [None, replace(FENCE, zones=FENCE.zones * 2), replace(FENCE, fence_on=False)]
    )
    def test_under_another_it_does_not(self, was: Verifier | None) -> None:
        assert self.refusal(State.FLYING_MISSION, FENCE, was) is Code.BAD_MISSION

    @pytest.mark.parametrize(
        ("was", "is_"),
        [
            (Circle((0.0, 0.0), 150.0), Circle((0.0, 1.5), 150.0)),
            (Circle((0.0, 0.0), 150.0), Circle((0.0, 0.0), 140.0)),
            (Circle((0.0, 0.0), 150.0), Polygon(SQUARE)),
            (Polygon(SQUARE), Polygon((*SQUARE, (30.0, -30.0)))),
            (Polygon(SQUARE), Polygon(((42.0, 0.0), *SQUARE[1:]))),
        ],
    )
    def test_nor_under_one_that_has_as_many_zones(self, was: Shape, is_: Shape) -> None:
        """station.md, bug 14: the number of zones alone was compared."""
        fences = [replace(FENCE, zones=(Zone("yard", True, s, 0.0, 50.0),)) for s in (was, is_)]
        assert self.refusal(State.FLYING_MISSION, fences[1], fences[0]) is Code.BAD_MISSION

    @pytest.mark.parametrize("zone", [Zone("loft", True, CIRCLE, 2.0, 50.0), EXCLUDED, RENAMED])
    def test_nor_where_its_heights_its_kind_or_its_name_differ(self, zone: Zone) -> None:
        yard = replace(FENCE, zones=(Zone("loft", True, CIRCLE, 0.0, 50.0),))
        other = replace(FENCE, zones=(zone,))
        assert self.refusal(State.FLYING_MISSION, other, yard) is Code.BAD_MISSION

    def test_a_home_that_moves_by_centimetres_makes_no_other_fence(self) -> None:
        """As it does when the vehicle arms; without a ceiling, too."""
        was = replace(FENCE, zones=(Zone("yard", True, CIRCLE, 0.0, math.inf),))
        moved = Circle((0.25, -0.75), 150.0)
        now = replace(FENCE, zones=(Zone("yard", True, moved, 0.25, math.inf),))
        assert self.refusal(State.FLYING_MISSION, now, was) is None

    @pytest.mark.parametrize("was", [None, FENCE, replace(FENCE, fence_on=False)])
    def test_with_the_fence_off_there_is_nothing_to_verify_by(self, was: Verifier | None) -> None:
        off = replace(FENCE, fence_on=False)
        assert self.refusal(State.FLYING_MISSION, off, was) is None
