"""What the vehicle does about trouble: it watches while armed, and acts as its parameters say."""

from __future__ import annotations

from vehicle_sim.autopilot.core import Core
from vehicle_sim.autopilot.demands import Situation
from vehicle_sim.autopilot.failsafe import OFFBOARD_LOSS, Action, Failsafe
from vehicle_sim.autopilot.parameters import Quantity


class Watch(Core):
    """Failsafes, carried out."""

    def _guard(self, s: Situation) -> None:
        battery = self._quad.battery
        struck = self._failsafes.check(self.power, battery.remaining, s.wall_ns)
        if struck is not None:
            self._act(struck)

    def _act(self, struck: Failsafe) -> None:
        self._say(struck.severity, struck.text)
        match struck.action:
            case Action.WARN:
                return
            case Action.TERMINATE:
                self._terminate()
            case Action.DISARM:
                self._disarm("Disarmed by failsafe")
            case Action.RETURN | Action.LAND if not self._pilot.flying:
                self._disarm("Disarmed by failsafe")
            case _:
                self._enter_kind(struck.action.value)
        self._failsafe_active = self._armed

    def _watch_offboard(self, s: Situation) -> None:
        if self._mode.name != "OFFBOARD":
            return
        loss_ns = int(self.parameters.si(Quantity.SETPOINT_LOSS_S) * 1e9)
        if self._stream.age_ns(s.wall_ns) >= loss_ns:
            action = OFFBOARD_LOSS[int(self.parameters.get("COM_OBL_RC_ACT"))]
            self._act(Failsafe(action, f"Offboard setpoints lost: {action.value}", 3))
