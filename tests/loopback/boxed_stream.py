"""A MAVLink client that streams in a fence that is a box about home, and what the vehicle's own
truth is beside that box."""

from __future__ import annotations

import math

from gcs.gate.states import Control, State
from tests.loopback.bridged import BridgedFlight, Client

ACCEPTED = 0
ARM, TAKE_OFF = 400, 22


def box_fence(half_m: float, ceiling_m: float) -> str:
    """The fence of a policy file."""
    return f"""
[[fence]]
name = "box"
kind = "box"
east_m = [-{half_m}, {half_m}]
north_m = [-{half_m}, {half_m}]
floor_up_m = 0.0
ceiling_up_m = {ceiling_m}
"""


def taken_off(flight: BridgedFlight, client: Client, up_m: float) -> None:
    """Armed and taken off by the client, hovering above home, under the gate's control."""
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    height_m = up_m
    if flight.personality == "px4":
        telemetry = flight.session.telemetry
        assert telemetry is not None
        assert telemetry.home is not None
        height_m = telemetry.home[2] + up_m
    assert client.ask(TAKE_OFF, 0, 0, 0, math.nan, math.nan, math.nan, height_m) == ACCEPTED
    for _ in range(40):
        flight.beating(1.0)
        if flight.is_in(State.HOVERING) and flight.session.gate.control is Control.OURS:
            return
    raise AssertionError(flight.told())


class BoxedStream:
    """A client that sends something each `period_s`, and a heartbeat a second."""

    def __init__(
        self,
        flight: BridgedFlight,
        client: Client,
        half_m: float,
        ceiling_m: float,
        period_s: float,
    ) -> None:
        self.flight, self.client, self.period_s = flight, client, period_s
        self.outside_m = -math.inf
        """How far outside the vehicle was at the most; negative: inside."""
        self._half_m, self._ceiling_m = half_m, ceiling_m
        self._count = 0

    def passes(self, seconds: float) -> None:
        """Time, with the client's heartbeats."""
        for _ in range(round(seconds / self.period_s)):
            if self._count % round(1.0 / self.period_s) == 0:
                self.client.beat()
            self._count += 1
            self.flight.run(self.period_s)
            east_m, north_m, up_m = self.flight.truth_enu()
            beside_m = max(abs(east_m), abs(north_m)) - self._half_m
            self.outside_m = max(self.outside_m, beside_m, up_m - self._ceiling_m, -up_m)
