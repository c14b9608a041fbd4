"""What would move the vehicle becomes a request to the gate, in operators' words and frame."""

from __future__ import annotations

import math
from typing import Final

from gcs import ipc
from gcs.bridge.catalog import Row
from gcs.bridge.effects import BridgeEffect, ForwardToVehicle
from gcs.bridge.judge.climbs import HEIGHT_WRITTEN, asks_for_height, climbs
from gcs.bridge.judge.received import Judged, Received, refuse
from gcs.bridge.judge.set_up import SetUpJudge
from gcs.bridge.judge.target_component import is_for_another, only_autopilot
from gcs.bridge.mission_mode import MissionMode
from gcs.bridge.translate.meaning import Forward, Reject, Sample, Seen, Settled, Sticks, Words
from gcs.bridge.translate.translate import meaning_of
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.attitude import roll_pitch_yaw
from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.wire.ids import Cmd, ModeFlag
from gcs.wire.messages import CommandInt, CommandLong, Message, SetMode

SET_MODES: Final = frozenset({Cmd.DO_SET_MODE, Cmd.DO_SET_STANDARD_MODE})


class MotionJudge:
    """Of what clients would have one vehicle fly."""

    def __init__(self, set_up: SetUpJudge, mission_mode: MissionMode) -> None:
        self._set_up = set_up
        self._mission_mode = mission_mode

    def judge(self, given: Received, message: Message | None, row: Row) -> Judged:
        """What is done with it."""
        client, seen, now_ns = given.client, given.look(), given.now_ns
        if seen is None:
            return refuse(given, message, row, Refusal(Code.NO_VEHICLE, "no vehicle is heard"))
        if message is None:
            return refuse(given, message, row, Refusal(Code.UNSUPPORTED, row.why))
        meant = meaning_of(message, seen)
        if is_for_another(given, message) and not isinstance(meant, Forward):
            return refuse(given, message, row, only_autopilot(given))
        ignored = client.sticks.news(meant) if isinstance(meant, Sticks) else ""
        told = client.dialogue.text(given.by, Level.INFO, ignored, now_ns) if ignored else []
        settled = client.settle(meant, seen, now_ns)
        if not (isinstance(meant, Sticks) and isinstance(settled, Reject)):
            chosen = self._chooses_takeoff(given, message, settled, seen)
            chosen = chosen or self._chooses_mission(given, message, settled, seen)
            if chosen:
                return Judged(False, [*told, *chosen])
            settled, forgotten = client.joined_with_choice(settled, seen, now_ns)
            told += forgotten
        judged = self._meant(given, message, row, settled, seen)
        return Judged(judged.refused, [*told, *judged.effects])

    def _chooses_takeoff(
        self, given: Received, message: Message, settled: Settled, seen: Seen
    ) -> list[BridgeEffect]:
        """A take-off that is kept until this client arms; nothing where it is not for that.

        A take-off *mode* is not kept: its client waits for a heartbeat that shows it.
        """
        if not isinstance(message, CommandLong | CommandInt):
            return []
        if message.command != Cmd.NAV_TAKEOFF or self._set_up.height_awaited:
            return []
        chosen = given.client.chooses_takeoff(settled, seen, given.by, given.now_ns)
        if chosen is None:
            return []
        return [*chosen, *given.client.dialogue.ask(given.by, message, (), given.now_ns)]

    def _chooses_mission(
        self, given: Received, message: Message, settled: Settled, seen: Seen
    ) -> list[BridgeEffect]:
        """The mode of a mission is forwarded, and its start waits for this client's arming;
        nothing where it is not for that."""
        sets_mode = isinstance(message, SetMode) or (
            isinstance(message, CommandLong | CommandInt) and message.command in SET_MODES
        )
        if not sets_mode or _arms_too(message) or not self._mission_mode.may_be_sent(given.now_ns):
            return []
        chosen = given.client.chooses_mission(settled, seen, given.by, given.now_ns)
        if chosen is None:
            return []
        self._mission_mode.sent(given.now_ns)
        return [*chosen, ForwardToVehicle(given.frame.raw)]

    def _meant(
        self, given: Received, message: Message, row: Row, meaning: Settled, seen: Seen
    ) -> Judged:
        client, now_ns = given.client, given.now_ns
        match meaning:
            case Words(asks, note, _, answered_by):
                climbing = (climbs(each, seen.autopilot) for each in asks)
                if self._set_up.height_awaited and any(climbing):
                    unknown = refuse(given, message, row, HEIGHT_WRITTEN)
                    asks_for_it = asks_for_height(given.by.source, given.by.addressed)
                    return Judged(True, [*unknown.effects, asks_for_it])
                asked = client.dialogue.ask(
                    given.by, message, asks, now_ns, answered_by=answered_by, note=note
                )
                return Judged(False, asked)
            case Sample():
                return Judged(False, client.dialogue.stream(given.by, stream_of(meaning)))
            case Forward():
                return Judged(False, [ForwardToVehicle(given.frame.raw)])
            case Reject(refusal):
                return refuse(given, message, row, refusal)


def _arms_too(message: Message) -> bool:
    """A mode with MAV_MODE_FLAG_SAFETY_ARMED: MAVLink's old way to arm in the same message."""
    if isinstance(message, SetMode):
        return bool(message.base_mode & ModeFlag.SAFETY_ARMED)
    if not isinstance(message, CommandLong | CommandInt) or message.command != Cmd.DO_SET_MODE:
        return False
    return math.isfinite(message.param1) and bool(int(message.param1) & ModeFlag.SAFETY_ARMED)


def stream_of(sample: Sample) -> ipc.Stream:
    """A sample of a setpoint stream in the operators' words: in east, north, up and degrees."""
    if sample.attitude is not None:
        roll, pitch, yaw = map(math.degrees, roll_pitch_yaw(sample.attitude.q_ned_from_frd))
        return ipc.Stream(
            roll_deg=roll,
            pitch_deg=pitch,
            yaw_deg=yaw,
            yaw_rate_deg_s=_degrees(sample.yaw_rate_rad_s),
            thrust=sample.attitude.thrust,
        )
    return ipc.Stream(
        pos_enu=_enu(sample.pos_ned),
        v_enu=_enu(sample.v_ned),
        a_enu=_enu(sample.a_ned),
        yaw_deg=_degrees(sample.yaw_rad),
        yaw_rate_deg_s=_degrees(sample.yaw_rate_rad_s),
    )


def _enu(triple_ned: Vec3 | None) -> ipc.Maybe3 | None:
    """East, north, up; an axis that was left out (NaN) is None."""
    if triple_ned is None:
        return None
    east, north, up = (None if math.isnan(x) else x for x in enu_from_ned(triple_ned))
    return (east, north, up)


def _degrees(angle_rad: float | None) -> float | None:
    return None if angle_rad is None else math.degrees(angle_rad)
