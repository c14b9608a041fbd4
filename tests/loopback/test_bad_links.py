"""Links and clocks that are late, slow or lose frames: what is still flown, and what is not."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest

from gcs import ipc
from gcs.gate.states import State
from gcs.wire.frame import Frame, split
from tests.loopback import pymavlink_decoder
from tests.loopback.flight import HOMES, MISSIONS, PEER, Flight, Personality
from tests.loopback.lossy_link import CLEAR, Air, Weather
from tests.loopback.observed import START_NS
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import LinkSpec, World

# ------------------------------------------------------------------------------
# A link that is late by a constant time from its first byte: the answers to TIMESYNC show it.


def late(seconds: float) -> Weather:
    return Weather(delay_s=(seconds, seconds))


@pytest.mark.parametrize("ways_s", [(0.0, 3.0), (1.5, 1.5), (3.0, 0.0)])
def test_nothing_is_armed_on_a_link_that_takes_three_seconds(
    personality: Personality, ways_s: tuple[float, float]
) -> None:
    up_s, down_s = ways_s
    flight = Flight(personality, up=late(up_s), down=late(down_s))
    flight.run(12.0)
    assert flight.is_in(State.STALE)
    arm = flight.say("arm")
    flight.run(10.0)
    assert flight.done(arm) == "refused STALE"
    assert not flight.vehicle.armed
    assert any("s late, by" in line and "not used" in line for line in flight.lines("link"))


def test_a_link_that_becomes_quick_is_flown_on(personality: Personality) -> None:
    flight = Flight(personality, up=late(1.5), down=late(1.5))
    flight.run(12.0)
    assert flight.is_in(State.STALE)
    flight.up.weather = flight.down.weather = CLEAR
    flight.run(10.0)
    assert flight.is_in(State.GROUNDED)


def test_a_quarter_of_a_second_each_way_is_flown(personality: Personality) -> None:
    flight = Flight(personality, up=late(0.25), down=late(0.25)).connected()
    assert flight.is_in(State.GROUNDED)
    flight.say("arm")
    flight.run(4.0)
    assert flight.vehicle.armed


# ------------------------------------------------------------------------------
# A vehicle whose clock is slower than ours, as of a simulator on a busy machine.


class SlowFlight(Flight):
    """The same flight, its vehicle at `rate` of real time."""

    def __init__(self, personality: Personality, rate: str) -> None:
        super().__init__(personality)
        parameters = self.vehicle.parameters
        profile = profile_of(personality, parameters.firmware)
        server = VehicleServer(self.vehicle, profile, parameters, 1)
        self.world = World([server], [LinkSpec((PEER,))], Fraction(rate), START_NS)


@pytest.mark.parametrize("rate", ["0.95", "0.8"])
def test_it_flies_and_is_never_stale(personality: Personality, rate: str) -> None:
    flight = SlowFlight(personality, rate).connected()
    since_ns = flight.now_ns
    flight.hovering(3.0)
    flight.run(20.0)
    assert flight.done(flight.goto(4.0, 0.0, 3.0)) == "complete"
    flight.do("land")
    flight.until(lambda: not flight.vehicle.armed)
    assert "STALE" not in flight.states(since_ns)
    assert flight.is_in(State.GROUNDED)


def test_its_positions_in_a_long_queue_are_stale_all_the_same() -> None:
    flight = SlowFlight("px4", "0.8").hovering(3.0)
    since_ns = flight.now_ns
    flight.down.weather = Weather(delay_s=(3.0, 3.0))
    flight.until(lambda: "STALE" in flight.states(since_ns), 8.0)
    flight.run(10.0)
    assert not flight.is_in(State.HOVERING)


# ------------------------------------------------------------------------------
# The vehicle's settings over a link that loses them: what needs one waits for it.

LOSSY = Weather(loss=0.25)
RETURNS = """\
QGC WPL 110
0\t1\t0\t16\t0\t0\t0\t0\t{lat}\t{lon}\t{alt}\t1
1\t0\t3\t22\t0\t0\t0\t0\t{lat}\t{lon}\t5\t1
2\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1
"""


@pytest.mark.parametrize("seed", range(1, 6))
def test_a_mission_that_returns_is_verified_though_a_quarter_is_lost(
    personality: Personality, seed: int, tmp_path: Path
) -> None:
    """clients.md, gate 3: refused as RTL_BLOCKED in five of five, asked for right at the start."""
    flight = Flight(personality, seed=seed, up=LOSSY, down=LOSSY)
    flight.until(lambda: flight.is_in(State.GROUNDED) and flight.home_ned is not None, 20.0)
    home = HOMES[personality]
    path = tmp_path / "returns.waypoints"
    path.write_text(
        RETURNS.format(lat=home.lat_deg, lon=home.lon_deg, alt=home.alt_amsl_m), encoding="utf-8"
    )
    ask = flight.say("mission_upload", path=str(path))
    flight.until(lambda: bool(flight.verdicts(ask)), 20.0)
    (verdict,) = flight.verdicts(ask)
    assert (verdict.outcome, verdict.code) == ("accepted", ""), verdict.sentence
    assert not [t for t in flight.of(ipc.Trouble) if "return height" in t.text]


# ------------------------------------------------------------------------------
# What the vehicle says of its flight, over a link that loses a quarter both ways.

SAID = (
    "Armed by external command",
    "Takeoff detected",
    "Landing detected",
    "Disarmed by landing",
)
"""PX4's texts of a short flight, each once (A5_takeoff_hold_only of the recorded scenarios)."""


