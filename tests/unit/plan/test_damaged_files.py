"""Files damaged in every way: a plan, or a PlanError that can be told, and nothing else."""

from __future__ import annotations

import json
import random
from contextlib import suppress

import pytest

from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.compare import same_meaning
from gcs.plan.errors import PlanError
from gcs.plan.flown.path import flight_path
from gcs.plan.formats.reader import SIZE_MAX, read
from gcs.plan.formats.writer import write
from gcs.plan.legs import Ground
from gcs.plan.lint import lint
from gcs.plan.model import AutopilotName, Plan
from gcs.plan.place import georeference
from gcs.plan.wire import to_wire
from gcs.plan.zones import zone_specs
from tests.sample_files import SAMPLES
from tests.unit.plan.samples import LOCAL, WHO, box, survey, wpl

TABLE = wpl(
    "0 1 0 16 0 0 0 0 -35.363262 149.165237 584 1",
    "1 0 3 22 0 0 0 0 -35.363 149.165 20 1",
    "2 0 3 18 2 0 10 0 -35.362 149.165 20 1",
    "3 0 2 177 2 1 0 0 0 0 0 1",
    "4 0 3 5001 3 0 0 0 -35.363 149.165 0 1",
    "5 0 3 5001 3 0 0 0 -35.362 149.165 0 1",
    "6 0 3 5001 3 0 0 0 -35.362 149.166 0 1",
    "7 0 3 5003 20 0 0 0 -35.362 149.166 0 1",
)
FILES = {
    "box.plan": json.dumps(box(), indent=1),
    "survey.plan": json.dumps(survey()),
    "table.txt": TABLE,
    "local.toml": LOCAL,
    **{
        name: (SAMPLES / folder / name).read_text(encoding="utf-8")
        for folder, name in (
            ("xml", "field.kml"),
            ("xml", "track.gpx"),
            ("csv", "everything.csv"),
            ("tables", "fence_of_the_old_kind.txt"),
            ("tables", "rally_of_the_old_kind.txt"),
            ("tables", "protobuf.txt"),
        )
    },
}
TOKENS = [b"null", b"NaN", b"1e999", b"-1", b"0", b"[", b"]", b"{", b"}", b'"', b"\n", b"\xff"]
TOKENS += [b"9" * 500, b"177", b"5001", b"#", b"=", b",", b"true", b"[[fence]]", b"2.5", b"\x00"]
ROUNDS = 500


def damaged(data: bytes, rng: random.Random) -> bytes:
    for _ in range(rng.randint(1, 4)):
        at, end = sorted((rng.randrange(len(data) + 1), rng.randrange(len(data) + 1)))
        end = min(end, at + 30)
        match rng.randrange(4):
            case 0:
                data = data[:at] + data[end:]
            case 1:
                data = data[:at] + rng.choice(TOKENS) + data[end:]
            case 2:
                data = data[:at] + data[at:end] * 2 + data[end:]
            case _:
                numbers = [i for i, byte in enumerate(data) if chr(byte).isdigit()]
                at = rng.choice(numbers) if numbers else 0
                data = data[:at] + rng.choice(TOKENS) + data[at + 1 :]
    return data


def use(plan: Plan) -> None:
    """Everything that is done with a plan that was read."""
    projection = Projection(Origin(47.397742, 8.545594, 488.0), "px4")
    for who in WHO:
        lint(plan, who)
        zone_specs(plan.fence)
        placed = georeference(plan, projection.lat_lon)
        ground = Ground(who, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), projection.north_east, 488.0, 30.0)
        flight_path(placed, ground)
        with suppress(PlanError):
            write("a.txt", placed, who)
        with suppress(PlanError):
            write("a.plan", placed, who)
            sent = to_wire(placed, who)
            assert same_meaning(sent, sent, who) == []


def attempt(name: str, data: bytes, who: AutopilotName | None = None) -> Plan | str:
    """The plan, or the error as it is told."""
    try:
        return read(name, data, who)
    except PlanError as error:
        return str(error)


@pytest.mark.parametrize("name", FILES)
def test_a_damaged_file_never_gets_further_than_a_told_error(name: str) -> None:
    rng = random.Random(name)
    read_anyway = 0
    for _ in range(ROUNDS):
        data = damaged(FILES[name].encode(), rng)
        for who in (*WHO, None):
            answer = attempt(name, data, who)
            if isinstance(answer, Plan):
                read_anyway += 1
                use(answer)
            else:
                assert answer.startswith(name)
    assert 0 < read_anyway < 3 * ROUNDS


def test_a_file_cut_anywhere_is_told() -> None:
    for name, text in FILES.items():
        data = text.encode()
        for end in range(0, len(data), 7):
            answer = attempt(name, data[:end])
            assert isinstance(answer, Plan) or answer.startswith(name)


@pytest.mark.parametrize("data", [b"", b"\xef\xbb\xbf", b"\x89PNG\r\n", b"PK\x03\x04"])
def test_what_is_no_mission_file_is_told_what_would_be_one(data: bytes) -> None:
    with pytest.raises(PlanError, match="QGC WPL 110"):
        read("somewhere/a.bin", data)


def test_a_file_of_any_size_is_not_taken() -> None:
    with pytest.raises(PlanError, match="bytes"):
        read("a.plan", b" " * (SIZE_MAX + 1))
