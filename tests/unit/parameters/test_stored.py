"""What parameters outlive, how they are reset, and when those of the simulation act."""

from __future__ import annotations

import pytest

from tests.unit.autopilot.flight import HOMES, Flight
from tests.unit.autopilot.hand_flight import HandFlight
from tests.unit.parameters.probing import Setting
from tests.unit.parameters.scripts import Served
from tests.unit.vehicle_services.fake_vehicle import S, acks, long
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.engine.batch_engine import BatchEngine
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import Seat, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.faults import WindChange
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
HEIGHT: dict[Personality, str] = {"px4": "MIS_TAKEOFF_ALT", "ardupilot": "PILOT_TKOFF_ALT"}
CHANGED, DEFAULT = {"px4": 7.0, "ardupilot": 700.0}, {"px4": 2.5, "ardupilot": 0.0}


@either
def test_a_reboot_keeps_what_was_set(personality: Personality) -> None:
    served = Served(Setting(personality, {HEIGHT[personality]: CHANGED[personality]}).fresh())
    served.advance(S)
    assert acks(served.send(long(Cmd.PREFLIGHT_REBOOT_SHUTDOWN, 1))) == [(246, Result.ACCEPTED)]
    served.advance(S)
    assert served.stored(HEIGHT[personality]) == CHANGED[personality]


def test_px4_resets_its_parameters_at_once() -> None:
    served = Served(Setting("px4", {HEIGHT["px4"]: 7.0}).fresh())
    served.advance(S)
    assert acks(served.send(long(Cmd.PREFLIGHT_STORAGE, 2))) == [(245, Result.ACCEPTED)]
    assert served.stored(HEIGHT["px4"]) == DEFAULT["px4"]


def test_ardupilot_resets_its_parameters_with_the_next_reboot() -> None:
    served = Served(Setting("ardupilot", {HEIGHT["ardupilot"]: 700.0}).fresh())
    served.advance(S)
    assert acks(served.send(long(Cmd.PREFLIGHT_STORAGE, 2))) == [(245, Result.ACCEPTED)]
    assert served.stored(HEIGHT["ardupilot"]) == CHANGED["ardupilot"]
    served.send(long(Cmd.PREFLIGHT_REBOOT_SHUTDOWN, 1))
    assert served.stored(HEIGHT["ardupilot"]) == DEFAULT["ardupilot"]


def started(personality: Personality, firmware: Firmware) -> Served:
    """Vehicle 5, started with two values of its own, as the command line starts it."""
    parameters = Parameters(personality, firmware)
    parameters.start_as(5)
    for name, value in STARTED_WITH[firmware].items():
        parameters.start_with(name, value)
    flight = HandFlight(personality)
    flight.vehicle = Autopilot(personality, HOMES[personality], 1, 0, parameters)
    return Served(flight, system=5)


STARTED_WITH: dict[Firmware, dict[str, float]] = {
    "1.14": {"MIS_TAKEOFF_ALT": 6.0, "MPC_XY_CRUISE": 3.0},
    "4.5": {"RTL_ALT": 900.0, "WPNAV_SPEED": 300.0},
    "4.7": {"RTL_ALT_M": 9.0, "WP_SPD": 3.0},
}


@pytest.mark.parametrize(
    ("personality", "firmware"), [("px4", "1.14"), ("ardupilot", "4.5"), ("ardupilot", "4.7")]
)
def test_a_reset_and_a_reboot_leave_system_id_and_what_it_was_started_with(
    personality: Personality, firmware: Firmware
) -> None:
    """vehicle.md, bug 6: vehicle 5 became vehicle 1, and values of --param were lost."""
    served = started(personality, firmware)
    served.advance(S)
    assert served.server.system == 5
    for name in STARTED_WITH[firmware]:
        served.server._given.set(name, 1.0)
    assert acks(served.send(long(Cmd.PREFLIGHT_STORAGE, 2, target=5))) == [(245, Result.ACCEPTED)]
    assert acks(served.send(long(Cmd.PREFLIGHT_REBOOT_SHUTDOWN, 1, target=5))) == [
        (246, Result.ACCEPTED)
    ]
    served.advance(S)
    assert served.server.system == 5
    assert {name: served.stored(name) for name in STARTED_WITH[firmware]} == STARTED_WITH[firmware]