FLIES = (State.HOVERING, State.HOLDING, State.EXTERNAL)


def insist(flight: Flight, word: str, seen: Callable[[], bool], up_m: float | None = None) -> None:
    """Ask until it is so: of the tries of one request all may be lost."""
    for _ in range(5):
        flight.done(flight.say(word, up_m=up_m))
        flight.run(5.0)
        if seen():
            return
    raise AssertionError(f"{word} five times: {flight.told()}")


@pytest.mark.parametrize("seed", range(1, 9))
def test_every_text_of_px4_is_told_once_by_itself_or_by_its_event(seed: int) -> None:
    flight = Flight("px4", seed=seed, up=LOSSY, down=LOSSY).connected()
    flight.run(10.0)  # it tells the number of its latest event every 3 s
    insist(flight, "arm", lambda: flight.vehicle.armed)
    # Where the answer to the take-off, or to the mode after it, is lost for good, it is held.
    insist(flight, "takeoff", lambda: flight.state in FLIES, up_m=3.0)
    insist(flight, "land", lambda: not flight.vehicle.armed)
    lines = [event.text for event in flight.of(ipc.LogEvent) if event.node == "vehicle"]
    assert {text: lines.count(text) for text in SAID} == dict.fromkeys(SAID, 1)


# ------------------------------------------------------------------------------
# The command for another mode is lost again and again, and all else arrives.
#
# A PX4 in OFFBOARD that hears no setpoint for COM_OF_LOSS_T (1 s) begins a failsafe of its own.

LOST_FOR_S = 1.3
"""Longer than a PX4 waits for a setpoint, and shorter than the gate tries to start a mission."""
COMMANDS = {"land": 21, "rtl": 20, "mission_start": 300}
SET_MODE = 176


class WayUp(Air):
    """Commands with these numbers are lost."""

    lost: frozenset[int] = frozenset()

    def send(self, data: bytes, now_ns: int) -> None:
        frames = [item for item in split(data) if isinstance(item, Frame)]
        kept = [frame.raw for frame in frames if not self._loses(frame)]
        if kept:
            super().send(b"".join(kept), now_ns)

    def _loses(self, frame: Frame) -> bool:
        command = frame.name in ("COMMAND_LONG", "COMMAND_INT")
        return command and pymavlink_decoder.read(frame.raw).command in self.lost


@pytest.mark.parametrize("word", COMMANDS)
def test_the_vehicle_stays_where_it_is_until_it_hears_of_it(
    personality: Personality, word: str
) -> None:
    flight = Flight(personality)
    flight.up = way_up = WayUp(CLEAR, 1)
    flight.connected()
    flight.do("mission_upload", path=str(MISSIONS / "demo.toml"))
    flight.run(3.0)
    flight.hovering(5.0)
    since_ns = flight.now_ns
    way_up.lost = frozenset({COMMANDS[word], SET_MODE})
    flight.say(word)
    flight.run(LOST_FOR_S)
    assert flight.truth_enu()[2] > 4.5, flight.told()
    way_up.lost = frozenset()
    flight.run(3.0)
    assert not [line for line in flight.lines("vehicle", since_ns) if "ailsafe" in line]
    assert flight.state in (State.LANDING, State.RETURNING, State.FLYING_MISSION), flight.told()
    assert not {"HOLDING", "EXTERNAL", "STALE"} & set(flight.states(since_ns))
