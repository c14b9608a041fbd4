"""Where a frame goes: MAVLink's routing rules (https://mavlink.io/en/guide/routing.html)."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import all as dialect

from gcs.bridge.routing import EVERYBODY, Routes, readdressed, target_of
from gcs.wire.frame import Frame, split
from tests.each import each

TARGETED = sorted(
    (cls for cls in dialect.mavlink_map.values() if "target_system" in cls.fieldnames),
    key=lambda cls: str(cls.msgname),
)


def frame_of(message: Any, sysid: int = 1, compid: int = 1) -> Frame:
    """As pymavlink puts it on the wire."""
    (frame,) = split(message.pack(dialect.MAVLink(None, srcSystem=sysid, srcComponent=compid)))
    assert isinstance(frame, Frame)
    return frame


def blank(cls: Any, **given: int) -> Any:
    """A message of pymavlink with zeros, but for what is given."""
    array = dict(zip(cls.ordered_fieldnames, cls.array_lengths, strict=True))
    values = []
    for name, kind in zip(cls.fieldnames, cls.fieldtypes, strict=True):
        zero: object = 0.0 if kind in ("float", "double") else 0
        if kind == "char":
            zero = b""
        elif array[name]:
            zero = [zero] * array[name]
        values.append(given.get(name, zero))
    return cls(*values)


@each("cls", TARGETED, said=lambda cls: str(cls.msgname))
def test_the_target_stands_where_pymavlink_puts_it(cls: Any) -> None:
    has_component = "target_component" in cls.fieldnames
    for sysid, compid in ((0, 0), (7, 0), (7, 190), (255, 1)):
        message = blank(cls, target_system=sysid, target_component=compid)
        expected = (sysid, compid if has_component else 0)
        assert target_of(frame_of(message)) == expected


def test_a_message_without_a_target_is_for_everybody() -> None:
    assert target_of(frame_of(blank(dialect.MAVLink_heartbeat_message))) == EVERYBODY


def ack_for(sysid: int, compid: int) -> Frame:
    return frame_of(
        blank(dialect.MAVLink_command_ack_message, target_system=sysid, target_component=compid)
    )


class TestRoutes:
    @staticmethod
    def routes() -> Routes:
        """Two clients on link 1 and one on link 2; nobody was heard on link 3 yet."""
        routes = Routes()
        for link in (1, 2, 3):
            routes.open(link)
        routes.heard(1, 245, 190)
        routes.heard(1, 255, 190)
        routes.heard(2, 255, 230)
        return routes

    def test_what_is_for_everybody_goes_to_every_client(self) -> None:
        beat = frame_of(blank(dialect.MAVLink_heartbeat_message))
        assert self.routes().to_clients(beat) == [1, 2, 3]
        assert self.routes().to_clients(ack_for(0, 0)) == [1, 2, 3]

    def test_what_is_for_a_system_goes_where_it_was_heard(self) -> None:
        assert self.routes().to_clients(ack_for(255, 0)) == [1, 2]
        assert self.routes().to_clients(ack_for(255, 230)) == [2]
        assert self.routes().to_clients(ack_for(245, 190)) == [1]

    def test_what_is_for_nobody_here_goes_nowhere(self) -> None:
        """Such as the vehicle's answers to the station itself."""
        assert self.routes().to_clients(ack_for(255, 191)) == []
        assert self.routes().to_clients(ack_for(9, 0)) == []

    def test_nothing_goes_back_where_it_came_from(self) -> None:
        beat = frame_of(blank(dialect.MAVLink_heartbeat_message), 245, 190)
        assert self.routes().between_clients(beat, 1) == [2, 3]

    def test_a_link_that_closed_is_forgotten_and_its_number_is_a_new_one(self) -> None:
        routes = self.routes()
        routes.close(2)
        assert routes.to_clients(ack_for(255, 0)) == [1]
        routes.open(2)
        assert routes.components(2) == []
        assert routes.to_clients(ack_for(255, 230)) == []


@each("cls", TARGETED, said=lambda cls: str(cls.msgname))
def test_a_frame_for_all_becomes_one_for_a_system(cls: Any) -> None:
    """As pymavlink reads it: nothing but the target is another."""
    given = {"target_component": 5} if "target_component" in cls.fieldnames else {}
    frame = frame_of(blank(cls, **given), 245, 190)
    changed = readdressed(frame, 7)
    assert target_of(changed) == (7, given.get("target_component", 0))
    reader = dialect.MAVLink(None)
    (before,), (after,) = reader.parse_buffer(frame.raw), reader.parse_buffer(changed.raw)
    assert (after.get_srcSystem(), after.get_srcComponent(), after.get_seq()) == (245, 190, 0)
    assert after.target_system == 7
    after.target_system = 0
    assert str(after) == str(before)


def test_manual_control_names_its_vehicle_as_target() -> None:
    message = dialect.MAVLink_manual_control_message(7, 100, 0, 500, 0, 0)
    assert target_of(frame_of(message, 245, 190)) == (7, 0)


def test_a_message_without_a_target_stays_as_it_is() -> None:
    frame = frame_of(dialect.MAVLink_system_time_message(1, 2), 245, 190)
    assert readdressed(frame, 7) is frame
