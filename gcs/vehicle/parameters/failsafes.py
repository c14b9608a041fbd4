"""The vehicle's own failsafes and fence, as its parameters have them, beside what the policy wants.

A gate on the ground cannot act once the link is down: then these are what is left.  So what is off,
or weaker than the policy, is told (`Condition.VEHICLE_FAILSAFE_WEAK`).  A fence that was uploaded
counts as far as it keeps the vehicle near home; the policy's exclusion zones are not looked for in
it.

Meanings of values: parameter references of PX4 1.14 and ArduCopter 4.7, from memory; those that
vehicle-sim has too are checked against the recorded autopilots there.  A number that an autopilot's
reference does not name is no action that is known, and counts as weak: what an autopilot does then
is written nowhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs.gate.policy.cylinder import cylinder_of
from gcs.gate.policy.policy import Policy
from gcs.protocol.lock_parameters import COPTER_BREACH, COPTER_FENCE_ON, PX4_BREACH, bits_of
from gcs.vehicle.missions.uploaded_fence import NO_FENCE, UploadedFence

LONGEST_STATION_LOSS_S: Final = 30.0
"""Without a station for longer than this, it might as well be never.  A judgement of ours."""
LONGEST_SETPOINT_LOSS_S: Final = 10.0
"""The same of setpoints."""
FENCE_ACTION: Final = "geofence breach"
FENCE: Final = "geofence"
"""What the cases about the vehicle's own fence are called."""
SLACK_M: Final = 0.5
"""A limit of the vehicle's that is wider than the policy's by no more than this is as wide."""

Values: TypeAlias = Mapping[str, float]
"""By the newest names, units of the newest firmware."""
Words: TypeAlias = Mapping[float, str]
"""What the values of a parameter mean."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a vehicle's settings are judged beside: the policy, as far as a vehicle's own fence can
    be as narrow, in metres from and above home; and what the vehicle has that is no setting."""

    reach_m: float
    """The farthest from home that its fence lets the vehicle fly."""
    ceiling_up_m: float
    own_sysid: int
    """The station's number, which an ArduPilot must be told to watch."""
    uploaded: UploadedFence = NO_FENCE
    """The fence that it was sent."""


@dataclass(frozen=True, slots=True)
class Finding:
    """What the vehicle does in one case.  `weak`: off, or weaker than the policy, or not known."""

    about: str
    says: str
    weak: bool
    mends: tuple[tuple[str, float], ...] = ()
    """Parameters and values with which it would not be weak; empty where none is known here."""

    @property
    def words(self) -> str:
        return f"{self.about}: {self.says}"


@dataclass(frozen=True, slots=True)
class Case:
    """`needs` are the parameters without which nothing can be said, `may_need` those that it is
    said more exactly with."""

    about: str
    needs: tuple[str, ...]
    judge: Callable[[Values, Limits], tuple[str, bool]]
    may_need: tuple[str, ...] = ()
    mends: Callable[[Limits], Mapping[str, float]] = lambda _: {}
    """What each of them may be set to where it is weak."""

    def finding(self, values: Values, limits: Limits) -> Finding:
        unknown = [name for name in self.needs if name not in values]
        if unknown:
            return Finding(self.about, f"{' and '.join(unknown)} could not be read", True)
        says, weak = self.judge(values, limits)
        return Finding(self.about, says, weak, self._mends(values, limits) if weak else ())

    def _mends(self, values: Values, limits: Limits) -> tuple[tuple[str, float], ...]:
        """The first setting that is enough by itself, else all of them if these are."""
        known = [one for one in self.mends(limits).items() if math.isfinite(one[1])]
        for some in (*((one,) for one in known), tuple(known)):
            if not self.judge({**values, **dict(some)}, limits)[1]:
                return some
        return ()


def limits_of(policy: Policy, own_sysid: int) -> Limits:
    """Of the policy's fence, as far as its size is known before the vehicle told where it is."""
    about_home = cylinder_of(policy)
    return Limits(about_home.reach_m, about_home.ceiling_up_m, own_sysid)


def findings(autopilot: str, values: Values, limits: Limits) -> tuple[Finding, ...]:
    """One a case; none for an autopilot whose parameters are not known here."""
    return tuple(case.finding(values, limits) for case in CASES.get(autopilot, ()))


def parameters_of(autopilot: str) -> tuple[str, ...]:
    """What must be read for that, by the newest names; each once."""
    names = [name for case in CASES.get(autopilot, ()) for name in (*case.needs, *case.may_need)]
    return tuple(dict.fromkeys(names))


# ------------------------------------------------------------------------------ what is said


def _named(name: str, value: float) -> str:
    return f"{name} = {value:g}"


