"""`gcs key new`, `gcs bridge --lock`: who goes round it gets nothing, and is on the record."""

from __future__ import annotations

import hashlib
import time
from pathlib import Path
from typing import Any

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import all as dialect

from gcs.exit_codes import ExitCode
from tests.system.patience import until
from tests.system.programs import GCS, Running, gcs, running
from tests.system.test_bridge_cli import Client, ended, of_vehicle, port
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = pytest.mark.system

ARM, BY_FORCE = 400, 21196
HEARD_FOR_S = 1.5
PATIENT_S = 90.0
"""Key and parameters take 8 s; more on a busy machine, where the vehicle may start only after the
10 s in which the bridge looks for one."""


def attack(udp_port: int, sysid: int, secret: bytes = b"") -> set[str]:
    """Arms, by force too, uploads a mission, switches the asking off, takes the key away; kinds of
    messages that came back."""
    link: Any = mavutil.mavlink_connection(
        f"udpout:127.0.0.1:{udp_port}", source_system=sysid, source_component=190, dialect="all"
    )
    if secret:
        link.setup_signing(secret, allow_unsigned_callback=lambda *_: True)
    link.mav.heartbeat_send(6, 8, 0, 0, 4)
    for force in (0, BY_FORCE):
        link.mav.command_long_send(1, 1, ARM, 0, 1, force, 0, 0, 0, 0, 0)
    link.mav.mission_count_send(1, 1, 1, 0)
    link.mav.param_set_send(1, 1, b"COM_ARM_AUTH_REQ", 0, 6)
    link.mav.setup_signing_send(1, 1, [0] * 32, 0)
    heard, end_s = set(), time.monotonic() + HEARD_FOR_S
    while time.monotonic() < end_s:
        message = link.recv_match(blocking=True, timeout=0.1)
        if message is not None:
            heard.add(message.get_type())
    link.close()
    return heard


def said(program: Running, text: str) -> bool:
    assert program.process.poll() is None, f"it has ended: {program.err}"
    return any(text in line for line in program.err)


def test_a_locked_px4_flies_at_once_and_for_the_bridge_alone(tmp_path: Path) -> None:
    key = tmp_path / "vehicle.key"
    assert gcs("key", "new", str(key)).returncode == ExitCode.DONE
    at_bridge, at_vehicle = free_port(), free_port()
    links = ("--link", f"udpout://127.0.0.1:{at_bridge}")
    words = ("--lock", "--set-fence", "--sign-key", str(key), "--log-dir", str(tmp_path))
    ends = ("--vehicle", f"udpin://127.0.0.1:{at_bridge}", "--client", "udpin://127.0.0.1:0")
    patient = ("--timeout", f"{PATIENT_S:g}")
    with (
        vehicle_sim(*links, "--link", f"udpin://127.0.0.1:{at_vehicle}"),
        running(GCS, "bridge", *words, *ends, "--no-compact", *patient) as program,
    ):
        until(lambda: said(program, "clients: waiting"), "the bridge", PATIENT_S)
        client = Client(f"udpout:127.0.0.1:{port(program, 'udp')}", 245)
        client.until("HOME_POSITION", of_vehicle)
        told = "".join(program.err)
        for line in ("was given the key", "GF_MAX_HOR_DIST = 150 (was 0)", "COM_ARM_AUTH_REQ = 1"):
            assert line in told
        answers = {"COMMAND_ACK", "PARAM_VALUE", "MISSION_REQUEST_INT", "MISSION_REQUEST"}
        other = hashlib.sha256(b"another key").digest()
        for udp_port in (at_vehicle, at_bridge):
            assert not attack(udp_port, 250) & answers
            assert not attack(udp_port, 251, other) & answers
        disarmed = client.until("HEARTBEAT", of_vehicle)
        assert not disarmed.base_mode & 128
        until(lambda: said(program, "250/190 COMMAND_LONG"), "who tried")
        until(lambda: said(program, "251/190 COMMAND_LONG"), "who tried")
        client.send(dialect.MAVLink_command_long_message(1, 1, ARM, 0, 1, 0, 0, 0, 0, 0, 0))
        assert client.until("COMMAND_ACK", lambda ack: ack.command == ARM).result == 0
        client.until("HEARTBEAT", lambda beat: of_vehicle(beat) and beat.base_mode & 128)
        client.close()
        assert ended(program) == ExitCode.DONE
