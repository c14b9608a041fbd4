"""A client that calls itself by ever more names costs the station no memory."""

from __future__ import annotations

from gcs.bridge.routing import MOST_COMPONENTS, Routes
from gcs.protocol.effects import Address
from gcs.session.effects import Transmit
from gcs.station.links import MOST_NAMES, Links
from gcs.wire.frame import Frame, split
from gcs.wire.messages import ParamRequestRead


def test_only_so_many_components_of_a_link_are_remembered() -> None:
    routes = Routes()
    routes.open(1)
    for number in range(65536):
        routes.heard(1, number >> 8, number & 0xFF)
    assert len(routes.components(1)) == MOST_COMPONENTS
    routes.heard(1, 0, 0)
    assert len(routes.components(1)) == MOST_COMPONENTS


def test_only_so_many_names_are_written_in() -> None:
    links = Links(255, 191, 1)

    def sequence_number(sysid: int, compid: int) -> int:
        """Of the next frame in that name."""
        message = ParamRequestRead(-1, 1, 1, "SDLOG_MODE")
        (sent,) = [
            each
            for each in links.send_as(Address(sysid, compid), 0, message, 0)
            if isinstance(each, Transmit)
        ]
        (frame,) = split(sent.data)
        assert isinstance(frame, Frame)
        return frame.seq

    assert [sequence_number(1, 1) for _ in range(3)] == [0, 1, 2]
    for number in range(MOST_NAMES):
        sequence_number(2 + number // 256, number % 256)
    assert sequence_number(1, 1) == 0, "it was forgotten"
