"""What is decided is recorded in the order in which it happened."""

from __future__ import annotations

from gcs import ipc
from gcs.config import StationConfig
from gcs.gate.policy.parse import DEFAULT
from gcs.report import FsaItem
from gcs.session.effects import Record
from gcs.session.inputs import Datagram, OperatorLine
from gcs.session.session import Session
from gcs.session.setup import Setup
from gcs.wire.codec import FrameWriter
from gcs.wire.messages import ExtendedSysState, Heartbeat, Message
from tests.unit.session.vehicles import SECOND_NS, position

GENERIC_AUTOPILOT = 0
IN_AIR = 2


def test_a_landing_that_cannot_be_asked_for_is_recorded_after_it_began() -> None:
    """An autopilot of an unknown kind takes no commands: LANDING ends in the instant it begins."""
    session = Session(Setup(StationConfig(), "test", DEFAULT, "", ("a link",), ""), now_ns=0)
    vehicle = FrameWriter(1, 1)

    def hear(message: Message) -> None:
        session.handle(Datagram(0, vehicle.write(message)), SECOND_NS)

    hear(
        Heartbeat(
            custom_mode=0,
            type=2,
            autopilot=GENERIC_AUTOPILOT,
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
