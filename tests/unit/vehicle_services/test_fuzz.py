"""Everything that can come over the wire, right checksums included, and a vehicle that bears it.

`FUZZ` datagrams by default; `make soak` sends a million, and watches the memory.
"""

from __future__ import annotations

import math
import random
import struct
import sys

import pytest

from tests.soaking import SOAKING
from tests.unit.vehicle_services.fake_vehicle import MS, S, long
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import (
    DATAGRAM_BYTES,
    Datagram,
    Input,
    LinkSpec,
    Transmit,
    Wake,
    World,
)
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import BY_TYPE, encode
from vehicle_sim.wire.dialect import LAYOUTS
from vehicle_sim.wire.ids import Cmd
from vehicle_sim.wire.messages import IDS, TYPES, Message
from vehicle_sim.wire.split import Counters, split
from vehicle_sim.wire.supplement import MessageField

pytestmark = pytest.mark.slow

FUZZ = 20_000
SOAK = 1_000_000
GROWTH_MAX_BYTES = 8_000_000
SEEDS: dict[Personality, int] = {"px4": 20, "ardupilot": 21}
HOME = Geodetic(47.397742, 8.545594, 488.0)
KINDS = [kind for kind in TYPES.values() if kind is not m.SetupSigning]
"""A key would rightly end the conversation."""
GROUND = m.Heartbeat(0, 6, 8, 0, 4, 3)

FLOATS = (math.nan, math.inf, -math.inf, 3.4e38, -3.4e38, 1e-45, -0.0, 0.0, 1.0, -1.0, 1e10, 180.0)
INTEGERS = {
    "uint8_t": "B",
    "int8_t": "b",
    "uint16_t": "H",
    "int16_t": "h",
    "uint32_t": "I",
    "int32_t": "i",
    "uint64_t": "Q",
    "int64_t": "q",
}
NAMES = sorted(
    {spec.name.encode() for personality in SEEDS for spec in Parameters(personality).specs}
)
TARGETS = ("target_system", "target_component")
MOVING = (
    m.CommandLong,
    m.CommandInt,
    m.SetMode,
    m.SetPositionTargetLocalNed,
    m.SetPositionTargetGlobalInt,
    m.SetAttitudeTarget,
    m.MissionItem,
    m.MissionItemInt,
    m.MissionCount,
    m.MissionClearAll,
    m.MissionSetCurrent,
    m.ParamSet,
    m.ManualControl,
    m.RcChannelsOverride,
)
"""What may rightly move a vehicle, or change how it flies."""


def number(field: MessageField, draw: random.Random) -> float:
    """A value of that type: an extreme, a small one, or any."""
    if field.kind in ("float", "double"):
        return draw.choice((*FLOATS, draw.uniform(-1000.0, 1000.0)))
    letter = INTEGERS[field.kind]
    bits = 8 * struct.calcsize("<" + letter)
    low = 0 if letter.isupper() else -(1 << bits - 1)
    high = low + (1 << bits) - 1
    small = draw.randrange(max(low, -2), 9)
    return draw.choice((low, high, small, small, small, draw.randint(low, high)))


def value(field: MessageField, draw: random.Random) -> float | bytes | tuple[float, ...]:
    if field.name in TARGETS:
        return draw.choice((1, 1, 1, 0, 2, 255))
    if field.name == "command":
        return draw.choice((draw.choice(list(Cmd)), draw.randrange(1 << 16)))
    if field.name == "param_id" and draw.random() < 0.7:
        return draw.choice(NAMES)
    if field.kind == "char" or (field.length and field.kind == "uint8_t"):
        return draw.randbytes(draw.randrange(max(field.length, 1) + 1))
    if field.length:
        one = MessageField(field.name, field.kind, 0)
        return tuple(number(one, draw) for _ in range(field.length))
    return number(field, draw)


def any_message(kind: type[Message], draw: random.Random) -> Message:
    return kind._make(value(field, draw) for field in LAYOUTS[IDS[kind]].fields)


def any_frame(kinds: list[type[Message]], draw: random.Random) -> bytes:
    """A right checksum and whatever inside, in either MAVLink."""
    kind = draw.choice(kinds)
    message = any_message(kind, draw)
    codec = BY_TYPE[kind]
    payload = codec.payload(message)
    if draw.random() < 0.1:
        payload = payload[: draw.randrange(1, len(payload) + 1)]
    client = (draw.randrange(256), draw.choice((253, 254, 255, 1, 0)), draw.choice((190, 1, 0)))
    if draw.random() < 0.2 and codec.number <= 255:
        return codec.frame1(payload, *client)
    return codec.frame(payload, *client)


def mutated(data: bytes, draw: random.Random) -> bytes:
    changed = bytearray(data)
    for _ in range(draw.randrange(4)):
        match draw.randrange(3):
            case 0 if changed:
                changed[draw.randrange(len(changed))] = draw.randrange(256)
            case 1:
                changed[draw.randrange(len(changed) + 1) :] = b""
            case _:
                at = draw.randrange(len(changed) + 1)
                changed[at:at] = draw.randbytes(draw.randrange(8))
    return bytes(changed)


