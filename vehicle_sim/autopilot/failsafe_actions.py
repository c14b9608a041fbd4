"""What the vehicle's failsafes do: it watches while armed, and acts as its parameters say.

Of several failsafes the worse wins.  An operator may take over by changing the mode, which ends
what was being done; a new failsafe then acts anew.  PX4 holds for COM_FAIL_ACT_T before it acts,
so that somebody can.  ArduCopter lets nobody leave what a fence breach led to until it is back
inside, unless FENCE_OPTIONS allows it.
"""

from __future__ import annotations

from math import ceil, inf

from vehicle_sim.autopilot.control.demands import Situation, Task
from vehicle_sim.autopilot.failsafes.failsafe import (
    OFFBOARD_LOSS,
    RANK,
    Action,
    Cause,
    Failsafe,
    activated,
)
from vehicle_sim.autopilot.failsafes.failsafe_checks import Cleared, Strike
from vehicle_sim.autopilot.health_checks import HealthChecks
from vehicle_sim.autopilot.modes import Mode
from vehicle_sim.autopilot.parameters.parameters import Quantity
from vehicle_sim.autopilot.tasks.descend import Descend
from vehicle_sim.autopilot.tasks.tasks import Hold, TakeOff
from vehicle_sim.control_loops.flight import BY_RATES

_WITHOUT = frozenset({Action.POSITION, Action.HOLD, Action.BRAKE, Action.RETURN, Action.LAND})
_GRACE_COMES_BACK = 4.0
_EMERGENCY = frozenset({Action.DESCEND, Action.DISARM, Action.TERMINATE})


