"""Messages of clients, encoded by pymavlink, as the guard is given them."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.setup_policy.guard import Guard
from gcs.bridge.setup_policy.verdict import Allowed, GuardSeen, Judgement, Refused
from gcs.gate.policy.parse import parse_policy
from gcs.protocol.effects import Address
from gcs.wire.codec import decode, encode
from gcs.wire.frame import Frame, split
from gcs.wire.messages import Message

CLIENT = Address(245, 190)
VEHICLE = Address(1, 1)
FLYING = GuardSeen(CLIENT, VEHICLE, armed=True, on_ground=False)
PARKED = GuardSeen(CLIENT, VEHICLE, armed=False, on_ground=True)


def sent(name: str, *fields: object) -> Message:
    """The message of that name, as pymavlink's `<name>_encode` makes it of `fields`."""
    peer = mavlink.MAVLink(None, srcSystem=CLIENT.sysid, srcComponent=CLIENT.compid)
    made: Any = getattr(peer, f"{name}_encode")(*fields)
    (frame,) = split(made.pack(peer))
    assert isinstance(frame, Frame)
    message = decode(frame)
    assert message is not None
    return message


def command(number: int, *params: float) -> Message:
    """COMMAND_LONG to the vehicle."""
    return sent("command_long", 1, 1, number, 0, *params, *(0.0,) * (7 - len(params)))


def guard(rules: str = "", autopilot: str = "px4") -> Guard:
    """By the default policy with `rules` in its section `[bridge]`."""
    return Guard(parse_policy(f"[bridge]\n{rules}", "my.toml").bridge, autopilot)


def refused(judgement: Judgement) -> Refused:
    """It is refused, and every answer can be sent."""
    assert isinstance(judgement, Refused), judgement
    for message in (*judgement.answers, *judgement.ask_vehicle):
        encode(message)
    assert judgement.refusal.sentence
    return judgement


def allowed(judgement: Judgement) -> Allowed:
    assert isinstance(judgement, Allowed), judgement
    return judgement
