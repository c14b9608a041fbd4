"""Manual input: joystick and radio channels.

One named tuple a message, fields in wire order, values as MAVLink has them (units and frames are
the dialect's).
"""

from __future__ import annotations

from typing import NamedTuple


class RcChannels(NamedTuple):
    time_boot_ms: int
    chan1_raw: int
    chan2_raw: int
    chan3_raw: int
    chan4_raw: int
    chan5_raw: int
    chan6_raw: int
    chan7_raw: int
    chan8_raw: int
    chan9_raw: int
    chan10_raw: int
    chan11_raw: int
    chan12_raw: int
    chan13_raw: int
    chan14_raw: int
    chan15_raw: int
    chan16_raw: int
    chan17_raw: int
    chan18_raw: int
    chancount: int
    rssi: int


class RcChannelsRaw(NamedTuple):
    time_boot_ms: int
    chan1_raw: int
    chan2_raw: int
    chan3_raw: int
    chan4_raw: int
    chan5_raw: int
    chan6_raw: int
    chan7_raw: int
    chan8_raw: int
    port: int
    rssi: int


class ManualControl(NamedTuple):
    x: int
    y: int
    z: int
    r: int
    buttons: int
    target: int
    buttons2: int = 0
    enabled_extensions: int = 0
    s: int = 0
    t: int = 0
    aux1: int = 0
    aux2: int = 0
    aux3: int = 0
    aux4: int = 0
    aux5: int = 0
    aux6: int = 0


class RcChannelsOverride(NamedTuple):
    chan1_raw: int
    chan2_raw: int
    chan3_raw: int
    chan4_raw: int
    chan5_raw: int
    chan6_raw: int
    chan7_raw: int
    chan8_raw: int
    target_system: int
    target_component: int
    chan9_raw: int = 0
    chan10_raw: int = 0
    chan11_raw: int = 0
    chan12_raw: int = 0
    chan13_raw: int = 0
    chan14_raw: int = 0
    chan15_raw: int = 0
    chan16_raw: int = 0
    chan17_raw: int = 0
    chan18_raw: int = 0
