"""How long the gate takes for a verdict, in process: a goal, a stream sample, a 100-item mission.

    python -m tools.verdict_times [--goals 2000] [--missions 40] [--no-freeze]

A client's frame is handed to the whole session of a bridge in flight (simulated PX4, virtual time),
and a clock outside measures the one call that gives the verdict: split, judged, verified, answered.
Its CPU time is told too: on a busy machine the longest times are other programs'.  The garbage
collector is on, as in the program; `--no-freeze` leaves out what the program does about its pauses.
"""

from __future__ import annotations

import argparse
import gc
import os
import time
from collections import defaultdict
from collections.abc import Sequence

from pymavlink.dialects.v20 import all as dialect

from gcs.report import DecisionItem
from gcs.session import inputs
from gcs.session.effects import Effect, Record
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client, flying
from tests.loopback.flight import HOMES
from tests.loopback.plan_clients import NORTH_DEG, PlanFlight, Pymavlink, mission
from tests.loopback.test_bridge_streams import VELOCITY_ONLY

STEP_S = 0.05
ITEMS = 100
GOALS_UP_M = 5.0


class Stopwatch:
    """Times every call of a flight's session; keeps those that gave a verdict, by the request's
    word, and those with samples of a stream."""

    def __init__(self, flight: BridgedFlight) -> None:
        self.times_us: defaultdict[str, list[tuple[float, float]]] = defaultdict(list)
        """Of each call: by the wall's clock, and of CPU."""
        self.samples = False
        """What clients send now is a sample each."""
        self._handle = flight.session.handle
        flight.session.handle = self._timed  # type: ignore[method-assign]

    def _timed(self, given: inputs.Input, now_ns: int) -> list[Effect]:
        begin_ns, cpu_ns = time.perf_counter_ns(), time.thread_time_ns()
        effects = self._handle(given, now_ns)
        cpu_us = (time.thread_time_ns() - cpu_ns) / 1e3
        took_us = (time.perf_counter_ns() - begin_ns) / 1e3, cpu_us
        records = (effect.item for effect in effects if isinstance(effect, Record))
        for item in records:
            if isinstance(item, DecisionItem) and item.phase == "verdict":
                self.times_us[item.word].append(took_us)
        if self.samples and isinstance(given, inputs.Datagram) and given.link > 0:
            self.times_us["sample"].append(took_us)
        return effects


class Pauses:
    """The collector's runs since this was made, by generation."""

    def __init__(self) -> None:
        self.longest_ms = [0.0, 0.0, 0.0]
        self._begin_ns = 0
        gc.callbacks.append(self._called)

    def _called(self, phase: str, info: dict[str, int]) -> None:
        if phase == "start":
            self._begin_ns = time.perf_counter_ns()
        else:
            took_ms = (time.perf_counter_ns() - self._begin_ns) / 1e6
            generation = info["generation"]
            self.longest_ms[generation] = max(self.longest_ms[generation], took_ms)

    def end(self) -> None:
        gc.callbacks.remove(self._called)


def goals(flight: BridgedFlight, client: Client, many: int) -> None:
    """To and fro between two places, each asked for before the one before is reached."""
    home = HOMES["px4"]
    for number in range(many):
        north_deg = (number % 7 - 3) * 4.0 * NORTH_DEG
        client.fly_to(home.lat_deg + north_deg, home.lon_deg, home.alt_amsl_m + GOALS_UP_M)
        wait(flight, client, number)


def samples(flight: BridgedFlight, client: Client, watch: Stopwatch, many: int) -> None:
    """A velocity stream at 20 Hz, to and fro."""
    for number in range(many):
        v_n = 2.0 if number // 40 % 2 else -2.0
        velocity = (v_n, 0.0, 0.0)
        message = dialect.MAVLink_set_position_target_local_ned_message(
            0, *VEHICLE, 1, VELOCITY_ONLY, 0, 0, 0, *velocity, 0, 0, 0, 0, 0
        )
        watch.samples = True
        client.send(message)
        watch.samples = False
        wait(flight, client, number)


def wait(flight: BridgedFlight, client: Client, number: int) -> None:
    if number % 20 == 0:
        forget(flight)
        client.beat()
    flight.run(STEP_S)


def forget(flight: BridgedFlight) -> None:
    """What a test keeps and a station does not: it would make the collector's pauses longer."""
    for kept in (flight.events, flight.event_times_ns, flight.records, flight.sent):
        kept.clear()
    flight.received.clear()
    for client in flight.clients.values():
        client.heard.clear()


def missions(many: int) -> list[tuple[float, float]]:
    """Uploads of a mission of `ITEMS` items; each differs, so none is on board already."""
    flight = PlanFlight()
    flight.join()
    flight.connected()
    watch = Stopwatch(flight)
    for number in range(many):
        places = [
            (20.0 * (n % 5), 15.0 * (n // 5 % 6), 10.0 + number % 9 + 0.1 * (n % 7))
            for n in range(ITEMS - 2)
        ]
        forget(flight)
        upload = Pymavlink(flight, flight.clients[1], mission("px4", *places))
        assert upload.ended(120.0) == "complete", upload.result
        flight.clients[1].beat()
        flight.run(1.0)
    (times_us,) = watch.times_us.values()
    return times_us


def line(name: str, times_us: Sequence[tuple[float, float]]) -> str:
    told = f"  verdict on a {name:16}"
    for clock, column in (("wall", 0), ("CPU", 1)):
        ordered = sorted(each[column] for each in times_us)
        p50, p999 = (ordered[len(ordered) * part // 1000] for part in (500, 999))
        told += f"  {clock} p50 {p50:7.0f}, p99.9 {p999:7.0f}, longest {ordered[-1]:7.0f} us"
    return f"{told}; of {len(times_us)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--goals", type=int, default=2000, help="and as many samples")
    parser.add_argument("--missions", type=int, default=40)
    parser.add_argument("--no-freeze", action="store_true")
    asked = parser.parse_args()
    flight, client = flying("px4")
    if not asked.no_freeze:
        gc.collect()
        gc.freeze()
    print(f"in process, load {os.getloadavg()[0]:.1f}")
    pauses = Pauses()
    watch = Stopwatch(flight)
    goals(flight, client, asked.goals)
    samples(flight, client, watch, asked.goals)
    print(line("goal", watch.times_us["goto"]))
    print(line("stream sample", watch.times_us["sample"]))
    print(line(f"{ITEMS}-item mission", missions(asked.missions)))
    pauses.end()
    told = ", ".join(f"{ms:.1f}" for ms in pauses.longest_ms)
    print(f"  longest pauses of the collector, generations 0 to 2: {told} ms")


if __name__ == "__main__":
    main()
