"""How parameters reach the control loops and the estimator: as fields of their blocks.

Kernels see numbers only; these are written anew whenever a parameter has changed.
"""

from __future__ import annotations

from math import radians, tan

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.control_loops.believed import Believed
from vehicle_sim.control_loops.cascade import tune
from vehicle_sim.control_loops.flight import Flight
from vehicle_sim.estimation.estimated import Estimated

_GAINS: dict[Personality, dict[str, str]] = {
    "px4": {
        "MC_ROLL_P": "kp_roll",
        "MC_PITCH_P": "kp_pitch",
        "MC_ROLLRATE_P": "kp_rate_roll",
        "MC_PITCHRATE_P": "kp_rate_pitch",
        "MC_YAWRATE_P": "kp_rate_yaw",
    },
    "ardupilot": {
        "PSC_POSXY_P": "kp_pos_xy",
        "PSC_POSZ_P": "kp_pos_z",
        "PSC_VELZ_P": "kp_vel_z",
        # ArduCopter learns the hover thrust in its acceleration loop.
        "PSC_ACCZ_I": "ki_vel_z",
        "ATC_ANG_RLL_P": "kp_roll",
        "ATC_ANG_PIT_P": "kp_pitch",
        "ATC_ANG_YAW_P": "kp_yaw",
        "ATC_RAT_RLL_P": "kp_rate_roll",
        "ATC_RAT_PIT_P": "kp_rate_pitch",
        "ATC_RAT_YAW_P": "kp_rate_yaw",
    },
}
"""Which designed gain each parameter scales: by value over default."""

_YAW_RATE_GAINS: dict[Personality, tuple[float, float]] = {
    "px4": (3.4, 0.5),
    "ardupilot": (6.0, 0.3),
}
"""Proportional [1/s] and integral over proportional gain [1/s].

PX4's are what fits the two recorded turns best (ATTITUDE in px4_step_responses.tlog from 68.4 s and
904.1 s on: acceleration by the error of 2.8 times the angle that is left, 3.38 and 3.35), and
MC_YAWRATE_I over MC_YAWRATE_P.
"""

_RATES: dict[Personality, dict[str, str]] = {
    "px4": {
        "MC_ROLLRATE_MAX": "roll_rate_max_rad_s",
        "MC_PITCHRATE_MAX": "pitch_rate_max_rad_s",
        "MC_YAWRATE_MAX": "yaw_rate_max_rad_s",
    },
    "ardupilot": {
        "ATC_RATE_R_MAX": "roll_rate_max_rad_s",
        "ATC_RATE_P_MAX": "pitch_rate_max_rad_s",
        "ATC_RATE_Y_MAX": "yaw_rate_max_rad_s",
    },
}
_BOUNDS: dict[Personality, dict[str, str]] = {
    "px4": {
        "MPC_XY_ERR_MAX": "lead_max_m",
        "MPC_XY_P": "kp_pos_xy",
        "MPC_Z_P": "kp_pos_z",
        "MPC_XY_VEL_P_ACC": "kp_vel_xy",
        "MPC_XY_VEL_I_ACC": "ki_vel_xy",
        "MPC_Z_VEL_P_ACC": "kp_vel_z",
        "MPC_Z_VEL_I_ACC": "ki_vel_z",
        "MC_YAW_P": "kp_yaw",
    },
    "ardupilot": {
        "PSC_VELXY_P": "kp_vel_xy",
        "PSC_VELXY_I": "ki_vel_xy",
    },
}
"""What a parameter says as it is; the designed bound where the autopilot has no such parameter."""
_LEAN: dict[Personality, tuple[str, float]] = {
    "px4": ("MPC_TILTMAX_AIR", 1.0),
    "ardupilot": ("ANGLE_MAX", 0.01),
}
"""The largest lean, and its factor to degrees."""
_LEAN_S: dict[Personality, str | None] = {"px4": None, "ardupilot": "ATC_INPUT_TC"}
"""The time constant at which a lean that is asked for is taken up, where one is."""
_NO_AID_US: dict[Personality, str | None] = {"px4": "EKF2_NOAID_TOUT", "ardupilot": None}
# PX4: MPC_THR_MIN and LNDMC_LOW_T_THR (0.3, by memory) of the way from it to MPC_THR_HOVER, with
# their defaults of 0.12 and 0.5.  ArduCopter's as the time from touch-down to disarming has it.
_LAND_SHARE: dict[Personality, float] = {"px4": (0.12 + 0.3 * (0.5 - 0.12)) / 0.5, "ardupilot": 0.7}
_TILT_MOST_DEG = 80.0  # beyond it no collective carries any vehicle


def write_gains(parameters: Parameters, flight: Flight, est: Estimated, believed: Believed) -> None:
    """Gains and bounds of one vehicle, from its airframe and its parameters."""
    get = parameters.get
    designed = Flight()
    tune(designed, believed)
    designed.kp_rate_yaw, flight.ki_rate_yaw = _YAW_RATE_GAINS[parameters.personality]
    lean_s = _LEAN_S[parameters.personality]
    if lean_s is not None and get(lean_s) > 0.0:
        most = 1.0 / get(lean_s)
        designed.kp_roll = min(designed.kp_roll, most)
        designed.kp_pitch = min(designed.kp_pitch, most)
    for name, field in _GAINS[parameters.personality].items():
        ratio = get(name) / parameters.designed(name)
        setattr(flight, field, ratio * getattr(designed, field))
    rules = parameters.rules
    for name, field in _RATES[parameters.personality].items():
        own = rules.rate_limit_may_be_zero or get(name) > 0.0
        setattr(flight, field, radians(get(name)) if own else getattr(designed, field))
    lean, to_deg = _LEAN[parameters.personality]
    lean_deg = to_deg * get(lean)
    flight.tilt_max = tan(radians(min(lean_deg, _TILT_MOST_DEG)))
    flight.land_share = _LAND_SHARE[parameters.personality]
    for name, field in _BOUNDS[parameters.personality].items():
        setattr(flight, field, get(name))
    # A derivative gain on the velocity takes back a part of every acceleration: it is as if the
    # vehicle were heavier (PositionControl's acc = P error + I - D dv/dt).
    heavier = 1.0 if rules.velocity_damping is None else 1.0 + get(rules.velocity_damping)
    flight.kp_vel_xy /= heavier
    flight.ki_vel_xy /= heavier
    no_aid_us = _NO_AID_US[parameters.personality]
    if no_aid_us is not None:
        est.no_aid_s = 1e-6 * get(no_aid_us)
