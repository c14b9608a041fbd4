"""A stop is never lost: not for want of a heartbeat, of an answer, of a link, or of an operator."""

from __future__ import annotations

import math

import pytest

from gcs import ipc
from gcs.gate.states import State
from gcs.report import LogEvent
from gcs.session import inputs
from gcs.session.requests import FIRST
from gcs.wire.frame import Frame, split
from tests.loopback.flight import Flight, Personality, lab_policy
from tests.loopback.lossy_link import Weather

DO_SET_MODE, LAND = 176, 21
HOLD_MODE = {"px4": "AUTO.LOITER", "ardupilot": "BRAKE"}
RETURN_MODE = {"px4": "AUTO.RTL", "ardupilot": "RTL"}
LEAVE = inputs.OperatorLine(FIRST, ipc.Leave("quit"))


class WithoutHeartbeats(Flight):
    """Its heartbeats are lost on the way, from `deaf` on."""

    deaf = False

    def feed(self, given: inputs.Input) -> None:
        if self.deaf and isinstance(given, inputs.Datagram):
            frames = (item for item in split(given.data) if isinstance(item, Frame))
            rest = b"".join(frame.raw for frame in frames if frame.name != "HEARTBEAT")
            given = inputs.Datagram(given.link, rest)
        super().feed(given)


def test_a_vehicle_whose_heartbeats_alone_are_lost_is_not_lost(personality: Personality) -> None:
    """autopilots.md 7."""
    flight = WithoutHeartbeats(personality)
    flight.hovering(3.0)
    ask = flight.goto(20.0, 0.0, 3.0)
    flight.run(0.5)
    flight.deaf = True
    assert flight.done(ask) == "complete"
    flight.run(6.0)
    assert flight.is_in(State.HOVERING)


@pytest.mark.parametrize("word", ["hold", "abort"])
def test_at_cruise_it_is_complete_when_the_hold_is_seen(
    personality: Personality, word: str
) -> None:
    """newcomer.md 14: complete is said by a heartbeat that came later, and shows the mode."""
    flight = Flight(personality).hovering(3.0)
    flight.goto(60.0, 0.0, 3.0)
    flight.run(6.0)
    asked_ns = flight.now_ns
    ask = flight.say(word)
    assert flight.sent_commands(DO_SET_MODE, asked_ns)[0].time_ns == asked_ns
    flight.down.weather = Weather(loss=1.0)
    flight.run(0.9)
    assert flight.outcome(ask) is None
    assert flight.vehicle.mode_name == HOLD_MODE[personality]
    flight.down.weather = Weather()
    assert flight.done(ask) == "complete"
    assert flight.session.telemetry is not None
    assert flight.session.telemetry.mode_name == HOLD_MODE[personality]


def test_a_hold_that_is_not_seen_is_asked_for_again_and_complete_when_it_is(
    personality: Personality,
) -> None:
    """The link to the vehicle is out for three seconds."""
    flight = Flight(personality).hovering(3.0)
    flight.goto(60.0, 0.0, 3.0)
    flight.run(4.0)
    flight.up.weather = Weather(loss=1.0)
    asked_ns = flight.now_ns
    ask = flight.say("hold")
    flight.run(0.4)
    assert flight.outcome(ask) is None
    flight.run(2.6)
    flight.up.weather = Weather()
    assert flight.done(ask) == "complete"
    assert flight.is_in(State.HOLDING)
    assert len(flight.sent_commands(DO_SET_MODE, asked_ns)) > 2


@pytest.mark.parametrize(("word", "command"), [("hold", DO_SET_MODE), ("land", LAND)])
def test_a_stop_goes_out_to_a_vehicle_that_is_not_heard_any_more(word: str, command: int) -> None:
    """The link from the vehicle is out, and the one to it is not."""
    flight = Flight("ardupilot").hovering(3.0)
    flight.down.weather = Weather(loss=1.0)
    flight.run(5.0)
    assert flight.is_in(State.NO_VEHICLE)
    asked_ns = flight.now_ns
    ask = flight.say(word)
    assert flight.sent_commands(command, asked_ns)[0].time_ns == asked_ns
    flight.run(0.5)
    assert flight.vehicle.mode_name == {"hold": "BRAKE", "land": "LAND"}[word]
    flight.down.weather = Weather()
    assert flight.done(ask) == "complete"


def test_who_quits_holds_a_vehicle_that_is_not_heard_any_more() -> None:
    flight = Flight("ardupilot").hovering(3.0)
    flight.down.weather = Weather(loss=1.0)
    flight.run(5.0)
    flight.feed(LEAVE)
    flight.run(4.0)
    assert flight.finish is not None
    assert flight.vehicle.mode_name == "BRAKE"


