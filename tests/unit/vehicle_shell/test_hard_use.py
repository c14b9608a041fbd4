"""What clients and controllers do to the program that no specification has."""

from __future__ import annotations

import contextlib
import errno
import io
import json
import os
import socket
import sys

import pytest

from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.reporting import Plain
from vehicle_sim.shell.endpoints import ACCEPT_AGAIN_NS, TcpServer
from vehicle_sim.shell.readable import ReadableSockets
from vehicle_sim.shell.urls import Url, UrlKind
from vehicle_sim.simulation.control_line import LINE_MAX, answer
from vehicle_sim.simulation.fault_script import AnyFault
from vehicle_sim.simulation.world import Joined, Log


class EmptyStage:
    def truth(self, system: int) -> Truth | None:
        return None

    def inject(self, fault: AnyFault, system: int | None) -> bool:
        return False

    def faults(self, system: int | None) -> list[AnyFault]:
        return []


@pytest.mark.parametrize("line", [b"[" * (LINE_MAX - 1), b'{"id":' + b"[" * 60_000, b"\xff", b"1"])
def test_the_control_line_answers_whatever_is_written(line: bytes) -> None:
    assert "error" in json.loads(answer(line, EmptyStage()))


@pytest.mark.slow
def test_without_a_descriptor_to_spare_the_listener_rests_and_comes_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    server = TcpServer(0, Url(UrlKind.TCP_IN, "127.0.0.1", 0))
    watch = ReadableSockets()
    server.attach(watch)
    client = socket.create_connection(("127.0.0.1", server.url.port))
    ((listener, _),) = watch.ready(1.0)
    with monkeypatch.context() as patch:

        def no_room(self: socket.socket) -> None:
            raise OSError(errno.EMFILE, "Too many open files")

        patch.setattr(socket.socket, "accept", no_room)
        assert server.read(listener) == []
        assert watch.ready(0.0) == [], "it would wake the loop all the time"
    assert server.idle(0) == []
    assert watch.ready(0.0) == []
    server.idle(ACCEPT_AGAIN_NS)
    ((listener, _),) = watch.ready(1.0)
    assert [type(given) for given in server.read(listener)] == [Joined]
    client.close()
    server.close()
    watch.close()


def test_who_does_not_read_the_log_does_not_stop_the_vehicle(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    with contextlib.suppress(BlockingIOError):
        while True:
            os.write(writer, bytes(4096))
    os.set_blocking(reader, False)
    with os.fdopen(writer, "w", encoding="utf-8") as full, os.fdopen(reader, "rb") as unread:
        monkeypatch.setattr(sys, "stdout", full)
        # Were it written, the full pipe would raise: it does not block in this test.
        Plain("info").log(Log("info", "vehicle1", "nobody reads this"))
        assert sys.stdout is full
        unread.read()
        Plain("info").log(Log("info", "vehicle1", "read again"))
        assert unread.read() == b"INFO vehicle1: read again\n"


def test_a_full_disk_under_the_log_does_not_stop_the_vehicle(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class FullDisk(io.StringIO):
        def write(self, text: str) -> int:
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(sys, "stdout", FullDisk())
    Plain("info").log(Log("info", "vehicle1", "first"))
    Plain("info").log(Log("info", "vehicle1", "second"))
