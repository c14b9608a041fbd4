"""The frames of one vehicle: counted, put in order, decoded where somebody interprets them.

At 100,000 a second every call counts here.  A message that is interpreted is given to each part
that it concerns; a heartbeat of an autopilot may be that of a vehicle that is met, or is back.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs.gate import inputs
from gcs.gate.effects import Level
from gcs.gate.machine.could import why_not_arm
from gcs.protocol import arm_authorizer
from gcs.protocol.autopilot import autopilot_of
from gcs.protocol.effects import Address, Heard, Send
from gcs.session import announcements
from gcs.session.effects import Record
from gcs.session.work import GateInput, Log, PlaceFence, Work
from gcs.vehicle import record_items
from gcs.vehicle.health.limit_monitors import WATCH_MESSAGES
from gcs.vehicle.health.position_latency import Delay
from gcs.vehicle.interpreted_messages import (
    CAMERA_MESSAGES,
    FILE_MESSAGES,
    INTERPRETED,
    MISSION_MESSAGES,
    PARAMETER_MESSAGES,
    PLACE_MESSAGES,
    of_autopilot,
)
from gcs.vehicle.message_to_telemetry import is_its_kind, updates
from gcs.vehicle.parts import NODE, VehicleParts, accuracy
from gcs.vehicle.snapshot import lost_pct
from gcs.vehicle.talk.liveness import STATE_MESSAGES
from gcs.vehicle.talk.px4_events import EVENT_MESSAGES
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.talk.vehicle_texts import logged
from gcs.wire import messages as m
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import Component

OWN_BEATS_NS: Final = 1_500_000_000
"""Heartbeats come once a second: two vehicles that share a number are not taken for each other in
turn."""
MISSION_UNTOLD_NS: Final = 3_000_000_000
"""A vehicle that tells of its mission does so once a second; a PX4 1.14 without one never does."""
ALIVE: Final[Sequence[Work]] = (GateInput(inputs.MessageSeen()),)
"""What the gate is to hear of any frame of the autopilot, now and then."""
MOST_IN_TURN: Final = 100
"""Frames that are counted as one: fewer than half of the ring of sequence numbers."""


class VehicleFrames:
    """What came of a vehicle, or of its radio, on any link."""

    def __init__(self, parts: VehicleParts) -> None:
        self._parts = parts

    def passes(self, link: int, frames: Sequence[Frame], now_ns: int) -> bool:
        """Good frames of messages that are not in `INTERPRETED`: counted, and not decoded.

        True: the gate is to hear that the vehicle lives.
        """
        telemetry = self._parts.telemetry
        if telemetry is None:
            return False
        own = [frame for frame in frames if frame.sysid == telemetry.sysid]
        if not own:
            return False
        self._parts.presence.number_all(own, now_ns)
        telemetry.count_frames(len(own), now_ns)
        of_autopilot = telemetry.compid in [frame.compid for frame in own]
        return of_autopilot and self._alive(telemetry, link, now_ns)

    def _alive(self, telemetry: Telemetry, link: int, now_ns: int) -> bool:
        """A frame of its autopilot came; whether the gate is to hear of it."""
        if telemetry.heard_ns == now_ns == telemetry.link_ns:
            return False  # the datagram's first frame has told it
        self._parts.presence.choose_link(telemetry, link, now_ns)
        return self._parts.presence.alive(telemetry, now_ns)

    def in_turn(self, link: int, frames: Sequence[Frame], now_ns: int) -> Sequence[Work] | None:
        """Good frames that came together, all of its autopilot and each the next one: counted.

        What the gate is to hear of that.  None where they are any others, or very many: then
        nothing was counted.
        """
        telemetry = self._parts.telemetry
        if telemetry is None or len(frames) > MOST_IN_TURN:
            return None
        if not self._parts.presence.all_in_turn(
            (telemetry.sysid, telemetry.compid), frames, now_ns
        ):
            return None
        telemetry.count_frames(len(frames), now_ns)
        return ALIVE if self._alive(telemetry, link, now_ns) else ()

    def counted(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """One of those that `in_turn` has counted, of this vehicle or of another that has a radio
        of its own: that tells of the link."""
        parts = self._parts
        work: list[Work] = []
        message = decode(frame) if frame.msgid in INTERPRETED else None
        if isinstance(message, m.Heartbeat):
            work += self._heartbeat(link, frame, message, now_ns)
        elif isinstance(message, m.RadioStatus):
            work += parts.watch.radio(message, now_ns)
        telemetry = parts.telemetry
        if message is None or telemetry is None or frame.sysid != telemetry.sysid:
            return work
        state = type(message) in STATE_MESSAGES
        if state and parts.presence.overtaken(frame, message, parts.presence.number_of(frame)):
            return work
        return work + self._heard(telemetry, frame, message, now_ns)

    def placed(self, frame: Frame, now_ns: int) -> list[Work]:
        """The same of one that tells where the vehicle is: nothing else of it is changed by that,
        and nobody waits for it."""
        message, telemetry = decode(frame), self._parts.telemetry
        if message is None or telemetry is None:
            return []
        return self._updated(telemetry, message, now_ns)

    def frame(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """A good frame of anybody on `link`; what is not our vehicle's changes nothing."""
        parts = self._parts
        work: list[Work] = []
        message = decode(frame) if frame.msgid in INTERPRETED else None
        if isinstance(message, m.Heartbeat):
            work += self._heartbeat(link, frame, message, now_ns)
        telemetry = parts.telemetry
        if isinstance(message, m.RadioStatus):
            work += parts.watch.radio(message, now_ns)
        if telemetry is None or frame.sysid != telemetry.sysid:
            return work
        number = parts.presence.number(frame, now_ns)
        telemetry.count_frames(1, now_ns)
        if frame.compid == telemetry.compid and self._alive(telemetry, link, now_ns):
            work += ALIVE
        if message is not None and not parts.presence.overtaken(frame, message, number):
            work += self._heard(telemetry, frame, message, now_ns)
        return work

    # --------------------------------------------------------------------- one message

    def _heard(
        self, telemetry: Telemetry, frame: Frame, message: m.Message, now_ns: int
    ) -> list[Work]:
        """A message of it that is not void."""
        before = telemetry.armed, telemetry.mode_name, telemetry.landed
        heard = Heard(frame.sysid, frame.compid, message)
        work = self._told(telemetry, heard, now_ns)
        if before != (telemetry.armed, telemetry.mode_name, telemetry.landed):
            lost = lost_pct(self._parts.presence.losses)
            work.append(Record(record_items.status(telemetry, lost)))
        return work

    def _told(self, telemetry: Telemetry, heard: Heard, now_ns: int) -> list[Work]:
        parts = self._parts
        work: list[Work] = []
        message = heard.message
        if type(message) in PLACE_MESSAGES:
            own = heard.compid == telemetry.compid
            return self._updated(telemetry, message, now_ns) if own else []
        if isinstance(message, m.CommandAck):
            answered = parts.commands.heard(heard, now_ns)
            work += parts.reasons.explained(answered, telemetry.custom_mode, now_ns)
        elif type(message) in PARAMETER_MESSAGES:
            work += parts.learn(parts.settings.heard(heard, telemetry, now_ns), telemetry)
            if isinstance(message, m.ParamValue) and heard.compid == telemetry.compid:
                work += parts.stop_parameters.heard(message, telemetry.autopilot)
            work += parts.readers.heard(heard, telemetry, now_ns)
            work += self._of_plans(telemetry, heard, now_ns)
        elif type(message) in FILE_MESSAGES:
            return parts.readers.heard(heard, telemetry, now_ns)
        elif type(message) in MISSION_MESSAGES:
            work += self._of_plans(telemetry, heard, now_ns)
        elif isinstance(message, m.CommandLong):
            work += self._authorized(telemetry, heard, message, now_ns)
        elif isinstance(message, m.Statustext):
            work += logged(parts.words.text(heard.compid, message, now_ns))
            work += parts.missions.said(message.text, parts.view(telemetry), now_ns)
        elif isinstance(message, m.AutopilotVersion):
            work.append(Record(record_items.vehicle(telemetry, message, parts.of)))
        elif isinstance(message, m.ControlStatus):
            if text := parts.control.heard(message):
                level = Level.WARNING if parts.control.another else Level.INFO
                work.append(Log(level, NODE, text))
        elif type(message) in EVENT_MESSAGES and heard.compid == telemetry.compid:
            work += parts.events.heard(heard, now_ns)
        if heard.compid != telemetry.compid and type(message) not in CAMERA_MESSAGES:
            return work
        if type(message) in WATCH_MESSAGES and heard.compid == telemetry.compid:
            work += parts.watch.heard(message, now_ns)
        return [*work, *self._updated(telemetry, message, now_ns), *accuracy(telemetry)]

    def _of_plans(self, telemetry: Telemetry, heard: Heard, now_ns: int) -> list[Work]:
        """About a mission, rally points or a fence."""
        parts = self._parts
        work = parts.returns.heard(heard, telemetry, now_ns)
        work += parts.fence.heard(heard, telemetry, now_ns)
        missions = parts.missions.heard(heard, parts.view(telemetry), now_ns)
        return work + parts.with_plans_on_board(missions, now_ns)

    def _updated(self, telemetry: Telemetry, message: m.Message, now_ns: int) -> list[Work]:
        """What the vehicle reports of itself, into `telemetry`."""
        work: list[Work] = []
        if sign := self._restart_sign(telemetry, message, now_ns):
            work += self._restarted(telemetry, sign, now_ns)
            telemetry.restart_known = True
        for update in updates(message, telemetry, now_ns):
            match update:
                case GateInput(inputs.PositionSeen(reset=reset)):
                    telemetry.restart_known = False
                    work.append(update)
                    if reset:
                        work = [*self._parts.missions.forget(), *work, *accuracy(telemetry)]
                case GateInput(inputs.HomeSeen()) | PlaceFence():
                    work.append(update)
                    work += self._parts.returns.placed(telemetry)
                    work += self._parts.look_at_fence(telemetry)
                case _:
                    work.append(update)
        return work

    def _restart_sign(self, telemetry: Telemetry, message: m.Message, now_ns: int) -> str:
        """What shows that it has restarted; empty where nothing does."""
        restarts = self._parts.restarts
        if not isinstance(message, m.Timesync):
            return restarts.sign(message, now_ns)
        if message.tc1 <= 0 or not telemetry.delay.awaits(message.ts1):
            return ""
        armed = bool(telemetry.armed)
        return restarts.answered(message.ts1, message.tc1, now_ns, armed=armed)

    def _authorized(
        self, telemetry: Telemetry, heard: Heard, asked: m.CommandLong, now_ns: int
    ) -> list[Work]:
        """The vehicle asks whether it may arm, where it is set up to ask this station."""
        parts = self._parts
        asker = Address(heard.sysid, heard.compid)
        refusal = why_not_arm(parts.port.policy, parts.port.gate.memory, now_ns)
        troubles = [
            "" if refusal is None else refusal.sentence,
            parts.settings.without_fence(telemetry),
            parts.missions.unverified,
        ]
        answer = arm_authorizer.answer(asked, asker, parts.own, [each for each in troubles if each])
        if answer is None:
            return []
        parts.commands.deny_arming("" if answer.granted else answer.text)
        work: list[Work] = [Send(answer.ack), *parts.missions.ask_how_many(parts.view(telemetry))]
        if answer.text != parts.arming_answer:  # PX4 asks once a second while it stands
            level = Level.INFO if answer.granted else Level.WARNING
            work.append(Log(level, announcements.NODE, answer.text))
        parts.arming_answer = answer.text
        return work

    def _heartbeat(self, link: int, frame: Frame, beat: m.Heartbeat, now_ns: int) -> list[Work]:
        """Choose our vehicle: the first autopilot that is heard, or the one that was named."""
        parts = self._parts
        if not of_autopilot(beat) or frame.compid != Component.AUTOPILOT1:
            return []
        work: list[Work] = []
        if parts.roster.heard(frame.sysid, frame.compid, beat, now_ns):
            names = ", ".join(parts.roster.names(now_ns))
            level = Level.INFO if parts.config.target_sysid else Level.WARNING
            work.append(Log(level, NODE, f"several vehicles are heard: {names}"))
        wanted = parts.config.target_sysid
        if wanted not in (0, frame.sysid):
            return work
        telemetry = parts.telemetry
        if telemetry is not None and telemetry.sysid == frame.sysid:
            if self._is_another(telemetry, beat, now_ns):
                was = telemetry.label
                work += parts.leave_for_another(telemetry)
                work += self._meet(link, frame, beat, now_ns)
                assert parts.telemetry is not None
                text = f"another vehicle has the number of {was}, which is not there any more"
                work.append(Log(Level.WARNING, NODE, f"{text}: {parts.telemetry.label}"))
                return work + parts.read_anew(parts.telemetry, now_ns)
            return work + self._back(telemetry, beat, now_ns) + self._untold_mission(now_ns)
        if telemetry is not None:
            return work
        work += self._meet(link, frame, beat, now_ns)
        assert parts.telemetry is not None
        work.append(Log(Level.INFO, NODE, f"vehicle {parts.telemetry.label} on link {link}"))
        return work + parts.read_anew(parts.telemetry, now_ns)

    def _meet(self, link: int, frame: Frame, beat: m.Heartbeat, now_ns: int) -> list[Work]:
        """A vehicle that was not known: a new gate, for its autopilot."""
        parts = self._parts
        autopilot = autopilot_of(beat.autopilot, beat.type)
        telemetry = Telemetry(frame.sysid, frame.compid, autopilot, link)
        telemetry.mav_autopilot, telemetry.mav_type = beat.autopilot, beat.type
        telemetry.delay = Delay(parts.times)
        telemetry.rx_window_start_ns = telemetry.link_ns = now_ns
        telemetry.position_age_ns = round(parts.port.policy.position_age_s * 1e9)
        parts.met_ns = now_ns
        parts.telemetry, parts.sysid = telemetry, telemetry.sysid
        return parts.port.meet(telemetry, now_ns)

    def _back(self, telemetry: Telemetry, beat: m.Heartbeat, now_ns: int) -> list[Work]:
        """A heartbeat of a vehicle that is known: it may have been away."""
        parts = self._parts
        gone = telemetry.was_gone or parts.presence.is_gone(telemetry, now_ns)
        if not gone or not is_its_kind(beat, telemetry):
            return []
        parts.presence.back(telemetry, now_ns)
        log = Log(Level.INFO, NODE, f"vehicle {telemetry.label} is back")
        return [*parts.forget(telemetry), PlaceFence(), log, *parts.read_anew(telemetry, now_ns)]

    def _untold_mission(self, now_ns: int) -> list[Work]:
        """Ask for it, to know it before the vehicle asks whether it may arm."""
        parts = self._parts
        if now_ns - parts.met_ns < parts.times.real_ns(MISSION_UNTOLD_NS):
            return []
        assert parts.telemetry is not None
        return parts.missions.ask_how_many(parts.view(parts.telemetry))

    def _is_another(self, telemetry: Telemetry, beat: m.Heartbeat, now_ns: int) -> bool:
        """Whether its heartbeats have become those of another autopilot or kind of vehicle: two in
        a row, and none of its own meanwhile; of one that was armed, for as long as it takes to
        lose it, as it may be flown here."""
        if is_its_kind(beat, telemetry):
            telemetry.others = 0
            return False
        telemetry.others += 1
        parts = self._parts
        silence_ns = (
            parts.presence.gone_ns if telemetry.armed else parts.times.real_ns(OWN_BEATS_NS)
        )
        return telemetry.others >= 2 and now_ns - telemetry.heartbeat_ns > silence_ns

    def _restarted(self, telemetry: Telemetry, sign: str, now_ns: int) -> list[Work]:
        """It has restarted, as `sign` shows: nothing that was known of it counts any more."""
        parts = self._parts
        work = parts.forget(telemetry)
        if not telemetry.armed:
            work.append(PlaceFence())  # else with the position that is told as a reset
        text = f"vehicle {telemetry.label} has restarted ({sign}): it is read anew"
        return [*work, Log(Level.WARNING, NODE, text), *parts.read_anew(telemetry, now_ns)]
