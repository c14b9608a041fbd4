"""A vehicle that `gcs bridge --lock` has locked: who goes round the bridge gets nothing."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.protocol.lock_setup import Change, Ending, LockSetup
from gcs.protocol.signing_setup import Ending as KeyEnding
from gcs.protocol.signing_setup import SigningSetup
from gcs.wire.frame import Frame, split
from gcs.wire.signing import SecretKey
from tests.loopback.air import CLEAR, Air, Weather
from tests.loopback.bridged import STATION, BridgedFlight
from tests.loopback.flight import PEER, PERSONALITIES, Flight, Personality
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.simulation.world import Datagram, Transmit, Wake

KEY = SecretKey(bytes(range(32)))
STEP_NS = 10_000_000
LOSSY = Weather(loss=0.3, duplicate=0.1, delay_s=(0.001, 0.05))
ARM = 400


def run(flight: Flight, setup: SigningSetup | LockSetup, weather: Weather = CLEAR) -> None:
    """A set-up against the flight's vehicle, without its station."""
    flight.run(0.05)  # its record, which may be audited, begins with the station
    now_ns, up, down = flight.now_ns, Air(weather, 5), Air(weather, 6)
    while setup.ending is None:
        now_ns += STEP_NS
        sent = setup.wake(now_ns)
        outputs = [*flight.world.handle(Wake(), now_ns)]
        for data in up.arrived(now_ns):
            outputs += flight.world.handle(Datagram(0, PEER, data), now_ns)
        for output in outputs:
            if isinstance(output, Transmit):
                down.send(output.data, now_ns)
        for data in down.arrived(now_ns):
            for item in split(data):
                if isinstance(item, Frame):
                    sent += setup.handle(item, now_ns)
        for raw in sent:
            up.send(raw, now_ns)
    flight.now_ns = now_ns


def locked(flight: Flight, weather: Weather = CLEAR) -> LockSetup:
    deadline_ns = flight.now_ns + 10 * 10**9
    key = SigningSetup(KEY, None, 0, deadline_ns)
    run(flight, key, weather)
    assert key.ending is KeyEnding.DONE
    lock = LockSetup(KEY, STATION[0], 1, flight.now_ns + 10 * 10**9)
    run(flight, lock, weather)
    return lock


@pytest.mark.parametrize("weather", [CLEAR, LOSSY], ids=["clear", "30 % loss"])
@pytest.mark.parametrize(
    ("personality", "firmware", "changes"),
    [
        (
            "px4",
            None,
            [
                Change("COM_ARM_AUTH_ID", 10.0, 255.0),
                Change("COM_ARM_AUTH_MET", 0.0, 0.0),
                Change("COM_ARM_AUTH_REQ", 0.0, 1.0),
            ],
        ),
        ("ardupilot", "4.5", [Change("SYSID_MYGCS", 255.0, 255.0)]),
        ("ardupilot", "4.7", [Change("MAV_GCS_SYSID", 255.0, 255.0)]),
    ],
)
def test_what_is_changed_is_told_and_a_second_time_nothing_is(
    personality: Personality, firmware: Firmware | None, changes: list[Change], weather: Weather
) -> None:
    flight = Flight(personality, firmware=firmware)
    lock = locked(flight, weather)
    assert lock.ending is Ending.DONE
    assert lock.changes == changes
    assert [c.before for c in locked(flight, weather).changes] == [c.after for c in changes]


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_locked_vehicle_arms_for_the_bridge_and_for_nobody_else(
    personality: Personality,
) -> None:
    flight = BridgedFlight(personality, station_key=KEY.secret)
    if personality == "px4":
        for name, value in (("GF_ACTION", 2), ("GF_MAX_HOR_DIST", 100), ("GF_MAX_VER_DIST", 40)):
            flight.vehicle.parameters.set(name, value)
    assert locked(flight).ending is Ending.DONE
    client = flight.join()
    flight.connected()
    mav = dialect.MAVLink(None, srcSystem=STATION[0], srcComponent=STATION[1])
    for seq, param2 in enumerate((0, 21196)):
        mav.seq = seq
        arm = dialect.MAVLink_command_long_message(1, 1, ARM, 0, 1, param2, 0, 0, 0, 0, 0)
        outputs = flight.world.handle(Datagram(0, "stranger", bytes(arm.pack(mav))), flight.now_ns)
        names = {
            getattr(item, "name", "")
            for each in outputs
            if isinstance(each, Transmit)
            for item in split(each.data)
        }
        assert "COMMAND_ACK" not in names
    flight.run(2.0)
    assert not flight.vehicle.armed
    assert client.ask(ARM, 1, within_s=10) == 0
    assert flight.vehicle.armed


def test_an_armed_vehicle_is_not_locked() -> None:
    flight = Flight(vehicle_key=KEY.secret, station_key=KEY.secret).connected()
    flight.do("arm")
    lock = LockSetup(KEY, 255, 0, flight.now_ns + 10**10)
    run(flight, lock)
    assert (lock.ending, lock.changes) == (Ending.ARMED, [])


def test_a_vehicle_without_the_key_is_not_spoken_to() -> None:
    flight = Flight()
    lock = LockSetup(KEY, 255, 0, flight.now_ns + 3 * 10**9)
    run(flight, lock)
    assert lock.ending is Ending.NO_VEHICLE
