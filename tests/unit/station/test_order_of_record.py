"""What is decided is recorded in the order in which it happened."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.protocol.autopilot import CannotCommandError
from gcs.report import FsaItem
from gcs.session.effects import Record
from gcs.session.inputs import Datagram, OperatorLine
from gcs.session.setup import Setup
from gcs.station.session import Session
from gcs.vehicle.talk import commands
from gcs.wire.codec import FrameWriter
from gcs.wire.messages import CommandLong, ExtendedSysState, Heartbeat, Message
from tests.unit.station.vehicles import SECOND_NS, position

PX4_AUTOPILOT = 12
IN_AIR = 2


def _cannot(*_: object) -> CommandLong:
    raise CannotCommandError("not today")


def test_a_landing_that_cannot_be_asked_for_is_recorded_after_it_began(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Where a command cannot be put in the autopilot's words, LANDING ends as it begins."""
    monkeypatch.setattr(commands, "command_long_for", _cannot)
    session = Session(Setup(StationConfig(), "test", DEFAULT, "", ("a link",), ""), now_ns=0)
    vehicle = FrameWriter(1, 1)

    def hear(message: Message) -> None:
        session.handle(Datagram(0, vehicle.write(message)), SECOND_NS)

    hear(
        Heartbeat(
            custom_mode=0,
            type=2,
            autopilot=PX4_AUTOPILOT,
            base_mode=128,
            system_status=4,
            mavlink_version=3,
        )
    )
    hear(ExtendedSysState(vtol_state=0, landed_state=IN_AIR))
    hear(position(1000, z=-5.0))
    assert session.gate.state.name == "EXTERNAL"

    effects = session.handle(OperatorLine(1, ipc.Ask(1, "land")), SECOND_NS + 1)
    items = [effect.item for effect in effects if isinstance(effect, Record)]
    moves = [(item.before, item.state) for item in items if isinstance(item, FsaItem)]
    assert moves == [("EXTERNAL", "LANDING"), ("LANDING", "HOLDING")]
