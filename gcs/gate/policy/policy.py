"""The policy: what is allowed, how close, how fast, how old; one object, immutable, total.

A policy file mirrors `Policy` key for key: an attribute path here is a TOML path there, and a
key that is left out keeps the value below, which is also what `default.toml` says.
Reading a file is the shell's business; `parse_policy` turns text into a `Policy`.

Heights named `up_m` count from home (the take-off point), unless a zone says otherwise.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.tomlfile import PolicyError, Table, read
from gcs.gate.policy.zonespec import CircleSpec, FileSpec, ZoneSpec, read_zone, room_fault

__all__ = [
    "DEFAULT",
    "Arrival",
    "Braking",
    "ControlTimes",
    "Policy",
    "PolicyError",
    "Speeds",
    "TakeOffLimits",
    "parse_policy",
]


@dataclass(frozen=True, slots=True)
class Arrival:
    """A goal is reached closer than `radius_m`, slower than `speed_m_s` (None: at any speed),
    for `dwell_s` on end."""

    radius_m: float = 0.5
    speed_m_s: float | None = 0.5
    dwell_s: float = 0.5


@dataclass(frozen=True, slots=True)
class Braking:
    """What an autopilot is trusted to do when told to stop; see `stopping.py`."""

    react_s: float
    a_brake_h_m_s2: float
    a_brake_v_m_s2: float
    position_error_h_m: float = 0.5
    position_error_v_m: float = 0.2


@dataclass(frozen=True, slots=True)
class Speeds:
    """The slowest speeds a healthy vehicle flies a goal at, for deadlines."""

    cruise_m_s: float = 2.0
    climb_m_s: float = 0.7
    descend_m_s: float = 0.5


@dataclass(frozen=True, slots=True)
class TakeOffLimits:
    """`max_up_m` is metres above the take-off point."""

    max_up_m: float = 30.0
    timeout_s: float = 60.0


@dataclass(frozen=True, slots=True)
class ControlTimes:
    """Taking control: how long to stream before asking, how long to wait for the heartbeat."""

    stream_s: float = 1.0
    timeout_s: float = 5.0


def _default_fence() -> tuple[ZoneSpec, ...]:
    return (ZoneSpec("home", CircleSpec(150.0), floor_up_m=0.0, ceiling_up_m=50.0),)


def _default_braking() -> Mapping[str, Braking]:
    return MappingProxyType(
        {
            "px4": Braking(react_s=0.3, a_brake_h_m_s2=5.0, a_brake_v_m_s2=3.0),
            "ardupilot": Braking(react_s=0.4, a_brake_h_m_s2=4.0, a_brake_v_m_s2=2.5),
        }
    )


def _default_severities() -> Mapping[Condition, Severity]:
    return MappingProxyType(
        {
            Condition.RECORDER_FAILED: Severity.CAUTION,
            Condition.BATTERY_LOW: Severity.CAUTION,
            Condition.BATTERY_CRITICAL: Severity.RETURN,
            Condition.ORIGIN_MISMATCH: Severity.CAUTION,
            Condition.ORIGIN_MISSING: Severity.CAUTION,
            Condition.OTHER_STATION: Severity.CAUTION,
            Condition.VEHICLE_FAILSAFE_WEAK: Severity.CAUTION,
            Condition.VEHICLE_FAILSAFE_ACTIVE: Severity.CAUTION,
            Condition.TICK_LATE: Severity.CAUTION,
        }
    )


@dataclass(frozen=True, slots=True)
class Policy:
    """Everything the gate decides by.  Seconds, metres, metres per second."""

    name: str = "default"

    fence: tuple[ZoneSpec, ...] = field(default_factory=_default_fence)
    fence_switchable: bool = False
    bounds_inclusive: bool = False
    margin_h_m: float = 2.0
    margin_v_m: float = 0.3
    max_up_m: float = 120.0
    min_up_m: float = 0.0
    max_distance_m: float = 1000.0

    brake_slack_h_m: float = 1.5
    brake_slack_v_m: float = 0.3
    creep_m: float = 0.1
    braking: Mapping[str, Braking] = field(default_factory=_default_braking, hash=False)

    position_age_s: float = 1.0
    stale_grace_s: float = 0.5
    heartbeat_age_s: float = 3.5
    dead_man_s: float = 0.5
    jump_speed_m_s: float = 30.0

    arrival: Arrival = Arrival()
    speeds: Speeds = Speeds()
    deadline_factor: float = 2.0
    deadline_min_s: float = 10.0
    takeoff: TakeOffLimits = TakeOffLimits()
    land_timeout_s: float = 180.0
    photo_timeout_s: float = 10.0
    control: ControlTimes = ControlTimes()

    severities: Mapping[Condition, Severity] = field(
        default_factory=_default_severities, hash=False
    )
    rtl_blocked: Literal["hold", "land", "forward"] = "hold"
    retarget: Literal["refuse", "replace"] = "refuse"
    allow_force_disarm: bool = False
    arm_requires_recording: bool = False

    def braking_of(self, autopilot: str) -> Braking:
        """The autopilot's own, or for a stranger the worst of every entry."""
        own = self.braking.get(autopilot)
        if own is not None:
            return own
        every = tuple(self.braking.values())
        return Braking(
            react_s=max(b.react_s for b in every),
            a_brake_h_m_s2=min(b.a_brake_h_m_s2 for b in every),
            a_brake_v_m_s2=min(b.a_brake_v_m_s2 for b in every),
            position_error_h_m=max(b.position_error_h_m for b in every),
            position_error_v_m=max(b.position_error_v_m for b in every),
        )


