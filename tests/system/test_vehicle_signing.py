"""A pymavlink script sets up signing as MAVProxy does, and from then on only it is obeyed."""

from __future__ import annotations

import hashlib
import time
from typing import Protocol

import pytest
from pymavlink import mavutil

from tests.system.patience import PATIENT_S, until
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = pytest.mark.system

REQUEST_MESSAGE = 512
AUTOPILOT_VERSION = 148
EPOCH_UNIX_S = 1_420_070_400


class Link(Protocol):
    """What is used of pymavlink's connections here."""

    mav: Sender

    def wait_heartbeat(self, timeout: float) -> object: ...
    def recv_match(self, type: str, blocking: bool, timeout: float) -> object: ...
    def setup_signing(self, key: bytes) -> None: ...
    def close(self) -> None: ...


class Sender(Protocol):
    signing: Signing

    def command_long_send(self, *values: float) -> None: ...
    def setup_signing_send(self, system: int, component: int, key: list[int], at: int) -> None: ...


class Signing(Protocol):
    goodsig_count: int
    badsig_count: int
    reject_count: int


def connect(port: int, system: int) -> Link:
    """It listens, hears MAVLink 2 and speaks it."""
    link: Link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=system)
    return link


def answered(link: Link, within_s: float = 1.0) -> bool:
    link.mav.command_long_send(1, 1, REQUEST_MESSAGE, 0, AUTOPILOT_VERSION, 0, 0, 0, 0, 0, 0)
    return link.recv_match(type="COMMAND_ACK", blocking=True, timeout=within_s) is not None


def until_answered(link: Link) -> None:
    """Asks once a second: what a link that nobody reads cannot hold any more is lost."""
    until(lambda: answered(link), "an answer")


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_signing_is_set_up_used_and_ended_over_the_wire(autopilot: str) -> None:
    ports = free_port(), free_port()
    owner, stranger = connect(ports[0], 255), connect(ports[1], 254)
    key = hashlib.sha256(b"correct horse").digest()
    links = [part for port in ports for part in ("--link", f"udpout://127.0.0.1:{port}")]
    with vehicle_sim("--autopilot", autopilot, *links) as lines:
        for link in (owner, stranger):
            assert link.wait_heartbeat(timeout=PATIENT_S) is not None
        until_answered(stranger)
        ticks = int((time.time() - EPOCH_UNIX_S) * 1e5)
        owner.mav.setup_signing_send(1, 1, list(key), ticks)
        owner.setup_signing(key)
        until_answered(owner)
        assert owner.mav.signing.goodsig_count > 0
        assert not answered(stranger)
        owner.mav.setup_signing_send(1, 1, [0] * 32, 0)
        until_answered(stranger)
    assert any("signing is on, set up by client 255/" in line for line in lines)
    assert any("a frame is ignored (unsigned)" in line for line in lines)
    assert any("signing is off" in line for line in lines)
    owner.close()
    stranger.close()
