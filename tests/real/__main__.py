"""`make real`: the station flies real autopilots, and their simulations judge (docs/real.md)."""

import argparse
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from tests.real import autopilots, bounds, daily, record, rows, trials, ways
from tests.real.autopilots import KINDS, Kind
from tests.real.flight import Flight, NotReadyError
from tests.real.rows import Row
from tests.real.vehicle import Vehicle

TRIALS = trials.KINDS | ways.KINDS | daily.KINDS
Result = dict[str, Any]
LEAST_SHARE = 0.85
"""Of real time: a simulation that runs slower is starved, and what it did says nothing."""


def fly(flight: Flight, row: Row) -> Result:
    observer = flight.observer
    if flight.kind is not autopilots.PX4:
        observer.set("SIM_WIND_SPD", row.wind_m_s)
        observer.set("SIM_WIND_DIR", row.wind_deg)
    said = 0 if flight.current is None else len(flight.current.said)
    flight.marks = None
    started = time.monotonic()
    try:
        told, wrong = TRIALS[row.kind](flight, row)
    except NotReadyError as error:
        told, wrong = "not ready", str(error)
        flight.leave()
    except Exception as error:  # noqa: BLE001 - a row that breaks must not end the run
        told, wrong = "broke", f"{type(error).__name__}: {error}"
        flight.leave()
    marks = flight.marks or (len(observer.truth.samples), len(observer.off_m), time.monotonic())
    first, off, began = marks
    flown = observer.truth.samples[first:]
    clearances = [row.clearance_m(place) for place in observer.flown_from_home[first:]]
    nearest = min(clearances, default=None)
    share = 1.0
    if len(flown) > 1:
        share = (flown[-1].at_s - flown[0].at_s) / (time.monotonic() - began)
    if share < LEAST_SHARE:
        wrong = f"starved: the vehicle's clock ran at {share:.2f} of real time. {wrong}"
    if nearest is not None and nearest < 0.0:
        wrong = f"OUTSIDE by {-nearest:.2f} m. {wrong}"
    station = flight.current
    return {
        "autopilot": flight.kind.name,
        "row": row.name,
        "told": told,
        "wrong": wrong.strip(),
        "nearest_m": None if nearest is None else round(nearest, 2),
        "top_m_s": round(max((s.speed_m_s for s in flown), default=0.0), 2),
        "seconds": round(flown[-1].at_s - flown[0].at_s, 1) if flown else None,
        "estimate_off_m": round(max(observer.off_m[off:], default=0.0), 2),
        "row_s": round(time.monotonic() - started, 1),
        "clock_share": round(share, 2),
        "load": round(os.getloadavg()[0], 1),
        "states": [] if station is None else station.said[said:],
    }


def run(kind: Kind, groups: list[list[Row]], folder: Path, seed: int) -> list[Result]:
    results: list[Result] = []
    flight: Flight | None = None
    try:
        for row, begins in ((row, row is group[0]) for group in groups for row in group):
            if flight is not None and (begins or results[-1]["told"] in ("not ready", "broke")):
                flight.close()  # a fresh one
                flight = None
            try:
                if flight is None:
                    flight = Flight(kind, folder / f"{kind.name}_{len(results)}", seed)
                result = fly(flight, row)
                if result["told"] == "not ready" and results and not begins:
                    # A PX4's accelerometer bias grows while it stands after a landing.
                    why = result["wrong"]
                    flight.close()
                    flight = None
                    flight = Flight(kind, folder / f"{kind.name}_{len(results)}_again", seed)
                    result = fly(flight, row)
                    result["told"] += f" (another vehicle, as the first was not ready: {why})"
            except NotReadyError as error:
                result = {"autopilot": kind.name, "row": row.name, "told": "", "wrong": str(error)}
            results.append(result)
            print(line(result), flush=True)
            with (folder / f"{kind.name}.jsonl").open("a") as out:
                out.write(json.dumps(result) + "\n")
    finally:
        if flight is not None:
            flight.close()
    return results


