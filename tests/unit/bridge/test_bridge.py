"""The bridge alone, without a session: frames of clients in, effects out."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs import ipc
from gcs.bridge.bridge import Bridge
from gcs.bridge.effects import (
    AboutVehicle,
    AsksPlan,
    AsksVehicle,
    BridgeEffect,
    ClientRefused,
    ClientRequest,
    ForwardToLink,
    ForwardToVehicle,
    Joined,
    LogLine,
    Lost,
    Reply,
)
from gcs.bridge.judge.received import Judged
from gcs.bridge.translate.meaning import Seen
from gcs.gate.effects import Level
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import BridgeRules
from gcs.protocol.autopilot import ARDUPILOT, PX4
from gcs.protocol.effects import Address
from gcs.protocol.transfers.transfer import SPEC_TIMING
from gcs.wire.frame import Frame, split
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck, CommandLong, MissionAck, MissionRequestInt, Statustext
from tests.unit.bridge.vehicles import flying, standing

S = 1_000_000_000
OWN, VEHICLE = Address(255, 191), Address(1, 1)
ARM = mavlink.MAVLink_command_long_message(1, 1, Cmd.COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
HEARTBEAT = mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)

HOVERING = flying(PX4)


def frame_of(message: Any, sysid: int = 245, compid: int = 190) -> Frame:
    (frame,) = split(message.pack(mavlink.MAVLink(None, srcSystem=sysid, srcComponent=compid)))
    assert isinstance(frame, Frame)
    return frame


def with_rules(text: str) -> BridgeRules:
    return parse_policy(f"[bridge]\n{text}\n", "my.toml").bridge


class Table:
    """A bridge with clients on the links 1 to `clients`, before a PX4 that hovers."""

    def __init__(
        self,
        clients: int = 1,
        seen: Seen | None = HOVERING,
        rules: BridgeRules = DEFAULT.bridge,
    ) -> None:
        self.bridge = Bridge(OWN, rules, {}, 10 * S, SPEC_TIMING, S // 2)
        self.seen, self.now_ns = seen, 1_000 * S
        for link in range(1, clients + 1):
            self.bridge.came(link, f"udp {link}")

    def says(
        self, message: Any, link: int = 1, sysid: int = 0, *, vehicle: Address | None = VEHICLE
    ) -> Judged:
        frame = frame_of(message, sysid or 244 + link)
        vehicles = [vehicle] if vehicle else []
        return self.bridge.from_client(link, frame, vehicles, lambda _: self.seen, self.now_ns)


def due_ns(table: Table) -> int | None:
    """A call: a type checker must not remember it."""
    return table.bridge.deadline_ns


def of(kind: type, effects: Any) -> list[Any]:
    """Those of one kind, also where they are a vehicle's."""
    each_one = [
        one
        for each in effects
        for one in (each.effects if isinstance(each, AboutVehicle) else (each,))
    ]
    return [each for each in each_one if isinstance(each, kind)]


def acks(effects: Any) -> list[tuple[int, int]]:
    """Command and MAV_RESULT."""
    told = [each.message for each in of(Reply, effects)]
    return [(each.command, each.result) for each in told if isinstance(each, CommandAck)]


def texts(effects: list[BridgeEffect]) -> str:
    told = [each.message for each in of(Reply, effects)]
    return "".join(each.text for each in told if isinstance(each, Statustext))


def test_a_peer_is_a_client_with_its_first_frame_and_lost_when_it_is_silent() -> None:
    table = Table()
    judged = table.says(HEARTBEAT)
    assert of(Joined, judged.effects) == [Joined(1000, "MAVLink 245/190, udp 1")]
    assert not of(Joined, table.says(HEARTBEAT).effects)
    assert table.bridge.second([VEHICLE], table.now_ns + 10 * S) == []
    (lost,) = table.bridge.second([VEHICLE], table.now_ns + 10 * S + 1)
    assert lost == Lost(1000, "silent for 10 s")
    assert of(Joined, table.says(HEARTBEAT).effects)[0].client == 1001, "it is another one then"


