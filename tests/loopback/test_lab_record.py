"""The lab's checkpoint L20: a flight is rebuilt from its MCAP, without reading a log line."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from mcap.reader import make_reader
from mcap_ros1.decoder import DecoderFactory

from gcs.record.writer import Recorder
from tests.loopback.flight import Flight, lab_policy
from tests.loopback.observed import START_NS


class Rebuilt(NamedTuple):
    """What the file says, topic by topic, in order of log_time."""

    decisions: list[dict[str, Any]]
    machine: list[dict[str, Any]]
    positions: list[tuple[int, tuple[float, float, float]]]
    setpoints: list[tuple[int, tuple[float, float, float]]]


def rebuilt(path: Path) -> Rebuilt:
    found = Rebuilt([], [], [], [])
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        topics = ["/gate/decision", "/vehicle/1/fsa"]
        for _, channel, message in reader.iter_messages(topics=topics):
            into = found.decisions if channel.topic == topics[0] else found.machine
            into.append(json.loads(message.data))
        topics = [
            "/mavlink/1/1/LOCAL_POSITION_NED",
            "/mavlink/255/190/SET_POSITION_TARGET_LOCAL_NED",
        ]
        for _, channel, raw, m in reader.iter_decoded_messages(topics=topics):
            into_ned = found.positions if channel.topic == topics[0] else found.setpoints
            into_ned.append((raw.log_time, (m.x, m.y, m.z)))
    return found


@pytest.fixture(scope="module")
def lab_flight() -> Flight:
    """L3 (a goal), L5 (a second one while moving), L6 (arrival), and L4 (no position arriving)."""
    flight = Flight(policy=lab_policy()).hovering(1.0)
    first = flight.goto(3.0, 0.0, 0.5)
    flight.run(0.5)
    flight.goto(0.0, 2.0, 1.0)
    assert flight.done(first) == "complete"
    flight.run(1.0)
    flight.goto(-3.0, 0.0, 1.0)
    flight.run(0.5)
    flight.positions_lost = True
    flight.run(3.0)
    return flight


@pytest.fixture(scope="module")
def read_back(lab_flight: Flight, tmp_path_factory: pytest.TempPathFactory) -> Rebuilt:
    folder = tmp_path_factory.mktemp("logs")
    recorder = Recorder.open(folder, "lab", "20260101-000000", START_NS)
    for time_ns, item in lab_flight.records:
        recorder.write(item, time_ns)
        recorder.tick(time_ns)
    assert recorder.close(lab_flight.now_ns)
    return rebuilt(recorder.path)


def test_L20_every_request_and_its_outcome(read_back: Rebuilt) -> None:
    story = [
        (d["word"], d["phase"], d["outcome"], d.get("code", ""), tuple(d.get("goal", {}).values()))
        for d in read_back.decisions
        if d["word"] == "goto"
    ]
    assert story == [
        ("goto", "verdict", "accepted", "", (3.0, 0.0, 0.5)),
        ("goto", "verdict", "refused", "BUSY", (0.0, 2.0, 1.0)),
        ("goto", "ending", "complete", "", ()),
        ("goto", "verdict", "accepted", "", (-3.0, 0.0, 1.0)),
        ("goto", "ending", "aborted", "STALE", ()),
    ]


def test_L20_every_transition(lab_flight: Flight, read_back: Rebuilt) -> None:
    moves = [(m["before"], m["state"]) for m in read_back.machine if m["before"] != m["state"]]
    assert [after for _, after in moves] == lab_flight.states()
    assert all(a[1] == b[0] for a, b in pairwise(moves))
    assert moves[-1][1] == "STALE"
    ids = {m["state"]: m["state_id"] for m in read_back.machine}
    assert (ids["HOVERING"], ids["VERIFYING"], ids["MOVING"]) == (1, 2, 3)


def test_L20_every_setpoint_and_position(lab_flight: Flight, read_back: Rebuilt) -> None:
    sent = lab_flight.setpoints()
    assert [pos_ned for _, pos_ned in read_back.setpoints] == [s.pos_ned for s in sent]
    late_ns = [t - s.time_ns for (t, _), s in zip(read_back.setpoints, sent, strict=True)]
    assert 0 <= min(late_ns) <= max(late_ns) < 1000
    assert len(read_back.positions) > 150
    last_ned = read_back.positions[-1][1]
    assert last_ned == lab_flight.session.gate.pos_ned
    assert max(pos_ned[1] for _, pos_ned in read_back.positions) == pytest.approx(3.0, abs=0.3)
