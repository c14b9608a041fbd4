"""A vehicle that `gcs bridge --lock` has locked: who goes round the bridge gets nothing."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.protocol.lock_parameters import FenceSize, Locking
from gcs.protocol.lock_setup import Change, Ending, LockSetup
from gcs.protocol.signing_setup import Ending as KeyEnding
from gcs.protocol.signing_setup import SigningSetup
from gcs.vehicle.parameters.failsafes import FENCE, FENCE_ACTION, findings, limits_of
from gcs.wire.frame import Frame, split
from gcs.wire.signing import SecretKey
from tests.loopback.bridged import STATION, BridgedFlight
from tests.loopback.flight import PEER, Flight, Personality
from tests.loopback.lossy_link import CLEAR, Air, Weather
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.simulation.world import Datagram, Transmit, Wake

KEY = SecretKey(bytes(range(32)))
STEP_NS = 10_000_000
LOSSY = Weather(loss=0.3, duplicate=0.1, delay_s=(0.001, 0.05))
ARM = 400
PLAIN = Locking(STATION[0])


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


def locked(flight: Flight, weather: Weather = CLEAR, locking: Locking = PLAIN) -> LockSetup:
    deadline_ns = flight.now_ns + 10 * 10**9
    key = SigningSetup(KEY, None, 0, deadline_ns, locking.own_sysid)
    run(flight, key, weather)
    assert key.ending is KeyEnding.DONE
    lock = LockSetup(KEY, locking, 1, flight.now_ns + 10 * 10**9)
    run(flight, lock, weather)
    return lock


def fence_of(policy: Policy) -> FenceSize:
    limits = limits_of(policy, STATION[0])
    return FenceSize(limits.reach_m, limits.ceiling_up_m)


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
    lock = LockSetup(KEY, PLAIN, 0, flight.now_ns + 10**10)
    run(flight, lock)
    assert (lock.ending, lock.changes) == (Ending.ARMED, [])


def test_a_vehicle_without_the_key_is_not_spoken_to() -> None:
    flight = Flight()
    lock = LockSetup(KEY, PLAIN, 0, flight.now_ns + 3 * 10**9)
    run(flight, lock)
    assert lock.ending is Ending.NO_VEHICLE


DEFAULT_FENCE = fence_of(DEFAULT)


@pytest.mark.parametrize(
    ("personality", "firmware", "changes"),
    [
        (
            "px4",
            None,
            [
                Change("GF_MAX_HOR_DIST", 0.0, 150.0),
                Change("GF_MAX_VER_DIST", 0.0, 50.0),
                Change("GF_ACTION", 2.0, 2.0),
                Change("COM_ARM_AUTH_ID", 10.0, 255.0),
                Change("COM_ARM_AUTH_MET", 0.0, 0.0),
                Change("COM_ARM_AUTH_REQ", 0.0, 1.0),
            ],
        ),
        (
            "ardupilot",
            "4.5",
            [
                Change("FENCE_RADIUS", 150.0, 150.0),
                Change("FENCE_ALT_MAX", 100.0, 50.0),
                Change("FENCE_TYPE", 7.0, 7.0),
                Change("FENCE_ACTION", 1.0, 1.0),
                Change("FENCE_ENABLE", 0.0, 1.0),
                Change("SYSID_MYGCS", 255.0, 255.0),
                Change("SYSID_ENFORCE", 0.0, 1.0),
            ],
        ),
        (
            "ardupilot",
            "4.7",
            [
                Change("FENCE_RADIUS", 150.0, 150.0),
                Change("FENCE_ALT_MAX", 100.0, 50.0),
                Change("FENCE_TYPE", 7.0, 7.0),
                Change("FENCE_ACTION", 1.0, 1.0),
                Change("FENCE_ENABLE", 0.0, 1.0),
                Change("MAV_GCS_SYSID", 255.0, 255.0),
                Change("MAV_OPTIONS", 0.0, 1.0),
            ],
        ),
    ],
)
def test_a_fence_as_wide_as_the_policys_and_the_number_that_is_heard(
    personality: Personality, firmware: Firmware | None, changes: list[Change]
) -> None:
    """What the vehicle is given is what the station itself finds as strong as the policy."""
    flight = Flight(personality, firmware=firmware)
    locking = Locking(STATION[0], DEFAULT_FENCE, enforce_sysid=True)
    lock = locked(flight, locking=locking)
    assert (lock.ending, lock.changes) == (Ending.DONE, changes)
    assert [c.before for c in locked(flight, locking=locking).changes] == [c.after for c in changes]
    values = {change.name: change.after for change in changes}
    for found in findings(personality, values, limits_of(DEFAULT, STATION[0])):
        assert found.about not in (FENCE, FENCE_ACTION) or not found.weak, found.words


def test_a_narrower_fence_and_a_stronger_action_stay() -> None:
    params = {"GF_MAX_HOR_DIST": 40.0, "GF_MAX_VER_DIST": 10.0, "GF_ACTION": 3.0}
    lock = locked(Flight(params=params), locking=Locking(STATION[0], DEFAULT_FENCE))
    assert [each for each in lock.changes if each.name in params] == [
        Change(name, value, value) for name, value in params.items()
    ]


def test_a_wider_fence_of_another_kind_that_only_reports_is_made_one() -> None:
    params = {"FENCE_RADIUS": 300.0, "FENCE_TYPE": 4.0, "FENCE_ACTION": 0.0}
    flight = Flight("ardupilot", params=params)
    lock = locked(flight, locking=Locking(STATION[0], DEFAULT_FENCE))
    assert [each for each in lock.changes if each.name in params] == [
        Change("FENCE_RADIUS", 300.0, 150.0),
        Change("FENCE_TYPE", 4.0, 7.0),
        Change("FENCE_ACTION", 0.0, 1.0),
    ]


def test_with_a_fence_of_its_own_a_locked_vehicle_flies_at_once(personality: Personality) -> None:
    flight = BridgedFlight(personality, station_key=KEY.secret)
    assert locked(flight, locking=Locking(STATION[0], DEFAULT_FENCE)).ending is Ending.DONE
    client = flight.join()
    flight.connected()
    flight.run(3.0)  # a PX4 1.14 is asked whether a mission is on board
    assert client.ask(ARM, 1, within_s=10) == 0
    assert flight.vehicle.armed


@pytest.mark.parametrize(("sysid", "hears"), [(255, True), (245, False)])
def test_an_ardupilot_that_enforces_hears_clients_of_the_bridges_number_alone(
    sysid: int, hears: bool
) -> None:
    """MAVSDK's own number is 245: such a client is flown for, and reads nothing."""
    flight = BridgedFlight("ardupilot", station_key=KEY.secret)
    locked(flight, locking=Locking(STATION[0], enforce_sysid=True))
    client = flight.join(sysid=sysid)
    flight.connected()
    client.send(dialect.MAVLink_param_request_read_message(1, 1, b"ARMING_RUDDER", -1))
    flight.run(2.0)
    read = [each for each in client.messages("PARAM_VALUE") if each.param_id == "ARMING_RUDDER"]
    assert bool(read) is hears
    assert client.ask(ARM, 1, within_s=10) == 0
    told = "vehicle 1 hears system 255 alone (SYSID_ENFORCE), not 245"
    assert client.texts().count(told) == (0 if hears else 1)


