"""Writing parameters: which a client may write, and what it is told of those that it may not.

A refused write is answered as the protocol has it: with the value that the parameter still has.
Only the vehicle knows it, so the vehicle is asked for it in the write's place, and its answer goes
to every client.  PARAM_ERROR, which newer clients understand, says at once that it was refused.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Final

from gcs.bridge.setup_policy.free_parameters import free_group_of
from gcs.bridge.setup_policy.safety_parameters import NAME, group_of, pattern_of
from gcs.bridge.setup_policy.verdict import Allowed, GuardSeen, Judgement, Refused
from gcs.gate.effects import Level
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.autopilot import PX4, ParamEncoding
from gcs.protocol.parameters import BY_NAME, decode_value
from gcs.wire.ids import ParamExtResult, ParamFault, ParamType
from gcs.wire.messages import (
    Message,
    ParamError,
    ParamExtAck,
    ParamExtRequestRead,
    ParamExtSet,
    ParamRequestRead,
    ParamSet,
    ParamValue,
)

HASH_CHECK: Final = "_HASH_CHECK"
"""Written to a PX4 to say that its parameters are known already; it is no parameter."""
KEY: Final = "policy: bridge.parameters"
TAKEOFF_HEIGHT: Final = "MIS_TAKEOFF_ALT"
"""PX4's default and least height of a take-off.

