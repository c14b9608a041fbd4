"""What PX4 and ArduCopter do differently, one line for each rule.

A rule stands here when the same code flies both and only a value, an answer or a yes or no is
different.  Where whole procedures differ there is a function or a class for each of the two, in a
dictionary by personality beside them.
"""
# ruff: noqa: RUF009  # `each` builds nothing that a later instance could change

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.personality_table import COPTER_ONLY, PX4_ONLY, each, tables
from vehicle_sim.control_loops.trajectory import Law


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AutopilotRules:
    """`not_now` is the answer to what its own checks refuse.

    A value LIKE_THIS is the name of the parameter that says it.  None instead of a name means that
    there is no such parameter, and, if nothing else is said, that what it would bring about does
    not happen.
    """

    not_now: Result = each(Result.TEMPORARILY_REJECTED, Result.FAILED)

    # The parts of the autopilot: battery, start, what is shown.
    idle_thrust: str | None = each(None, "MOT_SPIN_ARM")  # of idle motors, 0..1
    battery_monitor: str | None = each(None, "BATT_MONITOR")  # if 0, no battery is measured
    battery_capacity: str = each("BAT1_CAPACITY", "BATT_CAPACITY")  # [mAh]
    charge_by_voltage: bool = PX4_ONLY  # where the capacity is 0; else it counts as empty then
    origin_text: str = each("GPS fix", "EKF3 IMU0 origin set")  # said when local NED has its origin
    failures_allowed_by: str | None = each("SYS_FAILURE_EN", None)  # 1 = they are; None = always
    parameters_reset_at_once: bool = PX4_ONLY  # else with the next reboot
    satellites: str | None = each("SIM_GPS_USED", None)  # how many the receiver uses
    mav_type: str | None = each("MAV_TYPE", None)  # HEARTBEAT's type; None = a quadrotor
    armed_is_active: bool = PX4_ONLY  # MAV_STATE_ACTIVE from arming on, else from lifting off on

    # The parts of the autopilot: arming.
    tells_unready: bool = COPTER_ONLY  # what is against arming is told unasked (AP_Arming::update)
    # The answer to RUN_PREARM_CHECKS while armed.
    arming_check_armed: Result = each(Result.ACCEPTED, Result.TEMPORARILY_REJECTED)
    calibration_denies_arming: bool = PX4_ONLY  # also forced arming
    calibrated_compass_needs_reboot: bool = COPTER_ONLY  # FIXED_MAG_CAL_YAW: it does not arm before
    arm_authorization: bool = PX4_ONLY  # another system may be asked before arming (COM_ARM_AUTH_*)
    armed_text: str = each("Armed by external command", "Arming motors")  # by a command
    disarmed_text: str = each("Disarmed by external command", "Disarming motors")  # the same
    disarming_denied_text: str | None = each("Disarming denied! Not landed", None)  # when in flight
    termination_lasts: bool = PX4_ONLY  # until it is ended; else it is no more than a disarming
    mode_back_after_disarming: bool = PX4_ONLY  # to the one that the user chose (UserModeIntention)

    # The parts of the autopilot: modes.
    takes_unknown_main_modes: bool = PX4_ONLY  # as recorded: changes nothing, and is accepted
    manual_modes_need_sticks: bool = PX4_ONLY  # to be entered while armed
    flown_mission_becomes_hold: bool = PX4_ONLY  # if its mode is entered in the air, after its end
    hold_ends_take_off: bool = COPTER_ONLY  # also on the ground; else it climbs to its height
    mode_ends_roi: bool = COPTER_ONLY  # every mode begins with its own way to point
    guided_forgets_setpoints: bool = COPTER_ONLY  # those that came before the mode was entered
    tells_return: bool = PX4_ONLY  # a STATUSTEXT for each leg of a return
    mode_switch: bool = COPTER_ONLY  # a radio channel chooses the mode (FLTMODE_CH)
    sinks_without_sticks: bool = PX4_ONLY  # in its position mode, where a failsafe has put it there
    sticks_take_over: bool = PX4_ONLY  # a moved stick ends an automatic flight (COM_RC_OVERRIDE)
    orbit_mode: bool = PX4_ONLY  # DO_ORBIT is known
    take_off_mode: str | None = each("AUTO.TAKEOFF", None)  # of NAV_TAKEOFF; None = GUIDED
    take_off_in_flight: Result = each(Result.ACCEPTED, Result.FAILED)  # NAV_TAKEOFF's answer
    repositions_by_hold: bool = PX4_ONLY  # DO_REPOSITION flies in the hold mode; else in GUIDED
    pauses: bool = COPTER_ONLY  # DO_PAUSE_CONTINUE is known
    changes_speed_on_ground: bool = PX4_ONLY  # DO_CHANGE_SPEED; else in flight only
    mission_speeds_have_type: bool = COPTER_ONLY  # SPEED_TYPE counts; else each is the cruise speed

    # The parts of the autopilot: lifting off and landing.
    arming_delay_s: float = each(0.0, 2.0)  # ARMING_DELAY_SEC, by memory: motors idle at first
    tells_land_detector: bool = PX4_ONLY  # a STATUSTEXT for take-off and landing
    aligns_yaw_in_flight: bool = COPTER_ONLY  # once in each flight, and says so (EKF3)
    holds_after_task: bool = PX4_ONLY  # enters its hold mode after a take-off and after a mission

    # The parts of the autopilot: the mission.
    checks_mission_feasible: bool = PX4_ONLY  # within the fence, and begun near home
    mission_needs_take_off: bool = COPTER_ONLY  # for its mode to be entered on the ground, armed
    mission_waits_for_start: bool = COPTER_ONLY  # on the ground, for MISSION_START (AUTO_OPTIONS)
    mission_start_arms: bool = PX4_ONLY  # MISSION_START does, and needs a mission that may be flown
    mission_return_changes_mode: bool = PX4_ONLY  # RETURN_TO_LAUNCH as an item ends its mode
    tells_mission_take_off: bool = PX4_ONLY  # a STATUSTEXT with its height
    tells_uploads: bool = COPTER_ONLY  # a STATUSTEXT for a mission or a fence that came
    no_mission_ends_mode: bool = PX4_ONLY  # where the mission was cleared, also while disarmed

    # The parts of the autopilot: fence and failsafes.
    goal_beyond_fence: Result = each(Result.ACCEPTED, Result.FAILED)  # its answer
    tells_goal_beyond_fence: bool = PX4_ONLY  # and flies there where GF_ACTION only warns
    setpoints_within_fence: bool = COPTER_ONLY  # setpoints with a goal beyond it are dropped
    fence_may_hold_mode: bool = COPTER_ONLY  # what a breach led to cannot be left (FENCE_OPTIONS)
    tells_manual_recovery: bool = COPTER_ONLY  # a STATUSTEXT for a mode change during a breach
    tells_lesser_failsafes: bool = COPTER_ONLY  # those that strike while a worse one is acted on
    mode_back_with_position: bool = PX4_ONLY  # to the mode in which the position was lost

    # Parameters.
    infinite_parameters: bool = PX4_ONLY  # a parameter may be infinite
    cuts_parameters_to_fit: bool = COPTER_ONLY  # a fraction or too large a number is not refused
    rate_limit_may_be_zero: bool = PX4_ONLY  # 0 is a limit of the body rates; else it is none
    hover_thrust: str = each("MPC_THR_HOVER", "MOT_THST_HOVER")  # 0..1

    # The fence.
    fence_action: str = each("GF_ACTION", "FENCE_ACTION")  # on a breach; 0 = nothing
    pilot_suspends_fence: bool = COPTER_ONLY  # for 10 s after a pilot takes over (AC_Fence)
    checks_fence_settings: bool = COPTER_ONLY  # contradictory ones refuse arming (AC_Fence)
    fence_always_on: bool = PX4_ONLY  # no command and no mission item turns it off or on
    fence_circle_needs_radius: bool = COPTER_ONLY  # else one of 0, of less or of none has no inside
    one_fence_return_point: bool = COPTER_ONLY  # a second one is refused (AC_PolyFence_loader)
    rally_inside_fence_only: bool = COPTER_ONLY  # a return goes to no point that it forbids

    # Missions.
    first_mission_item: int = each(0, 1)  # the first that is flown; ArduPilot keeps home at index 0
    names_mission_items: bool = COPTER_ONLY  # a STATUSTEXT for each that begins or is reached
    commands_are_reached: bool = PX4_ONLY  # MISSION_ITEM_REACHED for items that only act, too
    tells_end_of_jumps: bool = PX4_ONLY  # a STATUSTEXT when DO_JUMP has been repeated often enough
    mission_restart: str | None = each(None, "MIS_RESTART")  # 1 = anew when it is taken up
    delays_before_take_off: bool = COPTER_ONLY  # NAV_DELAY may come first, on the ground
    take_off_goes_to_place: bool = PX4_ONLY  # NAV_TAKEOFF climbs, then flies to its place
    items_have_heading: bool = PX4_ONLY  # a waypoint's param 4, and MPC_YAW_MODE counts
    waypoints_have_radius: bool = PX4_ONLY  # param 2 of a waypoint is its acceptance radius [m]
    nose_in_flight: str | None = each(None, "WP_YAW_BEHAVIOR")  # where it points; 0 = as it is
    flies_splines: bool = COPTER_ONLY  # NAV_SPLINE_WAYPOINT
    zero_keeps_height: bool = COPTER_ONLY  # an item of altitude 0 is as high as the one before
    terrain_items: bool = COPTER_ONLY  # heights above terrain are stored, not flown without data
    payload_item_lasts: str | None = each("MIS_PD_TO", None)  # of DO_GRIPPER and DO_WINCH [s]
    items_need_sound_place: bool = COPTER_ONLY  # no altitude that is no number, no place off Earth
    placeless_in_mission_frame: bool = PX4_ONLY  # items without a place take no other frame
    jumps_may_lead_beyond: bool = PX4_ONLY  # DO_JUMP to an item that is not there is stored

    # Take-off, landing, disarming.
    lifts_off_at_once: bool = PX4_ONLY  # else after TKOFF_SLEW_TIME, as the throttle comes to hover
    take_off_ramp: str | None = each("MPC_TKO_RAMP_T", None)  # how long the climb rate grows [s]
    take_off_done_within: str | None = each("NAV_MC_ALT_RAD", None)  # so near is enough [m]
    land_speed_high: str | None = each(None, "LAND_SPEED_HIGH")  # upper part of a landing [cm/s]
    land_slowest_below: str | None = each("MPC_LAND_ALT2", None)  # where the slow-down ends [m]
    any_landing_disarms: bool = PX4_ONLY  # after a time; else only a mode that lands by itself
    disarmed_after_landing: str = each("Disarmed by landing", "Disarming motors")  # by itself
    disarmed_unflown: str = each("Disarmed by auto preflight disarming", "Disarming motors")

    # Flown from outside: OFFBOARD, GUIDED, and a leader that is followed.
    setpoints_lift_off: bool = PX4_ONLY  # one that leads up starts the flight from the ground
    jerk: str = each("MPC_JERK_AUTO", "PSC_JERK_XY")  # of its own flights [m/s^3]
    law: Law = each(Law.PX4, Law.COPTER)  # that they follow
    brakes_by_velocity: bool = COPTER_ONLY  # a stop is a velocity of 0, not a place
    velocity_damping: str | None = each("MPC_XY_VEL_D_ACC", "PSC_VELXY_D")  # horizontal D-gain
    lands_by_velocity: bool = PX4_ONLY  # without a height that it must be at
    setpoints_fly_direct: bool = PX4_ONLY  # to position and velocity loops, without a trajectory
    setpoints_pass_cruise_speed: bool = PX4_ONLY  # up to MPC_XY_VEL_MAX and its like
    thrust_may_be_climb_rate: bool = COPTER_ONLY  # in SET_ATTITUDE_TARGET, by GUID_OPTIONS
    brakes_after_last_setpoint: bool = COPTER_ONLY  # GUID_TIMEOUT; PX4 leaves the mode instead
    leader_by_id: bool = COPTER_ONLY  # FOLL_SYSID, or the first that is heard until it is silent
    leader_height_by_home: str | None = each(None, "FOLL_ALT_TYPE")  # 1 = above each home

    # Sticks.
    joystick_overrides_channels: bool = COPTER_ONLY  # else a source of its own (COM_RC_IN_MODE)
    channel_map: str = each("RC_MAP_", "RCMAP_")  # begin of the names, one for each stick
    channel_lasts: str = each("COM_RC_LOSS_T", "RC_OVERRIDE_TIME")  # an overridden one, so long [s]
    receiver_grace: str | None = each(None, "RC_FS_TIMEOUT")  # so much later sticks are lost [s]
    receiver_silent: str | None = each(None, "SIM_RC_FAIL")  # if not 0, it hears nothing
    arming_gesture: str = each("MAN_ARM_GESTURE", "ARMING_RUDDER")  # 0 = sticks do not arm
    gesture_disarms_from: int = each(1, 2)  # from this value of it on the sticks disarm, too
    own_station: str | None = each(None, "SYSID_MYGCS")  # whose sticks and heartbeats count


RULES: Final[dict[Personality, AutopilotRules]] = tables(AutopilotRules)
