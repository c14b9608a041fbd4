"""A PX4 climbs to MIS_TAKEOFF_ALT at the least, and a client may write it, as MAVSDK does."""

from __future__ import annotations

from pymavlink.dialects.v20 import all as dialect

from tests.loopback.bridged import VEHICLE, BridgedFlight, joined

NAME = b"MIS_TAKEOFF_ALT"
REAL32 = 9


def test_nobody_climbs_before_the_vehicle_has_told_the_height_that_a_client_wrote() -> None:
    flight, client = joined(BridgedFlight("px4"))
    for height_m, word, mode in (
        (10.0, "takeoff", ""),
        (11.0, "mission_start", ""),
        (12.0, "mode", "AUTO.TAKEOFF"),
    ):
        flight.run(1.0)
        reads = len(flight.to_vehicle("PARAM_REQUEST_READ"))
        client.send(dialect.MAVLink_param_set_message(*VEHICLE, NAME, height_m, REAL32))
        (verdict,) = flight.verdicts(flight.say(word, mode=mode))
        assert (verdict.outcome, verdict.code) == ("refused", "BUSY"), word
        assert "MIS_TAKEOFF_ALT was written" in verdict.sentence
        assert len(flight.to_vehicle("PARAM_REQUEST_READ")) == reads + 1
        flight.run(1.0)
        assert flight.vehicle.parameters.get(NAME.decode()) == height_m
    again = flight.say("takeoff")
    flight.run(0.1)
    assert [verdict.code for verdict in flight.verdicts(again)] == ["NOT_ARMED"]