def test_what_is_set_after_ardupilots_parameters_were_erased_outlives_the_reboot() -> None:
    """vehicle.md, bug 7."""
    served = Served(Setting("ardupilot", {"RTL_ALT": 700.0, "GUID_TIMEOUT": 2.0}).fresh())
    served.advance(S)
    assert acks(served.send(long(Cmd.PREFLIGHT_STORAGE, 2))) == [(245, Result.ACCEPTED)]
    served.send(m.ParamSet(4.0, 1, 1, b"GUID_TIMEOUT", 9))
    assert served.stored("RTL_ALT") == 700.0
    served.send(long(Cmd.PREFLIGHT_REBOOT_SHUTDOWN, 1))
    served.advance(S)
    assert (served.stored("RTL_ALT"), served.stored("GUID_TIMEOUT")) == (1500.0, 4.0)


def test_a_second_reboot_resets_nothing() -> None:
    served = Served(Setting("ardupilot", {}).fresh())
    served.advance(S)
    served.send(long(Cmd.PREFLIGHT_STORAGE, 2))
    served.send(long(Cmd.PREFLIGHT_REBOOT_SHUTDOWN, 1))
    served.advance(S)
    served.send(m.ParamSet(800.0, 1, 1, b"RTL_ALT", 9))
    served.send(long(Cmd.PREFLIGHT_REBOOT_SHUTDOWN, 1))
    served.advance(S)
    assert served.stored("RTL_ALT") == 800.0


def test_simulated_wind_that_is_set_before_the_start_blows_from_the_start() -> None:
    flight = Flight("ardupilot")
    flight.vehicle.parameters.set("SIM_WIND_SPD", 6.0)
    flight.fly(5.0)
    assert flight.vehicle.blocks.body.wind_n == pytest.approx(6.0)


def test_other_parameters_leave_a_fault_alone_that_came_from_elsewhere() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.inject(WindChange((3.0, 0.0, 0.0)))
    flight.vehicle.parameters.set("SIM_BARO_GLITCH", 1.0)
    flight.vehicle.parameters.set("WPNAV_SPEED", 300.0)
    flight.fly(1.0)
    assert flight.vehicle.blocks.body.wind_n == 3.0


def test_a_reboot_does_not_end_what_the_simulation_was_told() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.parameters.set("SIM_WIND_SPD", 6.0)
    flight.fly(0.5)
    assert flight.vehicle.reboot() is Result.ACCEPTED
    flight.fly(0.5)
    assert flight.vehicle.blocks.body.wind_n == pytest.approx(6.0)


def test_gains_reach_a_vehicle_in_a_fleet_as_they_reach_one_alone() -> None:
    def flown(kind: type[ScalarEngine] | type[BatchEngine]) -> bytes:
        home = HOMES["px4"]
        specs = [VehicleSpec(1, index, home.lat_deg) for index in range(2)]
        engine = kind(specs, load())
        vehicles = []
        for lane, roll_p in enumerate((6.5, 4.0)):
            parameters = Parameters("px4")
            parameters.set("MC_ROLL_P", roll_p)
            vehicles.append(Autopilot("px4", home, 1, lane, parameters, Seat(engine, lane)))
        for step in range(2500):
            engine.step()
            for vehicle in vehicles:
                vehicle.live()
                if step == 400:
                    vehicle.arm(False)
                    vehicle.take_off(4.0)
                if step == 1800:
                    vehicle.parameters.set("MPC_XY_CRUISE", 8.0)
                    vehicle.reposition((10.0, 10.0, -4.0), None, None)
        states = [vehicle.state_bytes() for vehicle in vehicles]
        assert states[0] != states[1]
        return b"".join(states)

    assert flown(ScalarEngine) == flown(BatchEngine)
