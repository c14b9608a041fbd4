"""PX4's events interface: EVENT, CURRENT_EVENT_SEQUENCE, REQUEST_EVENT and RESPONSE_EVENT_ERROR.

An event has a number in a row, so that a station notices which it has missed, and asks for it
(https://mavlink.io/en/services/events.html).  Beside the events that go with the vehicle's texts
there is the health and arming report: 2 s after boot, then when it has changed but every 2 s at
most, and when RUN_PREARM_CHECKS asks for it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import Final

from vehicle_sim.autopilot.interface import Vehicle
from vehicle_sim.autopilot.modes import MODES
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.effects import Client, Effect, Send
from vehicle_sim.services.events.health_report import Checked, report
from vehicle_sim.services.events.px4_events import Modes, PX4Event, event_of
from vehicle_sim.services.units import boot_ms
from vehicle_sim.wire import messages as m

FIRST_SEQUENCE: Final = 65526
"""PX4 begins shortly before the number wraps, so that every client meets that."""
KEPT: Final = 20
"""So many of the last events can be asked for again."""
ANSWERED_MAX: Final = 256
"""Of one REQUEST_EVENT."""
REPORT_EVERY_NS: Final = 2_000_000_000
FIRST_REPORT_NS: Final = 2_080_000_000
"""After boot, as recorded."""
LOOK_EVERY_NS: Final = 500_000_000
S_NS: Final = 1_000_000_000
NO_MODES_TO_ARM_IN: Final = frozenset(
    MODES["px4"][name].custom_mode for name in ("AUTO.RTL", "AUTO.LAND", "POSCTL.ORBIT")
)
NO_MISSION: Final = 1  # MISSION_STATE
NEVER_NS: Final = -(1 << 62)


class EventServer:
    """The events of one vehicle.  Pure; the vehicle's own time, wall time where it is said."""

    def __init__(self, vehicle: Vehicle, parameters: Parameters, on: bool) -> None:
        """`on`: whether the vehicle has the interface; without it nothing is ever sent."""
        self.on: Final = on
        self._vehicle = vehicle
        self._given = parameters
        self._kept: deque[m.Event] = deque(maxlen=KEPT)
        self._next = FIRST_SEQUENCE
        self._custom_mode = vehicle.custom_mode
        self._reported: tuple[PX4Event, ...] = ()
        self._reported_ns = NEVER_NS
        self._look_ns = FIRST_REPORT_NS
        self._station_wall_ns = self._setpoint_wall_ns = NEVER_NS

    # -------------------------------------------------------------------- what was heard

    def station_heard(self, wall_ns: int) -> None:
        self._station_wall_ns = wall_ns

    def setpoint_heard(self, wall_ns: int) -> None:
        self._setpoint_wall_ns = wall_ns

    def restart(self) -> None:
        """The vehicle has booted anew."""
        self._kept.clear()
        self._next = FIRST_SEQUENCE
        self._reported = ()
        self._reported_ns, self._look_ns = NEVER_NS, self._vehicle.time_ns + FIRST_REPORT_NS

    # ------------------------------------------------------------------------ what is said

    def said(self, text: str) -> list[Effect]:
        """The event that goes with a text, if there is one."""
        if not self.on:
            return []
        modes = Modes(self._vehicle.custom_mode, self._custom_mode)
        event = event_of(text, modes)
        return self._send([event]) if event is not None else []

    def step(self, wall_ns: int) -> list[Effect]:
        """After the vehicle's decisions: a report, if there is something new to report."""
        now_ns = self._vehicle.time_ns
        if now_ns < self._look_ns or not self.on:
            return []
        self._look_ns = now_ns + LOOK_EVERY_NS
        self._custom_mode = self._vehicle.custom_mode
        if now_ns - self._reported_ns < REPORT_EVERY_NS:
            return []
        new = report(self._checked(wall_ns))
        return self._report(new) if new != self._reported else []

    def check(self, wall_ns: int) -> list[Effect]:
        """RUN_PREARM_CHECKS: a report in any case."""
        return self._report(report(self._checked(wall_ns))) if self.on else []

    def current_sequence(self) -> m.CurrentEventSequence:
        """The last one's number."""
        return m.CurrentEventSequence(sequence=(self._next - 1) & 0xFFFF, flags=0)

    def request(self, client: Client, asked: m.RequestEvent) -> list[Effect]:
        """REQUEST_EVENT: each event again, or that it is not kept any more."""
        if not self.on:
            return []
        count = ((asked.last_sequence - asked.first_sequence) & 0xFFFF) + 1
        kept = {event.sequence: event for event in self._kept}
        oldest = self._kept[0].sequence if self._kept else self._next
        effects: list[Effect] = []
        for turn in range(min(count, ANSWERED_MAX)):
            number = (asked.first_sequence + turn) & 0xFFFF
            event = kept.get(number)
            if event is None:
                error = m.ResponseEventError(number, oldest, client.system, client.component, 0)
                effects.append(Send(client.channel, error))
            else:
                effects.append(Send(client.channel, event))
        return effects

    # ------------------------------------------------------------------------------ inside

    def _report(self, new: tuple[PX4Event, ...]) -> list[Effect]:
        self._reported, self._reported_ns = new, self._vehicle.time_ns
        return self._send(new)

    def _send(self, events: Iterable[PX4Event]) -> list[Effect]:
        effects: list[Effect] = []
        for event in events:
            message = m.Event(
                id=event.id,
                event_time_boot_ms=boot_ms(self._vehicle),
                sequence=self._next,
                destination_component=0,
                destination_system=0,
                log_levels=event.log_levels,
                arguments=event.arguments,
            )
            self._next = (self._next + 1) & 0xFFFF
            self._kept.append(message)
            effects.append(Send(None, message))
        return effects

    def _checked(self, wall_ns: int) -> Checked:
        vehicle, given = self._vehicle, self._given
        health = vehicle.health
        local = health.velocity_ok and health.position_ok and health.height_ok
        station_age_ns = wall_ns - self._station_wall_ns
        setpoint_age_ns = wall_ns - self._setpoint_wall_ns
        return Checked(
            attitude=health.attitude_ok,
            velocity=health.velocity_ok,
            local_position=local,
            global_position=local and vehicle.home is not None,
            gps=health.gps_ok,
            mission=vehicle.mission_state != NO_MISSION,
            offboard=setpoint_age_ns <= given.get("COM_OF_LOSS_T") * S_NS,
            sticks=vehicle.sticks is not None,
            station=station_age_ns <= given.get("COM_DL_LOSS_T") * S_NS,
            station_needed=given.get("NAV_DLL_ACT") != 0,
            within_fence=not vehicle.fence_state.breached,
            mode_to_arm_in=vehicle.custom_mode not in NO_MODES_TO_ARM_IN,
        )
