"""Control among the clients of a bridge, by MAVLink's own messages; pymavlink reads the answers.

CONTROL_STATUS and its command are MAVLink's development.xml, which pymavlink 2.4.50 lacks: the
command goes by its number, the message is taken apart by hand.
"""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from gcs.wire.codec import decode
from gcs.wire.frame import Frame, split
from gcs.wire.messages import ControlStatus
from tests.loopback.bridged import BridgedFlight, Client

ARM, CONTROL = 400, 32100
ACCEPTED, TEMPORARILY_REJECTED, DENIED = 0, 1, 2
RELEASE, REQUEST = 0, 1
MANAGER, TAKEOVER = 1, 2


class Table(BridgedFlight):
    """Two clients at one vehicle on the ground; what each was sent, as bytes."""

    def __init__(self) -> None:
        self.raw: dict[int, list[bytes]] = {}
        super().__init__("px4")
        self.one, self.other = self.join(245), self.join(246)
        self.connected()
        for client in (self.one, self.other):
            assert client.ask(CONTROL, RELEASE) == ACCEPTED
        self.settle()

    def to_client(self, link: int, data: bytes) -> None:
        self.raw.setdefault(link, []).append(data)
        super().to_client(link, data)

    def status(self, client: Client) -> tuple[int, int]:
        """Flags and main station of the last CONTROL_STATUS that the client was sent."""
        last = decode(self.statuses(client)[-1])
        assert isinstance(last, ControlStatus)
        return last.flags, last.gcs_main

    def statuses(self, client: Client) -> list[Frame]:
        """Every CONTROL_STATUS that the client was sent."""
        return [
            item
            for data in self.raw.get(client.link, ())
            for item in split(data)
            if isinstance(item, Frame) and item.name == "CONTROL_STATUS"
        ]

    def settle(self) -> None:
        self.beating(1.5)


def test_control_status_comes_once_a_second_from_the_vehicle_s_own_address() -> None:
    table = Table()
    before = len(table.statuses(table.one))
    table.beating(5.0)
    statuses = table.statuses(table.one)
    assert {(frame.sysid, frame.compid) for frame in statuses} == {(1, 1)}
    assert 4 <= len(statuses) - before <= 6
    assert table.status(table.one) == (MANAGER | TAKEOVER, 0)


def test_who_has_never_used_the_command_is_not_sent_what_it_cannot_read() -> None:
    table = Table()
    third = table.join(247)
    table.beating(3.0)
    assert table.statuses(third) == []


def test_control_is_asked_for_given_up_and_seen_by_all() -> None:
    table = Table()
    assert table.one.ask(CONTROL, REQUEST, 1) == ACCEPTED
    table.settle()
    assert table.status(table.one) == table.status(table.other) == (MANAGER | TAKEOVER, 245)
    assert table.other.ask(ARM, 1) == TEMPORARILY_REJECTED
    assert table.one.ask(CONTROL, RELEASE) == ACCEPTED
    table.settle()
    assert table.status(table.other) == (MANAGER | TAKEOVER, 0)
    assert table.other.ask(ARM, 1) == ACCEPTED
    table.settle()
    assert table.status(table.one) == (MANAGER | TAKEOVER, 246)


def test_another_may_take_over_where_the_one_in_control_has_allowed_it() -> None:
    table = Table()
    assert table.one.ask(CONTROL, REQUEST, 1) == ACCEPTED
    assert table.other.ask(CONTROL, REQUEST, 0) == ACCEPTED
    table.settle()
    assert table.status(table.one) == (MANAGER, 246)
    assert table.one.ask(ARM, 1) == TEMPORARILY_REJECTED


def test_where_nobody_may_take_over_the_one_in_control_is_asked() -> None:
    table = Table()
    assert table.one.ask(CONTROL, REQUEST, 0) == ACCEPTED
    table.settle()
    assert table.status(table.one) == (MANAGER, 245)
    assert table.other.ask(CONTROL, REQUEST, 1, 10) == TEMPORARILY_REJECTED
    (asked,) = [m for m in table.one.messages("COMMAND_LONG") if m.command == CONTROL]
    assert (asked.param1, asked.param2, asked.param3, asked.param4) == (1, 1, 10, 246)
    assert (asked.target_system, asked.target_component) == (245, 190)
    table.settle()
    assert table.status(table.other) == (MANAGER, 245)
    assert table.one.ask(CONTROL, RELEASE) == ACCEPTED
    table.beating(3.0)
    assert table.other.ask(CONTROL, REQUEST, 1, 11) == ACCEPTED


def test_what_is_neither_release_nor_request_is_refused() -> None:
    table = Table()
    assert table.one.ask(CONTROL, 7) == DENIED
    table.settle()
    assert table.status(table.one) == (MANAGER | TAKEOVER, 0)


def test_nothing_of_it_reaches_the_vehicle() -> None:
    table = Table()
    table.one.ask(CONTROL, REQUEST, 1)
    change(table.other, 0)
    table.settle()
    assert not table.to_vehicle("CHANGE_OPERATOR_CONTROL")
    commands = [decode(frame) for frame in table.to_vehicle("COMMAND_LONG")]
    assert CONTROL not in {getattr(command, "command", 0) for command in commands}


def change(client: Client, asked: int) -> list[Any]:
    """CHANGE_OPERATOR_CONTROL: 0 requests, 1 releases; the answers to it."""
    client.send(dialect.MAVLink_change_operator_control_message(1, asked, 0, b""))
    client.flight.run(0.5)
    return client.messages("CHANGE_OPERATOR_CONTROL_ACK")


@pytest.mark.parametrize("kept", [False, True])
def test_the_older_message_does_the_same(kept: bool) -> None:
    table = Table()
    assert [(a.gcs_system_id, a.ack) for a in change(table.one, 0)] == [(245, 0)]
    table.settle()
    assert table.status(table.other) == (MANAGER | TAKEOVER, 245)
    assert change(table.one, 1)[-1].ack == 0
    table.settle()
    assert table.status(table.other) == (MANAGER | TAKEOVER, 0)
    if kept:
        assert table.one.ask(CONTROL, REQUEST, 0) == ACCEPTED
    assert change(table.other, 0)[-1].ack == (3 if kept else 0)
    table.settle()
    assert table.status(table.one)[1] == (245 if kept else 246)
    assert table.is_in(State.GROUNDED)
