"""What a ground station needs to word the events: the definitions, by the schema of libevents.

Names, messages and arguments are PX4 1.14's, of the events that this vehicle sends.  Groups matter:
a station builds its list of arming checks from `arming_check` and `health`.  The names of the
components and of the groups of modes that were not recorded are from memory of PX4's sources.
"""

from __future__ import annotations

from typing import Final, NamedTuple, TypeAlias

Json: TypeAlias = "dict[str, str | float | bool | Json | list[Json] | list[str]]"

COMPONENT: Final = 1  # the upper 8 bits of an id
_IN_CHECK: Final = (("navigation_mode_group_t", "modes"), ("uint8_t", "health_component_index"))


class _Definition(NamedTuple):
    id: int
    name: str
    message: str
    arguments: tuple[tuple[str, str], ...] = ()  # type, name


def _args(*types: str) -> tuple[tuple[str, str], ...]:
    return tuple((each, f"arg{number}") for number, each in enumerate(types))


_SAID: Final = (
    _Definition(26266355, "commander_armed_by", "Armed by {1}", _args("arm_disarm_reason_t")),
    _Definition(32794487, "commander_disarmed_by", "Disarmed by {1}", _args("arm_disarm_reason_t")),
    _Definition(21054825, "commander_takeoff_detected", "Takeoff detected"),
    _Definition(26622124, "commander_landing_detected", "Landing detected"),
    _Definition(
        27280279,
        "commander_modeswitch_not_avail",
        "Switching to mode '{2}' is currently not possible",
        _args("uint32_t", "navigation_mode_t"),
    ),
    _Definition(
        23844490,
        "commander_mission_start_denied_no_mission",
        "Mission start denied! No valid mission",
    ),
    _Definition(31928670, "mission_takeoff_to", "Takeoff to {1:.1m_v} above home", _args("float")),
    _Definition(24580612, "mission_finished", "Mission finished, landed"),
    _Definition(21455606, "mission_finished_loiter", "Mission finished, loitering"),
    _Definition(20167372, "mission_not_valid_loiter", "No valid mission available, loitering"),
    _Definition(26093318, "mission_do_jump_rep_completed", "DO JUMP repetitions completed"),
    _Definition(
        18740064,
        "mission_index_out_of_bound",
        "Mission item index out of bound, index: {1}, max: {2}",
        _args("uint16_t", "uint16_t"),
    ),
    _Definition(
        33469040, "mavlink_mission_mis_item_invalid", "Ignoring mission item, invalid item"
    ),
    _Definition(
        19608877,
        "navigator_mis_geofence_violation",
        "Geofence violation for waypoint {1}",
        _args("uint8_t"),
    ),
    _Definition(18121339, "navigator_rtl_home_activated", "RTL activated"),
    _Definition(27934633, "rtl_land_at_home", "RTL: landing at home position"),
    _Definition(
        25988105,
        "rtl_climb_to",
        "RTL: climb to {1m_v} ({2m_v} above destination)",
        _args("int32_t", "int32_t"),
    ),
    _Definition(
        32911184,
        "rtl_return_at",
        "RTL: return at {1m_v} ({2m_v} above destination)",
        _args("int32_t", "int32_t"),
    ),
    _Definition(
        28905952,
        "rtl_descend_to",
        "RTL: descend to {1m_v} ({2m_v} above destination)",
        _args("int32_t", "int32_t"),
    ),
    _Definition(16962474, "rtl_land_at_destination", "RTL: land at destination"),
    _Definition(27571288, "commander_gcs_lost", "Connection to ground control station lost"),
    _Definition(31011876, "commander_dl_regained", "GCS connection regained"),
    _Definition(17738815, "failsafe_rc_override", "Pilot took over using sticks"),
    _Definition(
        22511653,
        "commander_cal_cmd_denied",
        "Command denied during calibration: {1}",
        _args("uint8_t"),
    ),
    _Definition(
        21279712,
        "commander_failsafe_enter_generic_hold",
        "Failsafe activated, triggering {2} in {3} seconds",
        _args("uint32_t", "failsafe_action_t", "uint16_t"),
    ),
    _Definition(
        31382480,
        "commander_failsafe_enter_generic",
        "Failsafe activated, triggering {2}",
        _args("uint32_t", "failsafe_action_t"),
    ),
)
_CHECKS: Final = (
    _Definition(
        25679424, "check_estimator_hor_vel_not_stable", "Horizontal velocity unstable", _IN_CHECK
    ),
    _Definition(27227279, "check_modes_attitude", "No valid attitude estimate", _IN_CHECK),
    _Definition(30612409, "check_modes_local_pos", "No valid local position estimate", _IN_CHECK),
    _Definition(26788467, "check_modes_global_pos", "No valid global position estimate", _IN_CHECK),
    _Definition(18648929, "check_modes_cannot_takeoff", "Mode not suitable for arming", _IN_CHECK),
    _Definition(17154777, "check_modes_mission", "No valid mission available", _IN_CHECK),
    _Definition(19865031, "check_modes_offboard_signal", "No offboard signal", _IN_CHECK),
    _Definition(17231145, "check_modes_manual_control", "No manual control input", _IN_CHECK),
    _Definition(
        29908441,
        "check_gf_violation",
        "Geofence violation: {3}",
        (*_IN_CHECK, ("uint8_t", "arg0")),
    ),
    _Definition(
        23579003,
        "check_rc_dl_no_dllink",
        "No connection to the ground control station",
        _IN_CHECK,
    ),
)
_ARMING_SUMMARY: Final = _Definition(
    27825120,
    "commander_arming_check_summary",
    "Arming check summary event",
    (
        ("uint8_t", "chunk_idx"),
        ("health_component_t", "error"),
        ("health_component_t", "warning"),
        ("navigation_mode_group_t", "can_arm"),
        ("navigation_mode_group_t", "can_run"),
    ),
)
_HEALTH_SUMMARY: Final = _Definition(
    18691879,
    "commander_health_summary",
    "Health report summary event",
    (
        ("uint8_t", "chunk_idx"),
        ("health_component_t", "is_present"),
        ("health_component_t", "error"),
        ("health_component_t", "warning"),
    ),
)