@pytest.mark.parametrize("delay_s", [0.0, 2.0])
def test_who_leaves_does_not_cancel_a_return(personality: Personality, delay_s: float) -> None:
    """newcomer.md 8: `gcs rtl --wait 2`."""
    flight = Flight(personality).hovering(3.0)
    assert flight.done(flight.goto(20.0, 0.0, 3.0)) == "complete"
    flight.say("rtl")
    flight.run(delay_s)
    flight.feed(LEAVE)
    flight.run(3.0)
    assert flight.finish is not None
    assert RETURN_MODE[personality] in flight.finish.sentence
    assert flight.vehicle.mode_name == RETURN_MODE[personality]


def test_a_goto_during_a_return_that_is_not_ours_says_what_to_do(personality: Personality) -> None:
    """autopilots.md 12."""
    flight = Flight(personality).hovering(3.0)
    assert flight.done(flight.goto(20.0, 0.0, 3.0)) == "complete"
    flight.vehicle.set_mode_kind("return")
    flight.until(lambda: flight.state is State.RETURNING)
    (verdict,) = flight.verdicts(flight.goto(0.0, 0.0, 3.0))
    assert verdict.code == "NOT_IN_CONTROL"
    assert "`hold` stops it, then `resume` takes control" in verdict.sentence
    flight.do("hold")
    flight.do("resume")
    assert flight.done(flight.goto(0.0, 0.0, 3.0)) == "complete"


def test_a_failsafe_of_the_vehicle_ends_a_request_as_such() -> None:
    """autopilots.md 12: PX4 leaves OFFBOARD a second after the last setpoint, with status 5."""
    flight = Flight("px4").hovering(3.0)
    ask = flight.goto(60.0, 0.0, 3.0)
    flight.run(3.0)
    flight.up.weather = Weather(loss=1.0)
    flight.until(lambda: flight.outcome(ask) is not None)
    (ending,) = flight.endings(ask)
    assert (ending.ended, ending.code) == ("taken over", "VEHICLE_FAILSAFE")
    assert "a failsafe of the vehicle's own took over" in ending.sentence


@pytest.mark.parametrize(
    ("name", "instead"), [("LOITER", "BRAKE"), ("SMART_RTL", "RTL"), ("AUTO_RTL", "RTL")]
)
def test_a_mode_by_its_name_is_never_another_of_its_kind(name: str, instead: str) -> None:
    """autopilots.md 5: LOITER was complete, and the vehicle in BRAKE."""
    flight = Flight("ardupilot").hovering(3.0)
    (verdict,) = flight.verdicts(flight.say("mode", mode=name))
    assert verdict.code == "UNSUPPORTED"
    assert instead in verdict.sentence
    assert flight.vehicle.mode_name == "GUIDED"
    assert flight.done(flight.say("mode", mode=instead), 90.0) == "complete"


def test_outside_a_fence_that_is_on_again_it_is_said_what_is_possible() -> None:
    """newcomer.md 15: goto said "resume first", and resume OUTSIDE_FENCE."""
    flight = Flight("px4", policy=lab_policy()).hovering(1.0)
    assert flight.done(flight.say("fence", on=False)) == "complete"
    assert flight.done(flight.goto(8.0, 0.0, 1.0)) == "complete"
    since_ns = flight.now_ns
    assert flight.done(flight.say("fence", on=True)) == "complete"
    flight.run(2.0)
    assert flight.is_in(State.HOLDING)
    assert any("outside" in line for line in flight.lines("state_and_safety", since_ns))
    (verdict,) = flight.verdicts(flight.goto(0.0, 0.0, 1.0))
    assert verdict.code == "OUTSIDE_FENCE"
    assert "possible: resume (it flies back to (" in verdict.sentence
    assert verdict.sentence.endswith("), land, fence off")
    assert flight.done(flight.say("fence", on=False)) == "complete"
    flight.do("resume")
    assert flight.done(flight.goto(0.0, 0.0, 1.0)) == "complete"
    flight.run(3.0)
    assert math.dist(flight.truth_enu(), (0.0, 0.0, 1.0)) < 0.5


@pytest.mark.parametrize("lost_first", [False, True])
def test_a_hold_of_a_vehicle_that_is_lost_is_told_to_be_unanswered_once(lost_first: bool) -> None:
    """It is commanded on, once a second for as long as the vehicle is away."""
    flight = Flight("px4").hovering(5.0)
    since_ns = flight.now_ns
    flight.vehicle_silent = True
    flight.run(8.0 if lost_first else 0.1)
    flight.say("hold")
    flight.run(60.0)
    flight.say("hold")
    flight.run(20.0)
    told = [line.text for line in flight.recorded(LogEvent, since_ns) if "No answer" in line.text]
    assert told == ["No answer to the request for hold mode"]
