"""What is looked at before a take-off, of the vehicle: one row a subject, over what is known of it.

Nothing is sent for it.  What has not been told yet is a caution or a failure, never a pass.  An
active condition is as bad as the policy says: caution is a caution, and whatever is worse fails.
What the station knows of itself is `gcs/station/preflight.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final

from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.policy import Policy
from gcs.gate.states import State
from gcs.ipc import PreflightRow
from gcs.vehicle.health.position_health import Estimator, Gps
from gcs.vehicle.parameters.failsafes import FENCE, FENCE_ACTION, Finding
from gcs.vehicle.parameters.stop_parameters import Stops
from gcs.vehicle.snapshot import lost_pct
from gcs.vehicle.vehicle import Vehicle


class Verdict(StrEnum):
    """Of one row, in ascending order of how bad it is."""

    PASS = "pass"
    CAUTION = "caution"
    FAIL = "fail"


@dataclass(frozen=True, slots=True)
class Known:
    """All that the rows look at, of a vehicle that was heard."""

    policy: Policy
    label: str
    policy_path: str = ""
    """Of the policy's file; empty: the default one."""
    wrong: Mapping[Condition, str] = field(default_factory=dict)
    """The active conditions, and what each was reported with."""
    refusal: str = ""
    """Why nothing at all can be asked of it."""
    lost: bool = False
    silent_s: float = 0.0
    rx_hz: float = 0.0
    lost_pct: float = 0.0
    gps: Gps = field(default_factory=Gps)
    estimator: Estimator = field(default_factory=Estimator)
    stale: bool = False
    placed: bool = False
    """It has told a position."""
    home: bool = False
    origin: bool = False
    bad_place: str = ""
    """Why home, or where it stands, is outside the fence."""
    battery_told: bool = False
    """It has told something of a battery."""
    battery_pct: float | None = None
    battery_v: float | None = None
    prearm_ok: bool | None = None
    why_not_arm: str = ""
    """What it has said against arming."""
    other_mode: str = ""
    """The mode it is in, where that is another one than `arming_mode`."""
    arming_mode: str = ""
    """A mode in which this autopilot arms."""
    on_ground: bool = True
    failsafes: tuple[tuple[Finding, tuple[str, ...]], ...] = ()
    failsafes_asked: bool = False
    """Its own failsafes were asked for."""
    stops: Stops = field(default_factory=Stops)
    mission_items: int = 0
    mission_unverified: str = ""
    """Why the mission on board is not known to clear; empty where none is, or it does."""
    mission_told: bool = False
    """Whether one is on board was told."""
    mission_refused: bool = False


@dataclass(frozen=True, slots=True)
class Found:
    """What a row says."""

    verdict: Verdict
    sentence: str
    remedies: tuple[str, ...] = ()
    waits: bool = False


@dataclass(frozen=True, slots=True)
class Check:
    """One row: its name, what it reads, and what it makes of that."""

    name: str
    reads: str
    judge: Callable[[Known], Found]


OF_ROWS: Final[Mapping[str, tuple[Condition, ...]]] = {
    "link": (Condition.LINK_POOR,),
    "gps": (Condition.GPS_LOST, Condition.GPS_POOR),
    "estimator": (Condition.ESTIMATOR_UNRELIABLE,),
    "home and origin": (Condition.ORIGIN_MISSING, Condition.ORIGIN_MISMATCH),
    "battery": (Condition.BATTERY_LOW, Condition.BATTERY_CRITICAL),
    "failsafes": (Condition.VEHICLE_FAILSAFE_WEAK,),
    "recorder": (Condition.RECORDER_FAILED,),
    "other stations": (Condition.OTHER_STATION,),
    "clock": (Condition.TICK_LATE,),
    "itself": (Condition.PREFLIGHT_FAILED,),
}
"""Conditions that have a row of their own; every other one is told of in `other conditions`."""
ROWS_OF_FENCE: Final = (FENCE_ACTION, FENCE)


