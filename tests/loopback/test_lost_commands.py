"""The command for another mode is lost again and again, and all else arrives.

A PX4 in OFFBOARD that hears no setpoint for COM_OF_LOSS_T (1 s) begins a failsafe of its own.
"""

from __future__ import annotations

import pytest

from gcs.gate.states import State
from gcs.wire.frame import Frame, split
from tests.loopback import pymavlink_decoder
from tests.loopback.flight import MISSIONS, PERSONALITIES, Flight, Personality
from tests.loopback.lossy_link import CLEAR, Air

LOST_FOR_S = 1.3
"""Longer than a PX4 waits for a setpoint, and shorter than the gate tries to start a mission."""
COMMANDS = {"land": 21, "rtl": 20, "mission_start": 300}
SET_MODE = 176


class WayUp(Air):
    """Commands with these numbers are lost."""

    lost: frozenset[int] = frozenset()

    def send(self, data: bytes, now_ns: int) -> None:
        frames = [item for item in split(data) if isinstance(item, Frame)]
        kept = [frame.raw for frame in frames if not self._loses(frame)]
        if kept:
            super().send(b"".join(kept), now_ns)

    def _loses(self, frame: Frame) -> bool:
        command = frame.name in ("COMMAND_LONG", "COMMAND_INT")
        return command and pymavlink_decoder.read(frame.raw).command in self.lost


@pytest.mark.parametrize("word", COMMANDS)
@pytest.mark.parametrize("personality", PERSONALITIES)
def test_the_vehicle_stays_where_it_is_until_it_hears_of_it(
    personality: Personality, word: str
) -> None:
    flight = Flight(personality)
    flight.up = way_up = WayUp(CLEAR, 1)
    flight.connected()
    flight.do("mission_upload", path=str(MISSIONS / "demo.toml"))
    flight.run(3.0)
    flight.hovering(5.0)
    since_ns = flight.now_ns
    way_up.lost = frozenset({COMMANDS[word], SET_MODE})
    flight.say(word)
    flight.run(LOST_FOR_S)
    assert flight.truth_enu()[2] > 4.5, flight.told()
    way_up.lost = frozenset()
    flight.run(3.0)
    assert not [line for line in flight.lines("vehicle", since_ns) if "ailsafe" in line]
    assert flight.state in (State.LANDING, State.RETURNING, State.FLYING_MISSION), flight.told()
    assert not {"HOLDING", "EXTERNAL", "STALE"} & set(flight.states(since_ns))
