"""Records how a real autopilot flies the missions of the catalogue, by the simulation's truth.

`python -m tests.real.record_missions px4 facts.json --autopilot START` flies them, in a network of
its own; START is a program that starts the autopilot in the foreground: `START px4 DIR INSTANCE` or
`START arducopter DIR`, which tell of themselves on UDP 14540 + INSTANCE or 14550.  An ArduCopter
may be faster than time (SPEEDUP in the environment).  Needs root, for the network; on a machine
that is busy the autopilot needs a real-time priority (`chrt -r 1`), or it flies badly.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

from tests.real.mission_catalogue import FLIGHTS, HOME, LAND, Flight, Item

HOME_DEG = (47.397742, 8.545594)
METRES_A_DEGREE = {"px4": 6371000.0 * math.pi / 180.0, "ardupilot": 111318.845}
"""As each autopilot projects."""
TRUTH = {"px4": "HIL_STATE_QUATERNION", "ardupilot": "SIM_STATE"}
TRUTH_ID = {"px4": 115, "ardupilot": 108}
PORT = {"px4": 14540, "ardupilot": 14550}
HERTZ = 20.0
LONGEST_S = 420.0
NO_SPACE = 4
"""An ArduCopter says so of a mission that comes while it starts."""
KEPT_M = 0.1
"""A point of the track that is no farther from the line of its neighbours is not kept."""
RESTS_S = 6.0
NEVER_GOES_ON_S = 30.0
MOVES_M = 2.0
"""A PX4 at rest wanders by up to 1.6 m about its place: its estimate does."""

Track = list[tuple[float, ...]]
"""Of each moment: s, the truth and what the autopilot believes (north, east, down), the item."""


class FailedError(Exception):
    """The autopilot did not do what was asked."""


class Vehicle:
    """A real autopilot, started afresh."""

    def __init__(self, kind: str, start: str, folder: str, instance: int) -> None:
        self.kind = kind
        self.sysid = instance + 1
        name = {"px4": "px4", "ardupilot": "arducopter"}[kind]
        words = [start, name, folder, *([str(instance)] if kind == "px4" else [])]
        with Path(folder, "stdout").open("wb") as log:
            self._process = subprocess.Popen(
                words, stdout=log, stderr=log, stdin=subprocess.DEVNULL
            )
        self.link: Any = mavutil.mavlink_connection(
            f"udpin:127.0.0.1:{PORT[kind] + instance}", source_system=255, source_component=190
        )
        self.now_s = 0.0
        self.seq = 0
        self.armed = False
        self.pos = (0.0, 0.0, 0.0)
        self.believed = (0.0, 0.0, 0.0)
        self.ground_amsl_m: float | None = None
        self.track: Track = []
        self.reached: set[int] = set()
        self._beat_s = 0.0

    def close(self) -> None:
        self.link.close()
        self._process.send_signal(signal.SIGTERM)
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self._process.kill()

    # ------------------------------------------------------------------ what it tells

    def receive(self, timeout_s: float = 0.5) -> Any:
        """One message, or None; what it says of the vehicle is kept."""
        if time.monotonic() - self._beat_s > 0.3:
            self._beat_s = time.monotonic()
            self.link.mav.heartbeat_send(6, 8, 0, 0, 4)
        message = self.link.recv_match(blocking=True, timeout=timeout_s)
        if message is None or message.get_srcComponent() != 1:
            return None
        match message.get_type():
            case "HEARTBEAT":
                self.armed = bool(message.base_mode & 128)
            case "LOCAL_POSITION_NED":
                self.now_s = message.time_boot_ms / 1e3
                self.believed = (message.x, message.y, message.z)
            case "MISSION_CURRENT":
                self.seq = message.seq
            case "MISSION_ITEM_REACHED":
                self.reached.add(message.seq)
            case "STATUSTEXT" if message.severity < 5:
                print("   ", message.text, flush=True)
            case kind if kind == TRUTH[self.kind]:
                self._truth(message)
        return message

    def _truth(self, message: Any) -> None:
        if self.kind == "px4":
            lat_deg, lon_deg, alt_m = message.lat / 1e7, message.lon / 1e7, message.alt / 1e3
        else:
            lat_deg, lon_deg, alt_m = message.lat_int / 1e7, message.lon_int / 1e7, message.alt
        if self.ground_amsl_m is None:
            self.ground_amsl_m = alt_m
        a_degree = METRES_A_DEGREE[self.kind]
        north = (lat_deg - HOME_DEG[0]) * a_degree
        east = (lon_deg - HOME_DEG[1]) * a_degree * math.cos(math.radians(HOME_DEG[0]))
        self.pos = (north, east, self.ground_amsl_m - alt_m)
        self.track.append((self.now_s, *self.pos, *self.believed, self.seq))

    def until(self, what: str, is_so: Any, timeout_s: float) -> None:
        end_s = time.monotonic() + timeout_s
        while time.monotonic() < end_s:
            if is_so(self.receive()):
                return
        raise FailedError(what)

    # ------------------------------------------------------------------ what it is told

    def command(self, number: int, *params: float) -> None:
        """Again each second until it is accepted."""
        filled = (*params, *(0.0,) * (7 - len(params)))
        for _ in range(60):
            self.link.mav.command_long_send(self.sysid, 1, number, 0, *filled)
            end_s = time.monotonic() + 1.0
            while time.monotonic() < end_s:
                message = self.receive(0.2)
                if message is None or message.get_type() != "COMMAND_ACK":
                    continue
                if message.command == number and message.result == 0:
                    return
        raise FailedError(f"command {number}")

    def set_parameter(self, name: str, value: float) -> None:
        for _ in range(20):
            self.link.mav.param_set_send(self.sysid, 1, name.encode(), value, 9)
            end_s = time.monotonic() + 1.0
            while time.monotonic() < end_s:
                message = self.receive(0.2)
                if message is None or message.get_type() != "PARAM_VALUE":
                    continue
                if message.param_id == name and abs(message.param_value - value) < 1e-4:
                    return
        raise FailedError(f"parameter {name}")

    def upload(self, items: tuple[Item, ...]) -> None:
        self.link.mav.mission_count_send(self.sysid, 1, len(items), 0)
        end_s = time.monotonic() + 30.0
        while time.monotonic() < end_s:
            message = self.receive()
            kind = None if message is None else message.get_type()
            if kind in ("MISSION_REQUEST", "MISSION_REQUEST_INT"):
                self._send_item(items[message.seq], message.seq)
            elif kind == "MISSION_ACK":
                if message.type == 0:
                    return
                if message.type != NO_SPACE:
                    raise FailedError(f"the upload: {message.type}")
                time.sleep(0.5)
                self.link.mav.mission_count_send(self.sysid, 1, len(items), 0)
        raise FailedError("the upload")

    def _send_item(self, item: Item, seq: int) -> None:
        x = y = 0
        frame = 2 if item.up_m is None else 6
        if item.up_m is not None:
            a_degree = METRES_A_DEGREE[self.kind]
            wide = a_degree * math.cos(math.radians(HOME_DEG[0]))
            x = round(1e7 * (HOME_DEG[0] + item.north_m / a_degree))
            y = round(1e7 * (HOME_DEG[1] + item.east_m / wide))
        p1, p2, p3, p4 = item.params
        if self.kind == "px4" and frame == 6:
            p4 = math.nan
        self.link.mav.mission_item_int_send(
            self.sysid, 1, seq, frame, item.command, 0, 1, p1, p2, p3, p4, x, y, item.up_m or 0.0, 0
        )


def ready(vehicle: Vehicle) -> None:
    vehicle.until("a heartbeat", lambda m: m is not None and m.get_type() == "HEARTBEAT", 60.0)
    vehicle.command(511, TRUTH_ID[vehicle.kind], 1e6 / HERTZ)
    if vehicle.kind == "ardupilot":
        vehicle.command(511, 32, 1e6 / HERTZ)
        vehicle.command(511, 42, 2e5)
        vehicle.command(511, 46, 2e5)
    vehicle.until("its position", lambda _: vehicle.now_s > 0.0 and vehicle.track, 120.0)


def fly(vehicle: Vehicle, flight: Flight) -> Track:
    """The truth from the start of the mission to its end."""
    for name, value in flight.params.items():
        vehicle.set_parameter(name, value)
    items = flight.items
    if vehicle.kind == "ardupilot":
        vehicle.set_parameter("SIM_WIND_SPD", flight.wind_m_s)
        vehicle.set_parameter("SIM_WIND_DIR", 270.0)
        items = (Item(16, 0.0, 0.0, 0.0), *items)  # its first is home
    vehicle.upload(items)
    if vehicle.kind == "ardupilot":
        vehicle.command(176, 1.0, 4.0)
        vehicle.command(400, 1.0)
        vehicle.track.clear()
        vehicle.command(300)
    else:
        vehicle.command(176, 1.0 + 28.0, 4.0, 4.0)
        vehicle.command(400, 1.0)
        vehicle.track.clear()
    vehicle.reached.clear()
    _until_over(vehicle, items)
    return list(vehicle.track)


def _until_over(vehicle: Vehicle, items: tuple[Item, ...]) -> None:
    """Disarmed, or at rest for a while after the last item was reached."""
    lands = items[-1].command in (HOME, LAND)
    began_s = vehicle.now_s
    rests_since_s, was = vehicle.now_s, vehicle.pos
    while vehicle.now_s - began_s < LONGEST_S:
        vehicle.receive()
        if math.dist(vehicle.pos, was) > MOVES_M:
            rests_since_s, was = vehicle.now_s, vehicle.pos
        if not vehicle.armed and vehicle.now_s - began_s > 5.0:
            return
        done = len(items) - 1 in vehicle.reached and not lands
        if vehicle.now_s - rests_since_s > (RESTS_S if done else NEVER_GOES_ON_S):
            return
    raise FailedError("it did not come to its end")


def come_down(vehicle: Vehicle) -> None:
    """An ArduCopter flies the next mission, too: it lands where it is."""
    if vehicle.armed:
        vehicle.command(176, 1.0, 6.0)
        vehicle.until("it lands", lambda _: not vehicle.armed, 200.0)


def thinned(track: Track) -> Track:
    """Without the points that lie on the line of those that are kept (Douglas and Peucker)."""
    if len(track) < 3:
        return track
    keep = {0, len(track) - 1}
    stack = [(0, len(track) - 1)]
    while stack:
        first, last = stack.pop()
        far, at = max(
            ((_beside(track[n], track[first], track[last]), n) for n in range(first + 1, last)),
            default=(0.0, 0),
        )
        if far > KEPT_M:
            keep.add(at)
            stack += [(first, at), (at, last)]
    return [track[n] for n in sorted(keep)]


def _beside(point: Any, a: Any, b: Any) -> float:
    """From the place that the track would have at that moment between the two."""
    share = (point[0] - a[0]) / (b[0] - a[0]) if b[0] > a[0] else 0.0
    nominal = [x + share * (y - x) for x, y in zip(a, b, strict=True)]
    return max(math.dist(point[n : n + 3], nominal[n : n + 3]) for n in (1, 4))


def facts_of(flight: Flight, track: Track, seq_of_first: int) -> dict[str, object]:
    began_s = track[0][0]
    return {
        "name": flight.name,
        "params": flight.params,
        "wind_m_s": flight.wind_m_s,
        "items": [
            [item.command, item.north_m, item.east_m, item.up_m, *item.params]
            for item in flight.items
        ],
        "columns": "t_s, truth and belief: north_m east_m down_m, item",
        "track": [
            [round(t - began_s, 2), *(round(x, 2) for x in where), round(seq) - seq_of_first]
            for t, *where, seq in thinned(track)
        ],
    }


def record(kind: str, start: str, instance: int, flights: list[Flight], out: Path) -> None:
    """A PX4 begins each afresh: the bias of its accelerometer grows on the ground."""
    found: list[dict[str, object]] = json.loads(out.read_text()) if out.exists() else []
    done = {str(one["name"]) for one in found}
    waiting = [flight for flight in flights if flight.name not in done]
    for tried in range(3):
        failed: list[Flight] = []
        for flight, track in _flown(kind, start, instance, waiting):
            if track is None:
                failed.append(flight)
                continue
            found.append(facts_of(flight, track, int(kind == "ardupilot")))
            out.write_text(_written(found))
        waiting = failed
        if not waiting:
            return
        print(f"once more ({tried}): {[flight.name for flight in waiting]}", flush=True)


def _flown(
    kind: str, start: str, instance: int, flights: list[Flight]
) -> Iterator[tuple[Flight, Track | None]]:
    vehicle: Vehicle | None = None
    usual: dict[str, float] = {}
    for flight in flights:
        track: Track | None = None
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            try:
                if vehicle is None:
                    keep = folder if kind == "px4" else tempfile.mkdtemp()
                    vehicle = Vehicle(kind, start, keep, instance)
                    ready(vehicle)
                for name, value in usual.items():
                    vehicle.set_parameter(name, value)
                if kind == "ardupilot":
                    usual = {name: _read(vehicle, name) for name in flight.params}
                track = fly(vehicle, flight)
                if kind == "ardupilot":
                    come_down(vehicle)
                print(f"{flight.name}: {len(track)} points, {track[-1][0] - track[0][0]:.0f} s")
            except FailedError as error:
                print(f"{flight.name}: {error}", flush=True)
                usual = {}
                if vehicle is not None:
                    vehicle.close()
                    vehicle = None
            sys.stdout.flush()
            if vehicle is not None and kind == "px4":
                vehicle.close()
                vehicle = None
        yield flight, track
    if vehicle is not None:
        vehicle.close()


def _read(vehicle: Vehicle, name: str) -> float:
    for _ in range(20):
        vehicle.link.mav.param_request_read_send(vehicle.sysid, 1, name.encode(), -1)
        end_s = time.monotonic() + 1.0
        while time.monotonic() < end_s:
            message = vehicle.receive(0.2)
            if message is None or message.get_type() != "PARAM_VALUE":
                continue
            if message.param_id == name:
                return float(message.param_value)
    raise FailedError(f"parameter {name}")


def _written(found: list[dict[str, object]]) -> str:
    """A line a flight."""
    lines = (json.dumps(one, separators=(",", ":")) for one in found)
    return "[\n" + ",\n".join(lines) + "\n]\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("kind", choices=sorted(TRUTH))
    parser.add_argument("out", type=Path)
    parser.add_argument("--autopilot", required=True, help="the program that starts it")
    parser.add_argument("--instance", type=int, default=0, help="of PX4s at the same time")
    parser.add_argument("--only", nargs="*", help="names of flights")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if not asked.inside:
        words = ("-m", "tests.real.record_missions", *sys.argv[1:], "--inside")
        inside = ('ip link set lo up; exec "$@"', "sh", sys.executable, *words)
        os.execvp("unshare", ("unshare", "-n", "sh", "-c", *inside))
    flights = [one for one in FLIGHTS[asked.kind]() if not asked.only or one.name in asked.only]
    record(asked.kind, asked.autopilot, asked.instance, flights, asked.out)


if __name__ == "__main__":
    main()
