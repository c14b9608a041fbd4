"""Which ground station is in control: MAVLink's operator control protocol, in single-owner mode.

CONTROL_STATUS says who it is; MAV_CMD_REQUEST_OPERATOR_CONTROL asks for control or gives it up.
Only the station in control changes the vehicle's state; others may look, and ask for messages.
While nobody is in control anybody may command.  After MAVLink's development.xml (work in progress
there): parameters and results are those of the definition with `gcs_main` and `gcs_secondary`.
No recorded autopilot has it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.effects import Client, Effect, Note, Send
from vehicle_sim.services.commands.info import INFO
from vehicle_sim.services.commands.orders import Answer, Order
from vehicle_sim.services.commands.ports import CommandContext, CommandEntry, RefusedError
from vehicle_sim.services.profile import Profile
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Capability, Cmd

RELEASE, REQUEST = 0, 1  # MAV_CMD_REQUEST_OPERATOR_CONTROL's parameter 1
SYSTEM_MANAGER, TAKEOVER_ALLOWED = 1, 2  # GCS_CONTROL_STATUS_FLAGS
NO_SECONDARIES: Final = bytes(10)
STATUS_NS: Final = 1_000_000_000
ASK_S: Final = (3.0, 60.0)
"""How long a station in control may be asked for; development.xml's range."""

LOOKS_ONLY: Final = frozenset(INFO) | {Cmd.DO_SEND_BANNER, Cmd.RUN_PREARM_CHECKS}
"""Commands that change nothing but what is sent."""

_CHANGES: Final = (
    m.SetMode,
    m.SetPositionTargetLocalNed,
    m.SetPositionTargetGlobalInt,
    m.SetAttitudeTarget,
    m.ManualControl,
    m.RcChannelsOverride,
    m.MissionCount,
    m.MissionWritePartialList,
    m.MissionItem,
    m.MissionItemInt,
    m.MissionClearAll,
    m.MissionSetCurrent,
    m.ParamSet,
    m.LogErase,
)
"""Messages that act like commands."""

_FTP_OPCODE_AT: Final = 3
_FTP_CHANGES: Final = range(6, 14)  # CreateFile to Rename


def with_operator_control(profile: Profile) -> Profile:
    """The same autopilot, which says once a second who is in control."""
    return replace(
        profile,
        capabilities=profile.capabilities | Capability.COMPONENT_ACCEPTS_GCS_CONTROL,
        intervals_ns={**profile.intervals_ns, m.IDS[m.ControlStatus]: STATUS_NS},
    )


class OperatorControl:
    """Who commands one vehicle: system ids of ground stations, 0 = nobody."""

    __slots__ = ("_takeover_allowed", "owner")

    def __init__(self) -> None:
        self.owner = 0
        self._takeover_allowed = True

    def status(self) -> m.ControlStatus:
        """To nobody's vehicle every request is granted."""
        allowed = TAKEOVER_ALLOWED if self._takeover_allowed or not self.owner else 0
        return m.ControlStatus(SYSTEM_MANAGER | allowed, self.owner, NO_SECONDARIES)

    def admits(self, client: Client, system: int, message: m.Message) -> bool:
        """Whether the message is taken.  `system` is the vehicle's own: companions are heard."""
        if not self.owner or client.system in (self.owner, system):
            return True
        match message:
            case m.CommandLong() | m.CommandInt():
                asks = message.command == Cmd.REQUEST_OPERATOR_CONTROL
                return asks or message.command in LOOKS_ONLY
            case m.FileTransferProtocol():
                return message.payload[_FTP_OPCODE_AT] not in _FTP_CHANGES
            case _:
                return not isinstance(message, _CHANGES)

    def asked(self, order: Order) -> Answer:
        """MAV_CMD_REQUEST_OPERATOR_CONTROL."""
        station = order.client.system
        if order.p1 not in (RELEASE, REQUEST) or station == 0:
            raise RefusedError(Result.DENIED, f"{order.p1} is neither release (0) nor request (1)")
        if order.p1 == RELEASE:
            return self._released(station)
        if self.owner in (0, station) or self._takeover_allowed:
            self.owner, self._takeover_allowed = station, order.p2 == 1.0
            return self._changed(f"station {station} is in control")
        asks = m.CommandLong(
            REQUEST,
            float(order.p2 == 1.0),
            _within(order.p3, *ASK_S),
            float(station),
            0.0,
            0.0,
            0.0,
            Cmd.REQUEST_OPERATOR_CONTROL,
            self.owner,
            0,
            0,
        )
        note = Note("info", f"station {station} asks station {self.owner} for control")
        return Answer(Result.FAILED, (Send(None, asks), note))

    def _released(self, station: int) -> Answer:
        if self.owner not in (0, station):
            raise RefusedError(Result.FAILED, f"station {station} is not in control")
        self.owner, self._takeover_allowed = 0, True
        return self._changed("no station is in control")

    def _changed(self, text: str) -> Answer:
        effects: tuple[Effect, ...] = (Send(None, self.status()), Note("info", text))
        return Answer(Result.ACCEPTED, effects)


def _within(value: float, low: float, high: float) -> float:
    """NaN becomes `low`."""
    return max(low, min(value, high)) if value == value else low


def _request(context: CommandContext, order: Order) -> Answer:
    if context.ask_for_control is None:
        raise RefusedError(Result.UNSUPPORTED, "operator control is off")
    return context.ask_for_control(order)


OPERATOR: Final = {Cmd.REQUEST_OPERATOR_CONTROL: CommandEntry(_request)}
