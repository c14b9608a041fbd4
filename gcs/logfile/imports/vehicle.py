"""What one vehicle says in an old log, as the items that a session would report of it.

The derived topics of a record are made of these (`gcs/record/derived.py`), so that the same layouts
show any flight.  Only what was reported is told: where no LOCAL_POSITION_NED comes, the pose is
the global position about the first one, with the height above home.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field

from gcs.frames import Vec3, quat_from_euler
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.states import LandedState
from gcs.protocol.autopilot import GENERIC, PX4, Autopilot, mode_of
from gcs.report import (
    GeodeticItem,
    LogEvent,
    ParamItem,
    PoseItem,
    Quat,
    RecordItem,
    StatusItem,
)
from gcs.wire.ids import ModeFlag

STATUS_PERIOD_NS = 1_000_000_000
LOCAL_PATIENCE_NS = 2_000_000_000
"""After so long without a local position the global one is taken in its place."""

_INTEGER_CODES = {1: "B", 2: "b", 3: "H", 4: "h", 5: "I", 6: "i"}
"""MAV_PARAM_TYPE -> `struct` code, of those that PX4 puts byte by byte into the float."""
_SIZES = {"B": 1, "b": 1, "H": 2, "h": 2, "I": 4, "i": 4}
LEVEL_OF_SEVERITY = (5, 4, 4, 4, 3, 2, 2, 1)
"""MAV_SEVERITY -> LogEvent.level, as `gcs/vehicle/talk/vehicle_texts.py` has it for a flight."""


@dataclass(slots=True)
class ReportedVehicle:
    """One vehicle; each method takes what it said, and gives what is to be recorded of it."""

    sysid: int
    autopilot: Autopilot = GENERIC
    armed: bool = False
    mode: str = ""
    landed: LandedState = LandedState.UNDEFINED
    battery_pct: float | None = None
    battery_v: float | None = None
    q_ned_from_frd: Quat = (1.0, 0.0, 0.0, 0.0)
    rx_hz: float = 0.0
    lost_pct: float = 0.0
    heard: bool = False
    """A heartbeat, or what stands for it, was there: there is a status to tell."""
    _origin: Origin | None = None
    _local_ns: int = -LOCAL_PATIENCE_NS
    _status_ns: int = -STATUS_PERIOD_NS
    _texts: dict[int, list[str]] = field(default_factory=dict)

    def heartbeat(self, autopilot: Autopilot, base_mode: int, custom_mode: int) -> None:
        self.heard = True
        self.autopilot = autopilot
        self.armed = bool(base_mode & ModeFlag.SAFETY_ARMED)
        self.mode = mode_of(autopilot, base_mode, custom_mode).name

    def landed_state(self, value: int) -> None:
        """EXTENDED_SYS_STATE.landed_state."""
        try:
            self.landed = LandedState(value)
        except ValueError:
            self.landed = LandedState.UNDEFINED

    def attitude(self, roll_rad: float, pitch_rad: float, yaw_rad: float) -> None:
        if all(map(math.isfinite, (roll_rad, pitch_rad, yaw_rad))):
            self.q_ned_from_frd = quat_from_euler(roll_rad, pitch_rad, yaw_rad)

    def origin(self, lat_deg: float, lon_deg: float, alt_amsl_m: float) -> None:
        self._origin = Origin(lat_deg, lon_deg, alt_amsl_m)

    def local_position(self, pos_ned: Vec3, v_ned: Vec3, now_ns: int) -> Iterator[RecordItem]:
        if all(map(math.isfinite, (*pos_ned, *v_ned))):
            self._local_ns = now_ns
            yield PoseItem(self.sysid, pos_ned, v_ned, self.q_ned_from_frd)

    def global_position(
        self, fix: tuple[float, float, float, float], v_ned: Vec3, now_ns: int
    ) -> Iterator[RecordItem]:
        """`fix`: degrees, degrees, metres above mean sea level and above home."""
        lat_deg, lon_deg, _, alt_rel_m = fix
        if not all(map(math.isfinite, (*fix, *v_ned))) or (lat_deg, lon_deg) == (0.0, 0.0):
            # Before their first fix autopilots tell 0, 0.
            return
        yield GeodeticItem(self.sysid, *fix)
        if now_ns - self._local_ns < LOCAL_PATIENCE_NS:
            return
        if self._origin is None:
            self._origin = Origin(lat_deg, lon_deg, fix[2] - alt_rel_m)
        place = Projection(self._origin, self.autopilot.name).north_east(lat_deg, lon_deg)
        yield PoseItem(self.sysid, (*place, -alt_rel_m), v_ned, self.q_ned_from_frd)

    def battery(self, volts: float | None, percent: float | None) -> None:
        """None: not told."""
        self.battery_v = self.battery_v if volts is None else volts
        self.battery_pct = self.battery_pct if percent is None else percent

    def parameter(self, name: str, value: float, param_type: int) -> Iterator[RecordItem]:
        """PARAM_VALUE; `param_type` is MAV_PARAM_TYPE."""
        code = _INTEGER_CODES.get(param_type) if self.autopilot.name == PX4.name else None
        if code is not None:
            raw = struct.pack("<f", value)
            value = float(struct.unpack("<" + code, raw[: _SIZES[code]])[0])
        if math.isfinite(value):
            yield ParamItem(self.sysid, name, value)

    def text(
        self, severity: int, text: str, number: int, chunk: int, now_ns: int
    ) -> Iterator[RecordItem]:
        """STATUSTEXT; `number` and `chunk` are its id and chunk_seq."""
        if number:
            if chunk == 0:
                self._texts[number] = []
            self._texts.setdefault(number, []).append(text)
            if len(text) >= 50:
                return
            text = "".join(self._texts.pop(number))
        if text.strip():
            level = LEVEL_OF_SEVERITY[severity & 7]
            yield LogEvent(now_ns, level, "vehicle", text.strip())

    def status_is_due(self, now_ns: int) -> bool:
        return self.heard and now_ns - self._status_ns >= STATUS_PERIOD_NS

    def status(self, now_ns: int) -> StatusItem:
        self._status_ns = now_ns
        return StatusItem(
            self.sysid,
            self.armed,
            self.mode,
            self.landed.name,
            self.battery_pct,
            self.battery_v,
            self.rx_hz,
            self.lost_pct,
        )