class FailsafeActions(HealthChecks):
    """Failsafes, carried out."""

    _grace_left_s: float
    _grace_ns: int
    _acting: Failsafe | None
    _due_ns: int | None
    _came_from: Mode | None
    _overruled: Failsafe | None
    _on_its_own: bool

    def _restart(self) -> None:
        super()._restart()
        self._failsafe_checks.restart()
        self._failure_detector.reset()
        self._geofence.forget()
        self._on_its_own = False
        self._due_ns = None
        self._grace_left_s = inf
        self._grace_ns = self.time_ns
        self._stand_down()

    def _stand_down(self) -> None:
        """Nothing is being done about anything."""
        if self._due_ns is not None:  # what is left of the delay is left for the next one
            self._grace_left_s = max(0.0, (self._due_ns - self.time_ns) * 1e-9)
            self._grace_ns = self.time_ns
        self._acting = None
        self._due_ns = None
        self._came_from = None
        self._overruled = None

    @property
    def emergency(self) -> bool:
        """What is being done is a last resort: MAV_STATE_EMERGENCY in place of CRITICAL."""
        return self._acting is not None and self._acting.action in _EMERGENCY

    def gcs_heard(self, wall_ns: int) -> None:
        cleared = self._failsafe_checks.station_heard(wall_ns)
        if cleared is not None:
            self._say(cleared.severity, cleared.text)

    # ---------------------------------------------------------------- who is in command

    def _enter(self, mode: Mode, task: Task | None = None) -> None:
        super()._enter(mode, task)
        if self.personality == "ardupilot" and self._geofence.breached:
            self._say(6, "Manual recovery started")
        if self._on_its_own:
            return
        if mode.may_arm:
            # PX4 goes back to it with the disarming (UserModeIntention).
            self._mode_after_disarming = mode
        if self._acting is not None and self._acting.cause is Cause.FENCE:
            self._geofence.taken_over(self.time_ns)
        self._stand_down()

    def _disarm(self, text: str) -> None:
        super()._disarm(text)
        self._stand_down()
        self._failsafe_checks.reset()
        self._failure_detector.reset()

    def _held_by_fence(self, mode: Mode) -> bool:
        """Whether ArduCopter refuses to leave what a breach led to, and says so."""
        acting = self._acting
        if (
            self.personality == "px4"
            or acting is None
            or acting.cause is not Cause.FENCE
            or not self._geofence.breached
            or not int(self.parameters.get("FENCE_OPTIONS")) & 1
        ):
            return False
        self._say(4, f"Mode change to {mode.name} failed: in fence recovery")
        return True

    # --------------------------------------------------------------------- what it sees

    def _guard(self, s: Situation) -> None:
        """Ten times a second while armed."""
        crossing = self._look_at_fence(s)
        strikes: list[Strike] = []
        if not self._quiet(s, crossing):
            strikes += self._failsafe_checks.check(self._see(s, crossing))
        if not self._calm:
            by_rates = self.blocks.flight.attitude == BY_RATES
            strikes += self._failure_detector.check(self._posture(), s.flying, by_rates, s.time_ns)
        for strike in sorted(strikes, key=_order):
            if isinstance(strike, Cleared):
                self._relax(strike, s)
            elif self._armed:
                self._strike(strike, s)
        if self._due_ns is not None and s.time_ns >= self._due_ns and self._acting is not None:
            self._due_ns = None
            self._say(self._acting.severity, self._acting.text)
            self._carry_out(self._acting.action)

    def _watch_disarmed(self, s: Situation) -> None:
        """Ten times a second while disarmed: what is told then, and stands in the way of arming."""
        for struck in self._failsafe_checks.check_disarmed(
            s.wall_ns, self.power, self._charge_seen
        ):
            self._say(struck.severity, struck.text)

    # -------------------------------------------------------------------- what it does

    def _strike(self, struck: Failsafe, s: Situation) -> None:
        """Say it, and act if it is worse than what is being done already."""
        acting = self._acting
        worse = acting is None or RANK[struck.action] > RANK[acting.action]
        if struck.action is Action.WARN or not worse:
            if struck.action is Action.WARN or self.personality != "px4":
                self._say(struck.severity, struck.text)
            return
        wait_s = self._grace_s(struck, s)
        self._acting = struck
        self._came_from = self._came_from or self._mode
        self._overruled = acting
        if wait_s > 0.0:
            self._due_ns = s.time_ns + int(wait_s * 1e9)
            self._grace_left_s, self._grace_ns = 0.0, self._due_ns
            self._say(struck.severity, f"{struck.text} in {ceil(wait_s):.0f} seconds")
            climbing = self._task if isinstance(self._task, TakeOff) and not s.flying else None
            self._change(Action.HOLD)
            if climbing is not None:
                self._task = Hold(climbing.target.pos_ned, lifts=True)
        else:
            self._due_ns = None
            self._say(struck.severity, struck.text)
            self._carry_out(struck.action)

    def _grace_s(self, struck: Failsafe, s: Situation) -> float:
        """How long PX4 holds first: not for what is urgent, nor where it could not hold."""
        at_once = struck.action in (Action.DISARM, Action.TERMINATE) or not struck.delayed
        if (
            at_once
            or self._acting is not None
            or not (s.flying or self._task.lifts_off(s))
            or self._failsafe_checks.position_lost
        ):
            return 0.0
        # A delay that was used comes back in four times the time that it lasted.
        back_s = max(0, s.time_ns - self._grace_ns) * 1e-9 / _GRACE_COMES_BACK
        return min(self._grace_left_s + back_s, self.parameters.get("COM_FAIL_ACT_T"))

    def _carry_out(self, action: Action) -> None:
        match action:
            case Action.TERMINATE:
                self._terminate()
            case Action.DISARM:
                self._disarm("Disarmed by failsafe")
            case Action.RETURN | Action.LAND | Action.DESCEND if not self._pilot.flying:
                self._disarm("Disarmed by failsafe")
            case _:
                self._change(action)
        self._failsafe_active = self._armed

    def _change(self, action: Action) -> None:
        """The mode for it; without a position what needs one becomes a descent."""
        if action is Action.DESCEND or (action in _WITHOUT and self._failsafe_checks.position_lost):
            kind, task = "land", Descend(self.parameters)
        else:
            kind, task = action.value, None
        self._on_its_own = True
        self._enter_kind(kind, task)
        self._on_its_own = False
        self._failsafe_active = self._armed

    def _relax(self, cleared: Cleared, s: Situation) -> None:
        """What triggered it has gone.  PX4 goes back to what it flew before it lost position."""
        if cleared.text:
            self._say(cleared.severity, cleared.text)
        acting, came_from = self._acting, self._came_from
        if self.personality != "px4" or acting is None or acting.cause is not Cause.POSITION:
            return
        if cleared.cause is not Cause.POSITION:
            return
        if self._overruled is not None:
            self._acting, self._overruled = self._overruled, None
            self._carry_out(self._acting.action)
        elif came_from is not None and s.flying:
            self._enter(came_from)

    def _watch_offboard(self, s: Situation) -> None:
        if self._mode.name != "OFFBOARD":
            return
        loss_ns = int(self.parameters.si(Quantity.SETPOINT_LOSS_S) * 1e9)
        if self._stream.age_ns(s.wall_ns) >= loss_ns:
            action = OFFBOARD_LOSS[int(self.parameters.get("COM_OBL_RC_ACT"))]
            text = activated(action, "no offboard signal")
            self._strike(Failsafe(Cause.SETPOINTS, action, text, 2), s)


def _order(strike: Strike) -> int:
    """What has gone first, then what is only told, then the worst."""
    if isinstance(strike, Cleared):
        return -2
    return -1 if strike.action is Action.WARN else len(RANK) - RANK[strike.action]
