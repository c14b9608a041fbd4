"""`gcs.connect` where a station runs: joined as it is, or told what it has otherwise."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

import gcs
from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator import joined
from gcs.operator.client import StationClient
from gcs.operator.differences import Difference
from gcs.operator.joined import JoinedStation
from gcs.policy_digest import policy_digest
from gcs.resources import policy_path
from gcs.shell.stations import Description
from tests.unit.operator.test_station import FakeWay

LINK = "udpin://127.0.0.1:47001"
RUNNING = Description(
    4711,
    1,
    [LINK],
    vehicle="1/1 px4 quadrotor",
    log_path="/flights/a.mcap",
    policy="lab",
    policy_digest=policy_digest("lab"),
    speedup=2.0,
)


@pytest.fixture(autouse=True)
def running(monkeypatch: pytest.MonkeyPatch) -> None:
    """One station runs; joining it works, starting another one fails the test."""

    def refuse(*_: object) -> None:
        raise AssertionError("a station of its own was started")

    monkeypatch.setattr(joined, "running_stations", lambda: [RUNNING])
    monkeypatch.setattr(JoinedStation, "join", lambda *_, **__: FakeWay())
    monkeypatch.setattr(StationClient, "start", refuse)


def differing(**asked: object) -> gcs.StationDiffers:
    with pytest.raises(gcs.StationDiffers) as differs:
        gcs.connect(LINK, **asked)  # type: ignore[arg-type]
    return differs.value


@pytest.mark.parametrize(
    ("asked", "difference"),
    [
        ({"policy": "default"}, Difference("policy", "default", "lab")),
        ({"log_dir": "/elsewhere"}, Difference("log_dir", "/elsewhere", "/flights")),
        ({"speedup": 1.0}, Difference("speedup", "1", "2")),
        ({"keep": True}, Difference("keep", "True", "False")),
    ],
)
def test_what_the_running_station_has_otherwise_is_told(
    asked: dict[str, object], difference: Difference
) -> None:
    differs = differing(**asked)
    assert differs.differences == (difference,)
    assert differs.exit_code == ExitCode.USAGE
    assert str(difference) in differs.sentence
    assert "process 4711" in differs.sentence
    assert f"leave out {difference.option} to use that station" in differs.hint
    assert f"gcs stations end --link {LINK}" in differs.hint


THERE = ["1/1 px4 quadrotor", "2/1 ardupilot quadrotor"]
BRIDGE = msgspec.structs.replace(RUNNING, vehicles=THERE)


def test_of_several_one_is_flown_and_then_another(monkeypatch: pytest.MonkeyPatch) -> None:
    way = FakeWay()
    monkeypatch.setattr(joined, "running_stations", lambda: [BRIDGE])
    monkeypatch.setattr(JoinedStation, "join", lambda *_, **__: way)
    with gcs.connect(LINK, vehicle=2) as station:
        assert station.snapshot.vehicle == "2/1 px4 quadrotor"
        station.abort(wait=False)
        station.choose(1)
        assert station.snapshot.vehicle == "1/1 px4 quadrotor"
        station.abort(wait=False)
        with pytest.raises(gcs.BadArgument, match="a system id, 1 to 255"):
            station.choose(0)
    assert [each.vehicle for each in way.sent if isinstance(each, ipc.Ask)] == [2, 1]


def test_a_vehicle_that_is_not_there_is_told_with_those_that_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(joined, "running_stations", lambda: [BRIDGE])
    (told,) = differing(vehicle=3).differences
    assert told == Difference("vehicle", "3", "1/1 px4 quadrotor, 2/1 ardupilot quadrotor")


def test_a_station_with_one_vehicle_has_that_one_alone() -> None:
    (told,) = differing(vehicle=2).differences
    assert told == Difference("vehicle", "2", "1/1 px4 quadrotor")
    with gcs.connect(LINK, vehicle=1) as station:
        assert station.talk.hello is not None


def test_no_vehicle_is_chosen_of_a_simulator_of_ones_own() -> None:
    with pytest.raises(gcs.CannotConnect, match="vehicle=2 is for vehicles that are there"):
        gcs.connect(sim=True, vehicle=2)


def test_all_that_differs_is_told_at_once() -> None:
    told = [each.option for each in differing(policy="default", keep=True).differences]
    assert told == ["policy", "keep"]


@pytest.mark.parametrize(
    "asked", [{}, {"policy": "lab", "log_dir": "/flights", "speedup": 2.0, "keep": False}]
)
def test_what_was_not_asked_for_or_is_so_is_joined(asked: dict[str, object]) -> None:
    with gcs.connect(LINK, **asked) as station:  # type: ignore[arg-type]
        assert station.talk.hello is not None


def test_a_policy_is_known_by_what_is_in_its_file(tmp_path: Path) -> None:
    lab = policy_path("lab").read_text()
    same, other = tmp_path / "same.toml", tmp_path / "lab.toml"
    same.write_text(lab)
    other.write_text(lab.replace("brake_slack_h_m = 0.5", "brake_slack_h_m = 0.6"))
    with gcs.connect(LINK, policy=str(same)):
        pass
    (told,) = differing(policy=str(other)).differences
    assert told == Difference("policy", str(other), "lab")


def test_and_by_the_fence_files_that_it_names(tmp_path: Path) -> None:
    policy, fence = tmp_path / "field.toml", tmp_path / "field.plan"
    policy.write_text('[[fence]]\nkind = "file"\npath = "field.plan"\n')
    alone = policy_digest(str(policy))
    fence.write_text("one")
    first = policy_digest(str(policy))
    fence.write_text("two")
    assert len({alone, first, policy_digest(str(policy))}) == 3


def test_a_policy_that_cannot_be_read_is_told_as_such() -> None:
    with pytest.raises(gcs.CannotConnect) as wrong:
        gcs.connect(LINK, policy="missing.toml")
    assert wrong.value.exit_code == ExitCode.BAD_FILE


def test_the_autopilot_of_a_vehicle_that_is_there_cannot_be_chosen() -> None:
    with pytest.raises(gcs.CannotConnect, match="is for the vehicle of sim=True") as wrong:
        gcs.connect(LINK, autopilot="ardupilot")
    assert wrong.value.exit_code == ExitCode.USAGE


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"link": 5}, "connect: link must be str | array | null, not 5"),
        ({"link": [LINK, 5]}, "connect: link must be str, not ['udpin://127.0.0.1:47001', 5]"),
        ({"policy": 1}, "connect: policy must be str | null, not 1"),
        ({"timeout_s": "x"}, "connect: timeout_s must be float, not 'x'"),
        ({"timeout_s": -1}, "connect: timeout_s must be float >= 0.0, not -1"),
        ({"sim": True, "speedup": 0}, "connect: speedup must be float > 0.0, not 0"),
        ({"vehicle": 256}, "connect: vehicle must be int <= 255, not 256"),
        ({"sim": True, "autopilot": "dji"}, "connect: autopilot must be"),
    ],
)
def test_a_wrong_argument_is_named(given: dict[str, object], sentence: str) -> None:
    with pytest.raises(gcs.BadArgument) as wrong:
        gcs.connect(**given)  # type: ignore[arg-type]
    assert str(wrong.value).startswith(sentence)
    assert isinstance(wrong.value, ValueError | TypeError)
