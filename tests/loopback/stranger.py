"""Another station, which talks straight to the vehicle of a flight, past ours."""

from __future__ import annotations

import itertools
import math
from typing import Any

from pymavlink.dialects.v20 import all as dialect

from tests.loopback.flight import HOMES, Flight
from vehicle_sim.simulation.world import Datagram, Transmit

STRANGER = "another station"
SEQUENCES = itertools.count()


def stranger(flight: Flight, *messages: Any) -> list[Any]:
    """Another station says something straight to the vehicle; what it is answered."""
    mav = dialect.MAVLink(None, srcSystem=254, srcComponent=190)
    mav.seq = next(SEQUENCES) * 16 & 0xFF
    answers: list[Any] = []
    for message in messages:
        data = Datagram(0, STRANGER, bytes(message.pack(mav)))
        mav.seq = (mav.seq + 1) & 0xFF
        for output in flight.world.handle(data, flight.now_ns):
            if isinstance(output, Transmit) and output.peer == STRANGER:
                answers += mav.parse_buffer(output.data) or []
            elif isinstance(output, Transmit):
                flight.down.send(output.data, flight.now_ns)
    return answers


def stranger_uploads(flight: Flight, items: int, north_e7: int = 9000) -> None:
    """A mission past the gate, of waypoints 100 m apart, or so many degrees of latitude."""
    asked = stranger(flight, dialect.MAVLink_mission_count_message(1, 1, items, 0))
    for seq in range(items):
        assert asked, "the vehicle asks for the next item"
        item = dialect.MAVLink_mission_item_int_message(
            1, 1, seq, 6, 16, 0, 1, 0, 0, 0, 0, 473977420 + north_e7 * seq, 85455940, 20, 0
        )
        asked = stranger(flight, item)
    assert "MISSION_ACK" in {message.get_type() for message in asked}
    flight.run(3.0)


def stranger_fences(flight: Flight, half_m: float) -> None:
    """A square to stay in about home, put on board past the gate.  That it was, a PX4 tells by the
    fence's number, which it gives since 1.15 (from memory)."""
    at = HOMES[flight.personality]
    asked = stranger(flight, dialect.MAVLink_mission_count_message(1, 1, 4, 1))
    for seq, (north, east) in enumerate(((1, 1), (1, -1), (-1, -1), (-1, 1))):
        assert asked, "the vehicle asks for the next item"
        lat = at.lat_deg + north * half_m / 111_195
        lon = at.lon_deg + east * half_m / (111_195 * math.cos(math.radians(lat)))
        item = dialect.MAVLink_mission_item_int_message(
            1, 1, seq, 0, 5001, 0, 1, 4, 0, 0, 0, round(lat * 1e7), round(lon * 1e7), 0, 1
        )
        asked = stranger(flight, item)
    assert "MISSION_ACK" in {message.get_type() for message in asked}