def test_a_client_that_came_before_the_vehicle_enforces_is_told_when_it_does() -> None:
    flight = BridgedFlight("ardupilot")
    client = flight.join(sysid=245)
    flight.connected()
    flight.run(2.0)
    assert "alone" not in client.texts()
    parameters = flight.vehicle.parameters
    parameters.set("SYSID_ENFORCE", 1)
    own = flight.join(sysid=255)
    own.send(dialect.MAVLink_param_request_read_message(1, 1, b"SYSID_ENFORCE", -1))
    flight.run(3.0)
    assert client.texts().count("(SYSID_ENFORCE), not 245") == 1
    assert "alone" not in own.texts()


def test_a_vehicle_without_a_key_is_made_to_ask_all_the_same() -> None:
    """PX4 before 1.17 has no signing."""
    flight = BridgedFlight()
    lock = LockSetup(None, Locking(STATION[0], DEFAULT_FENCE), 0, flight.now_ns + 10**10)
    run(flight, lock)
    assert (lock.ending, lock.vehicle) == (Ending.DONE, "1/1")
    client = flight.join()
    flight.connected()
    flight.vehicle.parameters.set("GF_ACTION", 0)
    flight.run(5.0)
    stranger = dialect.MAVLink(None, srcSystem=250, srcComponent=190)
    arm = dialect.MAVLink_command_long_message(1, 1, ARM, 0, 1, 0, 0, 0, 0, 0, 0)
    flight.world.handle(Datagram(0, "stranger", bytes(arm.pack(stranger))), flight.now_ns)
    flight.run(3.0)
    assert not flight.vehicle.armed
    assert client.ask(ARM, 1, within_s=10) != 0


def test_an_ardupilot_s_port_that_takes_unsigned_frames_is_told() -> None:
    flight = Flight("ardupilot")
    assert flight.vehicle.parameters.get("SERIAL0_PROTOCOL") == 2
    lock = locked(flight)
    assert lock.ending is Ending.DONE
    assert lock.open_ports[0].startswith("SERIAL0 (USB, as a rule) takes unsigned frames, always")
