"""Commands that move the vehicle or change how it flies."""

from __future__ import annotations

import math
from typing import Final

from vehicle_sim.autopilot.geo import projection
from vehicle_sim.autopilot.interface import Geodetic, OrbitRequest, Result, SpeedType
from vehicle_sim.effects import Send
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.services.commands.orders import Answer, Order
from vehicle_sim.services.commands.ports import CommandContext, CommandEntry, RefusedError
from vehicle_sim.services.setpoints import FARTHEST
from vehicle_sim.services.texts import status_text
from vehicle_sim.wire.ids import ABSOLUTE, RELATIVE, Cmd

FORCE: Final = 21196.0
ROI_NONE: Final = 0.0  # MAV_ROI
ROI_LOCATION: Final = 3.0
CHANGE_MODE: Final = 1  # MAV_DO_REPOSITION_FLAGS
RESET_PARAMETERS: Final = 2.0


def _finite(value: float, what: str) -> float:
    if not abs(value) <= FARTHEST:
        raise RefusedError(Result.DENIED, f"{what} ({value}) is not finite, or beyond all measure")
    return value


def _home(context: CommandContext) -> Geodetic:
    if context.vehicle.home is None:
        raise RefusedError(Result.DENIED, "there is no home yet")
    return context.vehicle.home


def _arm_disarm(context: CommandContext, order: Order) -> Answer:
    force = order.p2 == FORCE
    if order.p1 == 1.0:
        return _once_decided(context.vehicle.arm(force))
    if order.p1 == 0.0:
        return Answer(context.vehicle.disarm(force))
    raise RefusedError(Result.DENIED, f"{order.p1} is neither arm (1) nor disarm (0)")


def _once_decided(result: Result) -> Answer:
    """PX4 answers an `arm` that waits for its authorization when that has come, and not before."""
    return Answer(result, acked=result is not Result.IN_PROGRESS)


def _take_off(context: CommandContext, order: Order) -> Answer:
    """px4: AMSL, anything at or below home or NaN = the default; ardupilot: above home."""
    if not context.profile.takeoff_amsl or order.relative:
        return Answer(context.vehicle.take_off(_finite(order.p7, "the height")))
    if math.isnan(order.p7):
        return Answer(context.vehicle.take_off(None))
    up_m = _finite(order.p7, "the height") - _home(context).alt_amsl_m
    return Answer(context.vehicle.take_off(up_m if up_m > 0.0 else None))


def _land(context: CommandContext, order: Order) -> Answer:
    return _with_text(context, context.vehicle.land(), "Landing at current position")


def _return(context: CommandContext, order: Order) -> Answer:
    return _with_text(context, context.vehicle.return_home(), "Returning to launch")


def _with_text(context: CommandContext, result: Result, text: str) -> Answer:
    """PX4 says so to the command, not to the mode that follows from it."""
    if not context.profile.names_command or result is not Result.ACCEPTED:
        return Answer(result)
    return Answer(result, (Send(None, status_text(context.profile, 6, text)),))


def _set_mode(context: CommandContext, order: Order) -> Answer:
    base, main, sub = (order.whole(value) for value in (order.p1, order.p2, order.p3))
    if base is None or main is None or not 0 <= base <= 0xFF or not 0 <= main <= 0xFFFF:
        raise RefusedError(Result.DENIED, "the mode is not a number")
    if context.profile.sub_modes:
        # HEARTBEAT.custom_mode holds PX4's main mode in its third byte, the sub mode in its fourth.
        main = (main & 0xFF) << 16 | ((sub or 0) & 0xFF) << 24
    return Answer(context.vehicle.set_mode(base, main))


def _reposition(context: CommandContext, order: Order) -> Answer:
    """NaN in a coordinate = keep it.  p4 is a heading in radians.

    Bit 1 of p2 allows the change to the mode that flies there: PX4 takes nothing without it,
    ArduCopter only where it is in that mode already, and never by COMMAND_LONG.
    """
    changes_mode = bool((order.whole(order.p2) or 0) & CHANGE_MODE)
    if context.profile.reposition_needs_change_flag and not changes_mode:
        raise RefusedError(Result.UNSUPPORTED, "without MAV_DO_REPOSITION_FLAGS_CHANGE_MODE")
    if order.frame is None and not context.profile.reposition_by_long:
        raise RefusedError(Result.UNSUPPORTED, "ArduCopter takes it as COMMAND_INT only")
    estimate = context.vehicle.estimate
    target: Vec3 | None = None
    if not (math.isnan(order.p5) and math.isnan(order.p6) and math.isnan(order.p7)):
        target = _place(context, order)
    return Answer(
        context.vehicle.reposition(
            target if target is not None else estimate.pos_ned,
            order.p4 if abs(order.p4) <= FARTHEST else None,
            order.p1 if 0.0 < order.p1 <= FARTHEST else None,
            changes_mode,
        )
    )


