"""The table is literal, total, all of it is used, and its printed copy is true."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import get_args

import pytest
from click.testing import CliRunner

import gcs
from gcs.cli.fsa import fsa
from gcs.gate.machine import render, table
from gcs.gate.machine.actions import Action
from gcs.gate.machine.checks import Check
from gcs.gate.machine.events import OF_REQUEST, REQUESTS, Event, event_of
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import cannot_happen, unchanged
from gcs.gate.machine.rows.row import COLUMNS, Branch, during, row
from gcs.gate.machine.sentences import ENDED, REFUSED
from gcs.gate.machine.step_context import Reply
from gcs.gate.machine.table import ROWS, STREAMS, TABLE, Streams
from gcs.gate.requests import (
    Arm,
    Disarm,
    Hold,
    Land,
    Request,
    SetMode,
    TakeControl,
    TakePhoto,
)
from gcs.gate.states import FlightMode, State

GOLDEN = Path(__file__).parent / "golden"
BRANCHES = [branch for cell in TABLE.values() for branch in cell]


def test_every_state_and_event_has_its_cell() -> None:
    assert set(TABLE) == {(state, event) for state in State for event in Event}
    assert sorted(COLUMNS) == sorted(State)
    assert set(ROWS) == set(Event)
    assert set(STREAMS) == set(State)


def test_a_row_that_leaves_a_state_out_is_not_built() -> None:
    with pytest.raises(ValueError, match=r"^HOLDING, EXTERNAL: missing in a row"):
        row(during(*COLUMNS[:-2], then=unchanged))


def test_a_row_that_names_a_state_twice_is_not_built() -> None:
    with pytest.raises(ValueError, match=r"^MOVING is named twice in a row"):
        row(during(*COLUMNS, then=unchanged), during(State.MOVING, then=cannot_happen))


def test_no_event_has_rows_in_two_files() -> None:
    written = [
        event
        for path in (Path(table.__file__).parent / "rows").glob("*.py")
        if path.stem != "row"  # which has an example
        for event in re.findall(r"^    Event\.(\w+): row\(", path.read_text("utf-8"), re.MULTILINE)
    ]
    assert sorted(written) == sorted(event.name for event in Event)


def test_the_last_branch_of_a_cell_has_no_condition_and_no_other_has_none() -> None:
    for where, cell in TABLE.items():
        if cell:
            assert cell[-1].when == (), where
            assert all(branch.when for branch in cell[:-1]), where


def test_every_word_is_used() -> None:
    assert set(Guard) == {guard for b in BRANCHES for guard in b.when}
    assert set(Check) == {check for b in BRANCHES for check in b.needs}
    assert set(Action) == {do for b in BRANCHES for do in b.do}


@pytest.mark.parametrize("event", sorted(REQUESTS))
def test_a_request_is_answered_by_every_branch_it_can_take(event: Event) -> None:
    for state in State:
        for branch in TABLE[state, event]:
            answered = branch.reply is not Reply.NONE
            assert answered != (branch.refuse is not None), (state, branch)


def test_only_requests_are_answered_and_only_they_and_samples_refused() -> None:
    for (_, event), cell in TABLE.items():
        for branch in cell:
            if event not in REQUESTS:
                assert branch.reply is Reply.NONE
                assert branch.refuse is None or event is Event.STREAM_SAMPLE
                assert branch.needs == ()


def test_every_reason_in_the_table_has_its_sentence() -> None:
    assert {b.refuse for b in BRANCHES if b.refuse is not None} == set(REFUSED)
    codes = {b.ends.code for b in BRANCHES if b.ends is not None and b.ends.code is not None}
    assert codes <= set(ENDED)


def test_verifying_takes_nothing_but_the_verifiers_answer() -> None:
    taken = {event for event in Event if TABLE[State.VERIFYING, event]}
    assert taken == {Event.GOAL_CLEARED, Event.GOAL_REFUSED}


def test_hold_land_and_abort_are_refused_by_no_branch_where_a_vehicle_is() -> None:
    for state in set(State) - {State.NO_VEHICLE, State.VERIFYING}:
        for event in (Event.HOLD, Event.LAND, Event.ABORT):
            assert all(branch.refuse is None for branch in TABLE[state, event])


def test_nothing_is_streamed_where_the_vehicle_flies_by_itself() -> None:
    silent = {state for state, what in STREAMS.items() if what is Streams.NOTHING}
    assert silent == {
        State.NO_VEHICLE,
        State.GROUNDED,
        State.TAKING_OFF,
        State.EXTERNAL,
    }
    awaiting = {s for s, what in STREAMS.items() if what is Streams.HOLD_GOAL_UNTIL_MODE}
    assert awaiting == {State.FLYING_MISSION, State.RETURNING, State.LANDING}


def test_every_request_has_an_event_of_its_own() -> None:
    assert OF_REQUEST.keys() == set(get_args(Request))
    assert len(set(OF_REQUEST.values())) == len(OF_REQUEST)
    assert event_of(Disarm(force=True)) is Event.FORCE_DISARM
    assert all(event_of(kind()) is OF_REQUEST[kind] for kind in (Arm, Disarm, Hold, TakePhoto))


def test_a_mode_asked_for_by_name_is_the_request_it_means() -> None:
    assert event_of(SetMode("OFFBOARD", FlightMode.GUIDED)) is event_of(TakeControl())
    assert event_of(SetMode("AUTO.LAND", FlightMode.LAND)) is event_of(Land())
    assert event_of(SetMode("ACRO", FlightMode.OTHER)) is Event.OTHER_MODE


@pytest.mark.parametrize(
    ("form", "printed"), [("text", render.text), ("dot", render.dot)], ids=["text", "dot"]
)
def test_the_printed_copy_is_the_table(form: str, printed: object) -> None:
    """Where this fails and the change is meant: `gcs fsa --format F > tests/.../golden/fsa.F`."""
    golden = (GOLDEN / f"fsa.{form}").read_text(encoding="utf-8")
    result = CliRunner().invoke(fsa, ["--format", form])
    assert result.exit_code == 0
    assert result.output == golden


def test_one_state_is_printed_in_a_line_an_event_with_what_follows() -> None:
    lines = render.short(State.HOVERING).splitlines()
    assert lines[0] == "HOVERING = 1    streams the hold goal"
    assert "  goto               pending until the tick (or refused)" in lines
    assert "  hold               -> HOLDING" in lines
    assert "  tick               -> VERIFYING" in lines
    assert render.short(State.VERIFYING).splitlines()[1] == "  goal cleared       -> MOVING"
    assert all(len(render.short(state).splitlines()) < 45 for state in State)


def test_the_labs_states_are_printed_without_all_that_leads_elsewhere() -> None:
    """HOVERING, VERIFYING and MOVING, as its state machine has them."""
    shown = CliRunner().invoke(fsa, ["--lab"]).output.splitlines()
    assert [line.split()[0] for line in shown if "=" in line] == ["HOVERING", "VERIFYING", "MOVING"]
    assert "  goal cleared       -> MOVING" in shown
    assert "  tick               -> VERIFYING or -> HOVERING" in shown
    assert not any("HOLDING" in line for line in shown)
    drawn = CliRunner().invoke(fsa, ["--lab", "--format", "dot"]).output
    assert "VERIFYING -> MOVING" in drawn
    assert "HOLDING" not in drawn


def test_a_changed_cell_prints_differently() -> None:
    changed = {**TABLE, (State.MOVING, Event.ABORT): (Branch(),)}
    assert render.text(changed) != render.text()
    assert "MOVING -> HOLDING" in render.dot(changed)


@pytest.mark.slow
def test_permits_are_issued_in_one_module_only() -> None:
    package = Path(gcs.__file__).parent
    users = set()
    for path in package.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            listed = getattr(node, "names", [])
            names = {one.name for one in listed if isinstance(one, ast.alias)}
            imported = isinstance(node, ast.ImportFrom) and node.module == "gcs.gate.permit"
            if imported and names & {"issue", "_SEAL"}:
                users.add(path.relative_to(package).as_posix())
            if not isinstance(node, ast.Attribute) or node.attr != "issue":
                continue
            if isinstance(node.value, ast.Name) and node.value.id == "permit":
                users.add(path.relative_to(package).as_posix())
    assert users == {"gate/machine/gate.py"}


ASKED = {
    FlightMode.GUIDED: Event.CONTROL,
    FlightMode.HOLD: Event.HOLD,
    FlightMode.TAKEOFF: Event.OTHER_MODE,
    FlightMode.MISSION: Event.MISSION,
    FlightMode.RETURN: Event.RETURN,
    FlightMode.LAND: Event.LAND,
    FlightMode.OTHER: Event.OTHER_MODE,
}


@pytest.mark.parametrize("mode", FlightMode)
def test_a_mode_by_its_name_is_the_request_that_means_the_same(mode: FlightMode) -> None:
    """A take-off has a height, which a mode has not: it is no way to take off."""
    assert event_of(SetMode("its name", mode)) is ASKED[mode]
