"""A vehicle, `gcs bridge` before it, and where the vehicle really was."""

from __future__ import annotations

import importlib.util
import math
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import all as dialect

from tests.clients.client_script import CLIENTS, SCRIPTS
from tests.system.patience import PATIENT_S, until
from tests.system.vehicle_program import free_port
from vehicle_sim.testing.process import Personality, Simulator

POLICY = Path(__file__).parent / "yard.toml"
HOMES = {"px4": (47.397742, 8.545594, 488.0), "ardupilot": (-35.363262, 149.165237, 584.0)}
EARTH_M_PER_DEG = 111_194.93
FLIGHT_S = 600.0


class Truth:
    """The vehicle's true places, 50 a second (`vehicle-sim --view`): north, east, up of home, m."""

    def __init__(self, personality: Personality) -> None:
        self.places: list[tuple[float, float, float]] = []
        self._home = HOMES[personality]
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self.url = f"udp://127.0.0.1:{self._socket.getsockname()[1]}"
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        parser = dialect.MAVLink(None)
        parser.robust_parsing = True
        lat_deg, lon_deg, sea_m = self._home
        east_m_per_deg = EARTH_M_PER_DEG * math.cos(math.radians(lat_deg))
        while data := self._socket.recv(65536):
            for message in parser.parse_buffer(data) or ():
                if message.get_type() == "HIL_STATE_QUATERNION":
                    north_m = (message.lat * 1e-7 - lat_deg) * EARTH_M_PER_DEG
                    east_m = (message.lon * 1e-7 - lon_deg) * east_m_per_deg
                    self.places.append((north_m, east_m, message.alt * 1e-3 - sea_m))

    def close(self) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as last:
            last.sendto(b"", self._socket.getsockname())
        self._reader.join()
        self._socket.close()

    def outside(self) -> list[tuple[float, float, float]]:
        """Places that yard.toml does not allow, without any margin."""
        return [place for place in self.places if not allowed(*place)]


def allowed(north_m: float, east_m: float, up_m: float) -> bool:
    """Inside the yard and outside the mast of yard.toml."""
    in_yard = abs(north_m) <= 60.0 and abs(east_m) <= 60.0 and up_m <= 60.0
    return in_yard and not (15.0 <= east_m <= 25.0 and abs(north_m) <= 10.0)


@dataclass
class Bridged:
    """A running bridge.  `said` are its lines so far."""

    personality: Personality
    clients: list[str]
    """host:port, one for each client link."""
    truth: Truth
    log_dir: Path
    said: list[str] = field(default_factory=list)

    def refusals(self, client: str = "") -> list[str]:
        """Lines of requests that were refused."""
        return [line for line in self.said if ": refused " in line and client in line]


@contextmanager
def bridged(personality: Personality, folder: Path, clients: int = 1) -> Iterator[Bridged]:
    """It has heard its vehicle; at the end it must leave in order."""
    vehicle_at = f"127.0.0.1:{free_port()}"
    places = [f"127.0.0.1:{free_port()}" for _ in range(clients)]
    words = ["--vehicle", f"udpin://{vehicle_at}", "--log-dir", str(folder / "logs")]
    for place in places:
        words += ["--client", f"udpin://{place}"]
    with ExitStack() as ends:
        truth = Truth(personality)
        ends.callback(truth.close)
        link = ["--link", f"udpout://{vehicle_at}", "--view", truth.url]
        vehicle = Simulator(personality, options=link)
        ends.callback(vehicle.stop)
        flight = Bridged(personality, places, truth, folder / "logs")
        ends.callback(lambda: print(*flight.said, sep=""))  # shown where the test fails
        ends.enter_context(_bridge(words, flight.said))
        until(lambda: any("GROUNDED" in line for line in flight.said), "the bridge is ready")
        yield flight


@contextmanager
def _bridge(words: list[str], said: list[str]) -> Iterator[None]:
    process = subprocess.Popen(
        [sys.executable, "-m", "gcs", "bridge", "--plain", "--policy", str(POLICY), *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    reader = threading.Thread(target=said.extend, args=(process.stdout,))
    reader.start()
    try:
        yield
    finally:
        process.send_signal(signal.SIGINT)
        try:
            code = process.wait(PATIENT_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            code = process.wait()
        reader.join()
        process.stdout.close()
    assert code == 0


def python_of(client: str) -> str:
    """An environment that has this client, or the test is skipped."""
    python = CLIENTS / client / "bin" / "python"
    if python.exists():
        return str(python)
    if client in ("pymavlink", "mavsdk") and importlib.util.find_spec(client):
        return sys.executable
    pytest.skip(f"`make .clients/{client}/.installed` makes the environment of {client}")


def start_peer(client: str, url: str, flight: Bridged, *words: str) -> subprocess.Popen[str]:
    """bridge_<client>.py, in a process group of its own."""
    script = SCRIPTS / f"bridge_{client}.py"
    folder = flight.log_dir.parent / f"{client}-{words[0]}"
    folder.mkdir()
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return subprocess.Popen(
        [python_of(client), "-B", str(script), url, flight.personality, *words],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


def end_peer(process: subprocess.Popen[str]) -> list[str]:
    """Its lines; it must end well."""
    try:
        output, _ = process.communicate(timeout=FLIGHT_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output = f"{process.communicate()[0]}\nstill flying after {FLIGHT_S:g} s"
    assert process.returncode == 0, output
    return output.splitlines()
