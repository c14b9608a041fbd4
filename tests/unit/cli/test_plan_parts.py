"""`gcs fence` and `gcs rally`: of files without a vehicle, and the requests that they send."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gcs import ipc, resources
from gcs.cli import oneshot_session
from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from tests.unit.cli.command_line import gcs
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts


@pytest.fixture
def connection(monkeypatch: pytest.MonkeyPatch) -> FakeConnection:
    """To the station that the commands will talk to, in place of a process of their own."""
    fake = FakeConnection(FakeStation("airborne"))

    def run(
        _: StationConfig, how: oneshot_session.OneShotConfig, task: oneshot_session.Task
    ) -> int:
        return oneshot_session.run_over(fake, NoInterrupts(), how, task)

    monkeypatch.setattr(oneshot_session, "run", run)
    return fake


@pytest.mark.parametrize(
    ("line", "word"),
    [
        ("fence upload FENCE", "fence_upload"),
        ("fence download NEW", "fence_download"),
        ("fence clear", "fence_clear"),
        ("fence put", "fence_put"),
        ("rally upload RALLY", "rally_upload"),
        ("rally download NEW", "rally_download"),
        ("rally clear", "rally_clear"),
    ],
)
def test_each_sends_its_request(
    line: str, word: str, connection: FakeConnection, tmp_path: Path
) -> None:
    files = {"FENCE": resources.find("fence"), "RALLY": resources.find("rally")}
    files["NEW"] = tmp_path / "new.plan"
    result = gcs(*(files.get(part, part) for part in line.split()))
    assert result.exit_code == ExitCode.DONE, result.output
    (ask,) = [sent for sent in connection.sent if isinstance(sent, ipc.Ask)]
    assert ask.word == word
    assert ask.path in {"", *map(str, files.values())}


@pytest.mark.parametrize(
    ("line", "code", "told"),
    [
        ("fence check fence", 0, "nothing is wrong with it"),
        (
            "fence check fence --policy lab",
            0,
            "'geoFence.circles[0]', to stay out of: circle of 8 m",
        ),
        ("fence check fence", 0, "north, 19600 m2, at all heights; home is inside, 60.0 m from"),
        ("fence check fence --home 47.4,8.545594,488", 0, "at all heights; home is OUTSIDE, "),
        ("fence check", 0, "circle of 150 m, from 0 m to 50 m above home; home is inside, 150.0 m"),
        ("fence check --policy lab", 0, "at most 1000 m from home, -1000 to 120 m above it"),
        ("fence check rally", 4, "none is in this file"),
        ("fence check demo", 4, "hint: it has"),
        ("fence upload demo", 4, "none is in this file"),
        ("fence show fence", 0, "stay out"),
        ("rally check rally", 0, "nothing is wrong with it"),
        ("rally check rally --home 47.0,8.0,488", 6, "TOO_FAR"),
        ("rally check fence", 4, "hint: it has 7 items, a fence of 3 zones"),
        ("rally show rally", 0, "10 m above home"),
        ("fence show", 2, "`gcs fence download FILE` brings"),
        ("fence check nosuch", 4, "no such mission file"),
        ("fence download fence.kml", 2, "no format that can be written"),
    ],
)
def test_of_a_file(line: str, code: int, told: str, connection: FakeConnection) -> None:
    result = gcs(*line.split())
    assert (result.exit_code, told in result.output) == (code, True), result.output
    assert connection.sent == []


def test_a_zone_with_heights_is_told_before_any_upload(tmp_path: Path) -> None:
    file = tmp_path / "yard.toml"
    file.write_text(
        "schema = 1\nframe = 'home'\n[[waypoint]]\nnorth_m = 5\neast_m = 0\nup_m = 5\n"
        "[fence]\nnorth_m = [-50, 50]\neast_m = [-50, 50]\nup_m = [0, 40]\n"
    )
    result = gcs("fence", "check", file)
    assert result.exit_code == ExitCode.BAD_FILE
    assert "gcs fence put" in result.output


def test_as_json() -> None:
    found = json.loads(gcs("fence", "check", "fence", "--json").output)
    assert (found["zones"], found["rally_points"], found["exit_code"]) == (3, 0, 0)
    shown = json.loads(gcs("rally", "show", "rally", "--json").output)
    assert shown["rally"] == [[47.398, 8.546, 10.0], [47.3974, 8.5451, 5.0]]


HOME = '[[fence]]\nname = "home"\nkind = "circle"\nradius_m = 90.0\n'
MAST = '[[fence]]\nname = "mast"\nkind = "circle"\ncentre = [60.0, 0.0]\nradius_m = 5.0\n'


@pytest.mark.parametrize(
    ("fence", "told"),
    [
        (f"{HOME}floor_up_m = 3.0\n", "all of that but: the floor of zone 'home' at 3 m"),
        (f"{HOME}{MAST}inclusion = false\nceiling_up_m = 9.0\n", "but: zone 'mast', to stay out"),
        (f"{HOME}{MAST}inclusion = false\n", "by gcs fence put: all of that\n"),
    ],
)
def test_what_a_vehicle_cannot_keep_of_a_policy_is_told(
    fence: str, told: str, tmp_path: Path
) -> None:
    file = tmp_path / "p.toml"
    file.write_text(fence)
    result = gcs("fence", "check", "--policy", file)
    assert (result.exit_code, told in result.output) == (0, True), result.output
