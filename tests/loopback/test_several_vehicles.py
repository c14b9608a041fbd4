"""Two vehicles on one link: named, and only the one that was chosen is spoken to."""

from __future__ import annotations

from fractions import Fraction

import pytest

from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from gcs.session.setup import Setup
from gcs.station.session import Session
from tests.loopback import pymavlink_decoder
from tests.loopback.flight import HOMES, PEER, Flight
from tests.loopback.observed import START_NS
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import LinkSpec, World

DISCOVERY = {"MISSION_REQUEST_LIST", "MISSION_ACK", "PARAM_REQUEST_READ", "TIMESYNC", "HEARTBEAT"}
ASKING = {511, 512}  # SET_MESSAGE_INTERVAL, REQUEST_MESSAGE


class TwoVehicles(Flight):
    """System ids 1 and 2, both PX4s, on the same link; `vehicles` by id."""

    def __init__(self, chosen: int = 0) -> None:
        super().__init__()
        self.vehicles: dict[int, Autopilot] = {}
        servers = []
        for sysid in (1, 2):
            parameters = Parameters("px4", None)
            vehicle = Autopilot("px4", HOMES["px4"], sysid, params=parameters)
            profile = profile_of("px4", parameters.firmware)
            servers.append(VehicleServer(vehicle, profile, parameters, sysid))
            self.vehicles[sysid] = vehicle
        self.vehicle = self.vehicles[chosen or 1]
        self.world = World(servers, [LinkSpec((PEER,))], Fraction(1), START_NS)
        config = StationConfig(endpoints=["test"], name="loopback", target_sysid=chosen)
        setup = Setup(config, "test", DEFAULT, "", ("a simulated link",), "")
        self.session = Session(setup, START_NS)

    def spoken_to(self) -> set[int]:
        """The targets of all that is no part of meeting a vehicle."""
        targets = set()
        for sent in self.sent:
            message = pymavlink_decoder.read(sent.data)
            asks = message.get_type() == "COMMAND_LONG" and message.command in ASKING
            if message.get_type() not in DISCOVERY and not asks:
                targets.add(int(message.target_system))
        return targets


@pytest.mark.parametrize("word", ["arm", "takeoff", "goto", "land", "rtl", "hold", "abort", "mode"])
def test_without_a_choice_every_request_is_refused_with_the_list(word: str) -> None:
    flight = TwoVehicles()
    flight.until(lambda: flight.is_in(State.GROUNDED))
    flight.run(1.5)
    ask = flight.say(word, up_m=2.0, goal_enu=(1.0, 0.0, 2.0), mode="LOITER")
    (verdict,) = flight.verdicts(ask)
    assert (verdict.outcome, verdict.code) == ("refused", "SEVERAL_VEHICLES")
    assert "1/1 px4 quadrotor, 2/1 px4 quadrotor" in verdict.sentence
    assert "--vehicle" in verdict.sentence
    flight.run(2.0)
    assert flight.spoken_to() == set()
    assert not any(vehicle.armed for vehicle in flight.vehicles.values())


@pytest.mark.parametrize("chosen", [1, 2])
def test_the_chosen_one_flies_and_the_other_one_is_left_alone(chosen: int) -> None:
    flight = TwoVehicles(chosen)
    flight.connected()
    flight.do("arm")
    assert {sysid: v.armed for sysid, v in flight.vehicles.items()} == {
        chosen: True,
        3 - chosen: False,
    }
    assert flight.spoken_to() == {chosen}
    assert any("several vehicles" in line for line in flight.lines("link"))