DEFAULT = Policy()


def parse_policy(text: str, file: str) -> Policy:
    """Read a policy; `file` is what errors call it.

    Raises PolicyError: unknown keys, wrong types, impossible values, contradictions.
    """
    top, d = read(text, file), DEFAULT
    margin_h_m = top.number("margin_h_m", d.margin_h_m, least=0.0)
    margin_v_m = top.number("margin_v_m", d.margin_v_m, least=0.0)
    policy = Policy(
        name=top.text("name", d.name),
        fence=_read_fence(top, margin_h_m, margin_v_m),
        fence_switchable=top.flag("fence_switchable", d.fence_switchable),
        bounds_inclusive=top.flag("bounds_inclusive", d.bounds_inclusive),
        margin_h_m=margin_h_m,
        margin_v_m=margin_v_m,
        max_up_m=top.number("max_up_m", d.max_up_m, least=0.0),
        min_up_m=top.number("min_up_m", d.min_up_m, least=-1.0e4),
        max_distance_m=top.number("max_distance_m", d.max_distance_m, least=0.0),
        brake_slack_h_m=top.number("brake_slack_h_m", d.brake_slack_h_m, least=0.0),
        brake_slack_v_m=top.number("brake_slack_v_m", d.brake_slack_v_m, least=0.0),
        creep_m=top.number("creep_m", d.creep_m, least=0.0),
        braking=_read_braking(top.table("braking")),
        position_age_s=top.number("position_age_s", d.position_age_s, least=0.05),
        stale_grace_s=top.number("stale_grace_s", d.stale_grace_s, least=0.0),
        heartbeat_age_s=top.number("heartbeat_age_s", d.heartbeat_age_s, least=1.0),
        dead_man_s=top.number("dead_man_s", d.dead_man_s, least=0.05),
        jump_speed_m_s=top.number("jump_speed_m_s", d.jump_speed_m_s, least=1.0),
        arrival=_read_arrival(top.table("arrival")),
        speeds=_read_speeds(top.table("speeds")),
        deadline_factor=top.number("deadline_factor", d.deadline_factor, least=1.0),
        deadline_min_s=top.number("deadline_min_s", d.deadline_min_s, least=0.1),
        takeoff=_read_takeoff(top.table("takeoff")),
        land_timeout_s=top.number("land_timeout_s", d.land_timeout_s, least=1.0),
        photo_timeout_s=top.number("photo_timeout_s", d.photo_timeout_s, least=0.1),
        control=_read_control(top.table("control")),
        severities=_read_severities(top.table("severities")),
        rtl_blocked=top.word("rtl_blocked", d.rtl_blocked, ("hold", "land", "forward")),
        retarget=top.word("retarget", d.retarget, ("refuse", "replace")),
        allow_force_disarm=top.flag("allow_force_disarm", d.allow_force_disarm),
        arm_requires_recording=top.flag("arm_requires_recording", d.arm_requires_recording),
    )
    top.done()
    _check_contradictions(top, policy)
    return policy


