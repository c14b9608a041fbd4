"""Commands that mean something only as items of a plan."""

from __future__ import annotations

from gcs.bridge.catalog.row import Group, Kind

ITEMS: tuple[Group, ...] = (
    Group(
        Kind.DENIED,
        "It is an item of a mission, which is uploaded and verified whole; no autopilot here "
        "flies it at once (from memory).",
        {
            16: "NAV_WAYPOINT",
            18: "NAV_LOITER_TURNS",
            19: "NAV_LOITER_TIME",
            30: "NAV_CONTINUE_AND_CHANGE_ALT",
            31: "NAV_LOITER_TO_ALT",
            36: "NAV_ARC_WAYPOINT",
            82: "NAV_SPLINE_WAYPOINT",
            83: "NAV_ALTITUDE_WAIT",
            93: "NAV_DELAY",
            112: "CONDITION_DELAY",
            113: "CONDITION_CHANGE_ALT",
            114: "CONDITION_DISTANCE",
            215: "DO_SET_RESUME_REPEAT_DIST",
            600: "JUMP_TAG",
            4501: "CONDITION_GATE",
            31000: "WAYPOINT_USER_1",
            31001: "WAYPOINT_USER_2",
            31002: "WAYPOINT_USER_3",
            31003: "WAYPOINT_USER_4",
            31004: "WAYPOINT_USER_5",
            31005: "SPATIAL_USER_1",
            31006: "SPATIAL_USER_2",
            31007: "SPATIAL_USER_3",
            31008: "SPATIAL_USER_4",
            31009: "SPATIAL_USER_5",
            42702: "NAV_SCRIPT_TIME",
            42703: "NAV_ATTITUDE_TIME",
        },
    ),
    Group(
        Kind.DENIED,
        "It is the old item of a mission for DO_SET_ROI; no autopilot here takes it as a "
        "command (from memory).",
        {
            80: "NAV_ROI",
        },
    ),
    Group(
        Kind.DENIED,
        "It is an item of a fence or of rally points, which are uploaded as a whole.",
        {
            5000: "NAV_FENCE_RETURN_POINT",
            5001: "NAV_FENCE_POLYGON_VERTEX_INCLUSION",
            5002: "NAV_FENCE_POLYGON_VERTEX_EXCLUSION",
            5003: "NAV_FENCE_CIRCLE_INCLUSION",
            5004: "NAV_FENCE_CIRCLE_EXCLUSION",
            5005: "NAV_FENCE_HOME_CIRCLE_INCLUSION",
            5100: "NAV_RALLY_POINT",
        },
    ),
    Group(
        Kind.DENIED,
        "It only marks the end of a range of numbers.",
        {
            95: "NAV_LAST",
            159: "CONDITION_LAST",
            240: "DO_LAST",
        },
    ),
)

ONLY_IN_PLANS: frozenset[int] = frozenset(number for group in ITEMS for number in group.names)
