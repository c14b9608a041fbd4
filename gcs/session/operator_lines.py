"""What operators say, as work of the vehicle that it is about."""

from __future__ import annotations

from gcs import ipc
from gcs.session.operators import Operators
from gcs.session.vehicles import Vehicles
from gcs.session.work import STATION, For


def line(
    operators: Operators, vehicles: Vehicles, client: int, command: ipc.Command, now_ns: int
) -> For:
    """One command of the operator `client`; what is about no vehicle is the station's."""
    if not isinstance(command, ipc.Ask | ipc.Stream):
        return For(STATION, tuple(operators.line(client, command, None, None, now_ns)))
    owner, autopilot, refusal = vehicles.asked(operators.vehicle_of(command), now_ns)
    return For(owner, tuple(operators.line(client, command, autopilot, refusal, now_ns)))
