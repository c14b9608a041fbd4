"""The bridge alone, before two vehicles: what is for all, for one, and for nobody."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.bridge import Bridge
from gcs.bridge.effects import (
    AboutVehicle,
    ClientRefused,
    ClientRequest,
    ForwardToVehicle,
    LogLine,
    Reply,
)
from gcs.bridge.judge.received import Judged
from gcs.gate.policy.parse import parse_policy
from gcs.protocol.autopilot import PX4
from gcs.protocol.effects import Address
from gcs.protocol.transfers.transfer import SPEC_TIMING
from gcs.wire.frame import Frame, split
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck
from tests.unit.bridge.test_bridge import HEARTBEAT, OWN, S, acks, frame_of, of, texts
from tests.unit.bridge.vehicles import standing

BOTH = (Address(1, 1), Address(2, 1))


class Pair:
    """A bridge with one client, before two PX4 that stand on the ground."""

    def __init__(self, rules: str = "") -> None:
        policy = parse_policy(f"[bridge]\n{rules}", "my.toml")
        self.bridge = Bridge(OWN, policy.bridge, {}, 10 * S, SPEC_TIMING, S // 2)
        self.bridge.came(1, "udp 1")
        self.says(HEARTBEAT)

    def says(
        self, message: Any, vehicles: tuple[Address, ...] = BOTH, why_not_ours: str = ""
    ) -> Judged:
        seen, frame = standing(PX4), frame_of(message)
        return self.bridge.from_client(
            1, frame, vehicles, lambda _: seen, 1_000 * S, lambda _: why_not_ours
        )


def faster(sysid: int, msgid: int, hz: float) -> Any:
    return mavlink.MAVLink_command_long_message(
        sysid, 1, Cmd.SET_MESSAGE_INTERVAL, 0, msgid, 1e6 / hz, 0, 0, 0, 0, 0
    )


def land(sysid: int) -> Any:
    return mavlink.MAVLink_command_long_message(sysid, 1, Cmd.NAV_LAND, 0, *[0.0] * 7)


def by_vehicle(judged: Judged, kind: type) -> dict[int, int]:
    """How many effects of that kind each vehicle has."""
    return {
        each.vehicle: len(of(kind, [each]))
        for each in judged.effects
        if isinstance(each, AboutVehicle) and of(kind, [each])
    }


RTCM = mavlink.MAVLink_gps_rtcm_data_message(0, 4, [0] * 180)


def test_a_message_without_a_target_that_is_refused_for_several_is_one_refusal() -> None:
    """And nothing is left in the other vehicle's dialogue: its request would never end."""
    pair = Pair('rtcm = "refuse"')
    (refused,) = of(ClientRefused, pair.says(RTCM).effects)
    (said,) = of(ClientRequest, pair.says(land(2)).effects)
    assert (refused.ask.id, said.command.id) == (1, 2)


def test_a_message_without_a_target_that_is_let_through_goes_out_once() -> None:
    (sent,) = of(ForwardToVehicle, Pair('rtcm = "forward"').says(RTCM).effects)
    assert sent.raw == frame_of(RTCM).raw


def test_a_rate_that_is_asked_of_all_vehicles_counts_for_each() -> None:
    pair = Pair("messages_hz = 200.0")
    for msgid in (100, 101):
        assert by_vehicle(pair.says(faster(0, msgid, 50.0)), ForwardToVehicle) == {1: 1, 2: 1}
    for sysid in (1, 2):
        refused = pair.says(faster(sysid, 102, 50.0))
        assert refused.refused
        assert by_vehicle(refused, ClientRefused) == {sysid: 1}


def test_a_group_that_is_asked_of_all_vehicles_counts_for_each() -> None:
    pair = Pair("messages_hz = 200.0")
    asked = mavlink.MAVLink_request_data_stream_message(0, 1, 0, 4, 1)
    assert by_vehicle(pair.says(asked), ForwardToVehicle) == {1: 1, 2: 1}
    assert pair.says(faster(2, 102, 50.0)).refused


def test_what_is_asked_of_all_vehicles_goes_to_each_in_its_own_name() -> None:
    """The same bytes twice would have each of them do it twice where they share a link."""
    sent = of(ForwardToVehicle, Pair().says(faster(0, 100, 10.0)).effects)
    frames = [frame for each in sent for frame in split(each.raw) if isinstance(frame, Frame)]
    assert [frame.payload[30] for frame in frames] == [1, 2], "COMMAND_LONG.target_system"


@pytest.mark.parametrize("message", [land(9), faster(9, 30, 10.0)])
def test_what_is_for_nobody_is_answered_with_a_text_that_names_the_vehicles(message: Any) -> None:
    """In the name of a vehicle that is there; an acknowledgement would be in the name of none."""
    pair = Pair()
    judged = pair.says(message)
    assert judged.refused
    assert acks(judged.effects) == []
    assert texts(list(judged.effects)) == "refused: there is no system 9 here (heard: system 1, 2)"
    assert {each.source for each in of(Reply, judged.effects)} == {BOTH[0]}
    assert len(of(LogLine, judged.effects)) == 1
    again = pair.says(message)
    assert (again.refused, list(again.effects)) == (True, [])
    assert "no system 10" in texts(list(pair.says(land(10)).effects))


NOT_OURS = "system 2 is not this bridge's: --target 1"


@pytest.mark.parametrize("kind", ["long", "int"])
def test_a_command_for_a_vehicle_that_is_shown_only_is_denied_in_its_name(kind: str) -> None:
    """Each time; the text comes once."""
    pair = Pair()
    message = land(2)
    if kind == "int":
        message = mavlink.MAVLink_command_int_message(2, 0, 0, Cmd.NAV_LAND, 0, 0, *[0] * 7)
    judged = pair.says(message, BOTH[:1], NOT_OURS)
    assert judged.refused
    assert texts(list(judged.effects)) == f"refused: {NOT_OURS}"
    assert acks(judged.effects) == [(Cmd.NAV_LAND, Result.DENIED)]
    assert {
        each.source for each in of(Reply, judged.effects) if isinstance(each.message, CommandAck)
    } == {BOTH[1]}
    again = pair.says(message, BOTH[:1], NOT_OURS)
    assert acks(again.effects) == [(Cmd.NAV_LAND, Result.DENIED)]
    assert texts(list(again.effects)) == ""


def test_what_is_no_command_for_a_vehicle_that_is_shown_only_is_told_by_text() -> None:
    asked = mavlink.MAVLink_param_request_list_message(2, 1)
    judged = Pair().says(asked, BOTH[:1], NOT_OURS)
    assert (judged.refused, acks(judged.effects)) == (True, [])
    assert texts(list(judged.effects)) == f"refused: {NOT_OURS}"


def test_before_a_vehicle_is_heard_the_bridge_says_so_itself() -> None:
    judged = Pair().says(land(1), vehicles=())
    assert "system 1 here (no vehicle's heartbeat was heard yet)" in texts(list(judged.effects))
    assert {each.source for each in of(Reply, judged.effects)} == {OWN}
