"""Hearing a vehicle without a station: what goes out, and what does not."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.shell.clock import Clock
from gcs.shell.endpoints import parse_endpoint
from gcs.shell.listener import Listener
from tests.unit.record.flights import position_frame

pytestmark = pytest.mark.slow

RAW = position_frame(1).raw
TRIES = 50


@pytest.fixture
def peer() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as made:
        made.bind(("127.0.0.1", 0))
        made.settimeout(0.3)
        yield made


def heard(listener: Listener, send: Callable[[], object]) -> bytes:
    """The first frame, sent again and again until it is there."""
    for _ in range(TRIES):
        send()
        for _, frame in listener.frames():
            return frame.raw
    raise AssertionError("nothing is heard")


def test_a_link_that_waits_says_nothing(peer: socket.socket) -> None:
    port = _free_port()
    with Listener([parse_endpoint(f"udpin://127.0.0.1:{port}")], Clock()) as listener:
        assert heard(listener, lambda: peer.sendto(RAW, ("127.0.0.1", port))) == RAW
        list(listener.frames())
        with pytest.raises(TimeoutError):
            peer.recv(1000)


def test_where_a_vehicle_answers_only_who_speaks_a_generic_component_does(
    peer: socket.socket,
) -> None:
    """Of no ground station's system id and type: no failsafe waits for it."""
    port = peer.getsockname()[1]
    with Listener([parse_endpoint(f"udpout://127.0.0.1:{port}")], Clock()) as listener:
        list(listener.frames())
        said, address = peer.recvfrom(1000)
        (beat,) = dialect.MAVLink(None).parse_buffer(said)
        assert (beat.get_type(), beat.get_srcSystem(), beat.type) == ("HEARTBEAT", 254, 0)
        assert heard(listener, lambda: peer.sendto(RAW, address)) == RAW
        with pytest.raises(TimeoutError):
            peer.recv(1000)


def _free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as made:
        made.bind(("127.0.0.1", 0))
        return int(made.getsockname()[1])
