"""What stops the vehicle stops a mission start that is still being prepared."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.flight import MISSIONS, Flight, Personality
from tests.loopback.lossy_link import Weather

SLOW = Weather(delay_s=(0.1, 0.1))
MISSION_START = 300


def preparing(personality: Personality, word: str) -> tuple[Flight, int]:
    """A mission is on board, and its start is being read back, each message for 0.1 s."""
    flight = Flight(personality, up=SLOW, down=SLOW).connected()
    flight.do("mission_upload", path=str(MISSIONS / "square.toml"))
    flight.do("arm")
    if word != "abort_on_ground":
        flight.do("takeoff", up_m=3.0)
    ask = flight.say("mission_start")
    flight.run(0.45)
    assert flight.verdicts(ask) == []
    return flight, ask


def never_starts(flight: Flight, since_ns: int) -> None:
    flight.run(15.0)
    assert "FLYING_MISSION" not in flight.states(since_ns)
    assert flight.sent_commands(MISSION_START, since_ns) == []


@pytest.mark.parametrize("word", ["abort", "hold", "land", "rtl", "abort_on_ground"])
def test_no_mission_begins_after_a_stop(personality: Personality, word: str) -> None:
    flight, ask = preparing(personality, word)
    since_ns = flight.now_ns
    flight.say(word.removesuffix("_on_ground"))
    flight.run(0.2)
    (verdict,) = flight.verdicts(ask)
    assert (verdict.outcome, verdict.code) == ("refused", "OPERATOR")
    assert verdict.sentence == "an operator stopped the vehicle before it began"
    never_starts(flight, since_ns)


def test_no_mission_begins_after_its_operator_has_left() -> None:
    flight = Flight("px4", up=SLOW, down=SLOW).hovering(3.0)
    flight.do("mission_upload", path=str(MISSIONS / "square.toml"))
    since_ns = flight.now_ns
    flight.feed(inputs.OperatorJoined(2, "second"))
    flight.feed(inputs.OperatorLine(2, ipc.Ask(900, "station_take")))
    flight.feed(inputs.OperatorLine(2, ipc.Ask(901, "mission_start")))
    flight.run(0.45)
    flight.feed(inputs.OperatorGone(2, "its connection was closed"))
    never_starts(flight, since_ns)
    assert flight.is_in(State.HOLDING)


def test_what_does_not_stop_the_vehicle_leaves_the_start_alone() -> None:
    flight, ask = preparing("px4", "photo")
    flight.say("photo")
    flight.until(lambda: flight.verdicts(ask) != [])
    assert flight.verdicts(ask)[0].code != "OPERATOR"
