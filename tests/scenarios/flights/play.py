"""Play a recorded flight's script to our vehicle, as the real one: the same at the same times."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from math import isnan, nan
from typing import Any, Final

from pymavlink.dialects.v20 import all as mavlink

from tests.contract.client import Client, Sky
from tests.scenarios.flights.facts import Flight, Timed, recorded, reduced
from tests.scenarios.flights.script import (
    ENDS_S,
    HOMES,
    Asked,
    Command,
    asked_otherwise,
    commands,
)
from tests.scenarios.play import FIRMWARE
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.plant.sensors import GRADES

AFTER_S: Final = 0.18
"""How long after the one before the recorder sent a command that was not answered."""

PHASE_NS: Final[dict[Personality, int]] = {"px4": 120_000_000, "ardupilot": 20_000_000}
"""When in a second the recorded HEARTBEATs came."""

POSITION_AND_YAW: Final = 0b100111111000
"""What a setpoint's mask ignores: all but the position and the heading."""

Sent = Command | Asked


@cache
def played(personality: Personality, sensors: str = "good") -> Flight:
    """Our vehicle's flight: real start-up, streams and firmware, no camera."""
    sky = Sky(
        personality,
        home=HOMES[personality],
        firmware=FIRMWARE[personality],
        boot="real",
        camera=False,
        real_streams=True,
        grade=GRADES[sensors],
        phase_ns=PHASE_NS[personality],
    )
    client = sky.client()
    client.beat_if_due()
    for t, sent in script(personality):
        sky.run(t - sky.now_ns / 1e9)
        _send(client, sent)
    sky.run(ENDS_S[personality] - sky.now_ns / 1e9)
    starts_s = recorded(personality).starts_s
    heard = [Timed(each.at_s, each.message) for each in client.heard if each.at_s >= starts_s - 0.1]
    return reduced(personality, "vehicle-sim", heard)


def script(personality: Personality) -> list[tuple[float, Sent]]:
    """What is sent, with its time."""
    both = [
        *_timed_commands(personality),
        *((each.t, each) for each in asked_otherwise(personality)),
    ]
    return sorted(both, key=lambda pair: pair[0])


def _timed_commands(personality: Personality) -> Iterator[tuple[float, Sent]]:
    acks = iter(recorded(personality).acks)
    t = 0.0
    for command in commands(personality):
        t = next(acks).t if command.acked else t + AFTER_S
        yield t, command


def _send(client: Client, sent: Sent) -> None:
    match sent:
        case Command(frame=None):
            p = (*sent.params, *(0.0,) * (7 - len(sent.params)))
            client.send(mavlink.MAVLink_command_long_message(1, sent.component, sent.number, 0, *p))
        case Command():
            p = (*sent.params, *(0.0,) * (7 - len(sent.params)))
            x, y = (0 if isnan(value) else int(value) for value in p[4:6])
            client.send(
                mavlink.MAVLink_command_int_message(
                    1, sent.component, sent.frame, sent.number, 0, 0, *p[:4], x, y, p[6]
                )
            )
        case Asked():
            client.send(_otherwise(sent))


def _otherwise(asked: Asked) -> Any:
    match asked.what.split():
        case ["parameters"]:
            return mavlink.MAVLink_param_request_list_message(1, 1)
        case ["hold"]:
            return mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 4, 3, 0, 0, 0, 0)
        case ["land"]:
            return mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 4, 6, 0, 0, 0, 0)
        case ["read", name]:
            return mavlink.MAVLink_param_request_read_message(1, 1, name.encode(), -1)
        case ["streams"]:
            return mavlink.MAVLink_request_data_stream_message(1, 1, 0, int(asked.value), 1)
        case ["throttle", "down"]:
            sticks = (1500, 1500, 1000, 1500, *(65535,) * 4)
            return mavlink.MAVLink_rc_channels_override_message(1, 1, *sticks)
        case ["setpoint"]:
            place, still = (5.0, 3.0, -5.0), (0.0,) * 6
            return mavlink.MAVLink_set_position_target_local_ned_message(
                0, 1, 1, mavlink.MAV_FRAME_LOCAL_NED, POSITION_AND_YAW, *place, *still, 0.0, nan
            )
    raise ValueError(asked.what)
