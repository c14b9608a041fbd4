"""`gcs bridge --client-key`: a crowd without the key neither keeps out who has it, nor hears more
than heartbeats."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.exit_codes import ExitCode
from gcs.shell.key_files import new_key
from gcs.wire.codec import decode
from gcs.wire.frame import Frame, split
from gcs.wire.messages import CommandAck
from tests.system.patience import PATIENT_POLICY, hold_much, until
from tests.system.programs import gcs
from tests.system.test_bridge_cli import ANY_TCP, ANY_UDP, bridge, ended, port

pytestmark = pytest.mark.system

CROWD = 10
BEAT_S = 0.5
ARM = 400
ACCEPTED = dialect.MAV_RESULT_ACCEPTED
ANSWERS = (ACCEPTED, dialect.MAV_RESULT_TEMPORARILY_REJECTED)
OTHER_KEY = bytes(32 * [7])
BRIDGE_RULES = "\n[bridge]\nmax_clients = 2\n"


@pytest.fixture(autouse=True)
def runtime(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stations of this test alone."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("run")))


class Peer:
    """Beats and asks for an arming, without a key or with one, and keeps what it is sent."""

    def __init__(self, kind: str, at: int, sysid: int, key: bytes | None) -> None:
        self._kind, self._at = kind, at
        self._mav = dialect.MAVLink(None, srcSystem=sysid, srcComponent=190)
        if key is not None:
            self._mav.signing.secret_key, self._mav.signing.sign_outgoing = key, True
            self._mav.signing.timestamp = round((time.time() - 1_420_070_400) * 1e5)
        self._heard = b""
        self._socket = self._connect()

    def _connect(self) -> socket.socket:
        kind = socket.SOCK_DGRAM if self._kind == "udp" else socket.SOCK_STREAM
        made = socket.socket(socket.AF_INET, kind)
        hold_much(made)
        made.connect(("127.0.0.1", self._at))
        made.setblocking(False)
        return made

    def beat(self) -> None:
        """One that was closed comes again."""
        for message in (
            dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3),
            dialect.MAVLink_command_long_message(1, 1, ARM, 0, 1, 0, 0, 0, 0, 0, 0),
        ):
            try:
                self._socket.send(message.pack(self._mav))
            except OSError:
                self.close()
                self._socket = self._connect()
        with suppress(BlockingIOError, ConnectionError):
            while data := self._socket.recv(1 << 16):
                self._heard += data

    @property
    def heard(self) -> list[Frame]:
        """All good frames; what is no frame fails the test."""
        items = split(self._heard)
        frames = [item for item in items if isinstance(item, Frame)]
        assert len(frames) == len(items)
        return frames

    def answered(self, *results: int) -> bool:
        """Whether an arming of it had one of these as its answer."""
        acks = [decode(frame) for frame in self.heard if frame.name == "COMMAND_ACK"]
        return any(isinstance(ack, CommandAck) and ack.result in results for ack in acks)

    def close(self) -> None:
        self._socket.close()


class Beats:
    """Everybody who is there beats while something is waited for."""

    def __init__(self) -> None:
        self.there: list[Peer] = []
        self._next_s = 0.0

    def until(self, true: Callable[[], bool], what: str) -> None:
        def looked() -> bool:
            if time.monotonic() >= self._next_s:
                self._next_s = time.monotonic() + BEAT_S
                for each in self.there:
                    each.beat()
            return true()

        until(looked, what)


@contextmanager
def everybody() -> Iterator[Beats]:
    beats = Beats()
    try:
        yield beats
    finally:
        for each in beats.there:
            each.close()


@pytest.mark.parametrize("key", [None, OTHER_KEY], ids=["no key", "another key"])
def test_a_crowd_without_the_key_keeps_nobody_out_who_has_it(
    tmp_path: Path, key: bytes | None
) -> None:
    path = str(tmp_path / "client.key")
    right = new_key(path).secret
    policy = tmp_path / "two_clients.toml"
    policy.write_text(Path(PATIENT_POLICY).read_text() + BRIDGE_RULES)
    words = ("--sim", "--policy", str(policy), "--client-key", path)
    with bridge(tmp_path, *words, "--client", ANY_UDP, "--client", ANY_TCP) as program:
        udp, tcp = port(program, "udp"), port(program, "tcp")
        with everybody() as beats:
            crowd = [Peer("udp", udp, 100 + each, key) for each in range(CROWD)]
            crowd += [Peer("tcp", tcp, 120 + each, key) for each in range(CROWD)]
            beats.there += crowd
            beats.until(lambda: all(each.heard for each in crowd[:CROWD]), "their heartbeats")

            one, other = Peer("udp", udp, 255, right), Peer("tcp", tcp, 254, right)
            beats.there += [one, other]
            beats.until(lambda: one.answered(ACCEPTED) or other.answered(ACCEPTED), "an arming")
            beats.until(lambda: one.answered(*ANSWERS) and other.answered(*ANSWERS), "both answers")
            status = ("status", "--log-dir", str(tmp_path))
            beats.until(lambda: "not verified" in gcs(*status).stdout, "who is not, in gcs status")
            beats.until(lambda: any("not verified)" in line for line in program.out), "its status")

            told = "".join(program.err)
            assert told.count("is verified: it has the clients' key") == 2
            assert "not verified: it is sent heartbeats alone" in told
        assert ended(program) == ExitCode.DONE
    heard = [frame for each in crowd for frame in each.heard]
    assert {(frame.name, frame.sysid, frame.compid) for frame in heard} == {("HEARTBEAT", 1, 1)}
    (log,) = tmp_path.glob("*_bridge.mcap")
    audit = gcs("log", "audit", str(log))
    assert "no difference" in audit.stdout, audit.stdout + audit.stderr
