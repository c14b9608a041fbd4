"""Ten seeded scripts, each flown by both autopilots on a virtual clock.

What they send, receive and record is hashed: a change that only moves or renames leaves every byte
as it was.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.boxed_stream import taken_off
from tests.loopback.bridged import BridgedFlight, Client
from tests.loopback.flight import HOMES, Flight, Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.plan_clients import Mavsdk, PlanFlight, mission
from tests.loopback.stranger import stranger

Script = Callable[[Personality], Flight]

ARM, LAND, RTL, MISSION_START, PAUSE = 400, 21, 20, 300, 193
NORTH_DEG: Final = 1.0 / 111_319.5
ROUGH = Weather(loss=0.1, duplicate=0.1, corrupt=0.05, delay_s=(0.001, 0.08))


def goals(personality: Personality) -> Flight:
    """Goals that are flown and one that is refused; then it lands."""
    flight = Flight(personality, seed=11).hovering(5.0)
    flight.done(flight.goto(12.0, 4.0, 8.0))
    flight.done(flight.goto(500.0, 0.0, 5.0))
    flight.done(flight.goto(0.0, 0.0, 3.0))
    flight.do("land")
    flight.run(2.0)
    return flight


def operator_mission(personality: Personality) -> Flight:
    """A mission file is uploaded, flown and read back."""
    flight = Flight(personality, seed=12).connected()
    flight.do("mission_upload", path="missions/demo.toml")  # as it is in the record
    flight.do("arm")
    flight.done(flight.say("mission_start"), 180.0)
    flight.run(20.0)
    return flight


def stopped(personality: Personality) -> Flight:
    """A goal is aborted on its way, taken up again and left for home."""
    flight = Flight(personality, seed=13).hovering(10.0)
    flight.goto(60.0, 0.0, 10.0)
    flight.run(4.0)
    flight.say("abort")
    flight.run(6.0)
    flight.do("resume")
    flight.goto(0.0, 30.0, 10.0)
    flight.run(3.0)
    flight.done(flight.say("rtl"), 120.0)
    return flight


def lossy(personality: Personality) -> Flight:
    """Links that lose, double, spoil and delay."""
    flight = Flight(personality, seed=14, up=ROUGH, down=ROUGH)
    flight.run(2.0)
    flight.until(lambda: flight.is_in(State.GROUNDED))
    for word, up_m, seconds in (("arm", None, 4.0), ("takeoff", 4.0, 12.0)):
        flight.say(word, up_m=up_m)
        flight.run(seconds)
    flight.goto(8.0, -3.0, 4.0)
    flight.run(8.0)
    flight.say("land")
    flight.run(10.0)
    return flight


def several_operators(personality: Personality) -> Flight:
    """A second operator joins, stops the first one's goal, and leaves; noise on the lines."""
    flight = Flight(personality, seed=15).hovering(4.0)
    flight.feed(inputs.OperatorJoined(2, "a second one"))
    flight.feed(inputs.OperatorLine(2, ipc.Subscribe(["ATTITUDE"])))
    flight.goto(0.0, 20.0, 4.0)
    flight.run(2.0)
    flight.feed(inputs.OperatorNoise(2, "gibberish"))
    flight.feed(inputs.OperatorLine(2, ipc.Ask(1, "abort")))
    flight.run(4.0)
    flight.feed(inputs.OperatorGone(2, "its connection ended"))
    flight.feed(inputs.Datagram(0, b"GET / HTTP/1.1"))
    flight.feed(inputs.SignalCame("SIGTERM"))
    flight.run(6.0)
    return flight


def silent_vehicle(personality: Personality) -> Flight:
    """The vehicle is not heard for 6 s in a goal; then another station changes its mode."""
    flight = Flight(personality, seed=16).hovering(6.0)
    flight.goto(30.0, 0.0, 6.0)
    flight.run(2.0)
    flight.vehicle_silent = True
    flight.run(6.0)
    flight.vehicle_silent = False
    flight.run(5.0)
    command = dialect.MAVLink_command_long_message(1, 1, RTL, 0, 0, 0, 0, 0, 0, 0, 0)
    stranger(flight, command)
    flight.run(10.0)
    return flight


def _flying(personality: Personality, seed: int) -> tuple[BridgedFlight, Client]:
    flight = BridgedFlight(personality, seed=seed)
    client = flight.join()
    flight.connected()
    taken_off(flight, client, 10.0)
    return flight, client


def client_goals(personality: Personality) -> Flight:
    """A client of the bridge flies to a place, is refused another, stops and lands."""
    flight, client = _flying(personality, 17)
    home = HOMES[personality]
    for north_m in (25.0, 900.0, -10.0):
        client.fly_to(home.lat_deg + north_m * NORTH_DEG, home.lon_deg, home.alt_amsl_m + 12.0)
        flight.beating(6.0)
    client.command(PAUSE, 0.0)
    flight.beating(5.0)
    client.command(LAND)
    flight.beating(15.0)
    return flight


def client_stream(personality: Personality) -> Flight:
    """A client streams velocities towards the fence until they are refused."""
    flight, client = _flying(personality, 18)
    mask = 0b110111000111
    mode = (6 << 16, 4)[personality == "ardupilot"]
    for step in range(240):
        velocity = (0.0 if step < 40 else 8.0, 0.0, 0.0)
        client.send(
            dialect.MAVLink_set_position_target_local_ned_message(
                0, 1, 1, 1, mask, 0, 0, 0, *velocity, 0, 0, 0, 0, 0
            )
        )
        if step == 20:
            client.send(dialect.MAVLink_set_mode_message(1, 1, mode))
        flight.beating(0.1)
    return flight


def client_mission(personality: Personality) -> Flight:
    """A client uploads a mission, starts it, and changes another's parameter meanwhile."""
    flight = PlanFlight(personality, seed=19)
    client = flight.join()
    flight.connected()
    upload = Mavsdk(flight, client, mission(personality, (20.0, 0.0, 10.0), (20.0, 20.0, 12.0)))
    upload.begin()
    upload.ended()
    client.ask(ARM, 1.0)
    client.command(MISSION_START)
    for _ in range(80):
        client.beat()
        flight.run(0.5)
    return flight


def signed(personality: Personality) -> Flight:
    """Both sides sign."""
    key = bytes(range(32))
    flight = Flight(personality, seed=20, vehicle_key=key, station_key=key).hovering(3.0)
    flight.done(flight.goto(4.0, 4.0, 4.0))
    flight.do("land")
    return flight


SCRIPTS: Mapping[str, Script] = {
    script.__name__: script
    for script in (
        goals,
        operator_mission,
        stopped,
        lossy,
        several_operators,
        silent_vehicle,
        client_goals,
        client_stream,
        client_mission,
        signed,
    )
}
