"""One vehicle, as the rest of the session knows it: what is asked of it, and what it shows.

What it has is in `parts.py`, the way in of its frames in `received_frames.py`, and the way of its
gate's decisions out here.  What is per link is in `links.py`, per client in `requests.py`, and
what is per session in `session.py`.
"""

from __future__ import annotations

from collections.abc import Iterable

from gcs.config import StationConfig
from gcs.frames import Vec3
from gcs.gate import effects, inputs
from gcs.gate.airspace.pace import why_not_speed
from gcs.gate.airspace.separation import Leg
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind
from gcs.gate.machine.could import why_not_go_to, why_not_resume
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.sentences import REFUSED
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import Control, State
from gcs.protocol.effects import Address, Send
from gcs.report import MissionItem, SetpointItem
from gcs.session import announcements
from gcs.session.effects import Record
from gcs.session.inputs import FileRead, FileWritten, RuleSaid
from gcs.session.speedup_waits import Times
from gcs.session.work import (
    GATE_ANSWERED,
    AskMission,
    AskOrbit,
    AskSpeed,
    CheckStart,
    GiveVerdict,
    Log,
    PlaceFence,
    Work,
    condition,
)
from gcs.vehicle import record_items
from gcs.vehicle.gate_port import NOT_FLYING
from gcs.vehicle.health.position_health import GPS_SILENT_NS
from gcs.vehicle.missions.missions import still_paused
from gcs.vehicle.parameters.thrust_meaning import with_thrust_meaning
from gcs.vehicle.parts import NODE, VehicleParts
from gcs.vehicle.received_frames import VehicleFrames
from gcs.vehicle.setpoints import attitude_target, setpoint
from gcs.vehicle.snapshot import lost_pct
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.talk.vehicle_texts import logged
from gcs.vehicle.ways import legs_asked
from gcs.wire import messages as m
from gcs.wire.ids import MissionType
from gcs.wire.messages import CommandLong

ORIGIN_PATIENCE_NS = 10_000_000_000
"""How long a vehicle may take to tell its origin before that is a condition."""


