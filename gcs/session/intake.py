"""The way in: bytes of every link become frames, frames messages, messages news for the rest.

Our vehicle is the first autopilot that is heard, or the one that the configuration names; whatever
else talks on a link is recorded and, towards the gate, not heard.
"""

from __future__ import annotations

from collections.abc import Iterable

from gcs.gate import inputs
from gcs.gate.condition import Condition
from gcs.gate.effects import Level
from gcs.protocol.autopilot import autopilot_of
from gcs.protocol.effects import Heard
from gcs.protocol.sequence import SequenceTracker
from gcs.record.items import Direction, FrameItem, GarbageItem, ParamItem, StatusItem
from gcs.session import greeting
from gcs.session.gatekeeper import Gatekeeper
from gcs.session.greeting import Greeting
from gcs.session.inbound import absorb
from gcs.session.missions import MissionDesk
from gcs.session.outbox import Outbox
from gcs.session.screen import lost_pct
from gcs.session.setup import Setup
from gcs.session.telemetry import Telemetry
from gcs.wire import messages as m
from gcs.wire.codec import decode
from gcs.wire.frame import Frame, Garbage, Item, StreamSplitter, split
from gcs.wire.ids import Component, MavAutopilot, MavType, Severity

VEHICLE_GONE_NS = 3_500_000_000
LINK_SILENT_NS = 2_000_000_000
ORIGIN_PATIENCE_NS = 10_000_000_000
"""How long a vehicle may take to tell its origin before that is a condition."""
OTHER_STATION_NS = 5_000_000_000
"""How long after its last frame a station with our id still counts as there."""

NODE = "link"

STATUSTEXT_LEVEL = {
    Severity.EMERGENCY: Level.FATAL,
    Severity.ALERT: Level.ERROR,
    Severity.CRITICAL: Level.ERROR,
    Severity.ERROR: Level.ERROR,
    Severity.WARNING: Level.WARNING,
    Severity.NOTICE: Level.INFO,
    Severity.INFO: Level.INFO,
    Severity.DEBUG: Level.DEBUG,
}


STATE_MESSAGES = m.Heartbeat | m.ExtendedSysState | m.SysStatus | m.MissionCurrent
"""What tells a state is void once a newer one was seen; answers and events are not."""


