"""What is done on the ground every day, by single commands: files, faults, and what must be so."""

import json
import time
from collections.abc import Callable
from pathlib import Path

from gcs.plan.formats.reader import read
from tests.real.autopilots import PX4
from tests.real.flight import Flight
from tests.real.pilots import OneShot
from tests.real.rows import HEIGHT_M, Row
from tests.real.trials import Told, alike, gps

SET = {
    "px4": {"MPC_LAND_SPEED": 0.6, "RTL_RETURN_ALT": 31.5, "NAV_DLL_ACT": 3},
    "arducopter": {"LAND_SPD_MS": 0.6, "RTL_ALT_M": 17.5, "FS_GCS_ENABLE": 1},
}
"""Two with fractions and a whole number, each other than delivered."""
STOPS = {"px4": ("MPC_XY_VEL_MAX", 9.0), "arducopter": ("WP_SPD", 6.0)}
FAULTS = ("gps", "mission", "stop parameters")
"""Rows of `gcs preflight` that are made to be bad."""


def daily(flight: Flight, row: Row) -> Told:
    flight.on_ground(row)
    return SUBJECTS[row.word](flight, row, flight.one_shot(row))


def parameters(flight: Flight, row: Row, shot: OneShot) -> Told:
    """Saved, set, the difference shown, loaded back; the observer reads them past the station."""
    wrong, values = [], SET[flight.kind.name]
    for suffix in ("parm", "param", "params"):
        before = flight.folder / f"before.{suffix}"
        code, told = shot.run("param", "save", str(before))
        differing = _differing(shot, before)
        if code or differing:
            wrong.append(f"{before.name}: {code} {told} {differing}")
    for name, value in values.items():
        code, told = shot.run("param", "set", name, str(value))
        seen = flight.observer.get(name)
        if code or seen is None or abs(seen - value) > 1e-6:
            wrong.append(f"{name} is {seen}, not {value}: {told}")
    differing = _differing(shot, before)
    if differing != set(values):
        wrong.append(f"diff: {differing}")
    code, told = shot.run("param", "load", "--yes", str(before))
    if code:
        wrong.append(f"load {code}: {told}")
    wrong += [f"then {left}"] if (left := _differing(shot, before)) else []
    count = before.read_text().count("\n")
    return f"{count} lines; {len(differing)} set, shown, loaded back", "; ".join(wrong)


def _differing(shot: OneShot, file: Path) -> set[str]:
    """Without an ArduPilot's running totals."""
    _, told = shot.run("param", "diff", "--json", str(file))
    return {each["name"] for each in json.loads(told) if not each["name"].startswith("STAT_")}


def preflight(flight: Flight, row: Row, shot: OneShot) -> Told:
    """Three faults are told, each in its row; mended, every row is as it was."""
    observer, (name, value) = flight.observer, STOPS[flight.kind.name]
    wide = flight.folder / "wide.plan"
    square = ((90.0, 0.0), (0.0, 90.0), (-90.0, 0.0))
    items = [f"{i + 1}\t0\t3\t16\t0\t0\t0\t0\t{lat:.7f}\t{lon:.7f}\t20\t1" for i, (lat, lon) in
             enumerate(observer.on_map((e, n, HEIGHT_M)) for n, e in square)]  # fmt: skip
    lat, lon = observer.on_map((0.0, 0.0, 0.0))
    home = f"0\t1\t0\t16\t0\t0\t0\t0\t{lat:.7f}\t{lon:.7f}\t0\t1"
    wide.write_text("\n".join(("QGC WPL 110", home, *items)) + "\n")
    before = _rows(shot)
    other = OneShot(flight.policy(Row("daily", radius_m=150.0)), flight.folder)
    sent = other.run("mission", "upload", str(wide))
    delivered = observer.get(name)
    observer.set(name, value)
    gps(flight, works=False)
    time.sleep(15.0)
    amid = _rows(shot)
    gps(flight, works=True)
    cleared = shot.run("mission", "clear")
    mended = shot.run("param", "set", name, str(delivered))
    time.sleep(25.0)
    after = _rows(shot)
    worse = {each for each in amid if amid[each] != before.get(each) and amid[each] != "pass"}
    text = f"worse: {', '.join(sorted(worse))}; before {_bad(before)}; after {_bad(after)}"
    done = not (sent[0] or cleared[0] or mended[0])
    missed = [each for each in FAULTS if each not in worse]
    return (
        text,
        "" if done and not missed and after == before else f"{text} {sent} {cleared} {mended}",
    )