def _off(name: str, value: float, word: str = "off") -> str:
    return f"{word} ({_named(name, value)})"


def _action(words: Words, name: str, value: float) -> tuple[str, bool]:
    """What an action is called, and whether it is weak, as one without a name is: a number that
    is not in the reference, a fraction or not a number."""
    known = words.get(value)
    return (_off(name, value, "unknown action"), True) if known is None else (known, False)


def _after(values: Values, name: str) -> str:
    return f" after {values[name]:g} s" if name in values else ""


def _too_long(values: Values, name: str, longest_s: float) -> bool:
    return not values.get(name, 0.0) <= longest_s


def _ceiling(values: Values, limits: Limits, name: str) -> tuple[str, bool]:
    up_m = values[name]
    if up_m <= limits.ceiling_up_m + SLACK_M:
        return f"at {up_m:g} m", False
    ceiling = f"above the policy's ceiling of {limits.ceiling_up_m:g} m"
    return f"at {up_m:g} m ({name}), {ceiling}", True


def _wider(values: Values, name: str, most_m: float, what: str) -> tuple[str, bool]:
    """A limit of the vehicle's, 0 for none, beside the policy's."""
    limit_m = values[name]
    if not limit_m > 0.0:
        return f"no {what} ({_named(name, limit_m)}), the policy's is {most_m:g} m", True
    if limit_m > most_m + SLACK_M:
        return f"{what} {limit_m:g} m ({name}), the policy's is {most_m:g} m", True
    return f"{what} {limit_m:g} m", False


def _fence(
    radius: tuple[str, bool], height: tuple[str, bool], limits: Limits, unused: str = ""
) -> tuple[str, bool]:
    """A vehicle's circle and height; an uploaded fence may do for the circle, unless it is
    `unused`, for that reason."""
    most_m = limits.reach_m + SLACK_M
    near = not unused and limits.uploaded.keeps_within(most_m)
    words = limits.uploaded.words(limits.reach_m, most_m, unused)
    says = ", ".join((radius[0], height[0], *([f"uploaded: {words}"] if words else [])))
    return says, height[1] or (radius[1] and not near)


# --------------------------------------------------------------------------------------- PX4

_PX4_LOSS: Final[Words] = {0: "off", 1: "hold", 2: "return", 3: "land", 5: "terminate", 6: "disarm"}
_PX4_BATTERY: Final[Words] = {
    0: "warns only",
    1: "return",
    2: "land when critical",
    3: "return, land when critical",
}
_PX4_OFFBOARD: Final[Words] = {
    0: "position mode",
    1: "altitude mode",
    2: "manual mode",
    3: "return",
    4: "land",
    5: "hold",
    6: "terminate",
    7: "disarm",
}
_PX4_FENCE: Final[Words] = {
    0: "off",
    1: "warns only",
    2: "hold",
    3: "return",
    4: "terminate",
    5: "land",
}


def _px4_station(values: Values, _limits: Limits) -> tuple[str, bool]:
    action = values["NAV_DLL_ACT"]
    if action == 0.0:
        return _off("NAV_DLL_ACT", action), True
    said, weak = _action(_PX4_LOSS, "NAV_DLL_ACT", action)
    long = _too_long(values, "COM_DL_LOSS_T", LONGEST_STATION_LOSS_S)
    return said + _after(values, "COM_DL_LOSS_T"), weak or long


def _px4_sticks(values: Values, _limits: Limits) -> tuple[str, bool]:
    action = values["NAV_RCL_ACT"]
    if action == 0.0:
        return _off("NAV_RCL_ACT", action), True
    return _action(_PX4_LOSS, "NAV_RCL_ACT", action)


def _px4_offboard(values: Values, _limits: Limits) -> tuple[str, bool]:
    """Altitude and manual mode hold no place."""
    action = values["COM_OBL_RC_ACT"]
    said, weak = _action(_PX4_OFFBOARD, "COM_OBL_RC_ACT", action)
    said += _after(values, "COM_OF_LOSS_T")
    if action in (1.0, 2.0):
        return f"{said} ({_named('COM_OBL_RC_ACT', action)}), which holds no place", True
    return said, weak or _too_long(values, "COM_OF_LOSS_T", LONGEST_SETPOINT_LOSS_S)


def _px4_battery(values: Values, _limits: Limits) -> tuple[str, bool]:
    action = values["COM_LOW_BAT_ACT"]
    if action == 0.0:
        return _off("COM_LOW_BAT_ACT", action), True
    return _action(_PX4_BATTERY, "COM_LOW_BAT_ACT", action)


