"""The demo's flight over a tapped wire: the record holds what crossed it, byte for byte."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from gcs import ipc, resources
from gcs.cli.demo.demo import run_over
from gcs.cli.demo.script import MISSION, POLICY
from gcs.operator.client import Polled, Readable, StationClient
from gcs.record.info import GAP_NS
from gcs.report import Direction
from tests.system.flight_log import Json, decoded, frames, readings, whole, wire
from tests.system.machine import KeptWaiting
from tests.system.patience import PATIENT_S, patient
from tests.system.station import tapped
from tests.system.wire_tap import Crossing, WireTap

pytestmark = pytest.mark.system

SPEEDUP = 3.0
SETPOINT = "/mavlink/255/190/SET_POSITION_TARGET_LOCAL_NED"


@dataclass(frozen=True)
class Flight:
    path: Path
    exit_code: int
    told: str
    tap: WireTap
    kept_waiting_s: float


class SilencingConnection:
    """The wire falls silent before the station ends, so that both sides saw the same of it.

    The station's first word, which the test has read already, is told once more.
    """

    def __init__(self, client: StationClient, tap: WireTap, hello: ipc.Hello) -> None:
        self._kept = KeptWaiting(client.pid)
        self.kept_waiting_s = 0.0
        self._client, self._tap = client, tap
        self._told: list[ipc.Hello] = [hello]
        self.now_s, self.close = client.now_s, client.close

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        if self._told:
            return Polled([self._told.pop()])
        return self._client.poll(timeout_s, also)

    def send(self, command: ipc.Command) -> bool:
        if isinstance(command, ipc.Leave):
            self._tap.silence_vehicle()
            self.kept_waiting_s = self._kept.seconds
        return self._client.send(command)


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Flight]:
    folder = tmp_path_factory.mktemp("logs")
    with tapped(folder, speedup=SPEEDUP, policy=patient(POLICY, folder)) as (operator, tap):
        told = StringIO()
        assert operator.dialogue.hello is not None
        connection = SilencingConnection(operator.client, tap, operator.dialogue.hello)
        mission = str(resources.find(MISSION))
        exit_code = run_over(
            connection, operator.interrupts, Console(file=told), mission, PATIENT_S
        )
        tap.drained()
        yield Flight(operator.log_path, exit_code, told.getvalue(), tap, connection.kept_waiting_s)


def joined(crossings: list[Crossing]) -> bytes:
    return b"".join(crossing.data for crossing in crossings)


def test_the_flight_went_as_scripted(flight: Flight) -> None:
    assert flight.exit_code == 0, flight.told
    longest_s = max((gap.seconds for gap in whole(flight.path).gaps), default=0.0)
    assert longest_s <= GAP_NS / 1e9 + SPEEDUP * flight.kept_waiting_s


def test_the_frames_rebuilt_from_the_record_are_what_crossed_the_wire(flight: Flight) -> None:
    found = frames(flight.path)
    assert wire(found, Direction.SENT) == joined(flight.tap.to_vehicle)
    assert wire(found, Direction.RECEIVED) == joined(flight.tap.to_station)


def test_an_independent_decoder_reads_every_frame(flight: Flight) -> None:
    topics = [topic for topic, _ in decoded(flight.path)]
    assert len(topics) == len(frames(flight.path))
    assert {"/mavlink/1/1/LOCAL_POSITION_NED", SETPOINT} <= set(topics)


def test_the_refused_goal_is_on_record_with_its_numbers_and_in_no_setpoint(flight: Flight) -> None:
    refused: list[dict[str, Json]] = [
        decision
        for _, decision in readings(flight.path, "/gate/decision")
        if decision.get("code") == "OUTSIDE_FENCE"
    ]
    (far,) = refused
    assert far["goal"] == {"east_m": 60.0, "north_m": 8.0, "up_m": 5.0}
    assert far["zone"] == "yard"
    assert isinstance(far["numbers"], dict)
    assert far["numbers"]["outside_m"] == pytest.approx(34.0, abs=0.5)
    assert "34." in str(far["sentence"])

    flown = [message for topic, message in decoded(flight.path) if topic == SETPOINT]
    assert len(flown) > 100
    assert max(abs(setpoint.y) for setpoint in flown) < 26.0  # the yard's wall
