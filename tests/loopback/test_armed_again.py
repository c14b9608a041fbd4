"""A command that is sent again soon after its answer: decided anew after a change."""

from __future__ import annotations

from pymavlink.dialects.v20 import all as dialect

from gcs.bridge.conversation.dialogue import AGAIN_NS
from tests.loopback.bridged import VEHICLE, BridgedFlight, joined
from tests.loopback.flight import Personality
from tests.loopback.stranger import stranger

ARM, ACCEPTED = 400, 0
DISARM = dialect.MAVLink_command_long_message(*VEHICLE, ARM, 0, *[0.0] * 7)


def test_an_arming_after_somebody_has_disarmed_it_is_decided_anew(
    personality: Personality,
) -> None:
    """Within the time in which the same command may be a repetition."""
    flight, client = joined(BridgedFlight(personality))
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    answered_ns = flight.now_ns
    stranger(flight, DISARM)
    flight.until(lambda: not shown_armed(flight), 1.5)
    assert flight.now_ns - answered_ns < AGAIN_NS
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    assert flight.vehicle.armed
    assert [one.word for one in flight.decisions("accepted")].count("arm") == 2


def test_an_arming_whose_answer_was_lost_is_not_decided_twice(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    for _ in range(3):
        flight.run(0.5)
        assert client.ask(ARM, 1, within_s=0.1) == ACCEPTED
    assert [one.word for one in flight.decisions("accepted")].count("arm") == 1


def shown_armed(flight: BridgedFlight) -> bool:
    """By the last heartbeat that the station has heard."""
    telemetry = flight.session.telemetry
    return telemetry is not None and bool(telemetry.armed)