def _px4_breach(values: Values, _limits: Limits) -> tuple[str, bool]:
    action = values["GF_ACTION"]
    said, weak = _action(_PX4_FENCE, "GF_ACTION", action)
    if not weak and action not in PX4_BREACH:
        return _off("GF_ACTION", action, said), True
    return said, weak


def _px4_fence(values: Values, limits: Limits) -> tuple[str, bool]:
    return _fence(
        _wider(values, "GF_MAX_HOR_DIST", limits.reach_m, "radius"),
        _wider(values, "GF_MAX_VER_DIST", limits.ceiling_up_m, "height"),
        limits,
    )


# -------------------------------------------------------------------------------- ArduCopter

_COPTER_STATION: Final[Words] = {
    1: "return",
    2: "go on with a mission, else return",
    3: "smart return, or return",
    4: "smart return, or land",
    5: "land",
    6: "land at a landing sequence, or return",
    7: "brake, or land",
}
_COPTER_STICKS: Final[Words] = {
    1: "return",
    2: "go on with a mission, else return",
    3: "land",
    4: "smart return, or return",
    5: "smart return, or land",
    6: "land at a landing sequence, or return",
    7: "brake, or land",
}
_COPTER_BATTERY: Final[Words] = {
    1: "land",
    2: "return",
    3: "smart return, or return",
    4: "smart return, or land",
    5: "terminate",
    6: "land at a landing sequence, or return",
    7: "brake, or land",
}
_COPTER_ESTIMATE: Final[Words] = {1: "land", 2: "altitude hold", 3: "land, from every mode"}
_COPTER_FENCE: Final[Words] = {
    0: "reports only",
    1: "return, or land",
    2: "land",
    3: "smart return, or return, or land",
    4: "brake, or land",
    5: "smart return, or land",
}
_HEIGHT, _CIRCLE, _ZONES = 1, 2, 4
"""Bits of FENCE_TYPE."""


def _copter_station(values: Values, limits: Limits) -> tuple[str, bool]:
    action = values["FS_GCS_ENABLE"]
    if action == 0.0:
        return _off("FS_GCS_ENABLE", action), True
    first = values.get("MAV_GCS_SYSID", float(limits.own_sysid))
    last = max(first, values.get("MAV_GCS_SYSID_HI", 0.0))
    if not first <= limits.own_sysid <= last:
        watched = _named("MAV_GCS_SYSID", first)
        return f"it watches another station than this one, {limits.own_sysid} ({watched})", True
    said, weak = _action(_COPTER_STATION, "FS_GCS_ENABLE", action)
    long = _too_long(values, "FS_GCS_TIMEOUT", LONGEST_STATION_LOSS_S)
    return said + _after(values, "FS_GCS_TIMEOUT"), weak or long


def _copter_sticks(values: Values, _limits: Limits) -> tuple[str, bool]:
    action = values["FS_THR_ENABLE"]
    if action == 0.0:
        return _off("FS_THR_ENABLE", action), True
    return _action(_COPTER_STICKS, "FS_THR_ENABLE", action)


def _copter_offboard(values: Values, _limits: Limits) -> tuple[str, bool]:
    """A position is flown to and held; velocities end (recorded: about 3 s)."""
    long = _too_long(values, "GUID_TIMEOUT", LONGEST_SETPOINT_LOSS_S)
    return f"stop{_after(values, 'GUID_TIMEOUT')} of velocities, positions are held", long


def _copter_battery(values: Values, _limits: Limits) -> tuple[str, bool]:
    action = values["BATT_FS_LOW_ACT"]
    if action == 0.0:
        return _off("BATT_FS_LOW_ACT", action), True
    thresholds = [values[n] for n in ("BATT_LOW_VOLT", "BATT_LOW_MAH") if n in values]
    if thresholds and not any(limit > 0.0 for limit in thresholds):
        return "never noticed (BATT_LOW_VOLT and BATT_LOW_MAH are 0)", True
    return _action(_COPTER_BATTERY, "BATT_FS_LOW_ACT", action)


def _copter_estimate(values: Values, _limits: Limits) -> tuple[str, bool]:
    action = values["FS_EKF_ACTION"]
    if action == 0.0:
        return _off("FS_EKF_ACTION", action), True
    return _action(_COPTER_ESTIMATE, "FS_EKF_ACTION", action)


def _copter_breach(values: Values, _limits: Limits) -> tuple[str, bool]:
    enabled = values["FENCE_ENABLE"]
    if enabled != COPTER_FENCE_ON:
        return _off("FENCE_ENABLE", enabled, "off" if enabled == 0.0 else "unknown value"), True
    action = values.get("FENCE_ACTION", 1.0)
    said, weak = _action(_COPTER_FENCE, "FENCE_ACTION", action)
    if not weak and action not in COPTER_BREACH:
        return _off("FENCE_ACTION", action, said), True
    return said, weak