def line(result: Result) -> str:
    nearest = result.get("nearest_m")
    room = "     -" if nearest is None else f"{nearest:6.2f}"
    refused = result["told"].startswith("refused")
    verdict = "WRONG" if result["wrong"] else "refused" if refused else "ok"
    text = (
        f"{result['autopilot']:10s} {verdict:7s} {result['row']:58s} nearest {room} m"
        f" {result.get('seconds') or 0:5.1f} s top {result.get('top_m_s') or 0:4.1f} m/s"
        f" estimate off {result.get('estimate_off_m') or 0:4.2f} m"
        f" load {result.get('load') or 0:4.1f}  {result['told'][:90]}"
    )
    return f"{text}\n{'':19s}{result['wrong'][:300]}" if result["wrong"] else text


def table(results: list[Result]) -> str:
    wrong = [result for result in results if result["wrong"]]
    outside = sum("OUTSIDE" in result["wrong"] for result in wrong)
    lines = ["", *(line(result) for result in results), ""]
    refused = sum(result["told"].startswith("refused") for result in results)
    lines.append(
        f"{len(results)} rows, {outside} outside, {len(wrong) - outside} otherwise wrong,"
        f" {refused} refused"
    )
    return "\n".join(lines)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.real", description=__doc__)
    parser.add_argument("what", nargs="?", default="fly", choices=("fly", "record", "judge"))
    parser.add_argument("--autopilot", choices=tuple(KINDS), help="this one alone")
    parser.add_argument("--smoke", action="store_true", help="a few rows, about 3 minutes")
    parser.add_argument("--only", default="", help="rows whose name matches this expression")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=40, help="approaches drawn by the seed")
    parser.add_argument("--folder", type=Path, help="for records and results; default: a new one")
    parser.add_argument("--part", default="steady", choices=record.PARTS, help="of record")
    parser.add_argument("--repeats", type=int, default=4, help="of record")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


def inside(asked: argparse.Namespace) -> int:
    """In the private network: one autopilot."""
    kind, folder = KINDS[asked.autopilot], asked.folder
    if asked.what == "record":
        process = autopilots.start(kind, folder / "vehicle")
        try:
            vehicle = Vehicle(kind)
            record.record(vehicle, asked.part, asked.repeats, folder / f"{asked.part}.jsonl")
        finally:
            autopilots.end(process)
        return 0
    with tempfile.TemporaryDirectory() as runtime:  # no station of this user is joined
        os.environ["XDG_RUNTIME_DIR"] = runtime
        chosen = [rows.smoke(kind)] if asked.smoke else rows.whole(kind, asked.seed, asked.count)
        groups = [[row for row in group if re.search(asked.only, row.name)] for group in chosen]
        results = run(kind, groups, folder, asked.seed)
    return int(any(result["wrong"] for result in results))


def outside(asked: argparse.Namespace) -> int:
    """Starts each autopilot in a network of its own, and puts together what was seen."""
    folder = asked.folder or Path(tempfile.mkdtemp(prefix="mavgate-real-"))
    folder.mkdir(parents=True, exist_ok=True)
    print(f"records and results: {folder}", flush=True)
    running: list[subprocess.Popen[bytes]] = []
    started: list[Kind] = []
    for kind in [KINDS[asked.autopilot]] if asked.autopilot else KINDS.values():
        if autopilots.command(kind) is None:
            print(f"{kind.name}: skipped, none is here; {kind.variable} names one (docs/real.md)")
            continue
        words = [*sys.argv[1:], "--inside", "--autopilot", kind.name, "--folder", str(folder)]
        command = autopilots.in_private_network("tests.real", words)
        if command is None:
            print(f"{kind.name}: skipped, as this system allows no network of its own (unshare -n)")
            continue
        started.append(kind)
        running.append(subprocess.Popen(command, cwd=autopilots.CHECKOUT))
    try:
        codes = [one.wait() for one in running]
    except (KeyboardInterrupt, SystemExit):
        for one in running:
            one.terminate()  # ends what it has started
        codes = [one.wait() for one in running]
    results: list[Result] = []
    for kind in started:
        path = folder / f"{kind.name}.jsonl"
        if path.exists():
            results += [json.loads(text) for text in path.read_text().splitlines()]
    if results:
        (folder / "results.json").write_text(json.dumps(results, indent=1))
        print(table(results))
    return max(codes, default=0)


def main() -> int:
    asked = arguments()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    if asked.what == "judge":
        print(bounds.report())
        return 0
    return inside(asked) if asked.inside else outside(asked)


if __name__ == "__main__":
    sys.exit(main())