_COMPONENTS: Final = (
    *("none", "absolute_pressure", "differential_pressure", "gps", "optical_flow"),
    *("vision_position", "distance_sensor", "remote_control", "motors_escs", "utm", "logging"),
    *("battery", "communication_links", "rate_controller", "attitude_controller"),
    *("position_controller", "attitude_estimate", "local_position_estimate", "mission"),
    *("avoidance", "system", "camera", "gimbal", "payload", "global_position_estimate"),
    *("storage", "parachute", "magnetometer", "accel", "gyro", "open_drone_id"),
)
"""In the order of their bits."""
_MODE_GROUPS: Final = {
    "manual": 0, "altctl": 1, "posctl": 2, "mission": 3, "loiter": 4, "rtl": 5, "acro": 10,
    "offboard": 14, "stab": 15, "takeoff": 17, "land": 18, "follow_target": 19, "precland": 20,
    "orbit": 21, "vtol_takeoff": 22,
}  # fmt: skip
_REASONS: Final = {
    "transition_to_standby": 0, "stick_gesture": 1, "rc_switch": 2, "command_internal": 3,
    "command_external": 4, "mission_start": 5, "auto_disarm_land": 6, "auto_disarm_preflight": 7,
    "kill_switch": 8, "lockdown": 9, "failure_detector": 10,
}  # fmt: skip
_MODES: Final = {
    "manual": 0, "altctl": 1, "posctl": 2, "auto_mission": 3, "auto_loiter": 4, "auto_rtl": 5,
    "acro": 6, "offboard": 7, "stab": 8, "auto_takeoff": 10, "auto_land": 11,
    "auto_follow_target": 12, "auto_precland": 13, "orbit": 14, "unknown": 255,
}  # fmt: skip
_ACTIONS: Final = {
    "none": 0, "warn": 1, "fallback_posctrl": 2, "fallback_altctrl": 3, "fallback_stab": 4,
    "hold": 5, "rtl": 6, "land": 7, "descend": 8, "disarm": 9, "terminate": 10,
}  # fmt: skip


def _enum(kind: str, entries: dict[str, int], bits: bool = False) -> Json:
    described: Json = {
        str(value): {"name": name, "description": name.replace("_", " ")}
        for name, value in entries.items()
    }
    return {"type": kind, "is_bitfield": bits, "entries": described}


def _group(*definitions: _Definition, kind: str = "") -> Json:
    events: Json = {}
    for each in definitions:
        event: Json = {"name": each.name, "message": each.message}
        if each.arguments:
            arguments: list[Json] = [
                {"type": type_, "name": name} for type_, name in each.arguments
            ]
            event["arguments"] = arguments
        if kind:
            event["type"] = kind
        events[str(each.id & 0xFF_FFFF)] = event
    return events


def definitions() -> Json:
    """The whole file."""
    bits: dict[str, int] = {name: 1 << bit for bit, name in enumerate(_COMPONENTS)}
    groups: dict[str, int] = {name: 1 << bit for name, bit in _MODE_GROUPS.items()}
    checks = _group(_ARMING_SUMMARY, kind="summary") | _group(*_CHECKS)
    component: Json = {
        "namespace": "px4",
        "enums": {
            "health_component_t": _enum("uint32_t", bits, bits=True),
            "navigation_mode_group_t": _enum("uint32_t", groups, bits=True),
            "arm_disarm_reason_t": _enum("uint8_t", _REASONS),
            "navigation_mode_t": _enum("uint8_t", _MODES),
            "failsafe_action_t": _enum("uint8_t", _ACTIONS),
        },
        "event_groups": {
            "default": {"events": _group(*_SAID)},
            "arming_check": {"events": checks},
            "health": {"events": _group(_HEALTH_SUMMARY, kind="summary")},
        },
        "supported_protocols": ["health_and_arming_check"],
    }
    return {"version": 1, "components": {str(COMPONENT): component}}