class Intake:
    """Everything that the vehicle says, brought to whom it concerns."""

    def __init__(
        self, setup: Setup, keeper: Gatekeeper, missions: MissionDesk, out: Outbox
    ) -> None:
        self._config = setup.config
        self._keeper = keeper
        self._missions = missions
        self._out = out
        self._greeting = Greeting(setup.config)
        self._splitters = {link: StreamSplitter() for link in setup.streams}
        self._other_station_ns = 0
        self._met_ns = 0
        self._newest: dict[tuple[int, int], int] = {}
        self._gone_ns = round(VEHICLE_GONE_NS * setup.config.speedup)
        self.losses = SequenceTracker()

    @property
    def deadline_ns(self) -> int | None:
        """When the greeting's next wait is over."""
        return self._greeting.deadline_ns

    def datagram(self, link: int, data: bytes, now_ns: int) -> None:
        for item in self._split(link, data):
            if isinstance(item, Garbage):
                self._out.record(GarbageItem(link, item.raw, item.reason.value))
            else:
                self._out.heard(link)
                self._out.record(FrameItem(link, Direction.RECEIVED, item.raw))
                self._frame(link, item, now_ns)

    def _split(self, link: int, data: bytes) -> list[Item]:
        """A datagram is whole; a read of a stream goes on where the last one ended."""
        splitter = self._splitters.get(link)
        return split(data) if splitter is None else splitter.feed(data)

    def _frame(self, link: int, frame: Frame, now_ns: int) -> None:
        own = (self._config.sysid, self._config.compid)
        if (frame.sysid, frame.compid) == own:
            self._other_station_ns = now_ns
            text = f"another station on link {link} calls itself {frame.sysid}/{frame.compid}"
            self._keeper.condition(Condition.OTHER_STATION, True, text, now_ns)
            return
        message = decode(frame)
        if isinstance(message, m.Heartbeat):
            self._heartbeat(link, frame, message, now_ns)
        seen = self._keeper.seen
        if seen is None or frame.sysid != seen.sysid:
            return
        number = self.losses.number(frame.sysid, frame.compid, frame.seq)
        self.losses.seen(frame.sysid, frame.compid, frame.seq)
        seen.count_frame(now_ns)
        if message is not None and not self._overtaken(frame, message, number):
            self._heard(seen, link, Heard(frame.sysid, frame.compid, message), now_ns)

    def _overtaken(self, frame: Frame, message: m.Message, number: int) -> bool:
        """A state that is older than one of the same kind that has come: void."""
        if not isinstance(message, STATE_MESSAGES):
            return False
        key = (frame.compid, frame.msgid)
        newest = self._newest.get(key)
        if newest is not None and number <= newest:
            return True
        self._newest[key] = number
        return False

    def _heard(self, seen: Telemetry, link: int, heard: Heard, now_ns: int) -> None:
        self._keeper.heard(heard, now_ns)
        self._missions.heard(heard, now_ns)
        self._from_greeting(self._greeting.heard(heard, seen, now_ns), now_ns)
        message = heard.message
        if isinstance(message, m.Statustext):
            level = STATUSTEXT_LEVEL.get(Severity(message.severity & 7), Level.INFO)
            self._out.say(level, "vehicle", message.text, now_ns)
        if heard.compid == seen.compid:
            self._choose_link(seen, link, now_ns)
        elif not isinstance(message, m.CameraImageCaptured | m.CameraFeedback):
            return
        for news in absorb(message, seen, now_ns):
            if isinstance(news, inputs.PositionSeen) and news.reset:
                self._missions.forget(now_ns)
            if isinstance(news, inputs.Input):
                self._keeper.give(news, now_ns)
            else:
                self._out.record(news)

    @staticmethod
    def _choose_link(seen: Telemetry, link: int, now_ns: int) -> None:
        """Answer where it is heard; another link takes over only once that one is silent."""
        if link == seen.link or now_ns - seen.link_ns > LINK_SILENT_NS:
            seen.link, seen.link_ns = link, now_ns

    def _heartbeat(self, link: int, frame: Frame, beat: m.Heartbeat, now_ns: int) -> None:
        """Choose our vehicle: the first autopilot that is heard, or the one that was named."""
        if beat.type == MavType.GCS or beat.autopilot == MavAutopilot.INVALID:
            return
        wanted = self._config.target_sysid
        if wanted not in (0, frame.sysid) or frame.compid != Component.AUTOPILOT1:
            return
        seen = self._keeper.seen
        if seen is None:
            seen = Telemetry(frame.sysid, frame.compid, autopilot_of(beat.autopilot), link)
            seen.rx_window_start_ns = seen.link_ns = now_ns
            seen.position_age_ns = round(self._keeper.policy.position_age_s * 1e9)
            self._met_ns = now_ns
            self._keeper.meet(seen, now_ns)
            news = f"vehicle {seen.label} on link {link}"
        elif seen.sysid == frame.sysid and now_ns - seen.heartbeat_ns > self._gone_ns:
            news = f"vehicle {seen.label} is back"
            seen.forget_place()
            self.losses.restart(frame.sysid, frame.compid)
            self._missions.forget(now_ns)
            self._keeper.place_fence(now_ns)
        else:
            return
        self._out.say(Level.INFO, NODE, news, now_ns)
        self._from_greeting(self._greeting.start(seen, now_ns), now_ns)
        self._ask_for_missing(seen, now_ns)

    def _from_greeting(self, news: Iterable[greeting.Out], now_ns: int) -> None:
        for item in news:
            match item:
                case greeting.Known(name, value):
                    assert self._keeper.seen is not None
                    self._out.record(ParamItem(self._keeper.seen.sysid, name, value))
                case greeting.Read(weak, return_up_m):
                    text = "the vehicle's own failsafes: " + ("; ".join(weak) or "all on")
                    condition = Condition.VEHICLE_FAILSAFE_WEAK
                    self._keeper.condition(condition, bool(weak), text, now_ns)
                    if not weak:
                        self._out.say(Level.INFO, NODE, text, now_ns)
                    if return_up_m is not None and self._keeper.seen is not None:
                        self._keeper.seen.return_up_m = return_up_m
                        self._keeper.give(inputs.ReturnHeightSeen(return_up_m), now_ns)
                case _:
                    assert self._keeper.seen is not None
                    self._out.send(self._keeper.seen.link, item)

    def wake(self, now_ns: int) -> None:
        if self._keeper.seen is not None:
            self._from_greeting(self._greeting.wake(self._keeper.seen, now_ns), now_ns)

    def _ask_for_missing(self, seen: Telemetry, now_ns: int) -> None:
        for command in self._greeting.missing(seen, now_ns):
            self._keeper.ask(command, now_ns)

    def second(self, seen: Telemetry, now_ns: int) -> None:
        """Once a second: ask for what is missing, and record how the vehicle is."""
        if now_ns - seen.heartbeat_ns <= self._gone_ns:
            self._ask_for_missing(seen, now_ns)
        if now_ns - self._other_station_ns > OTHER_STATION_NS:
            self._keeper.condition(Condition.OTHER_STATION, False, "it is gone", now_ns)
        missing = seen.origin is None and now_ns - self._met_ns > ORIGIN_PATIENCE_NS
        text = "the vehicle has not told its origin (GPS_GLOBAL_ORIGIN)"
        self._keeper.condition(Condition.ORIGIN_MISSING, missing, text, now_ns)
        self._out.record(
            StatusItem(
                seen.sysid,
                bool(seen.armed),
                seen.mode_name,
                seen.landed.name,
                seen.battery_pct,
                seen.battery_v,
                seen.rx_hz,
                lost_pct(self.losses),
            )
        )
