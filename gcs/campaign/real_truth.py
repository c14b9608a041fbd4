"""Where a real autopilot's own simulation has the vehicle, read from the messages that tell it.

HIL_STATE_QUATERNION of PX4's SIH and SIM_STATE of ArduCopter's SITL say what really is;
SYSTEM_TIME how far the vehicle's clock has come, and BATTERY_STATUS what was drawn, where the
simulation has an ammeter at all: PX4's has none.
"""

from __future__ import annotations

from gcs.campaign.simulators import Truth
from gcs.frames import Vec3
from gcs.gate.airspace.projection import Origin, Projection
from gcs.wire.codec import decode
from gcs.wire.fields import FieldValue, fields_of
from gcs.wire.frame import Frame
from gcs.wire.ids import Sensor
from gcs.wire.messages import BatteryStatus, Heartbeat, SysStatus

HERTZ = {
    "HEARTBEAT": 10.0,
    "SYS_STATUS": 2.0,
    "SYSTEM_TIME": 2.0,
    "BATTERY_STATUS": 5.0,
    "SIM_STATE": 50.0,
    "HIL_STATE_QUATERNION": 50.0,
}
"""The messages that are asked for, and how often."""
ON_GROUND_M = 0.1
"""Nearer to the height of its start it stands on the ground, which is flat in both simulations."""
JOULES_PER_VOLT_MAH = 3.6
NO_CELL_MV = 0xFFFF


class RealTruth:
    """Takes the frames of any of the vehicle's links."""

    def __init__(self, autopilot: str) -> None:
        self._autopilot = autopilot
        self._map: Projection | None = None
        self._pos_ned = self._v_ned = (0.0, 0.0, 0.0)
        self._armed = False
        self._drawn_mah: int | None = None
        self._energy_j: float | None = None
        """None while nothing is seen to be drawn: PX4's simulation tells 0 throughout."""
        self.ready = False
        """Whether the autopilot says that it can be armed."""
        self.clock_ms = 0
        """The vehicle's own, since its start; 0 before it was told."""
        self.parameters: dict[str, float] = {}

    @property
    def known(self) -> bool:
        return self._map is not None

    def take(self, frame: Frame) -> None:
        if frame.compid != 1:
            return
        match decode(frame):
            case Heartbeat(base_mode=mode):
                self._armed = bool(mode & 128)
            case SysStatus(onboard_control_sensors_health=health):
                self.ready = bool(health & Sensor.PREARM_CHECK)
            case BatteryStatus() as battery:
                self._draw(battery)
            case _:
                self._other(frame.name, fields_of(frame))

    def truth(self) -> Truth:
        """What was told last."""
        assert self._map is not None
        origin = self._map.origin
        home = origin.lat_deg, origin.lon_deg, origin.alt_amsl_m
        landed = -self._pos_ned[2] < ON_GROUND_M
        return Truth(self._pos_ned, self._v_ned, home, self._armed, landed, self._energy_j)

    def _other(self, name: str, fields: dict[str, FieldValue]) -> None:
        def number(key: str) -> float:
            value = fields[key]
            assert isinstance(value, int | float)
            return float(value)

        if name == "SYSTEM_TIME":
            self.clock_ms = int(number("time_boot_ms"))
        elif name == "PARAM_VALUE":
            self.parameters[str(fields["param_id"])] = number("param_value")
        elif name == "HIL_STATE_QUATERNION":
            place = number("lat") / 1e7, number("lon") / 1e7, number("alt") / 1e3
            self._is_at(place, (number("vx") / 100, number("vy") / 100, number("vz") / 100))
        elif name == "SIM_STATE":
            place = number("lat_int") / 1e7, number("lon_int") / 1e7, number("alt")
            self._is_at(place, (number("vn"), number("ve"), number("vd")))

    def _is_at(self, place: Vec3, v_ned: Vec3) -> None:
        if self._map is None:
            self._map = Projection(Origin(*place), self._autopilot)
        self._pos_ned, self._v_ned = self._map.ned_from_geodetic(*place), v_ned

    def _draw(self, battery: BatteryStatus) -> None:
        cells_mv = [each for each in battery.voltages if each != NO_CELL_MV]
        if battery.current_consumed < 0 or not cells_mv:
            return
        if self._drawn_mah is not None and battery.current_consumed > self._drawn_mah:
            drawn_mah = battery.current_consumed - self._drawn_mah
            energy_j = JOULES_PER_VOLT_MAH * drawn_mah * sum(cells_mv) / 1000
            self._energy_j = (self._energy_j or 0.0) + energy_j
        self._drawn_mah = battery.current_consumed
