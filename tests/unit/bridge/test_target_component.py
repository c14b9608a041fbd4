"""What a client sends to another component of the vehicle than its autopilot."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.effects import AsksPlan, ClientRefused, ClientRequest, ForwardToVehicle, Reply
from gcs.gate.refusal import Code
from gcs.protocol.autopilot import PX4
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd
from tests.unit.bridge.test_bridge import Table, of
from tests.unit.bridge.vehicles import flying, standing

CAMERA, NOBODY = 100, 77
WITH_CAMERA = flying(PX4, hears=lambda compid: compid == CAMERA)


def command(number: int, compid: int, *params: float) -> Any:
    filled = params + (0.0,) * (7 - len(params))
    return mavlink.MAVLink_command_long_message(1, compid, number, 0, *filled)


def to_move(compid: int) -> list[Any]:
    """One of each message with a target component that moves a vehicle, or sets it up."""
    return [
        command(Cmd.COMPONENT_ARM_DISARM, compid, 1),
        command(Cmd.NAV_LAND, compid),
        command(Cmd.DO_SET_MODE, compid, 1, 4, 3),
        mavlink.MAVLink_command_int_message(
            1, compid, 0, Cmd.DO_REPOSITION, 0, 0, -1, 1, 0, 0, 473977420, 85455940, 510
        ),
        mavlink.MAVLink_set_position_target_local_ned_message(
            0, 1, compid, 1, 0b110111000111, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0
        ),
        mavlink.MAVLink_set_position_target_global_int_message(
            0, 1, compid, 6, 0b110111000111, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0
        ),
        mavlink.MAVLink_set_attitude_target_message(0, 1, compid, 7, [1, 0, 0, 0], 0, 0, 0, 0.5),
        mavlink.MAVLink_rc_channels_override_message(1, compid, *[1500] * 8),
        mavlink.MAVLink_mission_item_int_message(
            1, compid, 0, 6, Cmd.NAV_WAYPOINT, 2, 0, 0, 0, 0, 0, 473977420, 85455940, 10
        ),
        mavlink.MAVLink_mission_set_current_message(1, compid, 0),
    ]


def to_set_up(compid: int) -> list[Any]:
    return [
        mavlink.MAVLink_param_set_message(1, compid, b"SDLOG_MODE", 0.0, 6),
        command(Cmd.PREFLIGHT_REBOOT_SHUTDOWN, compid, 1),
    ]


def names(message: Any) -> str:
    return str(message.get_type())


@pytest.mark.parametrize("message", [*to_move(NOBODY), *to_set_up(NOBODY)], ids=names)
def test_what_is_for_a_component_that_nobody_heard_is_refused(message: Any) -> None:
    judged = Table(seen=WITH_CAMERA).says(message)
    assert judged.refused
    assert not of(ForwardToVehicle, judged.effects)
    assert not of(ClientRequest, judged.effects)
    assert not of(AsksPlan, judged.effects)
    (refused,) = of(ClientRefused, judged.effects)
    assert refused.refusal.code is Code.UNSUPPORTED
    assert "there is no component 77 of system 1 (the autopilot is 1/1)" in (
        refused.refusal.sentence
    )


@pytest.mark.parametrize("message", to_move(CAMERA), ids=names)
def test_what_moves_the_vehicle_is_for_its_autopilot_alone(message: Any) -> None:
    judged = Table(seen=WITH_CAMERA).says(message)
    assert judged.refused
    assert not of(ForwardToVehicle, judged.effects)
    assert not of(ClientRequest, judged.effects)
    (refused,) = of(ClientRefused, judged.effects)
    assert refused.refusal.code is Code.UNSUPPORTED
    assert "component 100 flies nothing" in refused.refusal.sentence


@pytest.mark.parametrize("compid", [0, 1])
def test_what_is_for_the_autopilot_or_for_all_is_judged_as_ever(compid: int) -> None:
    land = command(Cmd.NAV_LAND, compid)
    judged = Table(seen=WITH_CAMERA).says(land)
    assert not judged.refused
    (said,) = of(ClientRequest, judged.effects)
    assert said.command.word == "land"


def test_an_autopilot_may_have_another_number() -> None:
    table, at = Table(seen=WITH_CAMERA), Address(1, 5)
    assert not table.says(command(Cmd.NAV_LAND, 5), vehicle=at).refused
    assert Table(seen=WITH_CAMERA).says(command(Cmd.NAV_LAND, 1), vehicle=at).refused


def test_what_sets_up_a_component_that_is_there_goes_by_the_policy() -> None:
    """As before: the guard decides it, and a free parameter is written."""
    on_ground = replace(standing(PX4), hears=lambda compid: compid == CAMERA, in_control=True)
    (free, _), (free_of_nobody, _) = to_set_up(CAMERA), to_set_up(NOBODY)
    assert of(ForwardToVehicle, Table(seen=on_ground).says(free).effects)
    assert not of(ForwardToVehicle, Table(seen=on_ground).says(free_of_nobody).effects)


def test_what_turns_a_camera_that_is_there_is_forwarded() -> None:
    for_camera = command(Cmd.DO_SET_ROI_NONE, CAMERA)
    assert of(ForwardToVehicle, Table(seen=WITH_CAMERA).says(for_camera).effects)
    assert not of(
        ForwardToVehicle, Table(seen=WITH_CAMERA).says(command(Cmd.DO_SET_ROI_NONE, 77)).effects
    )


def test_what_is_harmless_is_forwarded_to_whomever() -> None:
    asks = command(Cmd.REQUEST_MESSAGE, NOBODY, 148)
    assert of(ForwardToVehicle, Table(seen=WITH_CAMERA).says(asks).effects)
    assert not of(Reply, Table(seen=WITH_CAMERA).says(asks).effects)


def test_old_clients_send_what_is_about_missions_to_another_component() -> None:
    sets = mavlink.MAVLink_mission_set_current_message(1, 190, 0)
    judged = Table(seen=flying(PX4, mission_items=3)).says(sets)
    sentences = [each.refusal.sentence for each in of(ClientRefused, judged.effects)]
    assert not any("component" in each for each in sentences)
    assert judged.effects
