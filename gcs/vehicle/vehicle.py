"""One vehicle, as the rest of the session knows it: what is asked of it, and what it shows.

What it has is in `parts.py`, the way of its frames in `received_frames.py` and
`messages.py`, the way of its gate's decisions out in `decisions.py`.  What is per
link is in `links.py`, per client in `requests.py`, and what is per session in `session.py`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from gcs.config import StationConfig
from gcs.frames import Vec3
from gcs.gate import effects, inputs
from gcs.gate.condition import Condition
from gcs.gate.machine.could import why_not_go_to, why_not_resume
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.autopilot import Autopilot
from gcs.protocol.effects import Address, Send
from gcs.protocol.sequence import SequenceTracker
from gcs.report import FenceShape
from gcs.session import announcements
from gcs.session.effects import Record
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.speedup_waits import Times
from gcs.session.work import AskMission, AskOrbit, CheckStart, Log, PlaceFence, Work, condition
from gcs.vehicle import messages, record_items
from gcs.vehicle.decisions import VehicleDecisions
from gcs.vehicle.gate_port import NOT_FLYING
from gcs.vehicle.health.position_health import GPS_SILENT_NS
from gcs.vehicle.missions.missions import still_paused
from gcs.vehicle.parameters.thrust_meaning import with_thrust_meaning
from gcs.vehicle.parts import VehicleParts
from gcs.vehicle.received_frames import VehicleFrames
from gcs.vehicle.snapshot import lost_pct
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.talk.vehicle_texts import logged
from gcs.wire import messages as m
from gcs.wire.ids import MissionType
from gcs.wire.messages import CommandLong

ORIGIN_PATIENCE_NS = 10_000_000_000
"""How long a vehicle may take to tell its origin before that is a condition."""


class Vehicle:
    """One vehicle that a session flies."""

    def __init__(
        self,
        config: StationConfig,
        policy: Policy,
        times: Times,
        now_ns: int,
        *,
        shown: bool = True,
    ) -> None:
        """`shown`: it is the one that the screens of operators show."""
        self._parts = VehicleParts(config, policy, times, now_ns, shown=shown)
        self._decisions = VehicleDecisions(self._parts)
        self.frames = VehicleFrames(self._parts)
        """The way in of what it sends."""

    # ------------------------------------------------------------------------------ reading

    @property
    def telemetry(self) -> Telemetry | None:
        """What it reports; None until it is heard."""
        return self._parts.telemetry

    @property
    def mission_paused(self) -> bool:
        """A mission was stopped by a hold, and nothing else was flown since."""
        return self._parts.mission_paused

    @property
    def sysid(self) -> int:
        """0 before it is heard."""
        telemetry = self._parts.telemetry  # not `_parts.sysid`: this is asked of every frame
        return telemetry.sysid if telemetry else 0

    @property
    def deadline_ns(self) -> int | None:
        """When some part's wait is over; the gate itself lives on ticks."""
        parts = self._parts
        talking = (parts.commands, parts.settings, parts.missions, parts.returns, parts.fence)
        waiting = (*talking, parts.words, parts.events, parts.reasons)
        times = [part.deadline_ns for part in waiting]
        return min((time for time in times if time is not None), default=None)

    @property
    def gate(self) -> Gate:
        """To look at, not to handle."""
        return self._parts.port.gate

    def why_not_resume(self, now_ns: int) -> Refusal | None:
        """Why the gate would not fly it under control from here, once it is held."""
        port = self._parts.port
        return why_not_resume(port.policy, port.gate.memory, now_ns)

    def why_not_go_to(self, goal_ned: Vec3, yaw_rad: float | None) -> Refusal | None:
        """Why the gate would not fly it there, once its hold is lifted."""
        return why_not_go_to(self._parts.port.gate.memory, goal_ned, yaw_rad)

    def flying(self, now_ns: int) -> Telemetry | None:
        """What it tells, if it flies and its position is fresh."""
        parts = self._parts
        telemetry = parts.telemetry
        if telemetry is None or telemetry.pos_ned is None or parts.port.gate.state in NOT_FLYING:
            return None
        fresh = now_ns - telemetry.position_ns <= telemetry.position_age_ns
        return telemetry if fresh else None

    @property
    def bad_home(self) -> Refusal | None:
        """Why its home is outside the fence, where its start was looked at."""
        return self._parts.port.bad_home

    @property
    def bad_start(self) -> Refusal | None:
        """Why the place where it stands at the start is outside the fence."""
        return self._parts.port.bad_start

    @property
    def links(self) -> list[int]:
        """The link that it is answered on; none before it is heard."""
        return [] if self._parts.telemetry is None else [self._parts.telemetry.link]

    @property
    def fence_shapes(self) -> list[FenceShape]:
        """The fence as the verifier stands on it; empty before it is placed."""
        return self._parts.port.fence_shapes

    @property
    def parameters(self) -> Mapping[str, float]:
        """Those of its parameters that are known."""
        return self._parts.parameters

    def hears_component(self, compid: int) -> bool:
        """Whether that component of its system was ever heard on a vehicle's link."""
        telemetry = self._parts.telemetry
        return telemetry is not None and self._parts.presence.hears(telemetry.sysid, compid)

    @property
    def losses(self) -> SequenceTracker:
        """Frames that were lost on the way."""
        return self._parts.presence.losses

    @property
    def mission_total(self) -> int | None:
        return self._parts.missions.total

    @property
    def plan_transfer(self) -> bool:
        """The station reads or writes a plan of the vehicle, or is about to."""
        parts = self._parts
        return parts.missions.busy or parts.returns.reading or parts.fence.reading

    @property
    def not_on_board(self) -> tuple[MissionType, ...]:
        """Of which plans, fence and rally points, it was read that there are none."""
        parts = self._parts
        fence = (MissionType.FENCE,) if parts.fence.none_on_board else ()
        return (*fence, MissionType.RALLY) if parts.returns.none_on_board else fence

    @property
    def mission_items(self) -> int:
        """Items of the verified mission on board; 0 where there is none."""
        return self._parts.missions.items

    @property
    def land_starts(self) -> tuple[int, ...]:
        """The DO_LAND_START items of that mission."""
        return self._parts.missions.land_starts

    # --------------------------------------------------------------------------------- time

    def wake(self, now_ns: int) -> list[Work]:
        """Some part's deadline has passed."""
        parts = self._parts
        work = parts.commands.wake(parts.telemetry, now_ns) + logged(parts.words.wake(now_ns))
        work += parts.events.wake(now_ns)
        if parts.telemetry is not None:
            work += parts.reasons.wake(parts.telemetry.custom_mode, now_ns)
            work += parts.learn(parts.settings.wake(parts.telemetry, now_ns), parts.telemetry)
            missions = parts.missions.wake(parts.view(parts.telemetry), now_ns)
            work += parts.with_plans_on_board(missions, now_ns)
            work += parts.wake_plans_on_board(parts.telemetry, now_ns)
        return work

    def rally_points_change(self, now_ns: int) -> list[Work]:
        """A client's message that changes them goes to the vehicle."""
        parts = self._parts
        if parts.telemetry is None:
            return []
        return parts.with_plans_on_board(parts.returns.changed(parts.telemetry, now_ns), now_ns)

    def second(self, now_ns: int) -> list[Work]:
        """Once a second: ask for what is missing, and record how the vehicle is."""
        parts = self._parts
        telemetry = parts.telemetry
        if telemetry is None:
            return []
        work: list[Work] = []
        if not parts.presence.is_gone(telemetry, now_ns):
            work += parts.ask_for_missing(telemetry, now_ns)
        if now_ns >= telemetry.delay.ask_at_ns:
            target = telemetry.sysid, telemetry.compid
            work.append(Send(m.Timesync(0, telemetry.delay.ask(now_ns), *target)))
        if late := telemetry.delay.trouble(telemetry.position_age_ns, now_ns):
            work.append(Log(effects.Level.WARNING, messages.NODE, late))
        silent_ns = parts.times.real_ns(GPS_SILENT_NS)
        positions = now_ns - telemetry.position_ns <= telemetry.position_age_ns
        work += telemetry.health.gps_silent(silent_ns, now_ns, positions=positions)
        missing = telemetry.origin is None and now_ns - parts.met_ns > parts.times.real_ns(
            ORIGIN_PATIENCE_NS
        )
        work += parts.with_plans_on_board([], now_ns)
        work += parts.watch.second(parts.presence.losses, now_ns)
        text = "the vehicle has not told its origin (GPS_GLOBAL_ORIGIN)"
        work.append(condition(Condition.ORIGIN_MISSING, missing, text))
        return [*work, Record(record_items.status(telemetry, lost_pct(parts.presence.losses)))]

    def send_own(self, commands: Iterable[CommandLong], now_ns: int) -> list[Work]:
        """Harmless commands of the station's own, such as for a stream."""
        return [work for each in commands for work in self._parts.commands.send_own(each, now_ns)]

    def ask_for_streams(self, msgids: Iterable[int], now_ns: int) -> list[Work]:
        """Ask once more for streams that the gate needs."""
        parts = self._parts
        if parts.telemetry is None:
            return []
        return self.send_own(parts.discovery.again(parts.telemetry, msgids), now_ns)

    def remind(self) -> list[Work]:
        """The gate's state once more, for the record; before a vehicle is heard, of the one that
        is expected, where its number is known."""
        parts = self._parts
        sysid = parts.sysid or parts.config.expected_sysid
        return [*announcements.reminder(parts.port.gate, sysid)] if sysid else []

    def predicted_stop(self) -> list[Work]:
        """Where it would come to rest if it were told to stop now, for the record.  In flight."""
        parts = self._parts
        return [] if parts.telemetry is None else parts.port.predicted_stop(parts.telemetry)

    # ----------------------------------------------------------------------------- requests

    def refusal(self, now_ns: int) -> Refusal | None:
        """Why nothing at all can be asked of it; None where the gate or a job is to answer."""
        refusal = self._parts.roster.refusal(now_ns)
        telemetry = self._parts.telemetry
        if refusal is None and telemetry is not None and not telemetry.autopilot.commanded:
            what = f"{telemetry.label} is watched and recorded"
            sentence = f"this station flies multirotors with PX4 or ArduPilot only; {what}"
            return Refusal(Code.UNSUPPORTED_VEHICLE, sentence)
        return refusal

    def for_operators(self, now_ns: int) -> tuple[Autopilot | None, Refusal | None]:
        """Its autopilot, None before it is heard; and why nothing at all can be asked of it."""
        telemetry = self._parts.telemetry
        return telemetry.autopilot if telemetry else None, self.refusal(now_ns)

    def heard_vehicles(self, now_ns: int) -> list[str]:
        """The names of all that are heard."""
        return self._parts.roster.names(now_ns)

    def hears(self, sysid: int, now_ns: int) -> bool:
        """Whether the autopilot of that system is heard, this vehicle or another one."""
        return self._parts.roster.hears(sysid, now_ns)

    def listening(self, now_ns: int) -> bool:
        """Whether it may still turn out that there are several vehicles (one of our own is alone),
        or the return height or rally points, which a return needs, are still on their way."""
        parts = self._parts
        several = parts.config.sim is None and parts.roster.listening(now_ns)
        if several or parts.telemetry is None:
            return several
        return not parts.telemetry.return_told or parts.returns.first_time

    def ask_mission(self, asked: AskMission, now_ns: int) -> list[Work]:
        """A mission transfer, or the start of the mission on board."""
        parts = self._parts
        state, policy = parts.port.gate.state, parts.port.policy
        work = parts.missions.ask(
            asked.request_id,
            asked.ask,
            parts.telemetry,
            state,
            policy,
            now_ns,
            asked.plan,
            asked.kind,
        )
        return parts.ask_for_control(now_ns) + parts.with_plans_on_board(work, now_ns)

    def ask_orbit(self, asked: AskOrbit, now_ns: int) -> list[Work]:
        """An orbit, which is verified here before the gate is asked for its stream."""
        parts = self._parts
        return parts.ask_for_control(now_ns) + parts.orbits.ask(
            asked, parts.telemetry, parts.port.gate, parts.port.policy, now_ns
        )

    def orbit_sample(self, in_control: int, now_ns: int) -> list[Work]:
        """The next sample of the orbit that is flown, if it is that of the operator in control."""
        parts = self._parts
        return parts.orbits.tick(
            in_control, parts.telemetry, parts.port.gate, parts.port.policy, now_ns
        )

    def streamed_by(self, operator: int) -> list[Work]:
        """An operator sends samples of its own: an orbit of its is not flown any more."""
        return self._parts.orbits.streams_itself(operator)

    def file(self, news: FileRead | FileWritten, now_ns: int) -> list[Work]:
        parts = self._parts
        if parts.telemetry is None:
            return []
        work = parts.missions.file(news, parts.view(parts.telemetry), now_ns)
        return parts.with_plans_on_board(work, now_ns)

    def stop_transfer(self, request_id: int) -> list[Work]:
        """End the mission transfer of that request; nothing where none is under way."""
        return self._parts.missions.stop(request_id)

    def leave(self) -> list[Work]:
        """The session ends: a mission job that is under way ends with it; what the flight stood on
        is attached to the record."""
        parts = self._parts
        released: list[Work] = []
        if parts.telemetry is not None:
            address = Address(parts.telemetry.sysid, parts.telemetry.compid)
            command = parts.control.release(address)
            released = [] if command is None else [Send(command)]
        return [
            *parts.missions.leave(),
            *released,
            *record_items.stood_on(parts.parameters, parts.port.fence_shapes, parts.of),
        ]

    # --------------------------------------------------------------------------------- gate

    def ask_gate(self, given: inputs.Input, now_ns: int) -> list[Work]:
        parts = self._parts
        gate = parts.port.gate
        before = gate.state
        if isinstance(given, inputs.StreamSeen) and parts.telemetry is not None:
            given = with_thrust_meaning(given, parts.telemetry.autopilot, parts.parameters)
        work = [*parts.port.handle(given, now_ns), *parts.missions.overruled(given)]
        parts.mission_paused = still_paused(parts.mission_paused, before, gate.state)
        return work

    def carry_out(
        self, effect: effects.Effect | PlaceFence | CheckStart, now_ns: int
    ) -> list[Work]:
        """What the gate decided, put into practice."""
        return self._decisions.carry_out(effect, now_ns)

    def hold_without_gate(self, now_ns: int) -> list[Work]:
        """The last resort, past a gate that may be broken: HOLD, where control was ours."""
        return self._decisions.hold_without_gate(now_ns)
