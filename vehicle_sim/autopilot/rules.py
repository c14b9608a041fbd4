"""What PX4 and ArduCopter do differently, one field for each rule.

A rule stands here when the same code flies both and only a value, an answer or a yes or no is
different.  Where whole procedures differ there is a class for each, and the rule names the class.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality


@dataclass(frozen=True, slots=True)
class AutopilotRules:
    """`not_now` is the answer to what its own checks refuse.

    Where a field is the name of a parameter, None means that there is no such parameter, and that
    what it would bring about does not happen.
    """

    not_now: Result

    # The parts of the autopilot: battery, start, what is shown.
    idle_thrust: str | None  # the parameter with the thrust of idle motors, 0..1
    battery_monitor: str | None  # the parameter that, if 0, measures no battery
    battery_capacity: str  # the parameter with the capacity [mAh]
    charge_by_voltage: bool  # where the capacity is 0; else the battery counts as empty then
    origin_text: str  # what it says when local NED has its origin
    failures_allowed_by: str | None  # the parameter that, if 1, takes INJECT_FAILURE; None = always
    parameters_reset_at_once: bool  # else with the next reboot
    satellites: str | None  # the parameter with how many the receiver uses
    mav_type: str | None  # the parameter with HEARTBEAT's type; None = a quadrotor
    armed_is_active: bool  # MAV_STATE_ACTIVE from arming on, else from lifting off on

    # The parts of the autopilot: arming.
    tells_unready: bool  # what is against arming is told unasked (AP_Arming::update)
    arming_check_armed: Result  # the answer to RUN_PREARM_CHECKS while armed
    calibration_denies_arming: bool  # also forced arming
    arm_authorization: bool  # another system may be asked before arming (COM_ARM_AUTH_*)
    armed_text: str  # what it says when it is armed by a command
    disarmed_text: str  # what it says when it is disarmed by a command
    disarming_denied_text: str | None  # what it says when that is asked for in flight
    termination_lasts: bool  # until it is ended; else it is no more than a disarming
    mode_back_after_disarming: bool  # to the mode that the user chose (UserModeIntention)

    # The parts of the autopilot: modes.
    takes_unknown_main_modes: bool  # as recorded: changes nothing, and is accepted
    manual_modes_need_sticks: bool  # to be entered while armed
    flown_mission_becomes_hold: bool  # if its mode is entered in the air, after its end
    hold_ends_take_off: bool  # also before it has left the ground; else it climbs to its height
    mode_ends_roi: bool  # every mode begins with its own way to point
    guided_forgets_setpoints: bool  # those that came before the mode was entered
    tells_return: bool  # a STATUSTEXT for each leg of a return
    mode_switch: bool  # a radio channel chooses the mode (FLTMODE_CH)
    sticks_take_over: bool  # a moved stick ends an automatic flight (COM_RC_OVERRIDE)
    orbit_mode: bool  # DO_ORBIT is known
    take_off_mode: str | None  # the mode of NAV_TAKEOFF; None = it takes off in GUIDED
    take_off_in_flight: Result  # the answer to NAV_TAKEOFF in flight
    repositions_by_hold: bool  # DO_REPOSITION flies in the hold mode; else in GUIDED
    pauses: bool  # DO_PAUSE_CONTINUE is known
    changes_speed_on_ground: bool  # DO_CHANGE_SPEED; else in flight only

    # The parts of the autopilot: lifting off and landing.
    arming_delay_s: float  # ARMING_DELAY_SEC, by memory: the motors idle so long at first
    tells_land_detector: bool  # a STATUSTEXT for take-off and landing
    aligns_yaw_in_flight: bool  # once in each flight, and says so (EKF3)
    holds_after_task: bool  # enters its hold mode after a take-off and after a mission

    # The parts of the autopilot: the mission.
    checks_mission_feasible: bool  # within the fence, and begun near home
    mission_needs_take_off: bool  # for its mode to be entered on the ground, armed
    mission_waits_for_start: bool  # on the ground, for MISSION_START (AUTO_OPTIONS)
    mission_start_arms: bool  # MISSION_START does, and needs a mission that may be flown
    mission_return_changes_mode: bool  # RETURN_TO_LAUNCH as an item ends the mission mode
    tells_mission_take_off: bool  # a STATUSTEXT with its height
    tells_uploads: bool  # a STATUSTEXT for a mission or a fence that came
    no_mission_ends_mode: bool  # the mission was cleared: its mode ends, also while disarmed

    # The parts of the autopilot: fence and failsafes.
    fence_command: bool  # DO_FENCE_ENABLE is known
    goal_beyond_fence: Result  # the answer to a goal that the fence forbids
    tells_goal_beyond_fence: bool  # and flies there where GF_ACTION only warns
    setpoints_within_fence: bool  # setpoints with a goal beyond it are dropped
    fence_may_hold_mode: bool  # what a breach led to cannot be left (FENCE_OPTIONS)
    tells_manual_recovery: bool  # a STATUSTEXT for a mode change during a breach
    tells_lesser_failsafes: bool  # those that strike while a worse one is acted on
    mode_back_with_position: bool  # to the mode in which the position was lost


RULES: Final[dict[Personality, AutopilotRules]] = {
    "px4": AutopilotRules(
        not_now=Result.TEMPORARILY_REJECTED,
        # The parts of the autopilot: battery, start, what is shown.
        idle_thrust=None,
        battery_monitor=None,
        battery_capacity="BAT1_CAPACITY",
        charge_by_voltage=True,
        origin_text="GPS fix",
        failures_allowed_by="SYS_FAILURE_EN",
        parameters_reset_at_once=True,
        satellites="SIM_GPS_USED",
        mav_type="MAV_TYPE",
        armed_is_active=True,
        # The parts of the autopilot: arming.
        tells_unready=False,
        arming_check_armed=Result.ACCEPTED,
        calibration_denies_arming=True,
        arm_authorization=True,
        armed_text="Armed by external command",
        disarmed_text="Disarmed by external command",
        disarming_denied_text="Disarming denied! Not landed",
        termination_lasts=True,
        mode_back_after_disarming=True,
        # The parts of the autopilot: modes.
        takes_unknown_main_modes=True,
        manual_modes_need_sticks=True,
        flown_mission_becomes_hold=True,
        hold_ends_take_off=False,
        mode_ends_roi=False,
        guided_forgets_setpoints=False,
        tells_return=True,
        mode_switch=False,
        sticks_take_over=True,
        orbit_mode=True,
        take_off_mode="AUTO.TAKEOFF",
        take_off_in_flight=Result.ACCEPTED,
        repositions_by_hold=True,
        pauses=False,
        changes_speed_on_ground=True,
        # The parts of the autopilot: lifting off and landing.
        arming_delay_s=0.0,
        tells_land_detector=True,
        aligns_yaw_in_flight=False,
        holds_after_task=True,
        # The parts of the autopilot: the mission.
        checks_mission_feasible=True,
        mission_needs_take_off=False,
        mission_waits_for_start=False,
        mission_start_arms=True,
        mission_return_changes_mode=True,
        tells_mission_take_off=True,
        tells_uploads=False,
        no_mission_ends_mode=True,
        # The parts of the autopilot: fence and failsafes.
        fence_command=False,
        goal_beyond_fence=Result.ACCEPTED,
        tells_goal_beyond_fence=True,
        setpoints_within_fence=False,
        fence_may_hold_mode=False,
        tells_manual_recovery=False,
        tells_lesser_failsafes=False,
        mode_back_with_position=True,
    ),
    "ardupilot": AutopilotRules(
        not_now=Result.FAILED,
        # The parts of the autopilot: battery, start, what is shown.
        idle_thrust="MOT_SPIN_ARM",
        battery_monitor="BATT_MONITOR",
        battery_capacity="BATT_CAPACITY",
        charge_by_voltage=False,
        origin_text="EKF3 IMU0 origin set",
        failures_allowed_by=None,
        parameters_reset_at_once=False,
        satellites=None,
        mav_type=None,
        armed_is_active=False,
        # The parts of the autopilot: arming.
        tells_unready=True,
        arming_check_armed=Result.TEMPORARILY_REJECTED,
        calibration_denies_arming=False,
        arm_authorization=False,
        armed_text="Arming motors",
        disarmed_text="Disarming motors",
        disarming_denied_text=None,
        termination_lasts=False,
        mode_back_after_disarming=False,
        # The parts of the autopilot: modes.
        takes_unknown_main_modes=False,
        manual_modes_need_sticks=False,
        flown_mission_becomes_hold=False,
        hold_ends_take_off=True,
        mode_ends_roi=True,
        guided_forgets_setpoints=True,
        tells_return=False,
        mode_switch=True,
        sticks_take_over=False,
        orbit_mode=False,
        take_off_mode=None,
        take_off_in_flight=Result.FAILED,
        repositions_by_hold=False,
        pauses=True,
        changes_speed_on_ground=False,
        # The parts of the autopilot: lifting off and landing.
        arming_delay_s=2.0,
        tells_land_detector=False,
        aligns_yaw_in_flight=True,
        holds_after_task=False,
        # The parts of the autopilot: the mission.
        checks_mission_feasible=False,
        mission_needs_take_off=True,
        mission_waits_for_start=True,
        mission_start_arms=False,
        mission_return_changes_mode=False,
        tells_mission_take_off=False,
        tells_uploads=True,
        no_mission_ends_mode=False,
        # The parts of the autopilot: fence and failsafes.
        fence_command=True,
        goal_beyond_fence=Result.FAILED,
        tells_goal_beyond_fence=False,
        setpoints_within_fence=True,
        fence_may_hold_mode=True,
        tells_manual_recovery=True,
        tells_lesser_failsafes=True,
        mode_back_with_position=False,
    ),
}