def any_datagram(kinds: list[type[Message]], draw: random.Random) -> bytes:
    if draw.random() < 0.05:
        return draw.randbytes(draw.randrange(400))
    data = b"".join(any_frame(kinds, draw) for _ in range(draw.randrange(1, 3)))
    return mutated(data, draw) if draw.random() < 0.2 else data


class Bench:
    """A real vehicle, a clock, and what it says, checked."""

    def __init__(self, personality: Personality) -> None:
        self.vehicle = Autopilot(personality, HOME, 1)
        server = VehicleServer(self.vehicle, PROFILES[personality], self.vehicle.parameters, 1)
        self.world = World([server], [LinkSpec()])
        self.now_ns = 0
        self.sequence = 0

    def give(self, given: Input) -> list[tuple[object, bytes]]:
        said = []
        for output in self.world.handle(given, self.now_ns):
            if isinstance(output, Transmit):
                assert len(output.data) <= DATAGRAM_BYTES
                said.append((output.peer, output.data))
            else:
                assert "cannot be sent" not in output.text, output.text
        return said

    def send(self, message: Message) -> list[Message]:
        """What comes back to the ground station at once."""
        self.sequence += 1
        data = encode(message, self.sequence & 0xFF, 250, 190)
        return read(self.give(Datagram(0, "ground", data)))

    def run(self, seconds: float) -> list[Message]:
        end_ns = self.now_ns + round(seconds * S)
        heard: list[tuple[object, bytes]] = []
        while self.now_ns < end_ns:
            self.now_ns = min(end_ns, self.now_ns + 20 * MS)
            heard += self.give(Wake())
        return read(heard)

    def fuzz(self, count: int, kinds: list[type[Message]], draw: random.Random) -> None:
        """From 40 peers, a datagram a millisecond; the ground station is heard now and then."""
        at_half = 0
        for turn in range(count):
            if turn % 10_000 == 0:
                self.send(GROUND)
            self.now_ns += draw.randrange(2 * MS)
            data = any_datagram(kinds, draw)
            for _, said in self.give(Datagram(0, turn % 40, data)):
                counters = Counters()
                split(said, counters)
                assert counters == Counters(frames=counters.frames)
            if turn == count // 2:
                at_half = peak_bytes()
        if SOAKING:
            assert peak_bytes() - at_half < GROWTH_MAX_BYTES

    def assert_answers(self) -> None:
        """It streams, and answers three services at once."""
        self.send(GROUND)
        heard = self.run(2.0)
        assert {m.Heartbeat} <= {type(each) for each in heard}
        for each in heard:
            if isinstance(each, m.LocalPositionNed):
                assert all(math.isfinite(axis) for axis in each)
        (answer,) = (a for a in self.send(m.Timesync(0, 77)) if isinstance(a, m.Timesync))
        assert answer.ts1 == 77
        assert m.CommandAck in {type(a) for a in self.send(long(512, 148))}
        count = [a for a in self.send(m.MissionRequestList(1, 1)) if isinstance(a, m.MissionCount)]
        assert len(count) == 1


def read(said: list[tuple[object, bytes]]) -> list[Message]:
    """What the ground station hears of it."""
    frames = [frame for peer, data in said if peer == "ground" for frame in split(data, Counters())]
    return [known for frame in frames if (known := frame.message()) is not None]


def peak_bytes() -> int:
    """The most memory that this process has had; 0 where the system does not say."""
    try:
        import resource
    except ImportError:
        return 0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak


@pytest.mark.parametrize("personality", SEEDS)
def test_no_message_whatever_brings_the_vehicle_down(personality: Personality) -> None:
    """Half of the datagrams for each personality; commands that are meant for it are obeyed."""
    bench = Bench(personality)
    draw = random.Random(SEEDS[personality])
    bench.fuzz((SOAK if SOAKING else FUZZ) // 2, KINDS, draw)
    # It may just have been rebooted.
    bench.run(5.0)
    bench.assert_answers()


@pytest.mark.parametrize("personality", SEEDS)
def test_noise_that_commands_nothing_leaves_it_flying(personality: Personality) -> None:
    bench = Bench(personality)
    bench.send(GROUND)
    bench.run(3.0)
    if personality == "ardupilot":
        bench.send(long(176, 1, 4))
    bench.send(long(400, 1))
    nan = math.nan
    height = 20.0 if personality == "ardupilot" else nan
    bench.send(long(22, 0, 0, 0, nan, nan, nan, height))
    bench.run(15.0)
    before = bench.vehicle.estimate.pos_ned
    mode = bench.vehicle.custom_mode
    assert bench.vehicle.armed
    assert before[2] < -1.5
    draw = random.Random(SEEDS[personality])
    kinds = [kind for kind in KINDS if kind not in MOVING]
    bench.fuzz(FUZZ // 10, kinds, draw)
    after = bench.vehicle.estimate.pos_ned
    assert bench.vehicle.armed
    assert bench.vehicle.custom_mode == mode
    assert math.dist(before, after) < 2.0
    bench.assert_answers()
