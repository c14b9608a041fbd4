"""How well it flies, and on what: navigation, heights, air, board.

One named tuple a message, fields in wire order, values as MAVLink has them (units and frames are
the dialect's).
"""

from __future__ import annotations

from typing import NamedTuple


class NavControllerOutput(NamedTuple):
    nav_roll: float
    nav_pitch: float
    alt_error: float
    aspd_error: float
    xtrack_error: float
    nav_bearing: int
    target_bearing: int
    wp_dist: int


class PowerStatus(NamedTuple):
    Vcc: int
    Vservo: int
    flags: int


class Altitude(NamedTuple):
    time_usec: int
    altitude_monotonic: float
    altitude_amsl: float
    altitude_local: float
    altitude_relative: float
    altitude_terrain: float
    bottom_clearance: float


class Meminfo(NamedTuple):
    brkval: int
    freemem: int
    freemem32: int = 0


class Hwstatus(NamedTuple):
    Vcc: int
    I2Cerr: int


class Wind(NamedTuple):
    direction: float
    speed: float
    speed_z: float


class WindCov(NamedTuple):
    time_usec: int
    wind_x: float
    wind_y: float
    wind_z: float
    var_horiz: float
    var_vert: float
    wind_alt: float
    horiz_accuracy: float
    vert_accuracy: float


class Vibration(NamedTuple):
    time_usec: int
    vibration_x: float
    vibration_y: float
    vibration_z: float
    clipping_0: int
    clipping_1: int
    clipping_2: int


class AvailableModesMonitor(NamedTuple):
    seq: int