def links_of(judged: Judged) -> list[int]:
    """Where a client's frame goes on to."""
    return [each.link for each in of(ForwardToLink, judged.effects)]


def test_a_heartbeat_that_a_client_sends_back_does_not_go_round_again() -> None:
    table = Table(clients=3)
    table.says(HEARTBEAT, 3)
    assert links_of(table.says(HEARTBEAT, 1)) == [2, 3]
    assert links_of(table.says(HEARTBEAT, 2, sysid=245)) == [], "a copy of the one on link 1"
    table.now_ns += S
    assert links_of(table.says(HEARTBEAT, 1)) == [3], "link 2 says that it is this one, too"
    table.now_ns += 5 * S
    assert links_of(table.says(HEARTBEAT, 2, sysid=245)) == []
    table.now_ns += 1
    assert links_of(table.says(HEARTBEAT, 2, sysid=245)) == [3], "it was silent on link 1"
    table.bridge.gone(2, "closed")
    assert links_of(table.says(HEARTBEAT, 1)) == [3], "it is nowhere else any more"


def test_of_very_many_addresses_the_silent_ones_are_forgotten() -> None:
    table = Table(clients=2)
    for number in range(1100):
        table.now_ns += S // 100
        frame = frame_of(HEARTBEAT, 2 + number // 200, 1 + number % 200)
        look = lambda _: table.seen  # noqa: E731
        judged = table.bridge.from_client(1, frame, [VEHICLE], look, table.now_ns)
        assert links_of(judged) == [2]


def test_a_client_that_calls_itself_a_vehicle_is_none_for_the_others() -> None:
    table = Table(clients=2)
    played = mavlink.MAVLink_heartbeat_message(2, 12, 0, 0, 4, 3)
    judged = table.says(played, 1, sysid=2)
    assert links_of(judged) == []
    told = of(LogLine, judged.effects)
    assert "it calls itself 2/190, a vehicle; a vehicle belongs on a --vehicle link" in told[0].text
    assert told[0].level is Level.WARNING
    again = table.says(played, 1, sysid=2)
    assert not of(LogLine, again.effects), "once"
    assert links_of(again) == []
    companion = mavlink.MAVLink_heartbeat_message(18, 12, 0, 0, 4, 3)
    assert links_of(table.says(companion, 1, sysid=3)) == [2], "its type is no vehicle's"


def test_a_heartbeat_goes_to_the_other_clients_and_nothing_else_does() -> None:
    table = Table(clients=3)
    for link in (1, 2, 3):
        table.says(HEARTBEAT, link)
    assert [each.link for each in of(ForwardToLink, table.says(HEARTBEAT, 2).effects)] == [1, 3]
    assert not of(ForwardToLink, table.says(mavlink.MAVLink_system_time_message(1, 1), 2).effects)
    assert not of(ForwardToVehicle, table.says(HEARTBEAT, 2).effects)


def test_what_is_for_another_client_goes_there_unless_it_is_denied() -> None:
    table = Table(clients=2)
    for link in (1, 2):
        table.says(HEARTBEAT, link)
    ping = mavlink.MAVLink_ping_message(1, 1, 246, 190)
    judged = table.says(ping, 1)
    assert not judged.refused
    assert [each.link for each in of(ForwardToLink, judged.effects)] == [2]
    takes_over = mavlink.MAVLink_file_transfer_protocol_message(0, 246, 190, bytes(251))
    assert [each.link for each in of(ForwardToLink, table.says(takes_over, 1).effects)] == [2]
    nobody = table.says(mavlink.MAVLink_ping_message(1, 1, 77, 1), 1)
    assert nobody.refused
    assert "no system 77" in of(LogLine, nobody.effects)[0].text
    assert not of(LogLine, table.says(mavlink.MAVLink_ping_message(1, 1, 77, 1), 1).effects), "once"
    denied = mavlink.MAVLink_tunnel_message(246, 190, 0, 0, bytes(128))
    assert table.says(denied, 1).refused
    for_the_bridge = table.says(mavlink.MAVLink_ping_message(1, 1, 255, 191), 1)
    assert for_the_bridge == Judged(False, [])


@pytest.mark.parametrize("name", [(255, 191), (1, 1)])
def test_nobody_plays_the_bridge_or_the_vehicle(name: tuple[int, int]) -> None:
    table = Table()
    frame = frame_of(HEARTBEAT, *name)
    judged = table.bridge.from_client(1, frame, [VEHICLE], lambda _: table.seen, table.now_ns)
    assert judged.refused
    assert not of(Joined, judged.effects)
    assert table.bridge.status(table.now_ns)[0].refused == 1


def test_a_command_for_all_components_is_answered_by_the_autopilot() -> None:
    table = Table(seen=standing(PX4))
    for compid, answers_as in ((0, 1), (1, 1), (154, 154)):
        around = mavlink.MAVLink_command_long_message(1, compid, Cmd.DO_GO_AROUND, 0, *[0.0] * 7)
        refused = of(ClientRefused, table.says(around).effects)[0]
        verdict = ipc.VerdictEvent(refused.ask.id, refused.ask.word, "refused", "UNSUPPORTED")
        told = table.bridge.told(refused.client, verdict, 1, table.now_ns)
        (answer, *_) = of(Reply, told)
        assert answer.source == Address(1, answers_as)
        assert acks(told) == [(Cmd.DO_GO_AROUND, Result.UNSUPPORTED)]
        table.now_ns += 10 * S


def test_a_command_for_the_bridge_itself_is_answered_unsupported_in_its_own_name() -> None:
    """Its sender waits for an answer.  No other component of its system is spoken for."""
    table = Table(clients=2)
    for compid in (191, 0):
        command = mavlink.MAVLink_command_long_message(
            255, compid, Cmd.REQUEST_MESSAGE, 0, *[0.0] * 7
        )
        judged = table.says(command)
        assert judged.refused
        assert acks(judged.effects) == [(Cmd.REQUEST_MESSAGE, Result.UNSUPPORTED)]
        (answer,) = of(Reply, judged.effects)
        assert (answer.link, answer.source) == (1, OWN)
        assert (answer.message.target_system, answer.message.target_component) == (245, 190)
    elsewhere = mavlink.MAVLink_command_long_message(255, 77, Cmd.REQUEST_MESSAGE, 0, *[0.0] * 7)
    assert table.says(elsewhere) == Judged(False, [])


def test_a_command_for_a_client_of_the_bridges_system_goes_to_that_client() -> None:
    table = Table(clients=2)
    table.says(HEARTBEAT, 2, sysid=255)
    for compid in (190, 0):
        command = mavlink.MAVLink_command_long_message(
            255, compid, Cmd.REQUEST_MESSAGE, 0, *[0.0] * 7
        )
        judged = table.says(command)
        assert [each.link for each in of(ForwardToLink, judged.effects)] == [2]
        assert not of(Reply, judged.effects)


def test_before_a_vehicle_is_heard_nothing_moves_and_nothing_is_set_up() -> None:
    table = Table(seen=None)
    write = mavlink.MAVLink_param_set_message(1, 1, b"MPC_XY_CRUISE", 1.0, 9)
    for message in (ARM, write):
        judged = table.says(message, vehicle=None)
        assert judged.refused
        assert not of(ClientRequest, judged.effects)
        assert not of(ForwardToVehicle, judged.effects)


def test_a_request_of_anybody_else_makes_an_old_answer_void() -> None:
    """An arming that was accepted is asked for again once another one has asked for something."""
    table = Table(clients=2, seen=standing(PX4))

    def arms() -> list[ClientRequest]:
        table.now_ns += S // 2
        effects = table.says(ARM).effects
        for said in of(ClientRequest, effects):
            for event in (
                ipc.VerdictEvent(said.command.id, "arm", "accepted", operation=1),
                ipc.EndingEvent(said.command.id, "arm", "complete"),
            ):
                table.bridge.told(said.client, event, 1, table.now_ns)
        return of(ClientRequest, effects)

    assert len(arms()) == 1
    assert arms() == []
    table.bridge.asked(1000, 1, table.now_ns)
    assert arms() == [], "its own request changes nothing"
    table.bridge.asked(7, 1, table.now_ns)
    assert len(arms()) == 1


def test_the_soonest_wait_of_any_client_is_the_bridges() -> None:
    table = Table(clients=2)
    assert due_ns(table) is None
    table.says(mavlink.MAVLink_mission_count_message(1, 1, 3, 0), 1)
    first_ns = due_ns(table)
    assert first_ns is not None
    table.now_ns += S // 10
    table.says(mavlink.MAVLink_mission_count_message(1, 1, 3, 0), 2)
    assert due_ns(table) == first_ns
    assert table.bridge.wake(first_ns - 1) == []
    asked = table.bridge.wake(first_ns)
    assert {each.link for each in of(Reply, asked)} == {1}


def test_a_plan_is_collected_and_asked_for_whole() -> None:
    table = Table(seen=flying(ARDUPILOT))
    begun = table.says(mavlink.MAVLink_mission_count_message(1, 1, 1, 0)).effects
    assert any(isinstance(each.message, MissionRequestInt) for each in of(Reply, begun))
    item = mavlink.MAVLink_mission_item_int_message(
        1, 1, 0, 3, 16, 0, 1, 0, 0, 0, 0, 473977420, 85455940, 10, 0
    )
    (asked,) = of(AsksPlan, table.says(item).effects)
    assert asked.ask.word == "mission_upload"
    assert asked.plan is not None
    assert len(asked.plan.items) == 1


def test_an_item_to_fly_to_at_once_is_a_goto_and_no_part_of_a_plan() -> None:
    table = Table(seen=flying(ARDUPILOT))
    item = mavlink.MAVLink_mission_item_int_message(
        1, 1, 0, 6, 16, 2, 1, 0, 0, 0, 0, 473977420, 85455940, 10, 0
    )
    (said,) = of(ClientRequest, table.says(item).effects)
    assert said.command.word == "goto"


def test_too_much_is_counted_and_told() -> None:
    table = Table()
    (note,) = table.bridge.flooded(1, 5)
    assert note == LogLine(Level.WARNING, "udp 1 sends too much: 5 datagrams dropped")
    table.bridge.flooded(1, 2)
    assert table.bridge.status(table.now_ns)[0].dropped == 7
    assert table.bridge.flooded(2, 5) == []


def test_the_page_has_what_a_client_is() -> None:
    table = Table()
    table.now_ns += S
    table.says(HEARTBEAT)
    table.now_ns += 3 * S
    (told,) = table.bridge.status(table.now_ns)
    assert (told.client, told.link, told.ids, told.silent_s) == (1000, 1, ["245/190"], 3.0)
    assert not told.in_control
    changed = table.bridge.control_changed(1000, "udp 1", [VEHICLE], table.now_ns)
    assert texts(changed) == "gate: in control: udp 1"
    assert table.bridge.status(table.now_ns)[0].in_control
    assert texts(table.bridge.control_changed(0, "", [VEHICLE], table.now_ns)) == (
        "gate: nobody is in control"
    )
    assert not table.bridge.status(table.now_ns)[0].in_control


def test_rates_are_of_whole_spans_of_two_seconds() -> None:
    table = Table()
    frames = [frame_of(HEARTBEAT, 1, 1)] * 3
    for tenths in range(41):
        table.bridge.from_vehicle(frames, table.now_ns + tenths * S // 10)
    (told,) = table.bridge.status(table.now_ns)
    assert told.tx_hz == pytest.approx(30.0)
    assert told.rx_hz == 0.0


def test_a_client_that_has_gone_is_no_client() -> None:
    table = Table()
    table.says(HEARTBEAT)
    lost, note = table.bridge.gone(1, "the connection was closed")
    assert lost == Lost(1000, "the connection was closed")
    assert isinstance(note, LogLine)
    assert table.bridge.gone(1, "again") == []
    assert table.bridge.told(1000, ipc.EndingEvent(1, "arm", "complete"), 1, table.now_ns) == []
    assert table.bridge.status(table.now_ns) == []


def test_what_is_for_all_and_changes_a_vehicle_goes_to_the_one_that_it_was_judged_for() -> None:
    """Who else hears the same radio, and is no vehicle of this bridge, was not judged."""
    table = Table(seen=standing(PX4))
    table.says(HEARTBEAT)
    write = mavlink.MAVLink_param_set_message(0, 1, b"SDLOG_MODE", 1.0, 6)
    (sent,) = of(ForwardToVehicle, table.says(write).effects)
    (frame,) = split(sent.raw)
    assert isinstance(frame, Frame)
    assert (frame.sysid, frame.payload[4]) == (245, VEHICLE.sysid), "PARAM_SET.target_system"
    harmless = mavlink.MAVLink_param_request_list_message(0, 1)
    (passed,) = of(ForwardToVehicle, table.says(harmless).effects)
    assert passed.raw == frame_of(harmless).raw


def test_what_a_lost_client_had_the_vehicle_send_is_taken_back() -> None:
    table = Table()
    faster = mavlink.MAVLink_command_long_message(
        1, 1, Cmd.SET_MESSAGE_INTERVAL, 0, 105, 20_000, 0, 0, 0, 0, 0
    )
    table.says(faster)
    effects = table.bridge.second([VEHICLE], table.now_ns + 11 * S)
    (asked,) = of(AsksVehicle, effects)
    told = asked.message
    assert isinstance(told, CommandLong)
    assert (told.command, told.param1, told.param2) == (Cmd.SET_MESSAGE_INTERVAL, 105.0, 0.0)
    assert (asked.source, told.target_system) == (OWN, 1)


def told_of(table: Table, judged: Judged) -> str:
    """The texts that a client reads once the station has recorded the refusal."""
    return "".join(
        texts(
            table.bridge.told(
                each.client,
                ipc.VerdictEvent(
                    each.ask.id, each.ask.word, "refused", each.refusal.code, each.refusal.sentence
                ),
                VEHICLE.sysid,
                table.now_ns,
            )
        )
        for each in of(ClientRefused, judged.effects)
    )


def test_a_command_that_the_policy_denies_by_its_name_is_told_so() -> None:
    table = Table(rules=with_rules('extra_denied = ["DO_DIGICAM_CONTROL"]'))
    photo = mavlink.MAVLink_command_long_message(1, 1, 203, 0, 0, 0, 0, 0, 1, 0, 0)
    said = told_of(table, table.says(photo))
    assert said.startswith("DO_DIGICAM_CONTROL: refused POLICY: ")
    assert "extra_denied" in said
    assert "camera" not in said
    servo = mavlink.MAVLink_command_long_message(1, 1, 183, 0, 9, 1_900, 0, 0, 0, 0, 0)
    assert "past the controllers" in told_of(table, table.says(servo)), "by the tables, as ever"


def test_another_fence_that_is_refused_is_told_and_the_same_count_again_is_not() -> None:
    table = Table()
    said = [
        told_of(table, table.says(mavlink.MAVLink_mission_count_message(1, 1, many, 1)))
        for many in (4, 4, 5)
    ]
    assert [text.count("bridge.fence") for text in said] == [1, 0, 1]


@pytest.mark.parametrize(
    "message",
    [
        mavlink.MAVLink_mission_count_message(1, 1, 3, 9),
        mavlink.MAVLink_mission_clear_all_message(1, 1, 7),
    ],
)
def test_a_type_of_plan_that_is_not_known_is_not_supported(message: Any) -> None:
    answers = [each.message for each in of(Reply, Table().says(message).effects)]
    assert [each.type for each in answers if isinstance(each, MissionAck)] == [3]
