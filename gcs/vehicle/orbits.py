"""Orbits that operators have asked for: their samples, made at every tick in the operator's name.

An orbit is a setpoint stream of whoever asked for it, which the station makes itself.  So its
request is the gate's `BeginStream`, its samples go the way of any operator's samples and are
verified one by one, and it ends as a stream ends: with a stop, a go-to, another mode, with control,
or with its operator.
"""

from __future__ import annotations

import math
from typing import Final

from gcs import ipc
from gcs.enu_text import fixed, plain_enu
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.projection import Projection
from gcs.gate.effects import Level, Ruling, Verdict
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import BeginStream
from gcs.gate.states import State
from gcs.orbit.circle import Asked, Nose, Orbit, orbit_of
from gcs.orbit.clearance import why_not
from gcs.orbit.guidance import Guidance, Place
from gcs.session.effects import Emit
from gcs.session.requests import source_of
from gcs.session.speedup_waits import Times
from gcs.session.work import AskGate, AskOrbit, GiveVerdict, Log, OrbitSample, Work
from gcs.vehicle.talk.telemetry import Telemetry

NODE: Final = "orbit"
BEGINS_FROM: Final = frozenset({State.HOVERING, State.MOVING, State.STREAMING})
"""States from which the gate may let a stream begin; it refuses one in every other state."""
TOLD_NS: Final = 500_000_000
"""Twice a second of real time, as a PX4 tells of its orbit (from memory)."""


class Flown:
    """An orbit that is flown for an operator."""

    __slots__ = ("guidance", "last_ns", "operator", "task", "told_ns")

    def __init__(self, operator: int, guidance: Guidance, task: int, now_ns: int) -> None:
        """`task` is the request with which the gate's stream ends."""
        self.operator = operator
        self.guidance = guidance
        self.task = task
        self.last_ns = now_ns
        self.told_ns: int | None = None


