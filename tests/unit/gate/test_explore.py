"""The explorer finds nothing in the real table, and finds what is planted."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from gcs.gate.condition import Severity
from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.events import Event
from gcs.gate.machine.rules import Action, Branch, Cell, Check, End, Guard, Reply
from gcs.gate.machine.table import TABLE
from gcs.gate.proof.alphabet import CONDITIONS, YARD
from gcs.gate.proof.explorer import Explored, explore
from gcs.gate.refusal import Code
from gcs.gate.states import Control, State

GUARDED = replace(
    YARD, retarget="replace", rtl_blocked="land", fence_switchable=False, allow_force_disarm=False
)


def clean(explored: Explored) -> None:
    assert explored.fault is None, str(explored.fault)
    reached = {state for state, *_ in explored.combinations}
    assert reached == set(State) - {State.VERIFYING, State.STREAMING}
    for state in (State.NO_VEHICLE, State.GROUNDED, State.EXTERNAL, State.STALE, State.HOLDING):
        met = {severity for s, severity, *_ in explored.combinations if s is state}
        assert met >= set(CONDITIONS.values()) - {Severity.TERMINATE}
    controls = {c for s, _, c, _ in explored.combinations if s is State.HOVERING}
    assert controls == {Control.TAKING, Control.OURS}


def test_every_reachable_combination_keeps_every_invariant() -> None:
    clean(explore())


def test_so_it_does_for_the_other_autopilot_under_the_other_choices_of_the_policy() -> None:
    clean(explore(policy=GUARDED, autopilot="ardupilot", return_up_m=90.0))


TAKEN = Branch(reply=Reply.PENDING)

FAULTS: list[tuple[str, State, Event, Cell, int, str]] = [
    (
        "moving while stale",
        State.MOVING,
        Event.POSITION_AGED,
        (Branch(),),
        7,
        "wait: position too old",
    ),
    (
        "hovering while stale",
        State.HOVERING,
        Event.POSITION_AGED,
        (Branch(),),
        7,
        "wait: position too old",
    ),
    ("a busy goal is taken", State.MOVING, Event.GOTO, (TAKEN,), 4, "ask: goto inside"),
    (
        "a goal is taken while severity forbids it",
        State.EXTERNAL,
        Event.CONTROL,
        (
            Branch(
                needs=(Check.POSITION,),
                reply=Reply.ACCEPTED,
                do=(Action.TAKE_CONTROL,),
                to=State.HOVERING,
            ),
        ),
        7,
        "ask: control",
    ),
    (
        "abort is refused while a picture is taken",
        State.TAKING_PICTURE,
        Event.ABORT,
        (Branch(refuse=Code.BUSY),),
        5,
        "ask: abort",
    ),
    (
        "hold is refused while somebody else flies",
        State.EXTERNAL,
        Event.HOLD,
        (Branch(refuse=Code.NOT_IN_CONTROL),),
        10,
        "ask: hold",
    ),
    (
        "a breach is not braked",
        State.MOVING,
        Event.BREACH,
        (Branch(),),
        6,
        "position dashing for the fence",
    ),
    (
        "a breach is held but not braked",
        State.TAKING_OFF,
        Event.BREACH,
        (Branch(do=(Action.HOLD,), to=State.HOLDING),),
        6,
        "position dashing for the fence",
    ),
    (
        "holding is left without resume",
        State.HOLDING,
        Event.MODE_CONFIRMED,
        (Branch(ends=End(OutcomeKind.COMPLETE), do=(Action.CONFIRM_HOLD,), to=State.HOVERING),),
        5,
        "hold mode",
    ),
    (
        "the first forced disarm cuts the motors in the air",
        State.EXTERNAL,
        Event.FORCE_DISARM,
        (Branch(reply=Reply.ACCEPTED, do=(Action.FORCE_DISARM,)),),
        4,
        "ask: force disarm",
    ),
    (
        "a refused hold is not commanded again",
        State.HOLDING,
        Event.HOLD_REFUSED,
        (Branch(do=(Action.CONFIRM_HOLD,)),),
        4,
        "answer: refused",
    ),
    (
        "a hold that is due is not commanded",
        State.HOLDING,
        Event.HOLD_DUE,
        (Branch(),),
        4,
        "wait: mode overdue",
    ),
    (
        "the end of a request is forgotten",
        State.TAKING_PICTURE,
        Event.PHOTO_SEEN,
        (Branch(to=State.HOVERING),),
        0,
        "picture",
    ),
    (
        "a refused goal is flown",
        State.VERIFYING,
        Event.GOAL_REFUSED,
        (Branch(do=(Action.FLY_GOAL,), to=State.MOVING),),
        1,
        "tick",
    ),
    (
        "a breach predicted by a late sample is swallowed",
        State.STALE,
        Event.BREACH,
        (Branch(),),
        6,
        "position dashing for the fence",
    ),
    (
        "a goal is flown on in a fence that refuses it",
        State.MOVING,
        Event.CLEARS_NO_MORE,
        (Branch(),),
        2,
        "fence moves, and back",
    ),
    (
        "home moves and nobody holds",
        State.HOVERING,
        Event.HOME_MOVED,
        (Branch(),),
        2,
        "home moves, and back",
    ),
    (
        "a hold is over at once though the vehicle may fly",
        State.GROUNDED,
        Event.HOLD,
        (Branch(reply=Reply.DONE),),
        10,
        "ask: hold",
    ),
    (
        "a hold is withdrawn after the operator is lost",
        State.HOLDING,
        Event.RESUME,
        TABLE[State.HOLDING, Event.RESUME][1:],
        7,
        "ask: resume",
    ),
    (
        "a climb is over wherever the vehicle holds",
        State.TAKING_OFF,
        Event.TICK,
        (
            Branch(when=(Guard.LIFTED_OFF,), do=(Action.TAKE_CONTROL,), to=State.HOVERING),
            Branch(),
        ),
        2,
        "tick",
    ),
    (
        "a cell that cannot be entered",
        State.GROUNDED,
        Event.ARMED,
        (),
        0,
        "armed or disarmed",
    ),
]


@pytest.mark.parametrize(
    ("state", "event", "cell", "invariant", "letter"),
    [fault[1:] for fault in FAULTS],
    ids=[fault[0] for fault in FAULTS],
)
def test_a_planted_fault_is_found_with_its_shortest_trace(
    state: State, event: Event, cell: Cell, invariant: int, letter: str
) -> None:
    fault = explore({**TABLE, (state, event): cell}).fault
    assert fault is not None
    assert fault.objection.invariant == invariant
    assert fault.trace[-1][0] == letter
    assert "shortest trace:" in str(fault)


def test_the_trace_is_the_shortest_there_is() -> None:
    table = {**TABLE, (State.EXTERNAL, Event.HOLD): (Branch(refuse=Code.NOT_IN_CONTROL),)}
    fault = explore(table).fault
    assert fault is not None
    assert [letter for letter, _ in fault.trace] == [
        "guided mode",
        "position",
        "in the air",
        "ask: hold",
    ]
    assert fault.trace[-2][1] is State.EXTERNAL


def test_the_fault_is_printed_step_by_step() -> None:
    table = {**TABLE, (State.GROUNDED, Event.ARMED): ()}
    assert str(explore(table).fault).splitlines()[1:] == [
        "shortest trace:",
        "  guided mode                      -> STALE",
        "  position                         -> GROUNDED",
        "  armed or disarmed                -> GROUNDED",
    ]
