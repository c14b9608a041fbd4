"""All that one vehicle has in a session: its parts, what it reports, and what several of them need.

Nothing here decides when a part is asked: `received_frames.py` and `vehicle.py` do.
"""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from gcs.config import StationConfig
from gcs.gate import inputs
from gcs.gate.condition import Condition
from gcs.gate.effects import Level
from gcs.gate.policy.policy import Policy
from gcs.protocol.effects import Address, Send
from gcs.protocol.vehicle_control import VehicleControl
from gcs.report import ParamItem
from gcs.session.effects import Record
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, Work, condition
from gcs.vehicle.gate_port import GatePort
from gcs.vehicle.health.limit_monitors import Watch
from gcs.vehicle.missions.jobs.job import VehicleView
from gcs.vehicle.missions.missions import Missions
from gcs.vehicle.missions.return_places import ReturnPlaces
from gcs.vehicle.missions.uploaded_fence import FenceOnBoard
from gcs.vehicle.orbits import Orbits
from gcs.vehicle.own_rule import OwnRule
from gcs.vehicle.parameters import settings
from gcs.vehicle.parameters.failsafes import limits_of
from gcs.vehicle.parameters.settings import Settings
from gcs.vehicle.parameters.stop_parameters import StopParameters
from gcs.vehicle.readers.readers import Readers
from gcs.vehicle.talk.commands import Commands
from gcs.vehicle.talk.discovery import Discovery
from gcs.vehicle.talk.liveness import Presence, Roster
from gcs.vehicle.talk.px4_events import Events
from gcs.vehicle.talk.restarts import STEP_NS, Restarts
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.talk.vehicle_texts import Reasons, Words

NODE = "link"