def worst(seen: Known, conditions: Collection[Condition]) -> Found | None:
    """What the active ones of them come to, by the policy's severities; None where none is."""
    active = [name for name in conditions if name in seen.wrong]
    if not active:
        return None
    severity = max(seen.policy.severities[name] for name in active)
    words = "; ".join(f"{name.value}: {seen.wrong[name]}" for name in active)
    return Found(by_severity(severity), f"{words} (severity {severity.name.lower()})")


def _order(verdict: Verdict) -> int:
    return [*Verdict].index(verdict)


def by_severity(severity: Severity) -> Verdict:
    """How bad the policy's severity is before a take-off."""
    if severity is Severity.NOMINAL:
        return Verdict.PASS
    return Verdict.CAUTION if severity is Severity.CAUTION else Verdict.FAIL


def _vehicle(seen: Known) -> Found:
    if seen.refusal:
        return Found(Verdict.FAIL, seen.refusal)
    if not seen.on_ground:
        return Found(Verdict.CAUTION, f"{seen.label}, not known to stand on the ground")
    return Found(Verdict.PASS, f"{seen.label}, on the ground")


def _link(seen: Known) -> Found:
    if seen.lost:
        return Found(Verdict.FAIL, f"nothing was heard for {seen.silent_s:.0f} s")
    told = f"{seen.rx_hz:.0f} frames/s, {seen.lost_pct:.1f} % of all were lost"
    bad = worst(seen, OF_ROWS["link"])
    if bad is not None:
        return Found(bad.verdict, f"{bad.sentence}; {told}")
    if seen.rx_hz <= 0.0:
        return Found(Verdict.CAUTION, "its rate is not known yet", waits=True)
    return Found(Verdict.PASS, told)


def _gps(seen: Known) -> Found:
    bad = worst(seen, OF_ROWS["gps"])
    if bad is not None:
        return bad
    unfixed = by_severity(seen.policy.severities[Condition.GPS_LOST])
    if seen.gps.fix_type is None:
        return Found(
            max(unfixed, Verdict.CAUTION, key=_order), "it has told nothing of a GPS", waits=True
        )
    if not seen.gps.fixed:
        words = seen.gps.words
        return Found(unfixed, f"{words}: wait for a fix outdoors", waits=True)
    return Found(Verdict.PASS, seen.gps.words)


def _estimator(seen: Known) -> Found:
    bad = worst(seen, OF_ROWS["estimator"])
    if bad is not None:
        return bad
    if not seen.placed:
        return Found(Verdict.FAIL, "it has told no position", waits=True)
    if seen.stale:
        return Found(Verdict.FAIL, "its position is too old (position_age_s)")
    if not seen.estimator.seen_ns:
        return Found(Verdict.CAUTION, "it has told nothing of its estimator", waits=True)
    if seen.estimator.troubles:
        unsure = by_severity(seen.policy.severities[Condition.ESTIMATOR_UNRELIABLE])
        return Found(max(unsure, Verdict.CAUTION, key=_order), seen.estimator.words)
    return Found(Verdict.PASS, seen.estimator.words)


def _home(seen: Known) -> Found:
    missing = [name for name, told in (("home", seen.home), ("origin", seen.origin)) if not told]
    if missing:
        what = " and ".join(missing)
        return Found(
            Verdict.FAIL,
            f"{what} not known: the fence cannot be placed, no goal judged",
            waits=True,
        )
    if seen.bad_place:
        return Found(Verdict.FAIL, f"{seen.bad_place}: is this the policy for here?")
    return worst(seen, OF_ROWS["home and origin"]) or Found(Verdict.PASS, "known, inside the fence")


