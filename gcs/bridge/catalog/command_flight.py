"""Commands that move a vehicle, or decide how it moves."""

from __future__ import annotations

from gcs.bridge.catalog.row import Group, Kind

FLIGHT: tuple[Group, ...] = (
    Group(
        Kind.MOTION,
        "It arms or disarms: motors turn, or stop.",
        {
            400: "COMPONENT_ARM_DISARM",
        },
    ),
    Group(
        Kind.MOTION,
        "It takes off.",
        {
            22: "NAV_TAKEOFF",
        },
    ),
    Group(
        Kind.MOTION,
        "It lands.",
        {
            21: "NAV_LAND",
        },
    ),
    Group(
        Kind.MOTION,
        "It flies home and lands.",
        {
            20: "NAV_RETURN_TO_LAUNCH",
        },
    ),
    Group(
        Kind.MOTION,
        "It holds, where it is or somewhere else.",
        {
            17: "NAV_LOITER_UNLIM",
            193: "DO_PAUSE_CONTINUE",
            252: "OVERRIDE_GOTO",
        },
    ),
    Group(
        Kind.MOTION,
        "It changes the flight mode, and with it what the vehicle flies.",
        {
            92: "NAV_GUIDED_ENABLE",
            176: "DO_SET_MODE",
            262: "DO_SET_STANDARD_MODE",
        },
    ),
    Group(
        Kind.MOTION,
        "It flies to a position or a height.",
        {
            186: "DO_CHANGE_ALTITUDE",
            192: "DO_REPOSITION",
        },
    ),
    Group(
        Kind.MOTION,
        "It flies circles.",
        {
            34: "DO_ORBIT",
        },
    ),
    Group(
        Kind.MOTION,
        "It flies the mission on board, or sends it to another item.",
        {
            189: "DO_LAND_START",
            191: "DO_GO_AROUND",
            224: "DO_SET_MISSION_CURRENT",
            300: "MISSION_START",
        },
    ),
    Group(
        Kind.MOTION,
        "It changes the speed, and with it the way that a stop takes.",
        {
            178: "DO_CHANGE_SPEED",
        },
    ),
    Group(
        Kind.MOTION,
        "It turns the vehicle where it is.",
        {
            115: "CONDITION_YAW",
        },
    ),
    Group(
        Kind.MOTION,
        "It turns the nose of a multirotor to a place, and keeps it turned; it moves it nowhere.",
        {
            195: "DO_SET_ROI_LOCATION",
            196: "DO_SET_ROI_WPNEXT_OFFSET",
            197: "DO_SET_ROI_NONE",
            198: "DO_SET_ROI_SYSID",
            201: "DO_SET_ROI",
        },
    ),
    Group(
        Kind.DENIED,
        "It follows something, and where that will be nobody knows.",
        {
            25: "NAV_FOLLOW",
            32: "DO_FOLLOW",
            33: "DO_FOLLOW_REPOSITION",
        },
    ),
    Group(
        Kind.DENIED,
        "It flies a curve that the gate does not verify.",
        {
            35: "DO_FIGURE_EIGHT",
            2800: "PANORAMA_CREATE",
            4000: "SET_GUIDED_SUBMODE_STANDARD",
            4001: "SET_GUIDED_SUBMODE_CIRCLE",
            60020: "QSHOT_DO_CONFIGURE",
        },
    ),
    Group(
        Kind.DENIED,
        "It jumps within the mission on board; DO_SET_MISSION_CURRENT does that under the gate.",
        {
            177: "DO_JUMP",
            188: "DO_RETURN_PATH_START",
            190: "DO_RALLY_LAND",
            601: "DO_JUMP_TAG",
        },
    ),
    Group(
        Kind.DENIED,
        "It is for other kinds of vehicles than multirotors.",
        {
            84: "NAV_VTOL_TAKEOFF",
            85: "NAV_VTOL_LAND",
            194: "DO_SET_REVERSE",
            210: "DO_INVERTED_FLIGHT",
            212: "DO_AUTOTUNE_ENABLE",
            213: "NAV_SET_YAW_SPEED",
            3000: "DO_VTOL_TRANSITION",
            43000: "GUIDED_CHANGE_SPEED",
            43001: "GUIDED_CHANGE_ALTITUDE",
            43002: "GUIDED_CHANGE_HEADING",
        },
    ),
    Group(
        Kind.DENIED,
        "It takes off or lands at a local position, which the autopilots here do not do (from "
        "memory).",
        {
            23: "NAV_LAND_LOCAL",
            24: "NAV_TAKEOFF_LOCAL",
        },
    ),
    Group(
        Kind.DENIED,
        "It is a button: what it does depends on the vehicle's state, from taking off to landing.",
        {
            42001: "SOLO_BTN_FLY_CLICK",
            42002: "SOLO_BTN_FLY_HOLD",
            42003: "SOLO_BTN_PAUSE_CLICK",
        },
    ),
    Group(
        Kind.DENIED,
        "It hands control or its limits to somebody whom the gate does not know.",
        {
            81: "NAV_PATHPLANNING",
            221: "DO_GUIDED_MASTER",
            222: "DO_GUIDED_LIMITS",
        },
    ),
)
