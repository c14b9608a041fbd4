"""Arming and mode changes: what may be asked, when, and in which words it is refused."""

from __future__ import annotations

from vehicle_sim.autopilot.failsafes.arm_authorization import (
    ARM_AUTHORIZATION_REQUEST,
    Permission,
)
from vehicle_sim.autopilot.interface import CommandDone, Landed, Result
from vehicle_sim.autopilot.modes import (
    AUTO_MAIN_MODE,
    KINDS,
    MODES,
    Behaviour,
    Flag,
    Mode,
    by_number,
    main_mode,
    refusal_words,
    unknown_mode_words,
)
from vehicle_sim.autopilot.rules import RULES
from vehicle_sim.autopilot.tasks.tasks import Hold, TakeOff
from vehicle_sim.autopilot.view import View

_ARM_DISARM, _MISSION_START = 400, 300  # MAV_CMD that arm
_CLEAR_M = 0.5  # less than this above home, and a take-off has not left the ground


class ModeChanges(View):
    """Each request is answered at once."""

    @property
    def _not_now(self) -> Result:
        """How the personality answers what its own checks refuse."""
        return RULES[self.personality].not_now

    def arm(self, force: bool) -> Result:
        if self._armed:
            return Result.ACCEPTED
        if self._terminated:
            self._say(2, "Preflight Fail: Flight termination active")
            return Result.TEMPORARILY_REJECTED
        if self._calibration.busy and self.personality == "px4":
            self._say(2, "Transition denied: Init to Armed")
            return Result.TEMPORARILY_REJECTED
        if self._held_by_boot(force) or (not force and self._say_against_arming(True)):
            return self._not_now
        if self.personality == "px4" and not force:
            permission = self._arm_authorization.ask(self._sense().wall_ns)
            self._tell_authorization()
            if permission is not Permission.GRANTED:
                waits = permission is Permission.WAIT
                return Result.IN_PROGRESS if waits else self._not_now
        self._start_motors()
        return Result.ACCEPTED

    def _start_motors(self) -> None:
        self._armed = True
        self._armed_ns = self.time_ns
        self._auto_disarm.on_ground(False, self.time_ns)
        if self._origin is not None:
            self.move_home(None)
        self._task.begin(self._look_around(), self._pilot.heading)
        self._pilot.rest()
        self._poke()
        ardupilot = self.personality == "ardupilot"
        self._say(6, "Arming motors" if ardupilot else "Armed by external command")
        self._say_take_off()

    # --------------------------------------------------------------- arm authorization

    def command_acked(self, command: int, result: int, param1: int, param2: int) -> None:
        if self.personality == "px4" and command == ARM_AUTHORIZATION_REQUEST:
            wall_ns = self._sense().wall_ns
            permission = self._arm_authorization.answered(result, param1, param2, wall_ns)
            self._settle_authorization(permission)

    def _decide(self, regular: bool) -> None:
        authorization = self._arm_authorization
        if authorization.waiting and authorization.timed_out(self._sense().wall_ns):
            self._settle_authorization(Permission.REFUSED)
        super()._decide(regular)

    def _settle_authorization(self, permission: Permission) -> None:
        """The `arm` that waited is carried out, or refused."""
        self._tell_authorization()
        if permission is Permission.WAIT or int(self.parameters.get("COM_ARM_AUTH_MET")) != 0:
            return
        granted = permission is Permission.GRANTED and not self._terminated
        if granted and not self._armed:
            self._start_motors()
        result = Result.ACCEPTED if granted else self._not_now
        for command in (_ARM_DISARM, _MISSION_START):
            self.emit(CommandDone(command, result))
        self._poke()

    def _tell_authorization(self) -> None:
        events, self._arm_authorization.events = self._arm_authorization.events, []
        self._events += events

    def disarm(self, force: bool) -> Result:
        if not self._armed:
            return Result.ACCEPTED
        if (self._pilot.flying or self._cut_off_in_air) and not force:
            if self.personality == "px4":
                self._say(2, "Disarming denied! Not landed")
            return self._not_now
        ardupilot = self.personality == "ardupilot"
        self._disarm("Disarming motors" if ardupilot else "Disarmed by external command")
        return Result.ACCEPTED

    def set_mode(self, base_mode: int, custom_mode: int) -> Result:
        if not base_mode & Flag.CUSTOM_MODE_ENABLED:
            return Result.UNSUPPORTED
        mode = by_number(self.personality, custom_mode)
        if mode is None and self.personality == "px4" and main_mode(custom_mode) != AUTO_MAIN_MODE:
            return Result.ACCEPTED  # as recorded: of main modes it looks at none that it lacks
        if mode is None:
            self._say(*unknown_mode_words(self.personality, custom_mode))
            return self._not_now
        return self._change_mode(mode)

    def set_mode_kind(self, kind: str) -> Result:
        name = KINDS[self.personality].get(kind)
        if name is None:
            return Result.UNSUPPORTED
        return self._change_mode(MODES[self.personality][name])

    def _change_mode(self, mode: Mode) -> Result:
        # Asked to hold while it holds it stops anew: it may be on its way to a reposition goal.
        same = mode is self._mode and self._paused is None
        if same and (mode.behaviour is not Behaviour.HOLD or self._leaves_the_ground):
            return Result.ACCEPTED
        if self._held_by_fence(mode):
            return self._not_now
        starting = not self._armed and not self.boot_stage.position
        if mode.needs_position and not self._position_ok and not starting:
            return self._refuse(mode, "requires position")
        if self._lacks_sticks(mode):
            return self._refuse(mode, "no manual control")
        if self._has_flown(mode):
            self._say(2, "No valid mission available, loitering")
            self._enter_kind("hold")
            return Result.ACCEPTED
        if mode.behaviour is Behaviour.MISSION and not self._may_start(mode):
            return self._refuse(mode, "init failed")
        if mode.name == "FOLLOW" and not self.parameters.get("FOLL_ENABLE"):
            self._say(4, "Set FOLL_ENABLE = 1")
            return self._refuse(mode, "init failed")
        if mode.name == "OFFBOARD" and self._armed:
            return self._ask_offboard(mode)
        self._enter(mode, self._goes_on_up(mode))
        self._say_take_off()
        return Result.ACCEPTED

    def _lacks_sticks(self, mode: Mode) -> bool:
        """Armed, PX4 enters no mode that is flown by hand while there are no sticks."""
        by_hand = self.personality == "px4" and self._armed and mode.law is not None
        return by_hand and self._radio.sticks(self._sense().wall_ns) is None

    def _has_flown(self, mode: Mode) -> bool:
        """In the air PX4 does not begin a mission that is over from the start."""
        flown = self._mission.finished and self._pilot.flying
        return self.personality == "px4" and mode.behaviour is Behaviour.MISSION and flown

    def _say_take_off(self) -> None:
        """What PX4 says when its mission is going to leave the ground."""
        mission = self._mission
        grounded = self._armed and not self._pilot.flying
        if self.personality != "px4" or self._task is not mission or not grounded:
            return
        beyond = mission.jump_beyond
        if beyond is not None:
            count = len(mission.items)
            self._say(2, f"Mission item index out of bound, index: {beyond}, max: {count}.")
        up_m = mission.take_off_up_m(self._home_ned or (0.0, 0.0, 0.0))
        self._say(6, f"Takeoff to {up_m:.1f} meters above home")

    def _may_start(self, mode: Mode) -> bool:
        """A disarmed vehicle takes the mission mode with any mission, and with none."""
        if not self._armed:
            return True
        if not self._mission_ok:
            return False
        if self.personality == "px4" or self._pilot.flying or self._mission.takes_off:
            return True
        self._say(2, "Auto: Missing Takeoff Cmd")
        return False

    def _goes_on_up(self, mode: Mode) -> Hold | None:
        """PX4's HOLD, asked for before the take-off has left the ground: up to its height."""
        task = self._task
        if self.personality != "px4" or not isinstance(task, TakeOff):
            return None
        home_d = self._home_ned[2] if self._home_ned is not None else 0.0
        if self._pilot.flying and home_d - self._est.pos_d > _CLEAR_M:
            return None
        if mode.behaviour is not Behaviour.HOLD:
            return None
        return Hold(task.target.pos_ned, lifts=True, landed_word=Landed.TAKEOFF)

    @property
    def _leaves_the_ground(self) -> bool:
        """It stands, and its HOLD has a place to fly to."""
        task = self._task
        return isinstance(task, Hold) and task.lifts and not self._pilot.flying

    def _refuse(self, mode: Mode, why: str) -> Result:
        self._say(*refusal_words(self.personality, mode.name, why))
        return self._not_now

    def _ask_offboard(self, mode: Mode) -> Result:
        """A stream of more than 2 Hz is a must; the mode follows when it has lasted a second."""
        wall_ns = self._sense().wall_ns
        if not self._stream.alive(wall_ns):
            return self._refuse(mode, "no setpoint stream")
        if self._stream.proven(wall_ns):
            self._enter(mode)
        else:
            self._offboard_wanted = True
        return Result.ACCEPTED