def _battery(seen: Known) -> Found:
    limits, volts = seen.policy.battery, seen.battery_v
    told = "" if volts is None else f", {volts:.1f} V"
    low = [seen.wrong[name] for name in OF_ROWS["battery"] if name in seen.wrong]
    if low:
        return Found(Verdict.FAIL, f"low: {low[-1]}{told}: charge or change it")
    if seen.battery_pct is None:
        sentence = f"its charge is not known{told}"
        return Found(Verdict.CAUTION, sentence, waits=not seen.battery_told)
    charge = f"{seen.battery_pct:.0f} %{told}, low at {limits.low_pct:g} %"
    if limits.endurance_s is None:
        return Found(Verdict.PASS, charge)
    left_s = limits.endurance_s * max(0.0, seen.battery_pct - limits.low_pct) / 100.0
    return Found(Verdict.PASS, f"{charge}: flies for {left_s / 60.0:.0f} min until then")


def _arming(seen: Known) -> Found:
    if seen.prearm_ok is None:
        why = seen.why_not_arm or "it does not say that it would arm"
        return Found(Verdict.CAUTION, why, waits=True)
    if not seen.prearm_ok:
        if seen.other_mode and not seen.why_not_arm:
            # A mode in which nothing is armed, such as that of a landing, is a reason by itself.
            sentence = f"in {seen.other_mode} it would not arm, and does not say why"
            return Found(Verdict.CAUTION, sentence, (f"gcs mode {seen.arming_mode}",), waits=True)
        why = seen.why_not_arm or "it has not told why yet (an ArduPilot does every 30 s)"
        return Found(Verdict.FAIL, f"the vehicle would not arm: {why}", waits=not seen.why_not_arm)
    return Found(Verdict.PASS, "the vehicle would arm")


def _of_failsafes(seen: Known, of_fence: bool) -> Found:
    """Cases that are weak are told one by one, with what mends them."""
    if not seen.failsafes_asked:
        return Found(Verdict.CAUTION, "its parameters are being read", waits=True)
    found = [each for each in seen.failsafes if (each[0].about in ROWS_OF_FENCE) is of_fence]
    if not found:
        return Found(Verdict.CAUTION, "not known: which parameters it has is not known here")
    weak = [case for case, _ in found if case.weak]
    if not weak:
        return Found(Verdict.PASS, "; ".join(case.words for case, _ in found))
    bad = by_severity(seen.policy.severities[Condition.VEHICLE_FAILSAFE_WEAK])
    remedies = tuple(command for case, commands in found if case.weak for command in commands)
    if of_fence:
        remedies = (f"gcs fence put{f' --policy {seen.policy_path}' if seen.policy_path else ''}",)
    return Found(bad, "; ".join(case.words for case in weak), remedies)


def _stops(seen: Known) -> Found:
    stops = seen.stops
    unread = [names[0] for names in stops.unread]
    not_read = f"{len(unread)} were not read" if unread else ""
    if stops.others:
        words = "; ".join((*stops.others, *filter(None, [not_read])))
        why = "the bounds of a stop were recorded with other values, and may not hold"
        return Found(Verdict.CAUTION, f"{words}: {why}", stops.mends)
    if unread:
        return Found(Verdict.CAUTION, not_read, (f"gcs param get {' '.join(unread)}",))
    return Found(Verdict.PASS, "as when the bounds of a stop were recorded")


def _mission(seen: Known) -> Found:
    if seen.mission_refused:
        return Found(Verdict.FAIL, seen.mission_unverified, ("gcs mission clear",))
    if seen.mission_unverified:
        # What is on board may only be read by `preflight` itself, on the ground.
        return Found(Verdict.CAUTION, seen.mission_unverified, waits=not seen.mission_told)
    if not seen.mission_items:
        return Found(Verdict.PASS, "none on board")
    timed = "" if seen.policy.battery.endurance_s else "; its time is not judged (endurance_s)"
    return Found(Verdict.PASS, f"{seen.mission_items} items, which clear by this policy{timed}")