class Orbits:
    """Of one vehicle: the orbit that the gate is asked about, and the one that is flown."""

    def __init__(self, times: Times) -> None:
        self._times = times
        self.asked: dict[int, tuple[int, Orbit]] = {}
        """By request, those that the gate has not decided on yet: whose, and what."""
        self.flown: Flown | None = None
        """The one that is flown now."""

    def ask(
        self, asked: AskOrbit, telemetry: Telemetry | None, gate: Gate, policy: Policy, now_ns: int
    ) -> list[Work]:
        """All of it is verified before the gate is asked, so that nothing moves for one that does
        not clear."""
        orbit = self._orbit(asked, telemetry, gate, policy, now_ns)
        if isinstance(orbit, Refusal):
            text = f"orbit: refused {orbit.code.value}: {orbit.sentence}"
            refused = GiveVerdict(asked.request_id, Ruling.REFUSED, orbit)
            return [refused, Log(Level.WARNING, NODE, text)]
        work: list[Work] = []
        if orbit is not None:
            self.asked[asked.request_id] = asked.operator, orbit
            work.append(Log(Level.INFO, NODE, _in_words(orbit)))
        return [*work, AskGate(asked.request_id, BeginStream())]

    def _orbit(
        self, asked: AskOrbit, telemetry: Telemetry | None, gate: Gate, policy: Policy, now_ns: int
    ) -> Orbit | Refusal | None:
        """None: as things stand the gate refuses whatever it is, and says why."""
        verifier = gate.memory.verifier
        if telemetry is None or verifier is None or gate.state not in BEGINS_FROM:
            return None
        pos_ned, age_ns = telemetry.pos_ned, now_ns - telemetry.position_ns
        if pos_ned is None or age_ns > round(policy.position_age_s * 1e9):
            return None
        wanted = _asked_for(asked.ask.orbit or ipc.Circle())
        if isinstance(wanted, Refusal):
            return wanted
        own = self.flown is not None and self.flown.operator == asked.operator
        before = self.flown.guidance.orbit if own and self.flown is not None else None
        orbit = orbit_of(wanted, pos_ned, telemetry.yaw_rad, before, policy.stream)
        if isinstance(orbit, Refusal):
            return orbit
        return why_not(orbit, verifier, pos_ned, telemetry.v_ned) or orbit

    def decided(self, told: Verdict, gate: Gate, policy: Policy, now_ns: int) -> None:
        """The gate's verdict on a request: an orbit that it lets begin is flown from now on."""
        asked = self.asked.pop(told.request_id, None)
        memory = gate.memory
        if asked is None or told.ruling is not Ruling.ACCEPTED or memory.pos_ned is None:
            return
        operator, orbit = asked
        task = told.request_id if memory.task is None else memory.task.requested.request_id
        braking = policy.braking_of(memory.autopilot)
        guidance = Guidance(orbit, memory.pos_ned, braking, policy.stream)
        self.flown = Flown(operator, guidance, task, now_ns)

    def refused(self, request_id: int) -> None:
        """The gate is not asked about it."""
        self.asked.pop(request_id, None)

    def ended(self, request_id: int) -> None:
        """A request is over, and with it the orbit that it has asked for."""
        if self.flown is not None and self.flown.task == request_id:
            self.flown = None

    def streams_itself(self, operator: int) -> list[Work]:
        """This operator sends samples of its own: they are flown instead."""
        if self.flown is None or self.flown.operator != operator:
            return []
        self.flown = None
        text = "given up: its operator streams setpoints of its own"
        return [Log(Level.INFO, NODE, text)]

    def tick(
        self,
        in_control: int,
        telemetry: Telemetry | None,
        gate: Gate,
        policy: Policy,
        now_ns: int,
    ) -> list[Work]:
        """The next sample, before the gate's own tick; `in_control` is an operator's number."""
        flown = self.flown
        if flown is None or telemetry is None or telemetry.pos_ned is None:
            return []
        memory, operator = gate.memory, flown.operator
        if memory.flown_state is not State.STREAMING or memory.streamer != source_of(operator):
            self.flown = None
            return []
        age_ns = now_ns - telemetry.position_ns
        if age_ns > round(policy.stream.position_age_s * 1e9):
            return []
        if in_control != operator or flown.guidance.done:
            self.flown = None
            over = Log(Level.INFO, NODE, f"over after {_turns(flown.guidance)}")
            return [over, OrbitSample(operator, None)]
        place = Place(telemetry.pos_ned, telemetry.v_ned, age_ns / 1e9)
        setpoint = flown.guidance.step(place, (now_ns - flown.last_ns) / 1e9)
        flown.last_ns = now_ns
        yaw_deg = None if setpoint.yaw_rad is None else math.degrees(setpoint.yaw_rad)
        v_enu = enu_from_ned(setpoint.v_ned)
        sample = ipc.Stream(v_enu=v_enu, yaw_deg=yaw_deg, vehicle=telemetry.sysid)
        return [OrbitSample(operator, sample), *self._told(flown, telemetry, now_ns)]

    def _told(self, flown: Flown, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """To its operator, now and then: what is flown, for a map to show it."""
        if flown.told_ns is not None and now_ns - flown.told_ns < self._times.real_ns(TOLD_NS):
            return []
        flown.told_ns = now_ns
        orbit, origin = flown.guidance.orbit, telemetry.origin
        centre: tuple[float, float, float] | None = None
        if origin is not None:
            projection = Projection(origin, telemetry.autopilot.name)
            centre = projection.geodetic_from_ned(orbit.centre_ned)
        event = ipc.OrbitEvent(
            time_ns=now_ns,
            centre_enu=enu_from_ned(orbit.centre_ned),
            centre_lat_lon_amsl=centre,
            radius_m=orbit.way * orbit.radius_m,
            speed_m_s=orbit.speed_m_s,
            nose=orbit.nose.value,
            turns=flown.guidance.swept_rad / math.tau,
            circling=flown.guidance.circling,
            vehicle=telemetry.sysid,
        )
        return [Emit(event, flown.operator)]


def _asked_for(circle: ipc.Circle) -> Asked | Refusal:
    nose: Nose | None = None
    if circle.nose:
        if circle.nose not in (each.value for each in Nose):
            names = ", ".join(each.value for each in Nose)
            return Refusal(Code.UNSUPPORTED, f"nose is one of {names}, not {circle.nose[:20]!r}")
        nose = Nose(circle.nose)
    return Asked(circle.centre_enu, circle.radius_m, circle.speed_m_s, circle.turns, nose)


def _in_words(orbit: Orbit) -> str:
    centre: Vec3 = enu_from_ned(orbit.centre_ned)
    way = "clockwise" if orbit.way > 0 else "counter-clockwise"
    return (
        f"a circle of {fixed(orbit.radius_m, 1)} m about {plain_enu(centre)}, {way}, at "
        f"{fixed(orbit.speed_m_s, 1)} m/s"
    )


def _turns(guidance: Guidance) -> str:
    return f"{fixed(guidance.swept_rad / math.tau, 2)} turns"