class Vehicle(VehicleParts):
    """One vehicle that a session flies.  The rest of the session reads and asks its parts directly,
    where one of them alone has the answer."""

    def __init__(
        self,
        config: StationConfig,
        policy: Policy,
        times: Times,
        now_ns: int,
        *,
        first: bool = True,
    ) -> None:
        """`first`: it is the one that was there first."""
        super().__init__(config, policy, times, now_ns, first=first)
        self.frames = VehicleFrames(self)
        """The way in of what it sends."""
        self._path_ned: tuple[Vec3, ...] = ()
        """Of the mission on board, as it was recorded last."""

    # ------------------------------------------------------------------------------ reading

    @property
    def deadline_ns(self) -> int | None:
        """When some part's wait is over; the gate itself lives on ticks."""
        talking = (self.commands, self.settings, self.missions, self.returns.rally, self.fence)
        waiting = (*talking, self.readers, self.words, self.events, self.reasons)
        times = [time for part in waiting if (time := part.deadline_ns) is not None]
        return min(times, default=None)

    @property
    def gate(self) -> Gate:
        """To look at, not to handle."""
        return self.port.gate

    def why_not_resume(self, now_ns: int) -> Refusal | None:
        """Why the gate would not fly it under control from here, once it is held."""
        port = self.port
        return why_not_resume(port.policy, port.gate.memory, now_ns)

    def why_not_go_to(self, goal_ned: Vec3, yaw_rad: float | None) -> Refusal | None:
        """Why the gate would not fly it there, once its hold is lifted."""
        return why_not_go_to(self.port.gate.memory, goal_ned, yaw_rad)

    def flying(self, now_ns: int) -> Telemetry | None:
        """What it tells, if it flies and its position is fresh."""
        return None if self.port.gate.state in NOT_FLYING else self.placed(now_ns)

    def placed(self, now_ns: int) -> Telemetry | None:
        """What it tells, if its position is fresh."""
        telemetry = self.telemetry
        if telemetry is None or telemetry.pos_ned is None:
            return None
        fresh = now_ns - telemetry.position_ns <= telemetry.position_age_ns
        return telemetry if fresh else None

    @property
    def links(self) -> list[int]:
        """The link that it is answered on; none before it is heard."""
        return [] if self.telemetry is None else [self.telemetry.link]

    def hears_component(self, compid: int) -> bool:
        """Whether that component of its system was ever heard on a vehicle's link."""
        telemetry = self.telemetry
        return telemetry is not None and self.presence.hears(telemetry.sysid, compid)

    @property
    def plan_transfer(self) -> bool:
        """The station reads or writes a plan of the vehicle, or is about to."""
        return self.missions.job is not None or self.returns.rally.reading or self.fence.reading

    @property
    def not_on_board(self) -> tuple[MissionType, ...]:
        """Of which plans, fence and rally points, it was read that there are none."""
        fence = (MissionType.FENCE,) if self.fence.none_on_board else ()
        return (*fence, MissionType.RALLY) if self.returns.rally.none_on_board else fence

    # --------------------------------------------------------------------------------- time

    def wake(self, now_ns: int) -> list[Work]:
        """Some part's deadline has passed."""
        work = self.commands.wake(self.telemetry, now_ns) + logged(self.words.wake(now_ns))
        work += self.events.wake(now_ns)
        if self.telemetry is not None:
            work += self.reasons.wake(self.telemetry.custom_mode, now_ns)
            work += self.learn(self.settings.wake(self.telemetry, now_ns), self.telemetry)
            work += self.readers.wake(self.telemetry, now_ns)
            missions = self.missions.wake(self.view(self.telemetry), now_ns)
            work += self.with_plans_on_board(missions, now_ns)
            work += self.wake_plans_on_board(self.telemetry, now_ns)
        return work

    def rally_points_change(self, now_ns: int) -> list[Work]:
        """A client's message that changes them goes to the vehicle."""
        if self.telemetry is None:
            return []
        return self.with_plans_on_board(self.returns.changed(self.telemetry, now_ns), now_ns)

    def second(self, now_ns: int) -> list[Work]:
        """Once a second: ask for what is missing, and record how the vehicle is."""
        telemetry = self.telemetry
        if telemetry is None:
            return []
        work: list[Work] = []
        if not self.presence.is_gone(telemetry, now_ns):
            work += self.ask_for_missing(telemetry, now_ns)
        if now_ns >= telemetry.delay.ask_at_ns:
            target = telemetry.sysid, telemetry.compid
            work.append(Send(m.Timesync(0, telemetry.delay.ask(now_ns), *target)))
        if late := telemetry.delay.trouble(telemetry.position_age_ns, now_ns):
            work.append(Log(effects.Level.WARNING, NODE, late))
        silent_ns = self.times.real_ns(GPS_SILENT_NS)
        positions = now_ns - telemetry.position_ns <= telemetry.position_age_ns
        work += telemetry.health.gps_silent(silent_ns, now_ns, positions=positions)
        missing = telemetry.origin is None and now_ns - self.met_ns > self.times.real_ns(
            ORIGIN_PATIENCE_NS
        )
        work += self.with_plans_on_board([], now_ns)
        work += self.watch.second(self.presence.losses, now_ns)
        text = "the vehicle has not told its origin (GPS_GLOBAL_ORIGIN)"
        work.append(condition(Condition.ORIGIN_MISSING, missing, text))
        return [*work, Record(record_items.status(telemetry, lost_pct(self.presence.losses)))]

    def send_own(self, commands: Iterable[CommandLong], now_ns: int) -> list[Work]:
        """Harmless commands of the station's own, such as for a stream."""
        return [work for each in commands for work in self.commands.send_own(each, now_ns)]

    def ask_for_streams(self, msgids: Iterable[int], now_ns: int) -> list[Work]:
        """Ask once more for streams that the gate needs."""
        if self.telemetry is None:
            return []
        return self.send_own(self.discovery.again(self.telemetry, msgids), now_ns)

    def remind(self) -> list[Work]:
        """The gate's state once more, for the record; before a vehicle is heard, of the one that
        is expected, where its number is known."""
        sysid = self.sysid or self.config.expected_sysid
        return [*announcements.reminder(self.port.gate, sysid)] if sysid else []

    def drawn(self) -> list[Work]:
        """For the record: what the room allows on the leg that it flies, where it would come to
        rest if it were told to stop now, and the mission on board where that is another one."""
        if self.telemetry is None:
            return []
        work = self.port.ahead(self.telemetry)
        path_ned, plan = self.missions.path_ned, self.missions.plan
        if path_ned is not self._path_ned:
            self._path_ned = path_ned
            name = "" if plan is None else plan.plan.name
            work.append(Record(MissionItem(self.telemetry.sysid, name, path_ned)))
        return work

    # ----------------------------------------------------------------------------- requests

    def refusal(self, now_ns: int) -> Refusal | None:
        """Why nothing at all can be asked of it; None where the gate or a job is to answer."""
        refusal = self.roster.refusal(now_ns)
        telemetry = self.telemetry
        if refusal is None and telemetry is not None and not telemetry.autopilot.commanded:
            what = f"{telemetry.label} is watched and recorded"
            sentence = f"this station flies multirotors with PX4 or ArduPilot only; {what}"
            return Refusal(Code.UNSUPPORTED_VEHICLE, sentence)
        return refusal

    def listening(self, now_ns: int) -> bool:
        """Whether it may still turn out that there are several vehicles (where one of our own is
        not alone), or the return height or rally points, which a return needs, are still on their
        way."""
        alone = self.config.sim is not None and self.config.sim.count == 1
        several = not alone and self.roster.listening(now_ns)
        if several or self.telemetry is None:
            return several
        return not self.telemetry.return_told or not self.returns.rally.answered

    def ask_mission(self, asked: AskMission, now_ns: int) -> list[Work]:
        """A mission transfer, or the start of the mission on board."""
        view = None if self.telemetry is None else self.view(self.telemetry)
        work = self.missions.ask(asked.request_id, asked.ask, view, now_ns, asked.plan, asked.kind)
        return self.ask_for_control(now_ns) + self.with_plans_on_board(work, now_ns)

    def ask_orbit(self, asked: AskOrbit, now_ns: int) -> list[Work]:
        """An orbit, which is verified here before the gate is asked for its stream."""
        return self.ask_for_control(now_ns) + self.orbits.ask(
            asked, self.telemetry, self.port.gate, self.port.policy, now_ns
        )

    def ask_speed(self, asked: AskSpeed) -> list[Work]:
        """The most that the next legs are flown at, whoever asks for them; a leg under way goes on
        as it is."""
        if self.telemetry is None:
            unheard = Refusal(Code.NO_VEHICLE, REFUSED[Code.NO_VEHICLE])
            return [GiveVerdict(asked.request_id, effects.Ruling.REFUSED, unheard)]
        name = self.telemetry.autopilot.name
        refusal = why_not_speed(self.port.policy, name, asked.speed_m_s)
        if refusal is not None:
            return [GiveVerdict(asked.request_id, effects.Ruling.REFUSED, refusal)]
        self.leg_speed_m_s = asked.speed_m_s
        text = f"the next legs are flown at {asked.speed_m_s:g} m/s at most"
        return [
            GiveVerdict(asked.request_id, effects.Ruling.ACCEPTED),
            Log(effects.Level.INFO, NODE, text),
            effects.Outcome(asked.request_id, effects.OutcomeKind.COMPLETE, None, text),
        ]

    def orbit_sample(self, in_control: int, now_ns: int) -> list[Work]:
        """The next sample of the orbit that is flown, if it is that of the operator in control."""
        return self.orbits.tick(
            in_control, self.telemetry, self.port.gate, self.port.policy, now_ns
        )

    def file(self, news: FileRead | FileWritten, now_ns: int) -> list[Work]:
        if self.telemetry is None:
            return []
        work = self.missions.file(news, self.view(self.telemetry), now_ns)
        return self.with_plans_on_board(work, now_ns)

    def leave(self) -> list[Work]:
        """The session ends: a mission job that is under way ends with it; what the flight stood on
        is attached to the record."""
        released: list[Work] = []
        if self.telemetry is not None:
            address = Address(self.telemetry.sysid, self.telemetry.compid)
            command = self.control.release(address)
            released = [] if command is None else [Send(command)]
        return [
            *self.missions.leave(),
            *self.readers.leave(),
            *released,
            *record_items.stood_on(self.parameters, self.port.fence_shapes, self.of),
        ]

    # --------------------------------------------------------------------------------- gate

    def ask_gate(self, given: inputs.Input, now_ns: int) -> list[Work]:
        """What its gate answers, and what else follows for the vehicle from such an input; what
        leads somewhere is for the operator's own rule first, where there is one."""
        if self.rule is None:
            return self._asked_gate(given, now_ns)
        kept = self.rule.keeps(given, self.gate, now_ns)
        if kept is not None:
            return [*self._ruled(kept), GATE_ANSWERED]
        work: list[Work] = []
        if isinstance(given, inputs.Tick):
            permitted, ruled = self.rule.tick(self.gate, self._legs_of, now_ns)
            work += self._ruled(ruled)
            if permitted is not None:
                asked = self._asked_gate(permitted, now_ns)
                work += [each for each in asked if each is not GATE_ANSWERED]
        work += self._asked_gate(given, now_ns)
        return work + self._ruled(self.rule.after(self.gate))

    def rule_said(self, given: RuleSaid) -> list[Work]:
        """The answer of the operator's own rule; it may be another vehicle's."""
        return [] if self.rule is None else self._ruled(self.rule.said(given))

    def _ruled(self, work: list[Work]) -> list[Work]:
        """An orbit that the rule refuses is not flown."""
        for each in work:
            if isinstance(each, GiveVerdict):
                self.orbits.refused(each.request_id)
        return work

    def _legs_of(self, requested: inputs.Requested, pos_ned: Vec3) -> list[Leg]:
        return legs_asked(self, requested.request_id, requested.request, pos_ned)

    def _asked_gate(self, given: inputs.Input, now_ns: int) -> list[Work]:
        gate = self.port.gate
        before = gate.state
        if isinstance(given, inputs.StreamSeen) and self.telemetry is not None:
            given = with_thrust_meaning(given, self.telemetry.autopilot, self.parameters)
        work = self.port.handle(given, now_ns)
        if self.missions.job is not None:
            work += self.missions.overruled(given)
        if gate.state is not before:
            self.mission_paused = still_paused(self.mission_paused, before, gate.state)
        return work

    def carry_out(
        self, effect: effects.Effect | PlaceFence | CheckStart, now_ns: int
    ) -> list[Work]:
        """What the gate decided, put into practice."""
        match effect:
            case effects.SendSetpoint(permit):
                assert self.telemetry is not None
                made = setpoint if permit.attitude is None else attitude_target
                message = made(self.telemetry, permit, self.start_ns, now_ns)
                self.telemetry.count_setpoint(now_ns)
                if permit.pos_ned is None:
                    return [Send(message)]  # a velocity or an attitude: there is no place to draw
                sent = SetpointItem(self.telemetry.sysid, permit.pos_ned, permit.yaw_rad)
                return [Send(message), Record(sent)]
            case effects.SendCommand():
                assert self.telemetry is not None
                self.reasons.asked(effect.kind, now_ns)
                asked = self.ask_for_control(now_ns)
                return asked + self.commands.send(effect, self.telemetry, now_ns)
            case effects.CancelCommand(request_id, kind):
                return self.commands.cancel(request_id, kind, now_ns)
            case PlaceFence():
                return self.port.place_fence(self.telemetry)
            case CheckStart():
                self.port.check_start(effect)
                return []
            case effects.Outcome():
                if self.orbits.flown is not None:
                    self.orbits.ended(effect.request_id)
                return [effect]
            case effects.StreamVerdict():
                return [effect]
            case effects.Verdict():
                if effect.request_id in self.orbits.asked:
                    self.orbits.decided(effect, self.port.gate, self.port.policy, now_ns)
                return self.port.tell(effect, self.sysid)
            case _:
                return self.port.tell(effect, self.sysid)

    def hold_without_gate(self, now_ns: int) -> list[Work]:
        """The last resort: HOLD, past a gate that may be broken, where control was ours.

        A return or a landing goes on: it is the safer state.
        """
        comes_down = self.port.gate.state in (State.RETURNING, State.LANDING)
        if self.telemetry is None or self.port.gate.control is Control.NONE or comes_down:
            return []
        hold = effects.SendCommand(0, CommandKind.HOLD, now_ns)
        return self.commands.send(hold, self.telemetry, now_ns)
