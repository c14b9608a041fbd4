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


@dataclass(frozen=True, slots=True)
class AutopilotRules:
    """`not_now` is the answer to what its own checks refuse.

    Where a field is the name of a parameter, None means that there is no such parameter, and that
    what it would bring about does not happen.
    """

    not_now: Result

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
    items_need_sound_place: bool  # an altitude that is no number, or no place on Earth, is refused
    return_refuses_place: bool  # a RETURN_TO_LAUNCH in a global frame is refused
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
    arming_gesture: str  # the parameter that allows arming by the sticks; 0 = not
    gesture_disarms_from: int  # from this value of it on the sticks disarm, too
    own_station: str | None  # the parameter with whose sticks and heartbeats count, by system id


RULES: Final[dict[Personality, AutopilotRules]] = {
    "px4": AutopilotRules(
        not_now=Result.TEMPORARILY_REJECTED,
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
        items_need_sound_place=False,
        return_refuses_place=True,
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
        arming_gesture="MAN_ARM_GESTURE",
        gesture_disarms_from=1,
        own_station=None,
    ),
    "ardupilot": AutopilotRules(
        not_now=Result.FAILED,
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
        items_need_sound_place=True,
        return_refuses_place=False,
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
        arming_gesture="ARMING_RUDDER",
        gesture_disarms_from=2,
        own_station="SYSID_MYGCS",
    ),
}