class VehicleParts:
    """Of one vehicle: each part keeps what is its own, and `VehicleParts` what is no part's."""

    def __init__(
        self,
        config: StationConfig,
        policy: Policy,
        times: Times,
        now_ns: int,
        *,
        first: bool,
    ) -> None:
        """`first`: it is the one that was there first."""
        self.config = config
        self._policy = policy
        self.first = first
        self.times = times
        gone_ns = round(times.policy(policy).heartbeat_age_s * 1e9)
        self.start_ns = now_ns
        own = self.own = Address(config.sysid, config.compid)
        self.port = GatePort(times.policy(policy), now_ns, first=first)
        self.commands = Commands(own, times)
        self.discovery = Discovery(times)
        self.settings = Settings(
            own,
            times,
            limits_of(policy, own.sysid),
            reads_thrust=policy.stream.tilt_deg > 0.0,
            reads_enforced=config.bridge or bool(config.clients),
        )
        self.stop_parameters = StopParameters()
        self.missions = Missions(own, times)
        self.readers = Readers(own, times)
        self.orbits = Orbits(times)
        rule_path = config.rule_path
        self.rule = None if isinstance(rule_path, msgspec.UnsetType) else OwnRule(rule_path, times)
        self.leg_speed_m_s: float | None = None
        """The most that legs are flown at, where that was asked for."""
        self.returns = ReturnPlaces(own, times, policy)
        self.fence = FenceOnBoard(own, times)
        self.words = Words(times)
        self.events = Events(own, self.words, times)
        self.control = VehicleControl(own)
        self.roster = Roster(config.target_sysid, times, gone_ns)
        self.reasons = Reasons(self.words, times)
        self.met_ns = 0
        """When it was heard for the first time."""
        self.parameters: dict[str, float] = {}
        """Those of its parameters that are known."""
        self.presence = Presence(times, gone_ns)
        self.watch = Watch(policy, times)
        self.telemetry: Telemetry | None = None
        """What it reports; None until it is heard."""
        self.sysid = 0
        """That of `telemetry`, 0 before it is heard."""
        self.arming_answer = ""
        """What it was told last when it asked whether it may arm."""
        self.failing: tuple[str, ...] | None = None
        """Rows that fail before a take-off, as its gate was told; None: nothing was told yet."""
        self.mission_paused = False
        """A mission was stopped by a hold, and nothing else was flown since."""
        self.restarts = Restarts(max(STEP_NS, times.real_ns(STEP_NS)))

    @property
    def of(self) -> str:
        """In names in the record, of which the first vehicle's are plain."""
        return "" if self.first else f"-{self.sysid}"

    def view(self, telemetry: Telemetry) -> VehicleView:
        """What a mission job is to know of it."""
        state, policy = self.port.gate.state, self.port.policy
        return VehicleView(telemetry, state, policy, self.fence.items, self.returns.rally.items)

    def learn(self, found: Iterable[settings.Found], telemetry: Telemetry) -> list[Work]:
        """What the vehicle's own settings say."""
        work: list[Work] = []
        for item in found:
            match item:
                case Send():
                    work.append(item)
                case settings.ParameterKnown(name, value):
                    self.parameters[name] = value
                    work.append(Record(ParamItem(telemetry.sysid, name, value)))
                case settings.ReturnHeightKnown(up_m):
                    telemetry.return_up_m, telemetry.return_told = up_m, True
                    if up_m is not None:
                        telemetry.return_void = False
                        work.append(GateInput(inputs.ReturnHeightSeen(up_m)))
                        work += self.returns.height_known(telemetry)
                case settings.ReturnTypeKnown(kind):
                    work += self.returns.returns_by(kind, telemetry)
                case settings.AcceptanceKnown(radius_m):
                    telemetry.acceptance_m = radius_m
                    work += accuracy(telemetry)
                case settings.ClimbEndKnown(within_m):
                    work.append(GateInput(inputs.ClimbEndSeen(within_m)))
                case settings.FailsafesKnown(weak, every, mends):
                    telemetry.failsafes, telemetry.mends = every, mends
                    head = "the vehicle's own failsafes: "
                    text = head + ("; ".join(weak) or "all on")
                    work.append(condition(Condition.VEHICLE_FAILSAFE_WEAK, bool(weak), text))
                    work.append(Log(Level.INFO, NODE, head + "; ".join(every or weak)))
                    if mends:
                        hint = f"what mends its failsafes: {'; '.join(mends)}"
                        work.append(Log(Level.INFO, NODE, hint, recorded=False))
        return work

    def ask_for_missing(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """What of it is needed and did not come yet."""
        told = self.discovery.silence(telemetry, now_ns)
        work: list[Work] = [Log(Level.WARNING, NODE, told)] if told else []
        for command in self.discovery.missing(telemetry, now_ns):
            work += self.commands.send_own(command, now_ns)
        return work

    def forget(self, telemetry: Telemetry) -> list[Work]:
        """The vehicle restarted or was away: what it told of itself may be otherwise now."""
        telemetry.forget()
        self.parameters.clear()
        self.mission_paused = False
        self.restarts.begin()
        self.presence.begins_anew(telemetry)
        ends_m = telemetry.autopilot.climb_ends_within_m
        return [
            *self.missions.forget(),
            *self.readers.forget(),
            GateInput(inputs.ClimbEndSeen(ends_m)),
            *accuracy(telemetry),
        ]

    def read_anew(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """All that is to be known of a vehicle that appears is asked for."""
        self.discovery.start()
        self.events.start(Address(telemetry.sysid, telemetry.compid))
        work = self.learn(self.settings.start(telemetry, now_ns), telemetry)
        work += self.returns.start(telemetry, busy=self.missions.job is not None, now_ns=now_ns)
        self.fence.start(telemetry, now_ns)
        work += self.with_plans_on_board([], now_ns)
        if self.port.policy.arming.preflight == "no_fail":
            self.failing = None
            text = "nothing was looked at yet"
            work.append(condition(Condition.PREFLIGHT_FAILED, True, text))
        return work + self.ask_for_missing(telemetry, now_ns)

    def leave_for_another(self, telemetry: Telemetry) -> list[Work]:
        """Another vehicle has the number of this one: what is under way ends, and nothing that was
        meant for this one reaches the other."""
        work = [*self.forget(telemetry), *self.port.lose_vehicle()]
        self.commands = Commands(self.own, self.times)
        self.control = VehicleControl(self.own)
        self.watch = Watch(self._policy, self.times)
        self.telemetry, self.sysid = None, 0
        return work

    def with_plans_on_board(self, work: list[Work], now_ns: int) -> list[Work]:
        """What a job does, and what follows for rally points and fence: one transfer at a time."""
        telemetry = self.telemetry
        if telemetry is None:
            return work
        jobs, busy = tuple(work), self.missions.job is not None
        rally = self.returns.follow(jobs, telemetry, busy=busy or self.fence.reading, now_ns=now_ns)
        busy |= self.returns.rally.reading
        fence = self.fence.follow(jobs, telemetry, busy=busy, now_ns=now_ns)
        return [*work, *rally, *fence, *self.look_at_fence(telemetry)]

    def wake_plans_on_board(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """A wait for rally points or fence may be over."""
        busy = self.missions.job is not None
        rally = self.returns.wake(telemetry, busy=busy or self.fence.reading, now_ns=now_ns)
        busy |= self.returns.rally.reading
        fence = self.fence.wake(telemetry, busy=busy, now_ns=now_ns)
        return [*rally, *fence, *self.look_at_fence(telemetry)]

    def look_at_fence(self, telemetry: Telemetry) -> list[Work]:
        """What the uploaded fence is, or where home is, may have changed."""
        return self.learn(self.settings.uploaded(self.fence.seen(telemetry), telemetry), telemetry)

    def ask_for_control(self, now_ns: int) -> list[Work]:
        """Of a vehicle that has operator control, and obeys another station or nobody yet."""
        if self.telemetry is None:
            return []
        address = Address(self.telemetry.sysid, self.telemetry.compid)
        command = self.control.before_command(address, now_ns)
        return [] if command is None else self.commands.send_own(command, now_ns)


def accuracy(telemetry: Telemetry) -> list[Work]:
    """How near to a goal is there, as far as the vehicle tells; where that is news to the gate."""
    health, acceptance_m = telemetry.health, telemetry.acceptance_m
    seen = inputs.AccuracySeen(health.accuracy_h_m, acceptance_m)
    if seen == telemetry.accuracy_told:
        return []
    telemetry.accuracy_told = seen
    return [GateInput(seen)]
