"""`gcs bridge` as a user starts it: clients come and go, decisions are told, it ends in order."""

from __future__ import annotations

import json
import re
import signal
import socket
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import all as dialect

from gcs.exit_codes import ExitCode
from tests.system.patience import PATIENT_POLICY, PATIENT_S, hold_much, until
from tests.system.programs import GCS, Running, gcs, running
from tests.system.vehicle_program import free_port

if sys.platform != "win32":
    from tests.system.terminal import terminal

pytestmark = pytest.mark.system

ANY_UDP, ANY_TCP = "udpin://127.0.0.1:0", "tcpin://127.0.0.1:0"


class Client:
    """A MAVLink client of pymavlink's, which beats once a second while it is looked at."""

    def __init__(self, url: str, sysid: int = 255) -> None:
        self._link: Any = mavutil.mavlink_connection(
            url, source_system=sysid, source_component=190, dialect="all"
        )
        hold_much(self._link.port)
        self._beat_s = 0.0
        self.close: Callable[[], None] = self._link.close

    def send(self, message: Any) -> None:
        self._link.mav.send(message)

    def until(self, kind: str, wanted: Callable[[Any], bool] = lambda _: True) -> Any:
        end_s = time.monotonic() + PATIENT_S
        while time.monotonic() < end_s:
            if time.monotonic() >= self._beat_s:
                self._beat_s = time.monotonic() + 1.0
                self._link.mav.heartbeat_send(6, 8, 0, 0, 4)
            message = self._link.recv_match(blocking=True, timeout=0.2)
            if message is not None and message.get_type() == kind and wanted(message):
                return message
        raise AssertionError(f"no such {kind} within {PATIENT_S:g} s")


@contextmanager
def bridge(tmp_path: Path, *words: str) -> Iterator[Running]:
    with running(GCS, "bridge", "--log-dir", str(tmp_path), "--no-compact", *words) as program:
        yield program


def port(program: Running, kind: str) -> int:
    """The port of that kind that clients were given."""
    pattern = re.compile(rf"clients: waiting for \w+ on {kind} 127\.0\.0\.1:(\d+)")

    def found() -> list[int]:
        return [int(each[1]) for line in program.err if (each := pattern.search(line))]

    until(lambda: bool(found()), f"where clients come, in {program.err}")
    return found()[0]


def ended(program: Running) -> int:
    program.process.send_signal(signal.SIGTERM)
    return program.ended()


def of_vehicle(message: Any) -> bool:
    """Of its autopilot: the camera has heartbeats, too."""
    return (message.get_srcSystem(), message.get_srcComponent()) == (1, 1)


def test_two_clients_by_udp_and_tcp_one_in_control_and_a_refusal_with_its_reason(
    tmp_path: Path,
) -> None:
    words = ("--sim", "--policy", PATIENT_POLICY, "--client", ANY_UDP, "--client", ANY_TCP)
    with bridge(tmp_path, *words) as program:
        one = Client(f"udpout:127.0.0.1:{port(program, 'udp')}")
        other = Client(f"tcp:127.0.0.1:{port(program, 'tcp')}", 254)
        for client in (one, other):
            assert client.until("HEARTBEAT", of_vehicle).autopilot == dialect.MAV_AUTOPILOT_PX4
        one.until("HOME_POSITION")
        arm = dialect.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)

        def armed() -> bool:
            """It refuses as long as it starts."""
            one.send(arm)
            answer = one.until("COMMAND_ACK", lambda ack: ack.command == 400)
            return bool(answer.result == dialect.MAV_RESULT_ACCEPTED)

        until(armed, "an arming that is accepted")
        other.send(arm)
        refused = other.until("COMMAND_ACK", lambda ack: ack.command == 400)
        assert refused.result == dialect.MAV_RESULT_TEMPORARILY_REJECTED
        program.until_out("OTHER_OPERATOR")
        program.until_out("2 clients")
        other.close()
        until(lambda: "has gone: the connection was closed" in "".join(program.err), "it to go")
        assert ended(program) == ExitCode.DONE
        one.close()
    (log,) = tmp_path.glob("*_bridge.mcap")
    assert program.err[-1].strip() == f"log: {log}"


def test_json_is_a_line_an_event(tmp_path: Path) -> None:
    with bridge(tmp_path, "--sim", "--client", ANY_UDP, "--json") as program:
        program.until_out('"type":"bridge"')
        assert ended(program) == ExitCode.DONE
        kinds = [json.loads(line)["type"] for line in program.out]
    assert kinds[0] == "hello"
    assert kinds[-1] == "bye"
    assert program.err[-1].startswith("log: ")


def test_a_port_in_use_is_told_with_what_to_do(tmp_path: Path) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        taken = f"udpin://127.0.0.1:{other.getsockname()[1]}"
        as_client = gcs(
            "bridge", "--vehicle", ANY_UDP, "--client", taken, "--log-dir", str(tmp_path)
        )
        as_vehicle = gcs(
            "bridge", "--vehicle", taken, "--client", ANY_UDP, "--log-dir", str(tmp_path)
        )
    for got, option in ((as_client, "--client"), (as_vehicle, "--vehicle")):
        assert got.returncode == ExitCode.ADDRESS_IN_USE
        assert f"{taken} is in use by another program" in got.stderr
        assert option in got.stderr.splitlines()[-1]
        assert got.stdout == ""


def test_no_vehicle_within_the_time_out(tmp_path: Path) -> None:
    words = ("--vehicle", ANY_UDP, "--client", ANY_UDP, "--timeout", "0.5")
    got = gcs("bridge", *words, "--log-dir", str(tmp_path))
    assert got.returncode == ExitCode.NO_VEHICLE
    assert "no vehicle heard within 0.5 s" in got.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_bad_policy_is_told_with_file_line_and_key(tmp_path: Path) -> None:
    policy = tmp_path / "bad.toml"
    policy.write_text("[bridge]\nclient_rate_hz = nan\n")
    words = ("--vehicle", ANY_UDP, "--client", ANY_UDP, "--policy", str(policy))
    got = gcs("bridge", *words, "--log-dir", str(tmp_path))
    assert got.returncode == ExitCode.BAD_FILE
    assert f"{policy}:2" in got.stderr
    assert "client_rate_hz" in got.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
def test_on_a_terminal_it_is_a_page_that_ctrl_c_ends_in_order(tmp_path: Path) -> None:
    where = f"udpin://127.0.0.1:{free_port()}"
    words = ("bridge", "--sim", "--client", where, "--log-dir", str(tmp_path), "--no-compact")
    with terminal(GCS, *words) as screen:
        screen.until_text("1/1 px4 quadrotor", "in control: nobody", "nobody yet; waiting")
        client = Client(where.replace("udpin://", "udpout:"))
        client.until("HEARTBEAT", of_vehicle)
        screen.until_text("255/190")
        screen.press("\x03")
        screen.until_text("log: ", "gcs: the simulation has ended with it")
        assert screen.process.wait(PATIENT_S) == ExitCode.DONE
        assert screen.seen.count(b"\x1b[?25h") >= screen.seen.count(b"\x1b[?25l") > 0
        assert screen.settings == screen.settings_before
        client.close()
