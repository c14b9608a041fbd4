"""A client that asks for a plan once, as DroneKit does right after its upload, gets it later."""

from __future__ import annotations

from dataclasses import replace

from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.effects import ForwardToVehicle, Reply
from gcs.wire.messages import MissionAck
from tests.unit.bridge.test_bridge import HEARTBEAT, HOVERING, S, Table, of

LIST = mavlink.MAVLink_mission_request_list_message(1, 1, 0)


def held_back() -> Table:
    """The station brings a plan on board, and DroneKit asks for it."""
    table = Table(seen=replace(HOVERING, plan_transfer=True))
    table.says(HEARTBEAT)
    assert not of(ForwardToVehicle, table.says(LIST).effects)
    return table


def asked_again(table: Table, seconds: float) -> list[bytes]:
    """What goes to the vehicle then, and to the client nothing but texts."""
    table.now_ns += round(seconds * S)
    effects = table.bridge.ask_again(lambda _: table.seen, table.now_ns)
    assert not [each for each in of(Reply, effects) if isinstance(each.message, MissionAck)]
    return [each.raw for each in of(ForwardToVehicle, effects)]


def test_it_goes_to_the_vehicle_once_the_station_has_done() -> None:
    table = held_back()
    assert asked_again(table, 2.0) == []
    table.seen = HOVERING
    assert len(asked_again(table, 1.0)) == 1
    assert asked_again(table, 1.0) == []


def test_not_so_for_a_client_that_asks_again_by_itself() -> None:
    table = held_back()
    for _ in range(4):
        table.now_ns += S // 2
        table.says(LIST)
    table.seen = HOVERING
    assert asked_again(table, 1.0) == []


def test_nor_for_one_that_has_gone_or_has_waited_too_long() -> None:
    table = held_back()
    table.bridge.gone(1, "closed")
    table.seen = HOVERING
    assert asked_again(table, 1.0) == []
    table = held_back()
    table.seen = HOVERING
    assert asked_again(table, 31.0) == []