def _place(context: CommandContext, order: Order) -> Vec3:
    origin = context.vehicle.origin
    if origin is None:
        raise RefusedError(Result.DENIED, "there is no origin yet")
    here_n, here_e, here_d = context.vehicle.estimate.pos_ned
    north, east = here_n, here_e
    if not (math.isnan(order.p5) and math.isnan(order.p6)):
        lat_deg, lon_deg = latitude(order.p5), longitude(order.p6)
        there = Geodetic(lat_deg, lon_deg, 0.0)
        north, east, _ = projection(context.profile.name, origin).to_local(there)
    if math.isnan(order.p7):
        return (north, east, here_d)
    alt_amsl_m = _finite(order.p7, "the height")
    if order.relative:
        alt_amsl_m += _home(context).alt_amsl_m
    return (north, east, origin.alt_amsl_m - alt_amsl_m)


def latitude(value: float) -> float:
    if not abs(value) <= 90.0:
        raise RefusedError(Result.DENIED, f"{value} is no latitude")
    return value


def longitude(value: float) -> float:
    if not abs(value) <= 180.0:
        raise RefusedError(Result.DENIED, f"{value} is no longitude")
    return value


def _pause_continue(context: CommandContext, order: Order) -> Answer:
    if order.p1 == 0.0:
        return Answer(context.vehicle.pause())
    if order.p1 == 1.0:
        return Answer(context.vehicle.resume())
    raise RefusedError(Result.DENIED, f"{order.p1} is neither pause (0) nor continue (1)")


def _change_speed(context: CommandContext, order: Order) -> Answer:
    """PX4 1.14 ignores the type, and any value that is no speed restores its default."""
    if not context.profile.speed_by_type:
        speed_m_s = order.p2 if 0.0 < order.p2 <= FARTHEST else None
        return Answer(context.vehicle.change_speed(SpeedType.GROUND, speed_m_s))
    if not 0.0 < order.p2 <= FARTHEST or order.p1 not in tuple(SpeedType):
        raise RefusedError(Result.DENIED, f"{order.p2} m/s of type {order.p1} is no speed")
    return Answer(context.vehicle.change_speed(SpeedType(int(order.p1)), order.p2))


def _change_altitude(context: CommandContext, order: Order) -> Answer:
    height_m = _finite(order.p1, "the height")
    if order.p2 in RELATIVE:
        return Answer(context.vehicle.change_altitude(height_m))
    if order.p2 in ABSOLUTE:
        return Answer(context.vehicle.change_altitude(height_m - _home(context).alt_amsl_m))
    raise RefusedError(Result.UNSUPPORTED_MAV_FRAME, f"frame {order.p2} is not supported")


def _condition_yaw(context: CommandContext, order: Order) -> Answer:
    return Answer(
        context.vehicle.condition_yaw(
            math.radians(_finite(order.p1, "the angle")),
            order.p4 == 1.0,
            math.radians(_finite(order.p2, "the rate")),
            int(_finite(order.p3, "the direction")),
        )
    )


def _set_home(context: CommandContext, order: Order) -> Answer:
    if order.p1 == 1.0:
        return Answer(context.vehicle.set_home(None))
    where = Geodetic(latitude(order.p5), longitude(order.p6), _finite(order.p7, "the height"))
    return Answer(context.vehicle.set_home(where))


def _mission_start(context: CommandContext, order: Order) -> Answer:
    first, last = order.whole(order.p1), order.whole(order.p2)
    return _once_decided(context.vehicle.mission_start(first or 0, last or 0))


def _set_mission_current(context: CommandContext, order: Order) -> Answer:
    """ArduCopter fails what MISSION_SET_CURRENT would refuse; beyond the plan it denies."""
    seq = order.whole(order.p1)
    if seq is None or not 0 <= seq < max(1, len(context.vehicle.plan)):
        raise RefusedError(Result.DENIED, f"{order.p1} is no mission item")
    result = context.vehicle.mission_set_current(seq)
    return Answer(Result.FAILED if result is Result.DENIED else result)


def _image_start(context: CommandContext, order: Order) -> Answer:
    count = order.whole(order.p3)
    if count is None or count < 0 or not 0.0 <= order.p2 <= FARTHEST:
        raise RefusedError(Result.DENIED, "interval or number of images makes no sense")
    return Answer(context.vehicle.capture_image(order.p2, count))


def _image_stop(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.stop_capture())


def _camera_mode(context: CommandContext, order: Order) -> Answer:
    """Still images are all that it takes."""
    return Answer(Result.ACCEPTED if order.p2 == 0.0 else Result.DENIED)


def _prearm_checks(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.check_arming())


def _fence_enable(context: CommandContext, order: Order) -> Answer:
    choice = order.whole(order.p1)
    if choice is None:
        raise RefusedError(Result.DENIED, f"{order.p1} is neither off, on nor floor off")
    return Answer(context.vehicle.enable_fence(choice))


def _terminate(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.terminate(order.p1 > 0.5))


def _reboot(context: CommandContext, order: Order) -> Answer:
    """ArduPilot does not know an autopilot that is to be left as it is."""
    if order.p1 == 0.0:
        return Answer(context.profile.reboot_nothing)
    if order.p1 != 1.0:
        raise RefusedError(Result.DENIED, "it can only be rebooted (1)")
    return Answer(context.vehicle.reboot())