def _others(seen: Known) -> Found:
    named = {name for names in OF_ROWS.values() for name in names}
    bad = worst(seen, [name for name in Condition if name not in named])
    return bad or Found(Verdict.PASS, "none")


CHECKS: Final = (
    Check("vehicle", "its kind, and whether it stands on the ground", _vehicle),
    Check("link", "frames of the vehicle, received and lost", _link),
    Check("gps", "GPS_RAW_INT beside [gps] of the policy", _gps),
    Check("estimator", "ESTIMATOR_STATUS or EKF_STATUS_REPORT, and the position", _estimator),
    Check("home and origin", "HOME_POSITION and GPS_GLOBAL_ORIGIN inside the fence", _home),
    Check("battery", "SYS_STATUS and BATTERY_STATUS beside [battery] of the policy", _battery),
    Check("arming checks", "the vehicle's own: SYS_STATUS, its texts and events", _arming),
    Check("failsafes", "the vehicle's own, by its parameters", lambda s: _of_failsafes(s, False)),
    Check(
        "fence on board",
        "the vehicle's own fence beside the policy's, by its parameters and what was uploaded",
        lambda seen: _of_failsafes(seen, True),
    ),
    Check("stop parameters", "what shapes a stop, as the bounds were recorded with", _stops),
    Check("mission", "the mission on board beside policy and battery", _mission),
    Check("other conditions", "everything else that the gate was told is wrong", _others),
)
"""What is looked at of a vehicle."""


def known(vehicle: Vehicle, now_ns: int) -> Known | None:
    """Of a vehicle; None before it is heard."""
    telemetry, gate = vehicle.telemetry, vehicle.gate
    if telemetry is None:
        return None
    refusal = vehicle.refusal(now_ns)
    bad = vehicle.port.bad_home or vehicle.port.bad_start
    losses = vehicle.presence.losses
    missions = vehicle.missions
    autopilot = telemetry.autopilot
    arming_mode = autopilot.arms_in
    return Known(
        policy=vehicle.port.policy,
        label=telemetry.label,
        policy_path=vehicle.config.policy_path,
        wrong=dict(gate.reasons),
        refusal="" if refusal is None else refusal.sentence,
        lost=gate.state is State.NO_VEHICLE,
        silent_s=(now_ns - telemetry.heard_ns) / 1e9,
        rx_hz=telemetry.rx_hz,
        lost_pct=lost_pct(losses),
        gps=telemetry.health.gps,
        estimator=telemetry.health.estimator,
        stale=gate.state is State.STALE,
        placed=telemetry.pos_ned is not None,
        home=telemetry.home_ned is not None,
        origin=telemetry.origin is not None,
        bad_place="" if bad is None else bad.sentence,
        battery_told=telemetry.charge.told,
        battery_pct=telemetry.charge.left_pct(now_ns),
        battery_v=telemetry.battery_v,
        prearm_ok=telemetry.prearm_healthy or telemetry.prearm_ok,
        why_not_arm=vehicle.words.against_arming(telemetry.custom_mode, now_ns, now_ns),
        other_mode=""
        if not arming_mode or telemetry.mode_name == arming_mode
        else telemetry.mode_name,
        arming_mode=arming_mode,
        on_ground=gate.memory.on_ground,
        failsafes=vehicle.settings.failsafes(telemetry),
        failsafes_asked=vehicle.settings.asked,
        stops=vehicle.stop_parameters.known(autopilot.name),
        mission_items=missions.items,
        mission_unverified=missions.unverified,
        mission_told=missions.told,
        mission_refused=missions.does_not_clear,
    )


def rows(seen: Known) -> list[PreflightRow]:
    """Every row, in the order of the table."""
    return [row(check.name, check.judge(seen)) for check in CHECKS]


def row(name: str, found: Found) -> PreflightRow:
    """As it is told."""
    return PreflightRow(
        name, found.verdict.value, found.sentence, list(found.remedies), found.waits
    )