def _read_fence(top: Table, margin_h_m: float, margin_v_m: float) -> tuple[ZoneSpec, ...]:
    if not top.has("fence"):
        key = "margin_h_m" if room_fault(DEFAULT.fence[0], margin_h_m, 0.0) else "margin_v_m"
        if fault := room_fault(DEFAULT.fence[0], margin_h_m, margin_v_m):
            top.fail(key, fault[1], "the default fence: a circle of 150 m, 0 to 50 m above home")
        return DEFAULT.fence
    tables = top.tables("fence")
    zones = tuple(read_zone(table, margin_h_m, margin_v_m) for table in tables)
    names = [zone.name for zone in zones]
    for table, name in zip(tables, names, strict=True):
        if names.count(name) > 1:
            table.fail("name", f'two zones are called "{name}"')
    if not any(z.inclusion or isinstance(z.shape, FileSpec) for z in zones):
        top.fail("fence", "has no inclusion zone", "the gate must know where the vehicle may be")
    return zones


def _read_braking(table: Table) -> Mapping[str, Braking]:
    braking = {}
    for name, d in DEFAULT.braking.items():
        one = table.table(name)
        braking[name] = Braking(
            react_s=one.number("react_s", d.react_s, least=0.0, most=10.0),
            a_brake_h_m_s2=one.number("a_brake_h_m_s2", d.a_brake_h_m_s2, least=0.1, most=50.0),
            a_brake_v_m_s2=one.number("a_brake_v_m_s2", d.a_brake_v_m_s2, least=0.1, most=50.0),
            position_error_h_m=one.number("position_error_h_m", d.position_error_h_m, least=0.0),
            position_error_v_m=one.number("position_error_v_m", d.position_error_v_m, least=0.0),
        )
        one.done()
    table.done()
    return MappingProxyType(braking)


def _read_arrival(table: Table) -> Arrival:
    d = DEFAULT.arrival
    arrival = Arrival(
        radius_m=table.number("radius_m", d.radius_m, least=0.01),
        speed_m_s=table.number_or_none("speed_m_s", d.speed_m_s, least=0.01),
        dwell_s=table.number("dwell_s", d.dwell_s, least=0.0),
    )
    table.done()
    return arrival


def _read_speeds(table: Table) -> Speeds:
    d = DEFAULT.speeds
    speeds = Speeds(
        cruise_m_s=table.number("cruise_m_s", d.cruise_m_s, least=0.01),
        climb_m_s=table.number("climb_m_s", d.climb_m_s, least=0.01),
        descend_m_s=table.number("descend_m_s", d.descend_m_s, least=0.01),
    )
    table.done()
    return speeds


def _read_takeoff(table: Table) -> TakeOffLimits:
    d = DEFAULT.takeoff
    limits = TakeOffLimits(
        max_up_m=table.number("max_up_m", d.max_up_m, least=0.1),
        timeout_s=table.number("timeout_s", d.timeout_s, least=1.0),
    )
    table.done()
    return limits


def _read_control(table: Table) -> ControlTimes:
    d = DEFAULT.control
    times = ControlTimes(
        stream_s=table.number("stream_s", d.stream_s, least=0.0),
        timeout_s=table.number("timeout_s", d.timeout_s, least=0.1),
    )
    table.done()
    return times


def _read_severities(table: Table) -> Mapping[Condition, Severity]:
    words = tuple(s.name.lower() for s in Severity)
    severities = {
        condition: Severity[table.word(condition.value, default.name.lower(), words).upper()]
        for condition, default in DEFAULT.severities.items()
    }
    table.done()
    return MappingProxyType(severities)


def _check_contradictions(top: Table, p: Policy) -> None:
    if p.min_up_m >= p.max_up_m:
        top.fail("max_up_m", f"{p.max_up_m:g} is not above min_up_m of {p.min_up_m:g}")
    takeoff = top.table("takeoff")
    if takeoff.has("max_up_m") and p.takeoff.max_up_m > p.max_up_m:
        takeoff.fail(
            "max_up_m", f"{p.takeoff.max_up_m:g} is above the policy's max_up_m of {p.max_up_m:g}"
        )
    if p.control.timeout_s <= p.control.stream_s:
        top.table("control").fail("timeout_s", "is over before the stream has even begun to count")
