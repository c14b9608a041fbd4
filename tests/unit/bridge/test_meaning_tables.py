"""The tables of meanings are those of the classification, and those of docs/bridge.md."""

from __future__ import annotations

import pytest

from gcs.bridge.catalog.row import Kind
from gcs.bridge.catalog.tables import command_rows, message_rows
from gcs.bridge.translate.commands import COMMANDS
from gcs.bridge.translate.meaning import Forward, Reject, Words
from gcs.bridge.translate.modes import for_mode
from gcs.bridge.translate.translate import MESSAGES
from gcs.gate.refusal import Code
from gcs.gate.requests import SetMode
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.session.requests import request_of
from gcs.wire.ids import MsgId
from tests.unit.bridge.meaning_page import PAGE, page_with, tables
from tests.unit.bridge.vehicles import flying

OF_A_PLAN = {MsgId.MISSION_ITEM, MsgId.MISSION_ITEM_INT}
"""Part of a plan, but for those with `current` 2 or 3."""


def test_every_command_that_is_motion_has_a_meaning_and_no_other() -> None:
    motion = {number for number, row in command_rows().items() if row.kind is Kind.MOTION}
    assert set(COMMANDS) == motion


def test_every_message_that_is_motion_has_a_meaning_and_no_other() -> None:
    motion = {number for number, row in message_rows().items() if row.kind is Kind.MOTION}
    carriers = {number for number, row in message_rows().items() if row.kind is Kind.CARRIER}
    assert set(MESSAGES) == motion | carriers | OF_A_PLAN


def test_the_page_is_the_tables() -> None:
    """`python -m tests.unit.bridge.meaning_page` writes it anew."""
    assert PAGE.read_text(encoding="utf-8") == page_with(tables())


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)
@pytest.mark.parametrize(
    "state", [State.HOVERING, State.HOLDING, State.GROUNDED], ids=lambda s: s.name
)
def test_no_mode_of_the_sticks_is_ever_asked_of_the_vehicle(
    autopilot: Autopilot, state: State
) -> None:
    """It is refused at once, by the policy.  What is asked for by its name is refused by the gate:
    it is not the one of its kind that the gate sends."""
    on_ground = state is State.GROUNDED
    seen = flying(autopilot, state=state, on_ground=on_ground, mode_name="")
    for mode in autopilot.modes:
        meaning = for_mode(mode, seen)
        if mode.meaning is FlightMode.OTHER:
            assert isinstance(meaning, Reject)
            assert meaning.refusal.code is Code.POLICY
            continue
        assert not isinstance(meaning, Reject)
        if isinstance(meaning, Forward):
            assert (autopilot, mode.name, on_ground) == (ARDUPILOT, "GUIDED", True)
            continue
        assert isinstance(meaning, Words)
        if meaning.asks and meaning.asks[0].word == "mode":
            request = request_of(meaning.asks[0], autopilot)
            assert isinstance(request, SetMode)
            guided = request.meaning is FlightMode.GUIDED
            assert request.meaning is FlightMode.OTHER or (guided and on_ground)
