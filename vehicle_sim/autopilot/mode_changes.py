"""Arming and mode changes: what may be asked, when, and in which words it is refused."""

from __future__ import annotations

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import (
    KINDS,
    MODES,
    Behaviour,
    Flag,
    Mode,
    by_number,
    refusal_words,
    unknown_mode_words,
)
from vehicle_sim.autopilot.view import View


class ModeChanges(View):
    """Each request is answered at once."""

    @property
    def _not_now(self) -> Result:
        """How the personality answers what its own checks refuse."""
        return Result.FAILED if self.personality == "ardupilot" else Result.TEMPORARILY_REJECTED

    def arm(self, force: bool) -> Result:
        if self._armed:
            return Result.ACCEPTED
        if self._terminated:
            return Result.DENIED
        if not force and self._say_against_arming():
            return self._not_now
        self._armed = True
        self._armed_ns = self.time_ns
        self._auto_disarm.on_ground(False, self.time_ns)
        if self._origin is not None:
            self.move_home(None)
        self._task.begin(self._look_around(), self._pilot.heading)
        self._pilot.rest()
        self._poke()
        self._say(6, "Arming motors" if self.personality == "ardupilot" else "Armed by command")
        return Result.ACCEPTED

    def disarm(self, force: bool) -> Result:
        if not self._armed:
            return Result.ACCEPTED
        if self._pilot.flying and not force:
            self._say(4, "Disarming denied: not landed")
            return Result.FAILED if self.personality == "ardupilot" else Result.DENIED
        word = "Disarming motors" if self.personality == "ardupilot" else "Disarmed by command"
        self._disarm(word)
        return Result.ACCEPTED

    def set_mode(self, base_mode: int, custom_mode: int) -> Result:
        if not base_mode & Flag.CUSTOM_MODE_ENABLED:
            return Result.UNSUPPORTED
        mode = by_number(self.personality, custom_mode)
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
        if same and mode.behaviour is not Behaviour.HOLD:
            return Result.ACCEPTED
        if self._held_by_fence(mode):
            return self._not_now
        if mode.needs_position and not self._position_ok:
            return self._refuse(mode, "requires position")
        if mode.behaviour is Behaviour.MISSION and not self._mission_ok:
            return self._refuse(mode, "init failed")
        if mode.name == "FOLLOW" and not self.parameters.get("FOLL_ENABLE"):
            self._say(4, "Set FOLL_ENABLE = 1")
            return self._refuse(mode, "init failed")
        if mode.name == "OFFBOARD":
            return self._ask_offboard(mode)
        self._enter(mode)
        return Result.ACCEPTED

    def _refuse(self, mode: Mode, why: str) -> Result:
        self._say(*refusal_words(self.personality, mode.name, why))
        return self._not_now

    def _ask_offboard(self, mode: Mode) -> Result:
        """A stream of more than 2 Hz is a must; the mode follows when it has lasted a second."""
        wall_ns = self._sense().wall_ns
        if not self._stream.alive(wall_ns):
            self._say(4, "Offboard refused: no setpoint stream")
            return Result.TEMPORARILY_REJECTED
        if self._stream.proven(wall_ns):
            self._enter(mode)
        else:
            self._offboard_wanted = True
        return Result.ACCEPTED
