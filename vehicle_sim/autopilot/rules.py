"""What PX4 and ArduCopter do differently, one field for each rule.

A rule stands here when the same code flies both and only a value, an answer or a yes or no is
different.  Where whole procedures differ there is a function or a class for each of the two, in a
dictionary by personality beside them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.control_loops.trajectory import Law


@dataclass(frozen=True, slots=True, eq=False, repr=False)
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
    calibrated_compass_needs_reboot: bool  # FIXED_MAG_CAL_YAW: it does not arm before
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
    sinks_without_sticks: bool  # in its position mode, where a failsafe has put it there
    sticks_take_over: bool  # a moved stick ends an automatic flight (COM_RC_OVERRIDE)
    orbit_mode: bool  # DO_ORBIT is known
    take_off_mode: str | None  # the mode of NAV_TAKEOFF; None = it takes off in GUIDED
    take_off_in_flight: Result  # the answer to NAV_TAKEOFF in flight
    repositions_by_hold: bool  # DO_REPOSITION flies in the hold mode; else in GUIDED
    pauses: bool  # DO_PAUSE_CONTINUE is known
    changes_speed_on_ground: bool  # DO_CHANGE_SPEED; else in flight only
    mission_speeds_have_type: bool  # an item's SPEED_TYPE counts; else each is the cruise speed

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
    goal_beyond_fence: Result  # the answer to a goal that the fence forbids
    tells_goal_beyond_fence: bool  # and flies there where GF_ACTION only warns
    setpoints_within_fence: bool  # setpoints with a goal beyond it are dropped
    fence_may_hold_mode: bool  # what a breach led to cannot be left (FENCE_OPTIONS)
    tells_manual_recovery: bool  # a STATUSTEXT for a mode change during a breach
    tells_lesser_failsafes: bool  # those that strike while a worse one is acted on
    mode_back_with_position: bool  # to the mode in which the position was lost

    # Parameters.
    infinite_parameters: bool  # a parameter may be infinite
    cuts_parameters_to_fit: bool  # a fraction or too large a whole number is cut, not refused
    rate_limit_may_be_zero: bool  # 0 is a limit of the body rates; else it stands for none
    hover_thrust: str  # the parameter with the thrust of hover, 0..1

    # The fence.
    fence_action: str  # the parameter that says what a breach brings about; 0 = nothing
    pilot_suspends_fence: bool  # a pilot who takes over is left alone for 10 s (AC_Fence)
    checks_fence_settings: bool  # settings that contradict themselves refuse arming (AC_Fence)
    fence_always_on: bool  # no command and no mission item turns it off or on
    fence_circle_needs_radius: bool  # else one of 0, of less or of none has no inside
    one_fence_return_point: bool  # a second one is refused at upload (AC_PolyFence_loader)
    rally_inside_fence_only: bool  # a return goes to no point that the fence does not allow

    # Missions.
    first_mission_item: int  # the first that is flown; ArduPilot keeps home at index 0
    names_mission_items: bool  # a STATUSTEXT for each that begins or is reached
    commands_are_reached: bool  # MISSION_ITEM_REACHED also for items that only do something
    tells_end_of_jumps: bool  # a STATUSTEXT when DO_JUMP has been repeated often enough
    mission_restart: str | None  # the parameter by which a mission that is taken up begins anew
    delays_before_take_off: bool  # a mission may begin with NAV_DELAY, waited for on the ground
    take_off_goes_to_place: bool  # NAV_TAKEOFF climbs where it stands, then flies to its place
    items_have_heading: bool  # param 4 of a waypoint is a heading, and MPC_YAW_MODE counts
    waypoints_have_radius: bool  # param 2 of a waypoint is its acceptance radius [m]
    nose_in_flight: str | None  # the parameter that says where the nose points; 0 = as it is
    flies_splines: bool  # NAV_SPLINE_WAYPOINT
    zero_keeps_height: bool  # an item of altitude 0 is flown as high as the one before it
    terrain_items: bool  # heights above terrain are stored; without its data they are not flown
    payload_item_lasts: str | None  # the parameter with how long DO_GRIPPER and DO_WINCH last [s]
    items_need_sound_place: bool  # an altitude that is no number, or no place on Earth, is refused
    placeless_in_mission_frame: bool  # items without a place are refused in all other frames
    jumps_may_lead_beyond: bool  # DO_JUMP to an item that is not there is stored

    # Take-off, landing, disarming.
    lifts_off_at_once: bool  # else after TKOFF_SLEW_TIME, when the throttle has come up to hover
    take_off_ramp: str | None  # the parameter with how long the climb rate grows [s]
    take_off_done_within: str | None  # the parameter with how near the height is enough [m]
    land_speed_high: str | None  # the parameter for the upper part of a landing [cm/s]
    land_slowest_below: str | None  # the parameter with where the slow-down ends [m]
    any_landing_disarms: bool  # by the time for landings; else only a mode that lands by itself
    disarmed_after_landing: str  # the STATUSTEXT when it disarms by itself
    disarmed_unflown: str  # the same for one that never took off

    # Flown from outside: OFFBOARD, GUIDED, and a leader that is followed.
    setpoints_lift_off: bool  # a setpoint that leads up starts the flight from the ground
    jerk: str  # the parameter that shapes its own flights [m/s^3]
    law: Law  # that they follow
    brakes_by_velocity: bool  # a stop is a velocity of 0, not a place
    velocity_damping: str | None  # the parameter with the D-gain of its horizontal velocity loop
    lands_by_velocity: bool  # without a height that it must be at
    setpoints_fly_direct: bool  # to the position and velocity loops, without a trajectory
    setpoints_pass_cruise_speed: bool  # up to MPC_XY_VEL_MAX and its like, not the cruise speed
    thrust_may_be_climb_rate: bool  # SET_ATTITUDE_TARGET's, unless GUID_OPTIONS says thrust
    brakes_after_last_setpoint: bool  # GUID_TIMEOUT; PX4 leaves the mode instead
    leader_by_id: bool  # FOLL_SYSID, or the first that is heard, until it falls silent
    leader_height_by_home: str | None  # the parameter that, if 1, takes heights above each home

    # Sticks.
    joystick_overrides_channels: bool  # else it is a source of its own (COM_RC_IN_MODE)
    channel_map: str  # begin of the parameters that say which channel is which stick
    channel_lasts: str  # the parameter with how long an overridden channel counts [s]
    receiver_grace: str | None  # the parameter with how long after that the sticks are lost [s]
    receiver_silent: str | None  # the parameter that takes the simulated receiver away, if not 0
    arming_gesture: str  # the parameter that allows arming by the sticks; 0 = not
    gesture_disarms_from: int  # from this value of it on the sticks disarm, too
    own_station: str | None  # the parameter with whose sticks and heartbeats count, by system id


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
        calibrated_compass_needs_reboot=False,
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
        sinks_without_sticks=True,
        sticks_take_over=True,
        orbit_mode=True,
        take_off_mode="AUTO.TAKEOFF",
        take_off_in_flight=Result.ACCEPTED,
        repositions_by_hold=True,
        pauses=False,
        changes_speed_on_ground=True,
        mission_speeds_have_type=False,
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
        goal_beyond_fence=Result.ACCEPTED,
        tells_goal_beyond_fence=True,
        setpoints_within_fence=False,
        fence_may_hold_mode=False,
        tells_manual_recovery=False,
        tells_lesser_failsafes=False,
        mode_back_with_position=True,
        # Parameters.
        infinite_parameters=True,
        cuts_parameters_to_fit=False,
        rate_limit_may_be_zero=True,
        hover_thrust="MPC_THR_HOVER",
        # The fence.
        fence_action="GF_ACTION",
        pilot_suspends_fence=False,
        checks_fence_settings=False,
        fence_always_on=True,
        fence_circle_needs_radius=False,
        one_fence_return_point=False,
        rally_inside_fence_only=False,
        # Missions.
        first_mission_item=0,
        names_mission_items=False,
        commands_are_reached=True,
        tells_end_of_jumps=True,
        mission_restart=None,
        delays_before_take_off=False,
        take_off_goes_to_place=True,
        items_have_heading=True,
        waypoints_have_radius=True,
        nose_in_flight=None,
        flies_splines=False,
        zero_keeps_height=False,
        terrain_items=False,
        payload_item_lasts="MIS_PD_TO",
        items_need_sound_place=False,
        placeless_in_mission_frame=True,
        jumps_may_lead_beyond=True,
        # Take-off, landing, disarming.
        lifts_off_at_once=True,
        take_off_ramp="MPC_TKO_RAMP_T",
        take_off_done_within="NAV_MC_ALT_RAD",
        land_speed_high=None,
        land_slowest_below="MPC_LAND_ALT2",
        any_landing_disarms=True,
        disarmed_after_landing="Disarmed by landing",
        disarmed_unflown="Disarmed by auto preflight disarming",
        # Flown from outside.
        setpoints_lift_off=True,
        jerk="MPC_JERK_AUTO",
        law=Law.PX4,
        brakes_by_velocity=False,
        velocity_damping="MPC_XY_VEL_D_ACC",
        lands_by_velocity=True,
        setpoints_fly_direct=True,
        setpoints_pass_cruise_speed=True,
        thrust_may_be_climb_rate=False,
        brakes_after_last_setpoint=False,
        leader_by_id=False,
        leader_height_by_home=None,
        # Sticks.
        joystick_overrides_channels=False,
        channel_map="RC_MAP_",
        channel_lasts="COM_RC_LOSS_T",
        receiver_grace=None,
        receiver_silent=None,
        arming_gesture="MAN_ARM_GESTURE",
        gesture_disarms_from=1,
        own_station=None,
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
        calibrated_compass_needs_reboot=True,
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
        sinks_without_sticks=False,
        sticks_take_over=False,
        orbit_mode=False,
        take_off_mode=None,
        take_off_in_flight=Result.FAILED,
        repositions_by_hold=False,
        pauses=True,
        changes_speed_on_ground=False,
        mission_speeds_have_type=True,
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
        goal_beyond_fence=Result.FAILED,
        tells_goal_beyond_fence=False,
        setpoints_within_fence=True,
        fence_may_hold_mode=True,
        tells_manual_recovery=True,
        tells_lesser_failsafes=True,
        mode_back_with_position=False,
        # Parameters.
        infinite_parameters=False,
        cuts_parameters_to_fit=True,
        rate_limit_may_be_zero=False,
        hover_thrust="MOT_THST_HOVER",
        # The fence.
        fence_action="FENCE_ACTION",
        pilot_suspends_fence=True,
        checks_fence_settings=True,
        fence_always_on=False,
        fence_circle_needs_radius=True,
        one_fence_return_point=True,
        rally_inside_fence_only=True,
        # Missions.
        first_mission_item=1,
        names_mission_items=True,
        commands_are_reached=False,
        tells_end_of_jumps=False,
        mission_restart="MIS_RESTART",
        delays_before_take_off=True,
        take_off_goes_to_place=False,
        items_have_heading=False,
        waypoints_have_radius=False,
        nose_in_flight="WP_YAW_BEHAVIOR",
        flies_splines=True,
        zero_keeps_height=True,
        terrain_items=True,
        payload_item_lasts=None,
        items_need_sound_place=True,
        placeless_in_mission_frame=False,
        jumps_may_lead_beyond=False,
        # Take-off, landing, disarming.
        lifts_off_at_once=False,
        take_off_ramp=None,
        take_off_done_within=None,
        land_speed_high="LAND_SPEED_HIGH",
        land_slowest_below=None,
        any_landing_disarms=False,
        disarmed_after_landing="Disarming motors",
        disarmed_unflown="Disarming motors",
        # Flown from outside.
        setpoints_lift_off=False,
        jerk="PSC_JERK_XY",
        law=Law.COPTER,
        brakes_by_velocity=True,
        velocity_damping="PSC_VELXY_D",
        lands_by_velocity=False,
        setpoints_fly_direct=False,
        setpoints_pass_cruise_speed=False,
        thrust_may_be_climb_rate=True,
        brakes_after_last_setpoint=True,
        leader_by_id=True,
        leader_height_by_home="FOLL_ALT_TYPE",
        # Sticks.
        joystick_overrides_channels=True,
        channel_map="RCMAP_",
        channel_lasts="RC_OVERRIDE_TIME",
        receiver_grace="RC_FS_TIMEOUT",
        receiver_silent="SIM_RC_FAIL",
        arming_gesture="ARMING_RUDDER",
        gesture_disarms_from=2,
        own_station="SYSID_MYGCS",
    ),
}