MAVSDK has no other way to say how high it wants to take off: it writes this before
(`set_takeoff_altitude`, recorded of 4.1.0 and mavsdk-grpc 4.0.5).  The gate reads it as it changes,
decides on the climb to it, and verifies a mission with it anew before each start, so it may be
written while nothing flies.
"""
UNKNOWN: Final = "it is in no table here, so nobody has looked at what stands on it"
COUNTS: Final = frozenset({"MIS_TOTAL", "FENCE_TOTAL", "RALLY_TOTAL"})
"""ArduPilot writes these itself: how many items it was sent.  What it was sent is read anew."""
MOST_KEPT: Final = 4096
"""Values that are kept at most; an autopilot has 900 to 1,400."""
_TYPES: Final = frozenset(int(kind) for kind in ParamType)
_LONGEST: Final = 16


OVERTAKEN_NS: Final = 3_000_000_000
"""So long after a write a value that is not the written one may have left the vehicle before it, as
an answer to somebody who has read the parameter."""


@dataclass(frozen=True, slots=True)
class _Write:
    """One that was let through, and that the vehicle has not told the outcome of."""

    by: str
    value: float
    until_ns: int


@dataclass(frozen=True, slots=True)
class Changed:
    """What the log says of a parameter whose value has changed."""

    level: Level
    text: str


class ParameterGuard:
    """Judges writes, and follows what becomes of those that it let through."""

    def __init__(self, rules: BridgeRules, autopilot: str, encoding: ParamEncoding) -> None:
        self._rules = rules
        self._autopilot = autopilot
        self._encoding = encoding
        self._allowed = pattern_of(rules.parameters_allowed)
        self._guarded = pattern_of(rules.parameters_guarded)
        self._values: dict[str, float] = {}
        self._writes: dict[str, _Write] = {}

    def judge(self, message: ParamSet, seen: GuardSeen) -> Judgement:
        """PARAM_SET."""
        name = message.param_id
        value = self._decoded(message.param_value, message.param_type)
        finite = math.isfinite(value)
        numbers = (("value", float(value)),) if finite else ()
        why = None if self._is_height_of_takeoff(name, value, seen) else self.why_refused(name)
        if why is None and not finite:
            refusal = Refusal(Code.NON_FINITE, f"{name}: the value is not a finite number")
        elif why is None:
            if len(self._writes) < MOST_KEPT:
                by = f"{seen.client.sysid}/{seen.client.compid}"
                until_ns = seen.now_ns + OVERTAKEN_NS
                self._writes[name.upper()] = _Write(by, float(value), until_ns)
            return Allowed("" if name == HASH_CHECK else self._told(name, value))
        else:
            refusal = Refusal(Code.POLICY, f"{why} ({KEY})", numbers)
        fault = ParamFault.PERMISSION_DENIED if why else ParamFault.VALUE_OUT_OF_RANGE
        return refused_write(message, seen, refusal, fault)

    def _is_height_of_takeoff(self, name: str, value: float, seen: GuardSeen) -> bool:
        """Whether it is a PX4's, on the ground, and one that the policy allows to take off to."""
        return (
            self._autopilot == PX4.name
            and self._rules.parameters == "guard"
            and name == TAKEOFF_HEIGHT
            and not self._guarded.fullmatch(name)
            and seen.stands_disarmed
            and 0.0 < value <= seen.max_takeoff_up_m
        )

    def judge_extended(self, message: ParamExtSet, seen: GuardSeen) -> Judgement:
        """PARAM_EXT_SET: of a camera, a gimbal, a program on board."""
        name = message.param_id
        why = self.why_refused(name, of_autopilot=False)
        if why is None:
            return Allowed(f"{name} = {_printable(message.param_value)} is forwarded")
        told = ParamExtAck(
            param_id=_sendable(name),
            param_value="",
            param_type=message.param_type,
            param_result=ParamExtResult.FAILED,
        )
        ask: tuple[Message, ...] = ()
        if NAME.fullmatch(name):
            ask = (
                ParamExtRequestRead(
                    param_index=BY_NAME,
                    target_system=message.target_system or seen.vehicle.sysid,
                    target_component=message.target_component,
                    param_id=name,
                ),
            )
        return Refused(Refusal(Code.POLICY, f"{why} ({KEY})"), (told,), ask)

    def why_refused(self, name: str, *, of_autopilot: bool = True) -> str | None:
        """A sentence; None where the parameter may be written.

        What no table knows is guarded, but for names of other components (`of_autopilot` is
        False), which nobody has lists of.
        """
        if name == HASH_CHECK:
            return None
        shown = _sendable(name)
        if not NAME.fullmatch(name):
            return f"{shown!r} is no name of a parameter"
        if self._rules.parameters == "forward" or self._allowed.fullmatch(name):
            return None
        if self._rules.parameters == "refuse":
            return f"{shown} is not written: no parameter is"
        if self._guarded.fullmatch(name):
            return f"{shown} is guarded: the policy names it in parameters_guarded"
        group = group_of(self._autopilot, name)
        if group is not None:
            return f"{shown} is guarded: {group.why}"
        if of_autopilot and free_group_of(self._autopilot, name) is None:
            return f"{shown} is guarded: {UNKNOWN}"
        return None

    def awaits(self, name: str) -> bool:
        """It was let through, and the vehicle has not told yet what it is now."""
        return name in self._writes

    def written_by_station(self, message: ParamSet, now_ns: int) -> None:
        """The station sends one itself, for an operator."""
        value = self._decoded(message.param_value, message.param_type)
        write = _Write("the station", value, now_ns + OVERTAKEN_NS)
        self._writes[message.param_id.upper()] = write

    def heard(self, message: ParamValue, now_ns: int) -> Changed | None:
        """PARAM_VALUE of the vehicle: what is to be told of it."""
        name = message.param_id
        if not NAME.fullmatch(name) or name == HASH_CHECK:
            return None
        value = self._decoded(message.param_value, message.param_type)
        known = self._values.get(name)
        if known is None and len(self._values) >= MOST_KEPT:
            return None
        self._values[name] = value
        write = self._writes.get(name.upper())
        if write is not None and (value == write.value or now_ns >= write.until_ns):
            del self._writes[name.upper()]
        if known is None or known == value or math.isnan(value) or name in COUNTS:
            return None
        change = f"{name} was {known:g} and is {value:g} now"
        if write is not None:
            return Changed(Level.INFO, f"{change}: written by {write.by}")
        group = group_of(self._autopilot, name)
        if group is None or not group.set_by_people:
            return None
        return Changed(Level.WARNING, f"{change}, and no client of this bridge wrote it")

    def _told(self, name: str, value: float) -> str:
        known = next((v for k, v in self._values.items() if k.upper() == name.upper()), None)
        before = "not known" if known is None else f"{known:g}"
        return f"{name} = {value:g} is forwarded; it is {before} now"

    def _decoded(self, wire: float, type_: int) -> float:
        if type_ not in _TYPES:
            return wire
        return float(decode_value(wire, ParamType(type_), self._encoding))


def refused_write(
    message: ParamSet, seen: GuardSeen, refusal: Refusal, fault: ParamFault
) -> Refused:
    """With PARAM_ERROR, and a question to the vehicle for the value that it still has."""
    name = message.param_id
    told = ParamError(
        param_index=BY_NAME,
        target_system=seen.client.sysid,
        target_component=seen.client.compid,
        param_id=_sendable(name),
        error=fault,
    )
    ask: tuple[Message, ...] = ()
    if NAME.fullmatch(name):
        ask = (
            ParamRequestRead(
                param_index=BY_NAME,
                target_system=message.target_system or seen.vehicle.sysid,
                target_component=message.target_component or seen.vehicle.compid,
                param_id=name,
            ),
        )
    return Refused(refusal, (told,), ask)


def _sendable(name: str) -> str:
    """What fits into a message and into a sentence of what a client called a parameter."""
    return _printable(name)[:_LONGEST]


def _printable(text: str) -> str:
    """Without what a terminal would obey: the log is shown on one."""
    return re.sub(r"[^ -~]", "?", text)
