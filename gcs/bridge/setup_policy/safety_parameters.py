"""The parameters that safety stands on, by autopilot: groups of names, each with the reason.

What is in no group here and not in `free_parameters.py` either is guarded too: nobody has looked at
it.

In a name `*` stands for any letters.  Names are those of the recorded lists of a PX4 1.14.3 and an
ArduCopter 4.7-dev, of ArduCopter 4.5 where 4.7 renamed them, and, from memory, of what these
firmwares have on other boards (`SER_*`, `UAVCAN_*`, `EK2_*` ...).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

NAME: Final = re.compile(r"[A-Za-z0-9_]{1,16}")
"""What a parameter can be called."""


def pattern_of(patterns: Iterable[str]) -> re.Pattern[str]:
    """One that matches every name of `patterns`, in any case of letters: ArduPilot finds its
    parameters so (from memory)."""
    alternatives = "|".join(re.escape(each).replace(r"\*", "[A-Z0-9_]*") for each in patterns)
    return re.compile(alternatives or r"(?!)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Group:
    """Parameters that are guarded for one reason.

    `why` continues "NAME is guarded: ".  `set_by_people`: the vehicle never changes them by
    itself, so a change is somebody's.
    """

    why: str
    names: re.Pattern[str]
    set_by_people: bool


def _group(why: str, names: str, *, learned: bool = False) -> Group:
    return Group(why, pattern_of(names.split()), not learned)


_FENCE: Final = "it is of the vehicle's own fence"
_FAILSAFE: Final = "it says what the vehicle does when a link, the sticks or the battery fail"
_ARMING: Final = "it says what the vehicle checks before it arms, and when it stops its motors"
_PILOT: Final = "it says how the pilot's sticks and switches are read, who outranks everybody"
_RETURN: Final = "returns, landings and missions are verified with it"
_MOTION: Final = "how fast the vehicle flies and how far it takes to stop stand on it"
_ESTIMATOR: Final = "the vehicle finds its position by it"
_OUTPUTS: Final = "it says what is connected to the autopilot and what drives the motors"
_LINKS: Final = "it says whom the vehicle listens to, and how much it sends on a link"
_OTHER_VEHICLES: Final = "planes, VTOLs, helicopters or rovers fly by it"
_SIMULATED: Final = "it changes what a simulated vehicle senses and how it flies"

PX4: Final = (
    _group(_FENCE, "GF_*"),
    _group(
        _FAILSAFE,
        "NAV_DLL_ACT NAV_RCL_ACT NAV_TRAFF_* COM_*_LOSS_T COM_HLDL_REG_T COM_OBL_* COM_LOW_BAT_ACT"
        " COM_ACT_FAIL_ACT COM_FAIL_ACT_T COM_IMB_PROP_ACT COM_QC_ACT COM_POSCTL_NAVL COM_RCL_*"
        " COM_POS_* COM_VEL_FS_* COM_WIND_* COM_FLT_TIME_MAX COM_PARACHUTE COM_LKDOWN_TKO"
        " COM_OBS_AVOID COM_TAKEOFF_ACT COM_DLL_* COM_MODE* COM_SPOOLUP_TIME FD_* BAT*",
    ),
    _group(
        _ARMING,
        "COM_ARM_* COM_ARMABLE COM_PREARM_MODE COM_DISARM_* COM_KILL_DISARM COM_FORCE_SAFETY"
        " COM_MOT_TEST_EN COM_CPU_MAX COM_RAM_MAX COM_POWER_COUNT COM_REARM_GRACE COM_THROW_* MAN_*"
        " CBRK_*",
    ),
    _group(_PILOT, "COM_RC_* COM_FLTMODE* RC*"),
    _group(
        _RETURN,
        "RTL_* NAV_* MIS_* PLD_* FLW_TGT_* MPC_LAND_* MPC_TKO_* COM_HOME_* MC_ORBIT_RAD_MAX",
    ),
    _group(_MOTION, "MPC_* MC_* CP_* WV_* THR_MDL_FAC TRIM_*"),
    _group(
        _ESTIMATOR,
        "EKF2_* ATT_* LPE_* SENS_* CAL_* IMU_* GPS_* HTE_* LND_* LNDMC_* TC_* BARO_* MAG_*",
        learned=True,
    ),
    _group(
        _OUTPUTS,
        "CA_* PWM_* MOT_* DSHOT_* SYS_* UAVCAN_* CYPHAL_* HIL_* PD_* TRIG_PINS* TRIG_PWM_*"
        " TRIG_INTERFACE MNT_MODE_OUT",
    ),
    _group(_LINKS, "MAV_* SER_* UXRCE_* XRCE_* RTPS_* ZENOH_*"),
    _group(_OTHER_VEHICLES, "FW_* VT_* VTO_* GND_* ASPD_* NPFG_* RWTO_* UUV_*"),
    _group(_SIMULATED, "SIM_* SIH_*"),
)

ARDUCOPTER: Final = (
    _group(_FENCE, "FENCE_* AVOID_* AVD_* OA_*"),
    _group(
        _FAILSAFE,
        "FS_* BATT* GUID_* RC_FS_* CHUTE_* DISARM_DELAY GCS_PID_MASK FLIGHT_OPTIONS DEV_OPTIONS"
        " ADSB_* AFS_*",
    ),
    _group(_ARMING, "ARMING_* BRD_* BTN_* INITIAL_MODE LAND_REPOSITION"),
    _group(
        # A screen of parameters (OSD5_PARAM1_KEY ...) is one that the sticks change.
        _PILOT,
        "RC* FLTMODE* SIMPLE SUPER_SIMPLE PILOT_* PHLD_* THR_DZ TUNE* AUTOTUNE_* TMODE_*"
        " OSD*_PARAM*",
    ),
    _group(
        _RETURN,
        "RTL_* SRTL_* LAND_* RALLY_* MIS_* AUTO_* TERRAIN_* CIRCLE_* WP_* WPNAV_* PLND_* FOLL_*"
        " THROW_* ZIGZ_* TKOFF_* SURFTRAK_*",
    ),
    _group(_MOTION, "LOIT_* PSC_* ATC_* ACRO_* ANGLE_MAX WVANE_* SID_* FHLD_* CUST_ROT_* QUIK_*"),
    _group(
        _ESTIMATOR,
        "EK2_* EK3_* AHRS_* COMPASS_* GPS* INS_* BARO* VISO_* BCN_* FLOW_* RNGFND* PRX* EARTH_*"
        " ARSPD* TCAL_* EAHRS_* FILT* FFT_* GND_EFFECT_*",
        learned=True,
    ),
    _group(
        _OUTPUTS,
        "SERVO* RELAY* FRAME_* SCHED_* FSTRATE_* SCR_* CAN_* ESC_* DID_* FORMAT_VERSION"
        " KDE_* CC_* PLDP_* EFI_* GEN_* GRIP_* LGR_* RPM* RSSI_* SPRAY_* TEMP* WINCH_* VTX_*"
        " NTF_BUZZ_PIN CAM*_TYPE CAM*_RELAY* CAM*_SERVO* CAM*_FEEDBAK* MNT*_TYPE",
    ),
    _group(_OUTPUTS, "MOT_*", learned=True),
    _group(
        _LINKS, "SYSID_* MAV* SERIAL* NET_* DDS_* TELEM_* SR* FRSKY_* LOG_BACKEND_TYPE LOG_MAV_*"
    ),
    _group(_OTHER_VEHICLES, "H_* IM_*"),
    _group(_SIMULATED, "SIM_*"),
)

BY_AUTOPILOT: Final[Mapping[str, tuple[Group, ...]]] = MappingProxyType(
    {"px4": PX4, "ardupilot": ARDUCOPTER}
)


def groups_of(autopilot: str) -> tuple[Group, ...]:
    """The autopilot's own; for one that is not known, every group."""
    return BY_AUTOPILOT.get(autopilot, (*PX4, *ARDUCOPTER))


def group_of(autopilot: str, name: str) -> Group | None:
    """The group that guards the parameter; None where none does."""
    return next((each for each in groups_of(autopilot) if each.names.fullmatch(name)), None)
