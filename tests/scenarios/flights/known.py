"""In what our flights are known to differ from the recorded ones, and how each is judged.

A test fails where a difference comes that is not listed, and where a listed one is gone.
"""

from __future__ import annotations

from typing import Final

from vehicle_sim.autopilot.modes import Personality

SILENT: Final = (
    "the recorder had not spoken yet; from memory ArduPilot tells texts to who has, alone"
)
NO_SENSOR: Final = "of a sensor, a terrain or a simulator that this vehicle does not have"
LOGGER: Final = "the scenarios have it at every arming, this recording not at its only one"
PERIODIC: Final = "what is against arming is told every 30 s; in another second here"
VTOL: Final = "NAV_VTOL_TAKEOFF: a mode that is not flown here; ours is asked to hold, and to land"
TAKE_OFF_AGAIN: Final = "to mend: a take-off in the air, to a height below, climbs MIS_TAKEOFF_ALT"
LATER_DOWN: Final = "ours had not come down after OFFBOARD: it lands from 5 m, not from 1.5 m"
SETPOINTS: Final = "PX4's OFFBOARD steps are smoothed here: a known gap"
SLOW_START: Final = "to mend: PX4 leaves the ground 1.6 to 1.9 s after arming, ours after 1.2 s"
NOT_BUILT: Final = "not built here"
STANDING: Final = "its velocity estimate drifted while it stood"
INJECTED: Final = "on purpose: failures can be injected without a simulator's parameters"
OWN_NAME: Final = "on purpose: ours says what it is and how it is built"
UNASKED: Final = (
    "to mend: parameters that the vehicle itself changes are not told unasked (MIS_TOTAL)"
)

PX4: Final[dict[str, str]] = {
    "text '[logger] ./log/<date>.ulg': ours only": LOGGER,
    "base_mode 29: ours 17": VTOL,
    "base_mode 29 lasts: ours then 17 and 29": VTOL,
    "ack of 512 of message 395: ACCEPTED, ours DENIED": NOT_BUILT,
    "ack of 84: ACCEPTED, ours UNSUPPORTED": VTOL,
    "ack of 176: none, ours ACCEPTED": VTOL,
    "ack of 245: ACCEPTED, ours TEMPORARILY_REJECTED": LATER_DOWN,
    "ack of 420: none, ours ACCEPTED": INJECTED,
    "mode AUTO.VTOL_TAKEOFF: ours ORBIT": VTOL,
    "mode AUTO.VTOL_TAKEOFF lasts: ours then ORBIT": VTOL,
    "mode AUTO.VTOL_TAKEOFF: ours ORBIT and AUTO.LAND": VTOL,
    "mode AUTO.VTOL_TAKEOFF lasts: ours then AUTO.LAND and AUTO.LOITER": VTOL,
    "mode AUTO.TAKEOFF lasts: ours then AUTO.TAKEOFF and AUTO.LOITER": SLOW_START,
    "mode AUTO.TAKEOFF: ours AUTO.LOITER": TAKE_OFF_AGAIN,
    "armed False: ours True": LATER_DOWN,
    "armed False lasts: ours then True and False": LATER_DOWN,
    "system_status 3: ours 4": LATER_DOWN,
    "system_status 3 lasts: ours then 4 and 3": LATER_DOWN,
    "landed ON_GROUND: ours LANDING": LATER_DOWN,
    "text 'Preflight Fail: horizontal velocity unstable': ours never": STANDING,
    "text 'Using minimum takeoff altitude: 2.50 m': ours never": TAKE_OFF_AGAIN,
    "text 'Landing detected': ours later": LATER_DOWN,
    "text 'Disarmed by landing': ours later": LATER_DOWN,
    "kind TIME_ESTIMATE_TO_TARGET: the real one only": "not sent here: a known gap",
    "kind LINK_NODE_STATUS: the real one only": "not sent here: a known gap",
    "kind DISTANCE_SENSOR: the real one only": NO_SENSOR,
    "kind COMPONENT_INFORMATION: the real one only": NOT_BUILT,
    "first UTM_GLOBAL_POSITION: ours later": "every 2 s on a grid: at 8.1 s; PX4's at once, at 6.5",
    "first STATUSTEXT: ours later": STANDING,
    "rate intervals set, ORBIT_EXECUTION_STATUS: ours more": VTOL,
    "figure: take-off sent to TAKEOFF": SLOW_START,
    "figure: take-off sent to IN_AIR": SLOW_START,
    "figure: take-off again, fastest climb": TAKE_OFF_AGAIN,
    "figure: take-off again, height kept": TAKE_OFF_AGAIN,
    "figure: OFFBOARD, fastest across": SETPOINTS,
    "figure: OFFBOARD, fastest descent": TAKE_OFF_AGAIN,
    "figure: orbit, speed": "not recorded which was asked for; ours: 1 m/s",
}