def _orbit(context: CommandContext, order: Order) -> Answer:
    """The height is AMSL whatever the frame says, as PX4 takes it; NaN = as it is."""
    origin = context.vehicle.origin
    if origin is None:
        raise RefusedError(Result.TEMPORARILY_REJECTED, "there is no origin yet")
    centre_ne = None
    if not (math.isnan(order.p5) or math.isnan(order.p6)):
        there = Geodetic(latitude(order.p5), longitude(order.p6), 0.0)
        north, east, _ = projection(context.profile.name, origin).to_local(there)
        centre_ne = (north, east)
    height_m = _given(order.p7, "the height")
    return Answer(
        context.vehicle.orbit(
            OrbitRequest(
                radius_m=_given(order.p1, "the radius"),
                speed_m_s=_given(order.p2, "the speed"),
                nose=order.whole(order.p3),
                centre_ne=centre_ne,
                down_m=None if height_m is None else origin.alt_amsl_m - height_m,
            )
        )
    )


def _given(value: float, what: str) -> float | None:
    """None for NaN, which stands for "as it is"."""
    return None if math.isnan(value) else _finite(value, what)


def _look_at(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.look_at(_place(context, order)))


def _look_away(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.look_at(None))


def _old_roi(context: CommandContext, order: Order) -> Answer:
    """DO_SET_ROI: MAV_ROI 0 none, 3 a location; ArduCopter always takes it for a location."""
    if order.p1 == ROI_LOCATION or context.profile.roi_is_location:
        if order.p5 == order.p6 == order.p7 == 0.0:
            return _look_away(context, order)
        return _look_at(context, order)
    if order.p1 == ROI_NONE:
        return _look_away(context, order)
    raise RefusedError(Result.UNSUPPORTED, f"a region of interest of kind {order.p1}")


def _loiter(context: CommandContext, order: Order) -> Answer:
    return Answer(context.vehicle.set_mode_kind("hold"))


def _storage(context: CommandContext, order: Order) -> Answer:
    """What is set is kept, so that there is nothing to load or to save; 2 resets it all.

    ArduPilot knows the reset alone.
    """
    if context.profile.storage_resets_only and order.p1 != RESET_PARAMETERS:
        raise RefusedError(Result.DENIED, "ArduPilot reads and writes no parameters")
    if context.vehicle.armed:
        raise RefusedError(Result.TEMPORARILY_REJECTED, "not while armed")
    if order.p1 not in (0.0, 1.0, 2.0):
        raise RefusedError(Result.DENIED, "parameters can be read (0), written (1) or reset (2)")
    if order.p1 == RESET_PARAMETERS:
        context.vehicle.reset_parameters()
    return Answer(Result.ACCEPTED)


FLIGHT: Final[dict[Cmd, CommandEntry]] = {
    Cmd.COMPONENT_ARM_DISARM: CommandEntry(_arm_disarm),
    Cmd.NAV_LOITER_UNLIM: CommandEntry(_loiter, place=True, only="ardupilot"),
    Cmd.DO_ORBIT: CommandEntry(_orbit, place=True, only="px4"),
    Cmd.DO_SET_ROI_LOCATION: CommandEntry(_look_at, place=True),
    Cmd.DO_SET_ROI_NONE: CommandEntry(_look_away),
    Cmd.DO_SET_ROI: CommandEntry(_old_roi, place=True),
    Cmd.PREFLIGHT_STORAGE: CommandEntry(_storage),
    Cmd.NAV_TAKEOFF: CommandEntry(_take_off, place=True),
    Cmd.NAV_LAND: CommandEntry(_land, place=True),
    Cmd.NAV_RETURN_TO_LAUNCH: CommandEntry(_return),
    Cmd.DO_SET_MODE: CommandEntry(_set_mode),
    Cmd.DO_REPOSITION: CommandEntry(_reposition, place=True),
    Cmd.DO_PAUSE_CONTINUE: CommandEntry(_pause_continue, only="ardupilot"),
    Cmd.DO_CHANGE_SPEED: CommandEntry(_change_speed),
    Cmd.DO_CHANGE_ALTITUDE: CommandEntry(_change_altitude, only="px4"),
    Cmd.CONDITION_YAW: CommandEntry(_condition_yaw, only="ardupilot"),
    Cmd.DO_SET_HOME: CommandEntry(_set_home, place=True),
    Cmd.MISSION_START: CommandEntry(_mission_start),
    Cmd.DO_SET_MISSION_CURRENT: CommandEntry(_set_mission_current, only="ardupilot"),
    Cmd.IMAGE_START_CAPTURE: CommandEntry(_image_start),
    Cmd.IMAGE_STOP_CAPTURE: CommandEntry(_image_stop),
    Cmd.SET_CAMERA_MODE: CommandEntry(_camera_mode),
    Cmd.RUN_PREARM_CHECKS: CommandEntry(_prearm_checks),
    Cmd.DO_FENCE_ENABLE: CommandEntry(_fence_enable),
    Cmd.DO_FLIGHTTERMINATION: CommandEntry(_terminate),
    Cmd.PREFLIGHT_REBOOT_SHUTDOWN: CommandEntry(_reboot),
}
