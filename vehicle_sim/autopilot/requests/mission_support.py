"""What a mission may ask of the rest of the vehicle."""

from __future__ import annotations

from vehicle_sim.autopilot.bounds import Bounds
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import Result, SpeedType, VehicleEvent
from vehicle_sim.autopilot.mission.plan import Datum
from vehicle_sim.autopilot.requests.camera import CameraRequests
from vehicle_sim.autopilot.requests.outputs import OutputRequests
from vehicle_sim.autopilot.transitions import Transitions
from vehicle_sim.numerics.vectors import Vec3


class MissionSupport:
    """The `MissionVehicle` of `mission/mission_commands.py`."""

    def __init__(
        self,
        state: FlightState,
        bounds: Bounds,
        camera: CameraRequests,
        outputs: OutputRequests,
        transitions: Transitions,
    ) -> None:
        self._state = state
        self._bounds = bounds
        self._camera = camera
        self._transitions = transitions
        self.actuate = outputs.actuate

    def emit(self, event: VehicleEvent) -> None:
        self._state.emit(event)

    def datum(self) -> Datum:
        return self._state.datum()

    def take_pictures(self, interval_s: float, count: int) -> None:
        self._camera.take_pictures(interval_s, count)

    def stop_pictures(self) -> None:
        self._camera.stop_pictures()

    def change_speed(self, kind: float, speed_m_s: float | None) -> None:
        typed = self._state.rules.mission_speeds_have_type
        self._state.change_speed(speed_m_s, SpeedType(int(kind)) if typed else SpeedType.GROUND)

    def move_home(self, where_ned: Vec3 | None) -> None:
        self._state.move_home(where_ned)

    def enable_fence(self, choice: int) -> Result:
        return self._bounds.enable_fence(choice)

    def turn_nose(self, yaw_rad: float, rate_rad_s: float, direction: int) -> None:
        self._state.control.heading.turn(yaw_rad, rate_rad_s, direction)

    def nose_turns(self) -> bool:
        return self._state.control.heading.turning

    def leave_for_return(self) -> bool:
        if not self._state.rules.mission_return_changes_mode:
            return False
        self._state.say(6, "Returning to launch")
        self._transitions.enter_kind("return")
        return True

    def leave_without_terrain(self) -> bool:
        """ArduCopter's failsafe_terrain_on_event, from memory: home, with a text."""
        self._state.say(2, "Failsafe: Terrain data missing")
        self._transitions.enter_kind("return")
        return True
