"""What the autopilots' parameters say as delivered, for a plan that is checked without a vehicle.

Source: the full parameter lists of PX4 1.14.3 and ArduCopter 4.7.
"""

from __future__ import annotations

from gcs.plan.legs import FlightSettings
from gcs.plan.model import AutopilotName

USUAL: dict[AutopilotName, FlightSettings] = {
    "px4": FlightSettings(
        accept_m=2.0,
        accept_up_m=0.8,
        first_climb_m=2.5,
        return_low_within_m=10.0,
        speed_m_s=5.0,
        accel_m_s2=3.0,
        climb_m_s=1.5,
        descend_m_s=1.5,
        land_m_s=0.7,
        return_waits_s=0.0,
    ),
    "ardupilot": FlightSettings(
        accept_m=2.0,
        return_low_within_m=5.0,
        speed_m_s=10.0,
        accel_m_s2=2.5,
        climb_m_s=2.5,
        descend_m_s=1.5,
        land_m_s=0.5,
        return_waits_s=5.0,
    ),
}
