"""`gcs bridge --vehicle A --vehicle B`: two vehicles, one client, real sockets and time."""

from __future__ import annotations

import json
import math
import re
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from pymavlink import mavutil
from pymavlink.dialects.v20 import all as dialect

from gcs.exit_codes import ExitCode
from tests.system.patience import PATIENT_POLICY, PATIENT_S, hold_much, until
from tests.system.programs import GCS, Running, gcs, running
from tests.system.vehicle_program import free_port, vehicle_sim

if sys.platform != "win32":
    from tests.system.terminal import terminal

pytestmark = pytest.mark.system

ARM, TAKE_OFF, LAND, REPOSITION = 400, 22, 21, 192
PX4, ARDUPILOT = 1, 2
HOMES = {PX4: "47.397742,8.545594,488", ARDUPILOT: "47.397742,8.545993,488"}
"""30 m from each other."""


class Client:
    """pymavlink, with what it has heard of each vehicle last."""

    def __init__(self, url: str) -> None:
        self._link: Any = mavutil.mavlink_connection(
            url, source_system=245, source_component=190, dialect="all"
        )
        hold_much(self._link.port)
        self._beat_s = 0.0
        self.latest: dict[tuple[int, str], Any] = {}
        self.close: Callable[[], None] = self._link.close

    def send(self, message: Any) -> None:
        self._link.mav.send(message)

    def command(self, sysid: int, command: int, *params: float) -> int:
        """COMMAND_LONG to one vehicle, and what it is answered with in that vehicle's name."""
        filled = params + (0.0,) * (7 - len(params))
        self.latest.pop((sysid, "COMMAND_ACK"), None)
        self.send(dialect.MAVLink_command_long_message(sysid, 1, command, 0, *filled))
        return self._answer(sysid, command)

    def fly_to(self, sysid: int, north_m: float, up_m: float) -> int:
        """DO_REPOSITION, from where that vehicle started."""
        lat, lon, alt = (float(word) for word in HOMES[sysid].split(","))
        self.latest.pop((sysid, "COMMAND_ACK"), None)
        self.send(
            dialect.MAVLink_command_int_message(
                sysid,
                1,
                0,
                REPOSITION,
                0,
                0,
                -1.0,
                1.0,
                0.0,
                math.nan,
                round((lat + north_m / 111_195) * 1e7),
                round(lon * 1e7),
                alt + up_m,
            )
        )
        return self._answer(sysid, REPOSITION)

    def _answer(self, sysid: int, command: int) -> int:
        def answered() -> bool:
            ack = self.latest.get((sysid, "COMMAND_ACK"))
            return ack is not None and ack.command == command and ack.result != 5

        self.until(answered, f"an answer of {sysid} to {command}")
        return int(self.latest[sysid, "COMMAND_ACK"].result)

    def until(self, true: Callable[[], bool], what: str) -> None:
        end_s = time.monotonic() + PATIENT_S
        while not true():
            assert time.monotonic() < end_s, f"no {what} within {PATIENT_S:g} s"
            if time.monotonic() >= self._beat_s:
                self._beat_s = time.monotonic() + 1.0
                self._link.mav.heartbeat_send(6, 8, 0, 0, 4)
            message = self._link.recv_match(blocking=True, timeout=0.2)
            if message is not None:
                self.latest[message.get_srcSystem(), message.get_type()] = message

    def place(self, sysid: int) -> tuple[float, float]:
        """Metres north of its origin, and up; from what the vehicle tells."""
        told = self.latest.get((sysid, "LOCAL_POSITION_NED"))
        return (math.nan, math.nan) if told is None else (told.x, -told.z)

    def until_north(self, sysid: int, north_m: float) -> None:
        self.until(lambda: abs(self.place(sysid)[0] - north_m) < 1.0, f"{sysid} there")

    def armed(self, sysid: int) -> bool:
        beat = self.latest.get((sysid, "HEARTBEAT"))
        return beat is not None and bool(beat.base_mode & 128)