def _rows(shot: OneShot) -> dict[str, str]:
    """But for the machine's clock."""
    _, told = shot.run("preflight", "--json")
    rows = json.loads(told)["rows"]
    return {each["name"]: each["verdict"] for each in rows if each["name"] != "clock"}


def _bad(rows: dict[str, str]) -> str:
    return ", ".join(f"{name} {verdict}" for name, verdict in rows.items() if verdict != "pass")


def log(flight: Flight, row: Row, shot: OneShot) -> Told:
    """The log of a flight, fetched both ways, is the one on the vehicle's disk, and is imported."""
    flight.in_air_at(row, row.start)
    flight.marks = None
    flight.on_ground(row)
    flight.leave()
    time.sleep(5.0)
    wrong, told = [], ""
    disk = flight.folder / "vehicle"
    for by in ("ftp", "messages"):
        got, record = flight.folder / f"{by}.log", flight.folder / f"{by}.mcap"
        got = got.with_suffix(".ulg" if flight.kind is PX4 else ".BIN")
        words = ("get", "latest", "--by", by, "-o", str(got), "--import", str(record))
        code, said = shot.run("vehicle-log", *words)
        told += f"{by}: {said[:120]}; "
        # An ArduPilot goes on writing while it stands: what was fetched is the beginning of it.
        kept = [path.read_bytes() for path in (*disk.rglob("*.ulg"), *disk.rglob("*.BIN"))]
        if code or not any(each.startswith(got.read_bytes()) for each in kept):
            wrong.append(f"{by} {code}: {said}")
        code, said = shot.run("log", "report", str(record), options=False)
        if code:
            wrong.append(f"report {code}: {said}")
    return told, "; ".join(wrong)


def fences(flight: Flight, row: Row, shot: OneShot) -> Told:
    """A fence and rally points of a file, there and back by their own commands, then cleared."""
    lat, lon = flight.observer.on_map((0.0, 0.0, 0.0))
    corners = [
        (lat + n * 9e-6, lon + e * 13e-6) for n, e in ((50, 50), (50, -50), (-50, -50), (-50, 50))
    ]
    plan = {
        "fileType": "Plan", "groundStation": "QGroundControl", "version": 1,
        "mission": {"items": [], "version": 2, "plannedHomePosition": [0, 0, 0]},
        "geoFence": {"version": 2, "circles": [], "polygons": [
            {"inclusion": True, "polygon": [list(each) for each in corners], "version": 1}]},
        "rallyPoints": {"version": 2, "points": [[lat, lon + 2e-4, 5.0]]},
    }  # fmt: skip
    sent = flight.folder / "ours.plan"
    sent.write_text(json.dumps(plan))
    wrong = []
    for what in ("fence", "rally"):
        back = flight.folder / f"{what}_back.plan"
        for words in (("upload", sent), ("download", back), ("clear",)):
            code, said = shot.run(what, *map(str, words))
            if code:
                wrong.append(f"{what} {words[0]} {code}: {said}")
        there, here = (read(str(path), path.read_bytes()) for path in (sent, back))
        kept = [each.fence.zones if what == "fence" else each.rally for each in (there, here)]
        if not alike(*kept):
            wrong.append(f"{what}: {kept}")
        code, said = shot.run(what, "download", str(back), "--force")
        wrong += [f"{what} is still on board"] if code == 0 else []
    return "there and back, cleared", "; ".join(wrong)


SUBJECTS: dict[str, Callable[[Flight, Row, OneShot], Told]] = {
    "parameters": parameters,
    "preflight": preflight,
    "log": log,
    "fences": fences,
}
KINDS: dict[str, Callable[[Flight, Row], Told]] = {"daily": daily}
