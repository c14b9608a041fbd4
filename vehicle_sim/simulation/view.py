"""What a 3-D viewer is sent: where each vehicle really is, and that it is alive.

HIL_STATE_QUATERNION at 50 Hz and HEARTBEAT at 1 Hz of wall time, in datagrams of their own to one
address, as PX4's simulators send them to its viewer Hawkeye.  Nothing is heard from there.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import sqrt
from typing import Final

from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.services.server import COMPONENT, VehicleServer
from vehicle_sim.services.units import (
    clip_int16,
    clip_uint16,
    degrees_e7,
    millimetres,
    usec,
)
from vehicle_sim.simulation.traffic import Peer, Transmit
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode

STATE_EVERY_NS: Final = 20_000_000
STATES_A_HEARTBEAT: Final = 50


def state_of(server: VehicleServer) -> m.HilStateQuaternion:
    """The truth; but accelerations are what the sensor reads, and the air is taken to stand."""
    vehicle = server.vehicle
    truth = vehicle.truth
    north, east, down = truth.v_ned
    speed_cm_s = clip_uint16(100.0 * sqrt(north * north + east * east + down * down))
    ax, ay, az = (clip_int16(each * 1000.0 / GRAVITY_M_S2) for each in vehicle.readings.accel_frd)
    return m.HilStateQuaternion(
        usec(vehicle),
        truth.q_ned_from_frd,
        *truth.rates_frd,
        lat=degrees_e7(truth.lat_deg),
        lon=degrees_e7(truth.lon_deg),
        alt=millimetres(truth.alt_amsl_m),
        vx=clip_int16(north * 100.0),
        vy=clip_int16(east * 100.0),
        vz=clip_int16(down * 100.0),
        ind_airspeed=speed_cm_s,
        true_airspeed=speed_cm_s,
        xacc=ax,
        yacc=ay,
        zacc=az,
    )


class View:
    """All vehicles of a world, for one viewer."""

    def __init__(
        self, servers: Sequence[VehicleServer], link: int, peer: Peer, speedup: Fraction
    ) -> None:
        """`link` is a number that no link of the vehicles has."""
        self._servers = tuple(servers)
        self._link: Final = link
        self._peer: Final = peer
        self._every_ns = int(STATE_EVERY_NS * max(Fraction(1), speedup))
        self._turn = 0
        self._sequences = [0] * len(self._servers)
        self.due_ns = 0
        """In simulated time."""

    def step(self, time_ns: int) -> list[Transmit]:
        """What is due by now; called when something is."""
        self.due_ns = time_ns - time_ns % self._every_ns + self._every_ns
        alive = self._turn % STATES_A_HEARTBEAT == 0
        self._turn += 1
        out: list[Transmit] = []
        for number, server in enumerate(self._servers):
            data = self._frame(number, server, state_of(server))
            if alive:
                data = self._frame(number, server, server.heartbeat()) + data
            out.append(Transmit(self._link, self._peer, data))
        return out

    def _frame(self, number: int, server: VehicleServer, message: m.Message) -> bytes:
        sequence = self._sequences[number]
        self._sequences[number] = (sequence + 1) & 0xFF
        return encode(message, sequence, server.system, COMPONENT)