@pytest.fixture
def where() -> Iterator[tuple[str, str]]:
    """A PX4 and an ArduPilot that fly, each on a port of its own; the URLs for `gcs bridge`."""
    ports = free_port(), free_port()
    px4, ardupilot = (f"udpout://127.0.0.1:{port}" for port in ports)
    with (
        vehicle_sim("--home", HOMES[PX4], "--link", px4),
        vehicle_sim(
            "--autopilot", "ardupilot", "--sysid", "2", "--home", HOMES[ARDUPILOT], "--link",
            ardupilot,
        ),
    ):  # fmt: skip
        yield (f"udpin://127.0.0.1:{ports[0]}", f"udpin://127.0.0.1:{ports[1]}")


def client_port(program: Running) -> int:
    pattern = re.compile(r"clients: waiting for \w+ on udp 127\.0\.0\.1:(\d+)")

    def found() -> list[int]:
        return [int(each[1]) for line in program.err if (each := pattern.search(line))]

    until(lambda: bool(found()), f"where clients come, in {program.err}")
    return found()[0]


def take_off(client: Client, sysid: int) -> None:
    # The bridge knows a vehicle by its heartbeat; what else it tells may pass before that.
    client.until(lambda: (sysid, "HEARTBEAT") in client.latest, f"heartbeat of {sysid}")
    client.until(lambda: (sysid, "HOME_POSITION") in client.latest, f"home of {sysid}")
    # It may refuse while it starts.
    client.until(lambda: client.command(sysid, ARM, 1) == 0, f"an arming that {sysid} takes")
    nan = math.nan
    height = nan if sysid == PX4 else 3.0  # NaN: as high as MIS_TAKEOFF_ALT says
    assert client.command(sysid, TAKE_OFF, 0, 0, 0, nan, nan, nan, height) == 0
    client.until(lambda: client.place(sysid)[1] > 2.2, f"{sysid} up")


@pytest.mark.thorough
def test_one_client_flies_a_px4_and_an_ardupilot(tmp_path: Path, where: tuple[str, str]) -> None:
    words = ["--vehicle", where[0], "--vehicle", where[1], "--client", "udpin://127.0.0.1:0"]
    words += ["--policy", PATIENT_POLICY]
    bridge = (GCS, "bridge", "--log-dir", str(tmp_path), "--no-compact", *words)
    with (
        running(*bridge) as program,
        closing(Client(f"udpout:127.0.0.1:{client_port(program)}")) as client,
    ):
        for sysid in (PX4, ARDUPILOT):
            take_off(client, sysid)
        client.until(lambda: client.fly_to(PX4, 6, 4) == 0, "a goal that the px4 takes")
        client.until(lambda: client.fly_to(ARDUPILOT, -6, 4) == 0, "a goal that ardupilot takes")
        for sysid, north_m in ((PX4, 6), (ARDUPILOT, -6)):
            client.until_north(sysid, north_m)
        client.until(lambda: client.fly_to(ARDUPILOT, 400, 4) == 2, "a goal outside is denied")
        program.until_out("goto of vehicle 2: refused OUTSIDE_FENCE")
        client.send(dialect.MAVLink_command_long_message(0, 0, LAND, 0, 0, 0, 0, 0, 0, 0, 0))
        client.until(
            lambda: not client.armed(PX4) and not client.armed(ARDUPILOT), "both down, disarmed"
        )
        program.process.send_signal(signal.SIGTERM)
        assert program.ended() == ExitCode.DONE
    (log,) = tmp_path.glob("*_bridge.mcap")
    told = gcs("log", "info", "--json", str(log))
    assert told.returncode == ExitCode.DONE
    topics = json.dumps(json.loads(told.stdout))
    assert "/vehicle/1/fsa" in topics
    assert "/vehicle/2/fsa" in topics
    audited = gcs("log", "audit", str(log))
    assert audited.returncode == ExitCode.DONE, audited.stdout


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
def test_the_page_shows_both(tmp_path: Path, where: tuple[str, str]) -> None:
    words = ("--vehicle", where[0], "--vehicle", where[1], "--client", "udpin://127.0.0.1:0")
    with terminal(GCS, "bridge", "--log-dir", str(tmp_path), "--no-compact", *words) as screen:
        screen.until_text("1/1 px4 quadrotor", "2/1 ardupilot quadrotor", "GROUNDED")
        screen.press("\x03")
        screen.until_text("log: ")
        assert screen.process.wait(PATIENT_S) == ExitCode.DONE
