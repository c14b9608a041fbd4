"""What the gate of a vehicle decided, put into practice; and the last resort without it."""

from __future__ import annotations

from gcs.gate import effects
from gcs.gate.effects import CommandKind
from gcs.gate.states import Control, State
from gcs.protocol.effects import Send
from gcs.report import SetpointItem
from gcs.session.effects import Record
from gcs.session.work import CheckStart, PlaceFence, Work
from gcs.vehicle.parts import VehicleParts
from gcs.vehicle.setpoints import attitude_target, setpoint


class VehicleDecisions:
    """From an effect of the gate to the frame, the command or the line that it becomes."""

    def __init__(self, parts: VehicleParts) -> None:
        self._parts = parts

    def carry_out(
        self, effect: effects.Effect | PlaceFence | CheckStart, now_ns: int
    ) -> list[Work]:
        """What the gate decided, put into practice."""
        parts = self._parts
        match effect:
            case effects.SendSetpoint(permit):
                assert parts.telemetry is not None
                made = setpoint if permit.attitude is None else attitude_target
                message = made(parts.telemetry, permit, parts.start_ns, now_ns)
                parts.telemetry.count_setpoint(now_ns)
                if permit.pos_ned is None:
                    return [Send(message)]  # a velocity or an attitude: there is no place to draw
                sent = SetpointItem(parts.telemetry.sysid, permit.pos_ned, permit.yaw_rad)
                return [Send(message), Record(sent)]
            case effects.SendCommand():
                assert parts.telemetry is not None
                parts.reasons.asked(effect.kind, now_ns)
                asked = parts.ask_for_control(now_ns)
                return asked + parts.commands.send(effect, parts.telemetry, now_ns)
            case effects.CancelCommand(request_id, kind):
                return parts.commands.cancel(request_id, kind, now_ns)
            case PlaceFence():
                return parts.port.place_fence(parts.telemetry)
            case CheckStart():
                parts.port.check_start(effect)
                return []
            case effects.Outcome():
                parts.orbits.ended(effect.request_id)
                return [effect]
            case effects.StreamVerdict():
                return [effect]
            case effects.Verdict():
                parts.orbits.decided(effect, parts.port.gate, parts.port.policy, now_ns)
                return parts.port.tell(effect, parts.sysid)
            case _:
                return parts.port.tell(effect, parts.sysid)

    def hold_without_gate(self, now_ns: int) -> list[Work]:
        """The last resort: HOLD, past a gate that may be broken, where control was ours.

        A return or a landing goes on: it is the safer state.
        """
        parts = self._parts
        comes_down = parts.port.gate.state in (State.RETURNING, State.LANDING)
        if parts.telemetry is None or parts.port.gate.control is Control.NONE or comes_down:
            return []
        hold = effects.SendCommand(0, CommandKind.HOLD, now_ns)
        return parts.commands.send(hold, parts.telemetry, now_ns)
