"""Bad links: the model by itself, and a world behind it."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tests.unit.vehicle_services.fake_vehicle import MS, FakeVehicle, S, long
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.impairment import CLEAR, REORDER_HOLD_NS, Direction, Impairment, Path
from vehicle_sim.simulation.world import (
    Datagram,
    Input,
    Joined,
    Left,
    LinkSpec,
    Transmit,
    Wake,
    World,
)
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode
from vehicle_sim.wire.split import Counters, split

UP, DOWN = Direction.TO_VEHICLE, Direction.FROM_VEHICLE


def path(
    given: Impairment,
    seed: int = 1,
    link: int = 0,
    direction: Direction = UP,
    stream: bool = False,
) -> Path:
    made = Path(seed, link, direction, stream)
    made.impairment = given
    return made


def arrivals(given: Path, count: int, apart_ns: int = MS) -> list[tuple[int, ...]]:
    return [given.handle("peer", number * apart_ns) for number in range(count)]


def test_a_clear_path_delivers_at_once() -> None:
    assert arrivals(path(CLEAR), 3) == [(0,), (MS,), (2 * MS,)]


@pytest.mark.parametrize("rate", [0.0, 0.02, 0.3, 1.0])
def test_rates_are_what_they_say(rate: float) -> None:
    """20,000 draws: 5 standard deviations of a binomial are at most 0.0177."""
    lost = arrivals(path(Impairment(loss=rate)), 20_000).count(())
    twice = sum(len(each) == 2 for each in arrivals(path(Impairment(duplicate=rate)), 20_000))
    held = sum(
        at == (number * MS + REORDER_HOLD_NS,)
        for number, at in enumerate(arrivals(path(Impairment(reorder=rate)), 20_000))
    )
    for count in (lost, twice, held):
        assert count / 20_000 == pytest.approx(rate, abs=0.0 if rate in (0.0, 1.0) else 0.0177)


def test_accidents_are_independent_of_each_other() -> None:
    both = arrivals(path(Impairment(loss=0.5, duplicate=0.5)), 20_000)
    twice = sum(len(each) == 2 for each in both)
    assert twice / 20_000 == pytest.approx(0.25, abs=0.016)


def test_a_delay_lies_between_its_bounds_and_fills_them() -> None:
    given = path(Impairment(delay_ns=100 * MS, jitter_ns=40 * MS))
    delays = [at[0] - number * MS for number, at in enumerate(arrivals(given, 5_000))]
    assert min(delays) >= 100 * MS
    assert max(delays) < 140 * MS
    assert min(delays) < 101 * MS
    assert max(delays) > 139 * MS
    assert sum(delays) / 5_000 == pytest.approx(120 * MS, rel=0.01)


def test_an_outage_ends_at_its_time() -> None:
    given = path(Impairment(outage_until_ns=5 * MS))
    assert arrivals(given, 7) == [(), (), (), (), (), (5 * MS,), (6 * MS,)]


def test_noise_depends_on_seed_link_direction_and_number_alone() -> None:
    bad = Impairment(loss=0.3, duplicate=0.2, jitter_ns=50 * MS)
    reference = arrivals(path(bad), 200)
    assert arrivals(path(bad), 200) == reference
    for other in (path(bad, seed=2), path(bad, link=1), path(bad, direction=DOWN)):
        assert arrivals(other, 200) != reference
    late = path(CLEAR)
    assert arrivals(late, 100) == [(number * MS,) for number in range(100)]
    late.impairment = bad
    assert [late.handle("peer", number * MS) for number in range(100, 200)] == reference[100:]


def test_a_stream_loses_and_overtakes_nothing_and_is_held_up_by_an_outage() -> None:
    given = path(Impairment(0.5, 0.5, 0.5, 10 * MS, 30 * MS, outage_until_ns=20 * MS), stream=True)
    times = [at for each in arrivals(given, 300) for at in each]
    assert len(times) == 300
    assert times == sorted(times)
    assert times[0] >= 30 * MS
    assert max(at - number * MS for number, at in enumerate(times)) <= 60 * MS


@pytest.mark.parametrize("wrong", [{"loss": 1.1}, {"reorder": -0.1}, {"duplicate": float("nan")}])
def test_a_rate_is_a_probability(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="probability"):
        Impairment(**wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="negative"):
        Impairment(delay_ns=-1)


def test_only_links_that_are_there_can_be_bad() -> None:
    with pytest.raises(ValueError, match="no link 1, only 1"):
        Field().world.impair(1, None, CLEAR)


class Field:
    """One vehicle behind bad links."""

    def __init__(self, *links: LinkSpec, seed: int = 1) -> None:
        self.vehicle = FakeVehicle()
        server = VehicleServer(self.vehicle, PROFILES["px4"], Parameters("px4"), 1)
        self.world = World([server], links or [LinkSpec()], seed=seed)
        self.said: list[tuple[int, bytes]] = []

    def give(self, given: Input, at_ns: int) -> bytes:
        heard = [
            each.data for each in self.world.handle(given, at_ns) if isinstance(each, Transmit)
        ]
        self.said += [(at_ns, data) for data in heard]
        return b"".join(heard)

    def run(self, until_ns: int) -> None:
        while self.world.deadline_ns <= until_ns:
            self.give(Wake(), self.world.deadline_ns)

    @property
    def landings(self) -> int:
        return len(self.vehicle.named("land"))


def land(sequence: int = 0) -> Datagram:
    return Datagram(0, "ground", encode(long(21), sequence, 255, 190))


def acks(data: bytes) -> int:
    frames = split(data, Counters())
    return sum(isinstance(frame.message(), m.CommandAck) for frame in frames)


def test_a_command_arrives_late_and_so_does_its_ack() -> None:
    field = Field()
    field.world.impair(None, None, Impairment(delay_ns=250 * MS))
    field.give(land(), 10 * MS)
    assert field.landings == 0
    assert field.world.deadline_ns <= 260 * MS
    field.give(Wake(), 260 * MS - 1)
    assert field.landings == 0
    field.give(Wake(), 260 * MS)
    assert field.landings == 1
    field.run(509 * MS)
    assert not any(acks(data) for _, data in field.said)
    field.run(600 * MS)
    assert [at_ns for at_ns, data in field.said if acks(data)] == [510 * MS]


def test_a_late_command_finds_the_vehicle_at_its_time_however_late_the_call_is() -> None:
    field = Field()
    field.world.impair(0, UP, Impairment(delay_ns=100 * MS))
    field.give(Datagram(0, "ground", encode(m.Heartbeat(0, 6, 8, 0, 4, 3), 0, 255, 190)), 0)
    field.give(Wake(), 3 * S)
    assert field.vehicle.named("gcs_heard") == [(100 * MS,)]


def test_only_the_direction_and_link_that_was_named_are_bad() -> None:
    field = Field(LinkSpec(), LinkSpec())
    field.world.impair(0, UP, Impairment(loss=1.0))
    field.give(land(), 0)
    assert field.landings == 0
    elsewhere = Datagram(1, "ground", encode(long(21), 0, 255, 190))
    assert acks(field.give(elsewhere, 0)) == 1
    field.world.impair(0, UP, CLEAR)
    field.world.impair(None, DOWN, Impairment(loss=1.0))
    assert field.give(land(1), 1 * MS) == b""
    assert field.landings == 2


def test_a_duplicate_of_a_command_has_no_second_effect() -> None:
    field = Field()
    field.world.impair(None, UP, Impairment(duplicate=1.0))
    assert acks(field.give(land(), 0)) == 2
    assert field.landings == 1


def test_the_bytes_do_not_depend_on_how_often_one_looks() -> None:
    said = []
    for nap_ns in (1 * MS, 20 * MS, 333 * MS, 9 * S):
        field = Field()
        bad = Impairment(0.2, 0.2, 0.2, 30 * MS, 70 * MS)
        field.world.impair(None, None, bad)
        given: list[tuple[int, Input]] = [
            (at_ns, land(at_ns // (100 * MS) & 0xFF)) for at_ns in range(0, 5 * S, 100 * MS)
        ]
        given += [(at_ns, Wake()) for at_ns in range(nap_ns, 5 * S, nap_ns)]
        for at_ns, each in sorted(given, key=lambda pair: pair[0]):
            field.give(each, at_ns)
        field.give(Wake(), 6 * S)
        said.append(b"".join(data for _, data in field.said))
    assert len(said[0]) > 10_000
    assert said[1:] == said[:1] * 3
    assert said[0] != b"".join(data for _, data in _other_seed())


def _other_seed() -> list[tuple[int, bytes]]:
    field = Field(seed=2)
    field.world.impair(None, None, Impairment(0.2, 0.2, 0.2, 30 * MS, 70 * MS))
    for at_ns in range(0, 5 * S, 100 * MS):
        field.give(land(at_ns // (100 * MS) & 0xFF), at_ns)
    field.give(Wake(), 6 * S)
    return field.said


def test_a_connection_that_ends_takes_with_it_what_was_under_way() -> None:
    field = Field(LinkSpec(stream=True))
    field.give(Joined(0, "tcp"), 0)
    field.world.impair(0, None, Impairment(delay_ns=100 * MS))
    field.give(Datagram(0, "tcp", encode(long(21), 0, 255, 190)), 1 * MS)
    field.give(Left(0, "tcp"), 2 * MS)
    field.give(Wake(), 1 * S)
    assert field.landings == 0
    assert field.world.links == ()


def test_a_stream_brings_after_an_outage_all_that_was_said_in_it() -> None:
    field = Field(LinkSpec(stream=True))
    field.give(Joined(0, "tcp"), 0)
    field.world.impair(0, DOWN, Impairment(loss=1.0, outage_until_ns=2 * S))
    field.said.clear()
    field.run(2 * S - 1)
    assert field.said == []
    field.run(3 * S)
    frames = [frame for _, data in field.said for frame in split(data, Counters())]
    assert len(frames) > 100
    steps = {(b.sequence - a.sequence) & 0xFF for a, b in pairwise(frames)}
    assert steps == {1}
