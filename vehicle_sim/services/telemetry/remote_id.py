"""Builders of remote identification, as PX4 1.14 fills it: vehicle and operator, where they are."""

from __future__ import annotations

import math
from typing import Final

from vehicle_sim.autopilot.interface import Landed, Vehicle
from vehicle_sim.services.units import clip_int16, clip_uint16, degrees_e7, usec
from vehicle_sim.wire import messages as m

NO_TIMESTAMP: Final = 65535.0
ON_GROUND: Final = 1  # MAV_ODID_STATUS
AIRBORNE: Final = 2
OVER_TAKEOFF: Final = 0  # MAV_ODID_HEIGHT_REF
WITHIN_1_M: Final = 12  # MAV_ODID_HOR_ACC
WITHIN_3_M: Final = 5  # MAV_ODID_VER_ACC
WITHIN_150_M: Final = 1
WITHIN_1_M_S: Final = 3  # MAV_ODID_SPEED_ACC
NO_AREA_M: Final = -1000.0
EPOCH_2019_S: Final = 1_546_300_800
"""What OPEN_DRONE_ID_SYSTEM counts from, in Unix time."""


def open_drone_id_location(vehicle: Vehicle) -> m.OpenDroneIdLocation | None:
    if vehicle.origin is None:
        return None
    estimate = vehicle.estimate
    north, east, down = estimate.v_ned
    flying = vehicle.landed is not Landed.ON_GROUND
    return m.OpenDroneIdLocation(
        latitude=degrees_e7(estimate.lat_deg),
        longitude=degrees_e7(estimate.lon_deg),
        altitude_barometric=vehicle.readings.pressure_alt_amsl_m,
        altitude_geodetic=estimate.alt_amsl_m,
        height=estimate.alt_rel_m,
        timestamp=NO_TIMESTAMP,
        direction=round(math.degrees(math.atan2(east, north)) * 100.0) % 36000,
        speed_horizontal=clip_uint16(100.0 * math.hypot(north, east)),
        speed_vertical=clip_int16(-100.0 * down),
        target_system=0,
        target_component=0,
        id_or_mac=b"",
        status=AIRBORNE if flying else ON_GROUND,
        height_reference=OVER_TAKEOFF,
        horizontal_accuracy=WITHIN_1_M,
        vertical_accuracy=WITHIN_3_M,
        barometer_accuracy=WITHIN_150_M,
        speed_accuracy=WITHIN_1_M_S,
        timestamp_accuracy=0,
    )


def open_drone_id_system(vehicle: Vehicle, unix_start_ns: int) -> m.OpenDroneIdSystem | None:
    """The operator stands where the vehicle took off."""
    home = vehicle.home
    if home is None:
        return None
    now_s = unix_start_ns // 1_000_000_000 + usec(vehicle) // 1_000_000
    return m.OpenDroneIdSystem(
        operator_latitude=degrees_e7(home.lat_deg),
        operator_longitude=degrees_e7(home.lon_deg),
        area_ceiling=NO_AREA_M,
        area_floor=NO_AREA_M,
        operator_altitude_geo=home.alt_amsl_m,
        timestamp=max(0, now_s - EPOCH_2019_S),
        area_count=1,
        area_radius=0,
        target_system=0,
        target_component=0,
        id_or_mac=b"",
        operator_location_type=0,
        classification_type=0,
        category_eu=0,
        class_eu=0,
    )
