"""`gcs topic` and `gcs graph` beside a station that flies, and on a link without one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from gcs.exit_codes import ExitCode
from gcs.report import Direction
from gcs.vehicle.talk.discovery import WANTED_HZ
from gcs.wire.ids import MsgId
from tests.system.flight_log import decoded
from tests.system.flight_log import times_ns as recorded_ns
from tests.system.programs import GCS, gcs, running
from tests.system.station import simulated
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = pytest.mark.system

CLOSE = 0.03
TOPIC = "/mavlink/1/1/LOCAL_POSITION_NED"
SETTLED = 50
"""Messages: until then the rate may be another one, which was not asked for yet."""


@pytest.fixture(autouse=True)
def runtime(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stations of this test alone."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("run")))


def objects(*words: str) -> list[Any]:
    ended = gcs(*words, "--json")
    assert ended.returncode == ExitCode.DONE, ended.stderr
    return [json.loads(line) for line in ended.stdout.splitlines()]


def test_the_rate_is_the_configured_one_live_and_in_the_record(tmp_path: Path) -> None:
    configured_hz = dict(WANTED_HZ)[MsgId.LOCAL_POSITION_NED]
    with simulated(tmp_path) as operator:
        told = objects("topic", "hz", "LOCAL_POSITION_NED", "-t", "6")
        assert {one["topic"] for one in told} == {TOPIC}
        (one,) = objects("topic", "echo", "LOCAL_POSITION_NED", "-n", "1", "-t", "60")
        assert set(one["fields"]) == {"time_boot_ms", "x", "y", "z", "vx", "vy", "vz"}
        (state,) = objects("topic", "echo", "/vehicle/1/state.mode", "-n", "1", "-t", "60")
        assert isinstance(state["values"]["mode"], str)
        (graph,) = objects("graph", "-t", "3")
        assert {node["title"] for node in graph["nodes"]} >= {
            "operator 1",
            "gate",
            "vehicle 1/1",
            "recorder",
        }
        operator.leave()
        log = str(operator.log_path)
    times_ns = recorded_ns(Path(log), "LOCAL_POSITION_NED", Direction.RECEIVED)
    # What was told live is the rate of so many messages that are in the record in a row.
    count = told[-1]["window"]
    spans_ns = (end - begin for begin, end in zip(times_ns, times_ns[count - 1 :], strict=False))
    rates_hz = [(count - 1) * 1e9 / span_ns for span_ns in spans_ns]
    assert any(told[-1]["hz"] == pytest.approx(rate_hz, rel=1e-6) for rate_hz in rates_hz)
    (whole,) = objects("topic", "hz", "LOCAL_POSITION_NED", "--log", log)
    assert whole["hz"] == pytest.approx((len(times_ns) - 1) * 1e9 / (times_ns[-1] - times_ns[0]))
    # By the vehicle's own time, which a slow machine does not hurry or stop for one message.
    boot_ms = [m.time_boot_ms for topic, m in decoded(Path(log)) if topic == TOPIC][SETTLED:]
    mean_hz = (len(boot_ms) - 1) * 1e3 / (boot_ms[-1] - boot_ms[0])
    assert mean_hz == pytest.approx(configured_hz, rel=CLOSE)


@pytest.mark.thorough
def test_a_link_without_a_station_is_listened_to_and_left_alone() -> None:
    """The vehicle is not asked for anything: it has no peer but the one that it was given."""
    port = free_port()
    with vehicle_sim("--link", f"udpout://127.0.0.1:{port}"):
        link = ("--link", f"udpin://127.0.0.1:{port}")
        (one,) = objects("topic", "echo", "ATTITUDE", *link, "-n", "1")
        assert one["topic"] == "/mavlink/1/1/ATTITUDE"
        (short,) = objects("topic", "hz", "ATTITUDE", *link, "-t", "0.7")
        assert short["window"] > 2, "the last look is printed, however short it was"
        (rows,) = objects("topic", "list", "HEARTBEAT", "ATTITUDE", *link, "-t", "4")
        assert {row["topic"] for row in rows} == {
            "/mavlink/1/1/ATTITUDE",
            "/mavlink/1/1/HEARTBEAT",
        }
        (graph,) = objects("graph", *link, "-t", "2")
        assert {edge["source"] for edge in graph["edges"]} == {"1/1"}, "nobody else speaks"


def test_silence_is_told_and_a_reader_that_goes_ends_it() -> None:
    link = ("--link", f"udpin://127.0.0.1:{free_port()}")
    ended = gcs("topic", "list", *link, "-t", "0.5")
    assert (ended.returncode, "not heard" in ended.stderr) == (ExitCode.NO_VEHICLE, True)
    port = free_port()
    with (
        vehicle_sim("--link", f"udpout://127.0.0.1:{port}"),
        running(GCS, "topic", "echo", "ATTITUDE.roll", "--link", f"udpin://127.0.0.1:{port}") as it,
    ):
        it.until_out(".")
        it.process.send_signal(2)
        assert it.ended() == ExitCode.DONE
