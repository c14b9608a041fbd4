"""An operator in the test's own process, who speaks with a real station process."""

from __future__ import annotations

import re
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from gcs import ipc
from gcs.config import SimConfig, StationConfig
from gcs.operator.client import StationClient, StationEnded
from gcs.operator.conversation import TrackedRequest
from gcs.operator.dialogue import Dialogue
from gcs.operator.line_parser import parse_line
from gcs.request_words import SendRequests
from tests.system.patience import PATIENT_POLICY, PATIENT_S
from tests.system.vehicle_program import vehicle_sim
from tests.system.wire_tap import WireTap

PATIENT_VEHICLE = {"COM_OF_LOSS_T": 60.0}
"""A station that the machine stops for seconds streams its setpoints again afterwards."""


class NoInterrupts:
    """Nobody presses Ctrl-C here."""

    def __init__(self) -> None:
        self.name = ""
        self._ear, self._mouth = socket.socketpair()

    def fileno(self) -> int:
        return self._ear.fileno()

    def forget(self) -> None:
        """There is nothing to forget."""

    def close(self) -> None:
        self._ear.close()
        self._mouth.close()


class Station:
    """Types lines and waits for what becomes of them; keeps every event, in order."""

    def __init__(self, config: StationConfig) -> None:
        self.events: list[ipc.Event] = []
        self.client = StationClient.start(config)
        self.interrupts = NoInterrupts()
        self.dialogue = Dialogue(self.client, self.interrupts, self._keep)

    def _keep(self, event: ipc.Event, _request: TrackedRequest | None) -> None:
        self.events.append(event)

    @property
    def log_path(self) -> Path:
        assert self.dialogue.hello is not None
        return Path(self.dialogue.hello.log_path)

    @property
    def ports(self) -> list[int]:
        """Where the station waits for datagrams, once it has said so."""
        self.until(lambda: self.dialogue.hello is not None, "hello")
        assert self.dialogue.hello is not None
        told = " ".join(self.dialogue.hello.endpoints)
        return [int(port) for port in re.findall(r"on udp [\d.]+:(\d+)", told)]

    def until(self, condition: Callable[[], bool], what: str, timeout_s: float = PATIENT_S) -> None:
        self.dialogue.wait_until(condition, timeout_s)
        assert condition(), f"not within {timeout_s:g} s: {what}\n{self.events[-10:]}"

    def connect(self) -> None:
        self.dialogue.wait_for_vehicle(PATIENT_S)

    def send(self, line: str) -> TrackedRequest:
        """Send it, wait for the verdict."""
        parsed = parse_line(line)
        assert parsed is not None
        assert isinstance(parsed.action, SendRequests)
        request = self.dialogue.send(parsed.action.requests[0], line)
        self.until(lambda: request.verdict is not None, f"a verdict on {line}")
        return request

    def fly(self, *lines: str) -> None:
        """Send each, and see it complete before the next."""
        for line in lines:
            self.see_completed(self.send(line))

    def see_completed(self, request: TrackedRequest) -> None:
        self.until(lambda: request.settled, f"the outcome of {request.label}", 2 * PATIENT_S)
        assert request.completed, f"{request.label}: {request.verdict} {request.outcome}"

    def said(self, text: str) -> bool:
        """Whether a log line so far contains `text`."""
        return any(isinstance(event, ipc.LogEvent) and text in event.text for event in self.events)

    def leave(self) -> StationEnded:
        return self.dialogue.leave()

    def close(self) -> None:
        self.client.close()
        self.interrupts.close()


@contextmanager
def station(config: StationConfig) -> Iterator[Station]:
    """A station whose process is gone at the end, whatever happens."""
    made = Station(config)
    try:
        yield made
    finally:
        made.close()


@contextmanager
def simulated(
    log_dir: Path, speedup: float = 1.0, policy: str = PATIENT_POLICY
) -> Iterator[Station]:
    """A station with a vehicle of its own, connected."""
    config = StationConfig(
        sim=SimConfig(speedup=speedup, params=PATIENT_VEHICLE),
        speedup=speedup,
        log_dir=str(log_dir),
        policy_path=policy,
    )
    with station(config) as made:
        made.connect()
        yield made


@contextmanager
def tapped(
    log_dir: Path, speedup: float = 1.0, tap: WireTap | None = None, policy: str = PATIENT_POLICY
) -> Iterator[tuple[Station, WireTap]]:
    """A station and a vehicle, separate programs, with an ear on the wire between them."""
    config = StationConfig(
        endpoints=["udpin://127.0.0.1:0"],
        speedup=speedup,
        log_dir=str(log_dir),
        policy_path=policy,
    )
    with tap or WireTap() as ear, station(config) as made:
        ear.connect(made.ports[0])
        url = f"udpout://127.0.0.1:{ear.vehicle_port}"
        params = [f"{name}={value:g}" for name, value in PATIENT_VEHICLE.items()]
        words = [word for param in params for word in ("--param", param)]
        with vehicle_sim("--speedup", f"{speedup:g}", "--link", url, *words):
            made.connect()
            yield made, ear
