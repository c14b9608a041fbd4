"""A take-off or a mission that is asked for before the arming: when it is kept, and flown."""

from __future__ import annotations

from typing import Any

import pytest

from gcs import ipc
from gcs.bridge.translate.chosen_before_arming import (
    KEPT_NS,
    ChosenMission,
    ChosenTakeoff,
    ends_choice,
    mission_may_be_chosen,
    takeoff_may_be_chosen,
    with_chosen,
)
from gcs.bridge.translate.meaning import Sample, Words
from gcs.bridge.translate.says import ask, unsupported
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4
from tests.unit.bridge.vehicles import standing

UP = Words((ipc.Ask(0, "takeoff", up_m=6.0),))
CHOSEN = ChosenTakeoff(UP.asks[0], 2.5, KEPT_NS)


def up_to_10(up_m: float) -> bool:
    return up_m <= 10.0


def test_a_px4_that_stands_disarmed_may_be_told_before_it_is_armed() -> None:
    seen = standing(PX4, clears_takeoff=up_to_10)
    assert takeoff_may_be_chosen(UP, seen)
    assert not takeoff_may_be_chosen(Words((ipc.Ask(0, "takeoff", up_m=11.0),)), seen)
    assert not takeoff_may_be_chosen(ask("land"), seen)
    assert not takeoff_may_be_chosen(UP, standing(PX4)), "what is not known to be clear is not"
    assert not takeoff_may_be_chosen(UP, standing(ARDUPILOT, clears_takeoff=up_to_10))


@pytest.mark.parametrize(
    "changed",
    [{"armed": True}, {"on_ground": False}, {"in_control": False}, {"state": State.STALE}],
)
def test_it_is_not_kept(changed: dict[str, Any]) -> None:
    assert not takeoff_may_be_chosen(UP, standing(PX4, clears_takeoff=up_to_10, **changed))


def test_the_arming_becomes_two_requests() -> None:
    both = with_chosen(CHOSEN, ask("arm", "a note"), standing(PX4), KEPT_NS - 1)
    assert both == Words((ipc.Ask(0, "arm"), *UP.asks), "a note", answered_by="arm")


@pytest.mark.parametrize(
    "changed",
    [{"armed": True}, {"on_ground": False}, {"in_control": False}, {"takeoff_up_m": 8.0}],
)
def test_the_arming_is_an_arming_alone(changed: dict[str, Any]) -> None:
    assert with_chosen(CHOSEN, ask("arm"), standing(PX4, **changed), 0) is None


def test_it_is_kept_for_ten_seconds() -> None:
    assert KEPT_NS == 10_000_000_000
    assert with_chosen(CHOSEN, ask("arm"), standing(PX4), KEPT_NS) is None


MISSION = ChosenMission(KEPT_NS)


def test_the_mode_of_a_mission_that_was_verified_may_be_set_before_the_arming() -> None:
    assert mission_may_be_chosen(ask("mission_start"), standing(PX4, mission_items=3))
    assert not mission_may_be_chosen(ask("rtl"), standing(PX4, mission_items=3))
    assert not mission_may_be_chosen(ask("mission_start"), standing(ARDUPILOT, mission_items=3))


@pytest.mark.parametrize(
    "changed",
    [
        {"armed": True},
        {"on_ground": False},
        {"in_control": False},
        {"state": State.STALE},
        {"mission_items": 0},
        {"awaited": True},
    ],
)
def test_the_mode_of_a_mission_is_not_set(changed: dict[str, Any]) -> None:
    seen = standing(PX4, **{"mission_items": 3, **changed})
    assert not mission_may_be_chosen(ask("mission_start"), seen)


def test_the_arming_becomes_a_check_an_arming_and_the_start() -> None:
    both = with_chosen(MISSION, ask("arm", "a note"), standing(PX4), KEPT_NS - 1)
    check = ipc.Ask(0, "mission_check", mode="AUTO.MISSION")
    words = (check, ipc.Ask(0, "arm"), ipc.Ask(0, "mission_start"))
    assert both == Words(words, "a note", answered_by="arm")
    assert with_chosen(MISSION, ask("arm"), standing(PX4), KEPT_NS) is None


def test_what_else_a_client_asks_for_ends_it() -> None:
    assert ends_choice(ask("land"))
    assert ends_choice(Sample(v_ned=(1.0, 0.0, 0.0)))
    assert ends_choice(unsupported("no"))
    assert not ends_choice(Words(()))
