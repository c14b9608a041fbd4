"""Pictures of the keyboard screen in flight, as SVG: `python tools/screenshots.py [FOLDER]`.

Flies `vehicle-sim` with a real station, without a terminal, and saves what the screen shows:
a refusal before Enter, a mission with its path and its items, GPS lost with its alarm, typed lines,
three vehicles.
"""

from __future__ import annotations

import asyncio
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from textual.pilot import Pilot

from gcs.config import SimConfig, StationConfig
from gcs.operator.client import StationClient
from gcs.tui.app import FlyApp
from gcs.tui.result import until_hello

GPS_LOST = """\
[[fault]]
at_s = {at_s}
kind = "gps_lost"
for_s = 60
"""
PATIENCE_S = 60.0


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


async def until(app: FlyApp, pilot: Pilot[None], true: Callable[[], bool]) -> None:
    for _ in range(round(PATIENCE_S / 0.1)):
        if true():
            return
        await pilot.pause(0.1)
    state = app.scene.snapshot.state if app.scene.snapshot else "-"
    raise TimeoutError(f"{state}: {app.scene.answer.text}")


def state(app: FlyApp) -> str:
    return app.scene.snapshot.state if app.scene.snapshot else ""


def decided(app: FlyApp, text: str) -> bool:
    return any(each.text.startswith(text) for each in app.scene.decisions)


async def typed(pilot: Pilot[None], text: str) -> None:
    names = {" ": "space", "-": "minus", ".": "full_stop", "_": "underscore", "/": "slash"}
    await pilot.press("colon", *(names.get(letter, letter) for letter in text))


async def flown(columns: int, rows: int, folder: Path, shots: set[str]) -> None:
    port = free_port()
    with tempfile.TemporaryDirectory() as logs:
        faults = Path(logs, "faults.toml")
        faults.write_text(GPS_LOST.format(at_s=66))
        argv = [sys.executable, "-m", "vehicle_sim", "--link", f"udpout://127.0.0.1:{port}"]
        argv += ["--wind", "4,225,0.5", "--fault", str(faults)]
        vehicle = subprocess.Popen(argv, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        config = StationConfig([f"udpin://127.0.0.1:{port}"], log_dir=logs)
        station = StationClient.start(config)
        app = FlyApp(station, until_hello(station))
        try:
            async with app.run_test(size=(columns, rows)) as pilot:
                await flight(app, pilot, folder, f"screen-{columns}x{rows}", shots)
        finally:
            station.close()
            vehicle.terminate()
            vehicle.wait()


async def fleet(folder: Path) -> None:
    """Three vehicles: of two goals that cross the second one would be refused."""
    with tempfile.TemporaryDirectory() as logs:
        station = StationClient.start(
            StationConfig(sim=SimConfig(count=3), fleet=True, log_dir=logs)
        )
        app = FlyApp(station, until_hello(station))
        try:
            async with app.run_test(size=(120, 40)) as pilot:
                await crossing(app, pilot)
                app.redraw()
                await pilot.pause(0.3)
                path = folder / "screen-120x40-fleet.svg"
                path.write_text(app.export_screenshot(title="gcs fly"))
                print(path)
        finally:
            station.close()


async def crossing(app: FlyApp, pilot: Pilot[None]) -> None:
    async def say(text: str, until_it: str = "") -> None:
        await typed(pilot, text)
        await pilot.press("enter")
        if until_it:
            await until(app, pilot, lambda: decided(app, until_it))

    await until(app, pilot, lambda: bool(app.scene.snapshot and app.scene.snapshot.others))
    await until(app, pilot, lambda: state(app) == "GROUNDED")
    await pilot.pause(3.0)
    for number in (2, 3, 1):
        await say(f"vehicle {number}")
        await until(app, pilot, lambda: state(app) == "GROUNDED")
        await say("arm", f"vehicle {number}: arm: complete")
        await say("takeoff 5", f"vehicle {number}: takeoff 5: complete")
    for number, goal in ((2, "20 0 5"), (3, "0 20 5")):
        await say(f"vehicle {number}")
        await until(app, pilot, lambda: state(app) == "HOVERING")
        await say(f"goto {goal}", f"vehicle {number}: goto {goal}: complete")
    await say("vehicle 1")
    await until(app, pilot, lambda: state(app) == "HOVERING")
    await say("speed 1", "vehicle 1: speed 1: complete")
    await say("goto 20 20 5", "vehicle 1: goto 20 20 5: accepted")
    await say("vehicle 2")
    await until(app, pilot, lambda: state(app) == "HOVERING")
    await pilot.press("n")
    await typed(pilot, "goto -5 15 5")
    await pilot.pause(1.5)


async def flight(app: FlyApp, pilot: Pilot[None], folder: Path, name: str, shots: set[str]) -> None:
    async def shot(what: str) -> None:
        if what in shots:
            app.redraw()
            await pilot.pause(0.3)
            path = folder / f"{name}-{what}.svg"
            path.write_text(app.export_screenshot(title="gcs fly"))
            print(path)

    await until(app, pilot, lambda: state(app) == "GROUNDED")
    await pilot.pause(3.0)
    await pilot.press("m")
    await until(
        app, pilot, lambda: app.scene.snapshot is not None and bool(app.scene.snapshot.armed)
    )
    await pilot.press("t")
    await until(app, pilot, lambda: decided(app, "takeoff 1.5: complete"))
    await typed(pilot, "goto 8 4 3 90")
    await pilot.press("enter", "x", "x", *["right"] * 16)
    await until(app, pilot, lambda: decided(app, "goto 8 4 3 90: complete"))
    await pilot.press("enter")
    await pilot.pause(1.5)
    await shot("refused")
    await pilot.press("v")
    await typed(pilot, "goto 500 0 2")
    await pilot.pause(1.5)
    await shot("typed")
    await pilot.press("escape")
    await typed(pilot, "mission fly s")
    await pilot.press("tab")
    await shot("line")
    await pilot.press("q", "u", "tab", "enter")
    await until(app, pilot, lambda: state(app) == "FLYING_MISSION")
    await pilot.press("v", "z")
    await pilot.pause(10.0)
    await shot("mission")
    await pilot.press("I")
    await pilot.pause(0.3)
    await shot("items")
    await pilot.press("I")
    await until(app, pilot, lambda: "GPS LOST" in app.scene.alarms.words())
    await pilot.pause(3.0)
    await shot("gps-lost")


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs")
    every = {"refused", "mission", "gps-lost"}
    asyncio.run(flown(80, 24, folder, {*every, "line", "typed", "items"}))
    asyncio.run(flown(120, 40, folder, {*every, "items"}))
    asyncio.run(flown(200, 60, folder, every))
    asyncio.run(fleet(folder))


if __name__ == "__main__":
    main()
