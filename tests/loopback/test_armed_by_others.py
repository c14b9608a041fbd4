"""A vehicle that becomes armed although nobody asked this bridge for it: told, in the log and to
every client.  What the gate itself has armed is not."""

from __future__ import annotations

import itertools

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.gate.effects import Level
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.bridged import BridgedFlight, joined
from tests.loopback.fleet import Fleet
from tests.loopback.flight import Personality
from tests.loopback.test_arm_authorizer import GUARDED
from vehicle_sim.simulation.world import Datagram, Transmit

ARM, ACCEPTED, TEMPORARILY_REJECTED = 400, 0, 1
STRANGER = "another station"
SEQUENCES = itertools.count()
UNASKED = "it was disarmed and is armed now, and no client of this bridge asked for it"


def stranger_arms(flight: BridgedFlight, sysid: int = 1, arm: int = 1) -> None:
    """Straight to the vehicle, past the bridge."""
    mav = dialect.MAVLink(None, srcSystem=254, srcComponent=190)
    mav.seq = next(SEQUENCES) & 0xFF
    message = dialect.MAVLink_command_long_message(sysid, 1, ARM, 0, arm, 0, 0, 0, 0, 0, 0)
    data = Datagram(0, STRANGER, bytes(message.pack(mav)))
    for output in flight.world.handle(data, flight.now_ns):
        if isinstance(output, Transmit) and output.peer != STRANGER:
            flight.down.send(output.data, flight.now_ns)


def is_armed(flight: BridgedFlight) -> bool:
    return flight.vehicle.armed


def lines(flight: BridgedFlight) -> list[tuple[int, str]]:
    """What the log has of it."""
    logged = [(line.level, line.text) for line in flight.of(ipc.LogEvent)]
    return [(level, text) for level, text in logged if UNASKED in text]


def test_a_strangers_arming_is_told_once_and_again_when_it_is_another_one(
    personality: Personality,
) -> None:
    flight = BridgedFlight(personality)
    clients = [flight.join(245), flight.join(246)]
    flight.connected()
    stranger_arms(flight)
    flight.beating(3.0)
    assert is_armed(flight)
    assert lines(flight) == [(Level.WARNING, UNASKED)]
    assert [client.texts().count(f"gate: {UNASKED}") for client in clients] == [1, 1]
    stranger_arms(flight, arm=0)
    flight.beating(3.0)
    assert not is_armed(flight)
    stranger_arms(flight)
    flight.beating(3.0)
    assert len(lines(flight)) == 2


def test_an_arming_of_a_client_or_of_an_operator_is_not_told_so(personality: Personality) -> None:
    flight, client = joined(BridgedFlight(personality))
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flight.beating(3.0)
    assert client.ask(ARM, 0, within_s=10) == ACCEPTED
    flight.beating(3.0)
    flight.feed(inputs.OperatorLine(1, ipc.Ask(1, "station_take")))
    flight.feed(inputs.OperatorLine(1, ipc.Ask(2, "arm")))
    flight.beating(5.0)
    assert flight.vehicle.armed
    assert lines(flight) == []
    assert "no client of this bridge" not in client.texts()


def test_a_vehicle_that_is_met_armed_has_not_become_armed_here() -> None:
    flight = Fleet()
    client = flight.join()
    flight.silent.add(2)
    flight.run(5.0)
    stranger_arms(flight, sysid=2)
    flight.silent.clear()
    flight.run(5.0)
    assert flight.vehicles[2].armed
    assert flight.met(2).telemetry is not None
    assert lines(flight) == []
    assert "no client of this bridge" not in client.texts()


@pytest.mark.parametrize("armed", [False, True])
def test_a_vehicle_that_is_lost_and_back_is_compared_with_how_it_was(armed: bool) -> None:
    flight = Fleet()
    client = flight.join()
    flight.all_connected()
    flight.vehicles[2].parameters.set("DISARM_DELAY", 0)
    if armed:
        client.command(ARM, 1, target=(2, 1))
        flight.until(lambda: flight.vehicles[2].armed, 10)
        flight.beating(2.0)
    flight.silent.add(2)
    flight.beating(7.0)
    assert flight.state_of(2) is State.NO_VEHICLE
    stranger_arms(flight, sysid=2)
    flight.silent.clear()
    flight.beating(2.0)
    assert flight.vehicles[2].armed
    assert flight.state_of(2) is not State.NO_VEHICLE
    assert len(lines(flight)) == (0 if armed else 1)


def test_an_arming_that_the_bridge_has_authorized_for_another_one_is_told_too() -> None:
    flight, client = joined(BridgedFlight("px4", params=GUARDED))
    stranger_arms(flight)
    flight.run(1.0)
    stranger_arms(flight)  # PX4 refuses the first one while it asks
    flight.beating(4.0)
    assert flight.vehicle.armed
    assert lines(flight) == [(Level.WARNING, UNASKED)]
    assert client.texts().count(UNASKED) == 1


def test_of_several_vehicles_it_is_told_which_one() -> None:
    flight = Fleet()
    client = flight.join()
    flight.all_connected()
    stranger_arms(flight, sysid=2)
    flight.beating(3.0)
    assert [text for _, text in lines(flight)] == [f"vehicle 2: {UNASKED}"]
    told = {
        text.get_srcSystem() for text in client.messages("STATUSTEXT") if "disarmed" in text.text
    }
    assert told == {2}
