"""A recorded flight of each real autopilot beside the same script on ours."""

from __future__ import annotations

from typing import get_args

import msgspec
import pytest

from tests.scenarios.flights.agree import compare
from tests.scenarios.flights.facts import Ack, Flight, Kind, Point, State, Word, recorded
from tests.scenarios.flights.known import KNOWN
from tests.scenarios.flights.play import played
from tests.scenarios.flights.script import commands
from vehicle_sim.autopilot.modes import Personality

either = pytest.mark.parametrize("personality", get_args(Personality))


@pytest.mark.slow
@either
def test_no_new_difference_and_none_that_is_gone(personality: Personality) -> None:
    found = compare(personality, recorded(personality), played(personality))
    assert sorted(found.differences) == sorted(KNOWN[personality])


@either
def test_the_script_has_the_commands_that_were_acked(personality: Personality) -> None:
    sent = [command.number for command in commands(personality) if command.acked]
    assert sent == [ack.command for ack in recorded(personality).acks]


def test_arducopter_told_its_landed_state_at_the_first_request() -> None:
    """arducopter_4_7_flight.tlog: asked for first after 42.4 s, beside REQUEST_MESSAGE's ack."""
    real = recorded("ardupilot")
    requests = [ack for ack in real.acks if ack.command == 512]
    asked = [command.params[0] for command in commands("ardupilot") if command.number == 512]
    ack = requests[asked.index(245)]
    first_s = next(kind.first_s for kind in real.kinds if kind.name == "EXTENDED_SYS_STATE")
    assert ack.result == "ACCEPTED"
    assert first_s == pytest.approx(ack.t, abs=0.02)
    assert first_s == pytest.approx(42.4, abs=0.02)


@either
def test_a_flight_does_not_differ_from_itself(personality: Personality) -> None:
    real = recorded(personality)
    assert compare(personality, real, real).differences == []


def altered(flight: Flight) -> list[tuple[Flight, str]]:
    """One alteration each, and the difference that it makes."""
    change = msgspec.structs.replace
    refused = [Ack(flight.acks[0].t, 400, "DENIED"), *flight.acks[1:]]
    dangerous = [State(s.t, s.mode, s.base_mode, 5) for s in flight.states]
    fast = [Point(p.t, p.north, p.east, p.up, p.v_north, p.v_east, 9.0) for p in flight.track]
    rates = {name: {**each, "HEARTBEAT": 4.0} for name, each in flight.rates_hz.items()}
    late = [Kind(k.name, k.first_s + 9 * (k.name == "WIND"), k.count) for k in flight.kinds]
    return [
        (change(flight, acks=refused), "ack of 400: FAILED, ours DENIED"),
        (change(flight, states=dangerous), "system_status 4: ours 5"),
        (change(flight, landed=[*flight.landed[:1]]), "landed TAKEOFF: ours ON_GROUND"),
        (change(flight, texts=flight.texts[1:]), "text 'Arm: Gyros inconsistent': ours never"),
        (change(flight, texts=[*flight.texts, Word(9.0, "x")]), "text 'x': ours only"),
        (change(flight, kinds=flight.kinds[1:]), "kind HEARTBEAT: the real one only"),
        (change(flight, kinds=late), "first WIND: ours later"),
        (change(flight, rates_hz=rates), "rate climb, HEARTBEAT: ours more"),
        (change(flight, track=fast), "figure: take-off, fastest climb"),
    ]


@pytest.mark.parametrize(("flight", "difference"), altered(recorded("ardupilot")))
def test_the_comparison_sees_every_kind_of_difference(flight: Flight, difference: str) -> None:
    assert difference in compare("ardupilot", recorded("ardupilot"), flight).differences