ARDUPILOT: Final[dict[str, str]] = {
    "text 'PreArm: Need Position Estimate': ours only": PERIODIC,
    "ack of 512 of message 116: ACCEPTED, ours FAILED": NO_SENSOR,
    "ack of 512 of message 178: ACCEPTED, ours FAILED": NOT_BUILT,
    "ack of 512 of message 163: ACCEPTED, ours FAILED": NOT_BUILT,
    "ack of 512 of message 136: ACCEPTED, ours FAILED": NO_SENSOR,
    "ack of 420: UNSUPPORTED, ours ACCEPTED": INJECTED,
    "text '3d1219c7c4c5404aaa1f6d2a48adfda4': ours never": OWN_NAME,
    "text 'Frame: QUAD/PLUS': ours never": OWN_NAME,
    "text 'vehicle-sim': ours only": OWN_NAME,
    "text 'Frame: QUAD/X': ours only": OWN_NAME,
    "text 'SIM Hit ground at 2.447183 m/s': ours never": NO_SENSOR,
    **dict.fromkeys(
        (
            "text 'Barometer 1 calibration complete': ours only",
            "text 'Barometer 2 calibration complete': ours only",
            "text 'ArduPilot Ready': ours only",
            "text 'AHRS: DCM active': ours only",
            "text 'RC7: SaveWaypoint LOW': ours only",
            "text 'EKF3 IMU0 initialised': ours only",
            "text 'EKF3 IMU1 initialised': ours only",
            "text 'AHRS: EKF3 active': ours only",
            "text 'EKF3 IMU0 tilt alignment complete': ours only",
            "text 'EKF3 IMU1 tilt alignment complete': ours only",
            "text 'EKF3 IMU0 MAG0 initial yaw alignment complete': ours only",
            "text 'EKF3 IMU1 MAG0 initial yaw alignment complete': ours only",
            "text 'GPS 1: probing for u-blox at 230400 baud': ours only",
            "text 'GPS 1: detected u-blox': ours only",
            "first STATUSTEXT: ours sooner",
        ),
        SILENT,
    ),
    "kind ATTITUDE_TARGET: the real one only": "asked for once, disarmed: ours has no target then",
    **dict.fromkeys(
        (
            f"kind {name}: the real one only"
            for name in (
                *("SCALED_IMU2", "SCALED_IMU3", "SCALED_PRESSURE2"),
                *("TERRAIN_REPORT", "TERRAIN_REQUEST", "SIMSTATE"),
            )
        ),
        NO_SENSOR,
    ),
    "kind AHRS: the real one only": NOT_BUILT,
    "kind AHRS2: the real one only": NOT_BUILT,
    "kind ESC_TELEMETRY_1_TO_4: the real one only": NOT_BUILT,
    "first PARAM_VALUE: ours later": UNASKED,
    "first FENCE_STATUS: ours later": "chance: enabled for 0.16 s, told every 0.25 s",
    "rate descent, HEARTBEAT: ours more": "the recording lacks the one of 118 s",
}

KNOWN: Final[dict[Personality, dict[str, str]]] = {"px4": PX4, "ardupilot": ARDUPILOT}
