"""What the vehicle's failsafes do: it watches while armed, and acts as its parameters say.

Of several failsafes the worse wins.  An operator may take over by changing the mode, which ends
what was being done; a new failsafe then acts anew.  PX4 holds for COM_FAIL_ACT_T before it acts,
so that somebody can.  ArduCopter lets nobody leave what a fence breach led to until it is back
inside, unless FENCE_OPTIONS allows it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

from vehicle_sim.autopilot.acting_failsafe import ActingFailsafe
from vehicle_sim.autopilot.bounds import Bounds
from vehicle_sim.autopilot.control.demands import Situation
from vehicle_sim.autopilot.failsafes.failsafe import (
    OFFBOARD_LOSS,
    RANK,
    Action,
    Cause,
    Failsafe,
    activated,
)
from vehicle_sim.autopilot.failsafes.failsafe_checks import Cleared, FailsafeChecks, FailsafeEvent
from vehicle_sim.autopilot.failsafes.failure_detector import FailureDetector
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.battery_monitor import BatteryMonitor
from vehicle_sim.autopilot.health.health_checks import HealthChecks
from vehicle_sim.autopilot.modes import Mode
from vehicle_sim.autopilot.parameters.parameters import Quantity
from vehicle_sim.autopilot.tasks.descend import Descend
from vehicle_sim.autopilot.tasks.guided import SetpointStream
from vehicle_sim.autopilot.tasks.tasks import Hold, TakeOff
from vehicle_sim.autopilot.transitions import Transitions
from vehicle_sim.control_loops.flight import BY_RATES

_WITHOUT = frozenset({Action.POSITION, Action.HOLD, Action.BRAKE, Action.RETURN, Action.LAND})
_GRACE_COMES_BACK = 4.0


@dataclass(slots=True, eq=False, repr=False)
class FailsafeActions:
    """Failsafes, carried out."""

    _state: FlightState
    _battery: BatteryMonitor
    _bounds: Bounds
    _health_checks: HealthChecks
    _stream: SetpointStream
    _acting: ActingFailsafe
    _transitions: Transitions
    _failsafe_checks: FailsafeChecks
    _failure_detector: FailureDetector

    def gcs_heard(self, wall_ns: int) -> None:
        cleared = self._failsafe_checks.station_heard(wall_ns)
        if cleared is not None:
            self._state.say(cleared.severity, cleared.text)

    def held_by_fence(self, mode: Mode) -> bool:
        """Whether ArduCopter refuses to leave what a breach led to, and says so."""
        state = self._state
        acting = self._acting.failsafe
        if (
            not state.rules.fence_may_hold_mode
            or acting is None
            or acting.cause is not Cause.FENCE
            or not self._bounds.geofence.breached
            or not int(state.parameters.get("FENCE_OPTIONS")) & 1
        ):
            return False
        state.say(4, f"Mode change to {mode.name} failed: in fence recovery")
        return True

    # --------------------------------------------------------------------- what it sees

    def watch_armed(self, s: Situation) -> None:
        """Ten times a second while armed."""
        state = self._state
        crossing = self._bounds.crossing(s)
        events: list[FailsafeEvent] = []
        if not self._health_checks.failsafes_nominal(s, crossing):
            events += self._failsafe_checks.check(self._health_checks.see(s, crossing))
        if not self._health_checks.flight_nominal:
            by_rates = state.loops.attitude == BY_RATES
            posture = self._health_checks.posture()
            events += self._failure_detector.check(posture, s.flying, by_rates, s.time_ns)
        for event in sorted(events, key=_order):
            if isinstance(event, Cleared):
                self._clear(event, s)
            elif state.armed:
                self._trigger(event, s)
        due_ns, acting = self._acting.due_ns, self._acting.failsafe
        if due_ns is not None and s.time_ns >= due_ns and acting is not None:
            self._acting.due_ns = None
            state.say(acting.severity, acting.text)
            self._carry_out(acting.action)

    def watch_disarmed(self, s: Situation) -> None:
        """Ten times a second while disarmed: what is told then, and stands in the way of arming."""
        for failsafe in self._failsafe_checks.check_disarmed(
            s.wall_ns, self._battery.power, self._battery.charge_seen
        ):
            self._state.say(failsafe.severity, failsafe.text)

    def watch_offboard(self, s: Situation) -> None:
        state = self._state
        if not state.mode.needs_stream:
            return
        loss_ns = int(state.parameters.si(Quantity.SETPOINT_LOSS_S) * 1e9)
        if self._stream.age_ns(s.wall_ns) >= loss_ns:
            action = OFFBOARD_LOSS[int(state.parameters.get("COM_OBL_RC_ACT"))]
            text = activated(action, "no offboard signal")
            self._trigger(Failsafe(Cause.SETPOINTS, action, text, 2), s)

    # -------------------------------------------------------------------- what it does

    def _trigger(self, failsafe: Failsafe, s: Situation) -> None:
        """Say it, and act if it is worse than what is being done already."""
        state = self._state
        acting = self._acting.failsafe
        worse = acting is None or RANK[failsafe.action] > RANK[acting.action]
        if failsafe.action is Action.WARN or not worse:
            if failsafe.action is Action.WARN or state.rules.tells_lesser_failsafes:
                state.say(failsafe.severity, failsafe.text)
            return
        wait_s = self._grace_s(failsafe, s)
        self._acting.failsafe = failsafe
        self._acting.came_from = self._acting.came_from or state.mode
        self._acting.overruled = acting
        if wait_s > 0.0:
            self._acting.due_ns = s.time_ns + int(wait_s * 1e9)
            self._acting.grace_left_s, self._acting.grace_ns = 0.0, self._acting.due_ns
            state.say(failsafe.severity, f"{failsafe.text} in {ceil(wait_s):.0f} seconds")
            climbing = state.task if isinstance(state.task, TakeOff) and not s.flying else None
            self._change(Action.HOLD)
            if climbing is not None:
                state.task = Hold(climbing.target.pos_ned, lifts=True)
        else:
            self._acting.due_ns = None
            state.say(failsafe.severity, failsafe.text)
            self._carry_out(failsafe.action)

    def _grace_s(self, failsafe: Failsafe, s: Situation) -> float:
        """How long PX4 holds first: not for what is urgent, nor where it could not hold."""
        at_once = failsafe.action in (Action.DISARM, Action.TERMINATE) or not failsafe.delayed
        if (
            at_once
            or self._acting.failsafe is not None
            or not (s.flying or self._state.task.lifts_off(s))
            or self._failsafe_checks.position_lost
        ):
            return 0.0
        # A delay that was used comes back in four times the time that it lasted.
        back_s = max(0, s.time_ns - self._acting.grace_ns) * 1e-9 / _GRACE_COMES_BACK
        return min(self._acting.grace_left_s + back_s, self._state.parameters.get("COM_FAIL_ACT_T"))

    def _carry_out(self, action: Action) -> None:
        state = self._state
        match action:
            case Action.TERMINATE:
                self._transitions.terminate()
            case Action.DISARM:
                self._transitions.disarm("Disarmed by failsafe")
            case Action.RETURN | Action.LAND | Action.DESCEND if not state.control.flying:
                self._transitions.disarm("Disarmed by failsafe")
            case _:
                self._change(action)
        state.failsafe_active = state.armed

    def _change(self, action: Action) -> None:
        """The mode for it; without a position what needs one becomes a descent."""
        state = self._state
        if action is Action.DESCEND or (action in _WITHOUT and self._failsafe_checks.position_lost):
            kind, task = "land", Descend(state.parameters)
        else:
            kind, task = action.value, None
        self._acting.on_its_own = True
        self._transitions.enter_kind(kind, task)
        self._acting.on_its_own = False
        state.failsafe_active = state.armed

    def _clear(self, cleared: Cleared, s: Situation) -> None:
        """What triggered it has gone.  PX4 goes back to what it flew before it lost position."""
        if cleared.text:
            self._state.say(cleared.severity, cleared.text)
        acting, came_from = self._acting.failsafe, self._acting.came_from
        if not self._state.rules.mode_back_with_position or acting is None:
            return
        if acting.cause is not Cause.POSITION or cleared.cause is not Cause.POSITION:
            return
        if self._acting.overruled is not None:
            self._acting.failsafe, self._acting.overruled = self._acting.overruled, None
            self._carry_out(self._acting.failsafe.action)
        elif came_from is not None and s.flying:
            self._transitions.enter(came_from)


def _order(event: FailsafeEvent) -> int:
    """What has gone first, then what is only told, then the worst."""
    if isinstance(event, Cleared):
        return -2
    return -1 if event.action is Action.WARN else len(RANK) - RANK[event.action]