def _copter_fence(values: Values, limits: Limits) -> tuple[str, bool]:
    kinds = bits_of(values["FENCE_TYPE"])
    on = _named("FENCE_TYPE", values["FENCE_TYPE"])
    radius: tuple[str, bool] = f"no circle ({on})", True
    height: tuple[str, bool] = f"no height ({on})", True
    if kinds & _CIRCLE:
        radius = _wider(values, "FENCE_RADIUS", limits.reach_m, "radius")
    if kinds & _HEIGHT:
        height = _wider(values, "FENCE_ALT_MAX", limits.ceiling_up_m, "height")
    return _fence(radius, height, limits, "" if kinds & _ZONES else on)


CASES: Final[Mapping[str, tuple[Case, ...]]] = {
    "px4": (
        Case(
            "ground-station loss",
            ("NAV_DLL_ACT",),
            _px4_station,
            ("COM_DL_LOSS_T",),
            lambda _: {"NAV_DLL_ACT": 2, "COM_DL_LOSS_T": 10},
        ),
        Case("stick loss", ("NAV_RCL_ACT",), _px4_sticks, (), lambda _: {"NAV_RCL_ACT": 2}),
        Case(
            "offboard loss",
            ("COM_OBL_RC_ACT",),
            _px4_offboard,
            ("COM_OF_LOSS_T",),
            lambda _: {"COM_OBL_RC_ACT": 5, "COM_OF_LOSS_T": 1},
        ),
        Case(
            "low battery",
            ("COM_LOW_BAT_ACT",),
            _px4_battery,
            (),
            lambda _: {"COM_LOW_BAT_ACT": 3},
        ),
        Case(FENCE_ACTION, ("GF_ACTION",), _px4_breach, (), lambda _: {"GF_ACTION": 2}),
        Case(
            FENCE,
            ("GF_MAX_HOR_DIST", "GF_MAX_VER_DIST"),
            _px4_fence,
            (),
            lambda at: {"GF_MAX_HOR_DIST": at.reach_m, "GF_MAX_VER_DIST": at.ceiling_up_m},
        ),
        Case(
            "return",
            ("RTL_RETURN_ALT",),
            lambda v, at: _ceiling(v, at, "RTL_RETURN_ALT"),
            (),
            lambda at: {"RTL_RETURN_ALT": at.ceiling_up_m},
        ),
    ),
    "ardupilot": (
        Case(
            "ground-station loss",
            ("FS_GCS_ENABLE",),
            _copter_station,
            ("FS_GCS_TIMEOUT", "MAV_GCS_SYSID", "MAV_GCS_SYSID_HI"),
            lambda at: {"FS_GCS_ENABLE": 1, "FS_GCS_TIMEOUT": 5, "MAV_GCS_SYSID": at.own_sysid},
        ),
        Case("stick loss", ("FS_THR_ENABLE",), _copter_sticks, (), lambda _: {"FS_THR_ENABLE": 1}),
        Case(
            "offboard loss", (), _copter_offboard, ("GUID_TIMEOUT",), lambda _: {"GUID_TIMEOUT": 3}
        ),
        Case(
            "low battery",
            ("BATT_FS_LOW_ACT",),
            _copter_battery,
            ("BATT_LOW_VOLT", "BATT_LOW_MAH"),
            lambda _: {"BATT_FS_LOW_ACT": 2},
        ),
        Case(
            "position lost",
            ("FS_EKF_ACTION",),
            _copter_estimate,
            (),
            lambda _: {"FS_EKF_ACTION": 1},
        ),
        Case(
            FENCE_ACTION,
            ("FENCE_ENABLE",),
            _copter_breach,
            ("FENCE_ACTION",),
            lambda _: {"FENCE_ENABLE": 1, "FENCE_ACTION": 4},
        ),
        Case(
            FENCE,
            ("FENCE_TYPE", "FENCE_RADIUS", "FENCE_ALT_MAX"),
            _copter_fence,
            (),
            lambda at: {
                "FENCE_TYPE": 7,
                "FENCE_RADIUS": at.reach_m,
                "FENCE_ALT_MAX": at.ceiling_up_m,
            },
        ),
        Case(
            "return",
            ("RTL_ALT_M",),
            lambda v, at: _ceiling(v, at, "RTL_ALT_M"),
            (),
            lambda at: {"RTL_ALT_M": at.ceiling_up_m},
        ),
    ),
}
"""What is looked at, by autopilot, in the order in which it is told."""
