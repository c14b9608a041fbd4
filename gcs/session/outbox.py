"""Where every part of the session puts what is to happen, in the order in which it shall.

Also the last step before the wire: messages become frames, and motion needs a permit.
`setpoint` is the only place where a SET_POSITION_TARGET is made, and its one source of values is
a `Permit`, which only the gate can write (invariant 1).
"""

from __future__ import annotations

import math

from gcs import ipc
from gcs.gate.effects import Level
from gcs.gate.permit import Permit
from gcs.record.items import Direction, FrameItem, LogItem, RecordItem, SetpointItem
from gcs.session.ports import Effect, Emit, Record, Transmit
from gcs.session.telemetry import Telemetry
from gcs.wire.codec import FrameWriter
from gcs.wire.ids import MavAutopilot, MavFrame, MavState, MavType, TypeMask
from gcs.wire.messages import Heartbeat, Message, SetPositionTargetLocalNed

POSITION_ONLY = (
    TypeMask.VX_IGNORE
    | TypeMask.VY_IGNORE
    | TypeMask.VZ_IGNORE
    | TypeMask.AX_IGNORE
    | TypeMask.AY_IGNORE
    | TypeMask.AZ_IGNORE
    | TypeMask.YAW_IGNORE
    | TypeMask.YAW_RATE_IGNORE
)
"""3576: set bits mean "ignore"; heading is left to the autopilot."""
POSITION_AND_YAW = POSITION_ONLY & ~TypeMask.YAW_IGNORE
"""2552."""

MAVLINK_VERSION = 3


class Outbox:
    """Effects of the input that is being handled; `take` empties it."""

    def __init__(
        self,
        sysid: int,
        compid: int,
        links: int,
        start_ns: int,
        waiting: frozenset[int] = frozenset(),
    ) -> None:
        """`waiting`: links on which nobody is there yet to be sent anything."""
        self._writers = [FrameWriter(sysid, compid) for _ in range(links)]
        self._waiting = set(waiting)
        self._start_ns = start_ns
        self._effects: list[Effect] = []

    def take(self) -> list[Effect]:
        effects, self._effects = self._effects, []
        return effects

    def put(self, effect: Effect) -> None:
        self._effects.append(effect)

    # ------------------------------------------------------------------ operator, record

    def emit(self, event: ipc.Event) -> None:
        self._effects.append(Emit(event))

    def record(self, item: RecordItem) -> None:
        self._effects.append(Record(item))

    def say(self, level: Level, node: str, text: str, now_ns: int) -> None:
        """One line of the node `node`: to the screen and to the record."""
        self.emit(ipc.LogEvent(now_ns, int(level), node, text))
        self.record(LogItem(int(level), node, text))

    # ------------------------------------------------------------------------------ wire

    def heard(self, link: int) -> None:
        """Somebody is there."""
        self._waiting.discard(link)

    def send(self, link: int, message: Message) -> None:
        """One frame on one link, and its record; nothing where nobody would get it."""
        if link in self._waiting:
            return
        raw = self._writers[link].write(message)
        self._effects += (Transmit(link, raw), Record(FrameItem(link, Direction.SENT, raw)))

    def heartbeat(self) -> None:
        """HEARTBEAT of a ground station, on every link."""
        beat = Heartbeat(
            custom_mode=0,
            type=MavType.GCS,
            autopilot=MavAutopilot.INVALID,
            base_mode=0,
            system_status=MavState.ACTIVE,
            mavlink_version=MAVLINK_VERSION,
        )
        for link in range(len(self._writers)):
            self.send(link, beat)

    def setpoint(self, seen: Telemetry, permit: Permit, now_ns: int) -> None:
        """SET_POSITION_TARGET_LOCAL_NED with the permit's position and, if it has one, yaw."""
        pos_ned, yaw_rad = permit.pos_ned, permit.yaw_rad
        if pos_ned is None or permit.issued_ns != now_ns or not all(map(math.isfinite, pos_ned)):
            raise PermissionError("a setpoint needs a permit of this very moment, with a position")
        message = SetPositionTargetLocalNed(
            time_boot_ms=(now_ns - self._start_ns) // 1_000_000 & 0xFFFFFFFF,
            x=pos_ned[0],
            y=pos_ned[1],
            z=pos_ned[2],
            vx=0.0,
            vy=0.0,
            vz=0.0,
            afx=0.0,
            afy=0.0,
            afz=0.0,
            yaw=0.0 if yaw_rad is None else yaw_rad,
            yaw_rate=0.0,
            type_mask=POSITION_ONLY if yaw_rad is None else POSITION_AND_YAW,
            target_system=seen.sysid,
            target_component=seen.compid,
            coordinate_frame=MavFrame.LOCAL_NED,
        )
        seen.count_setpoint(now_ns)
        self.send(seen.link, message)
        self.record(SetpointItem(seen.sysid, pos_ned, yaw_rad))
