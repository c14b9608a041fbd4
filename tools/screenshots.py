"""Pictures of the keyboard screen in flight, as SVG: `python tools/screenshots.py [FOLDER]`.

Flies `vehicle-sim` with a real station, without a terminal, and saves what the screen shows:
a refusal before Enter, a mission with its path and its items, GPS lost with its alarm, typed lines.
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

from gcs.config import StationConfig
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
        faults.write_text(GPS_LOST.format(at_s=75))
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
    await pilot.pause(14.0)
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


if __name__ == "__main__":
    main()
