"""What the station asks of a vehicle that it has just met: streams, origin, home, failsafes.

An ArduPilot sends next to nothing until asked, a PX4 sends most of it unasked; asking both is
harmless, and a refused request is no error: what is needed and does not come shows up as STALE
or NO_ORIGIN, with its reason.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from gcs.config import StationConfig
from gcs.protocol.autopilot import Autopilot
from gcs.protocol.effects import (
    Address,
    Heard,
    ParamAbsent,
    ParamEffect,
    ParamRead,
    ParamsDone,
    Send,
    Wake,
)
from gcs.protocol.parameters import ParamReader, decode_value
from gcs.session.telemetry import Telemetry
from gcs.wire.ids import Cmd, MsgId, ParamType
from gcs.wire.messages import CommandLong, ParamValue

WANTED_HZ: tuple[tuple[MsgId, float], ...] = (
    (MsgId.EXTENDED_SYS_STATE, 5.0),
    (MsgId.LOCAL_POSITION_NED, 30.0),
    (MsgId.ATTITUDE, 20.0),
    (MsgId.GLOBAL_POSITION_INT, 5.0),
    (MsgId.SYS_STATUS, 2.0),
    (MsgId.MISSION_CURRENT, 2.0),
    (MsgId.GPS_RAW_INT, 1.0),
    (MsgId.BATTERY_STATUS, 1.0),
    (MsgId.POSITION_TARGET_LOCAL_NED, 5.0),
)

FASTEST_HZ = 200.0
"""Of real seconds; a sped-up vehicle is asked for its positions that much more often."""

PARAM_TYPES = frozenset(int(kind) for kind in ParamType)

ASK_AGAIN_NS = 2_000_000_000
"""Wait between two requests for what did not come."""
READ_AGAIN_NS = 5_000_000_000
"""The same for parameters that no answer came to; each has several tries a time."""


@dataclass(frozen=True, slots=True)
class Failsafe:
    """A parameter of the vehicle that says what it does without us; below `weak_below`: nothing."""

    name: str
    about: str
    weak_below: float


FAILSAFES: dict[str, tuple[Failsafe, ...]] = {
    # PX4 parameter reference: 0 = disabled for the first three.
    "px4": (
        Failsafe("NAV_DLL_ACT", "ground-station loss", 1.0),
        Failsafe("GF_ACTION", "geofence breach", 1.0),
        Failsafe("COM_LOW_BAT_ACT", "low battery", 1.0),
        Failsafe("COM_OF_LOSS_T", "offboard loss, seconds", 0.0),
        Failsafe("COM_OBL_RC_ACT", "offboard loss, action", 0.0),
    ),
    # ArduCopter parameter list: 0 = disabled for each of these.
    "ardupilot": (
        Failsafe("FS_GCS_ENABLE", "ground-station loss", 1.0),
        Failsafe("FENCE_ENABLE", "geofence breach", 1.0),
        Failsafe("BATT_FS_LOW_ACT", "low battery", 1.0),
    ),
}

RETURN_HEIGHT: dict[str, tuple[str, float]] = {
    "px4": ("RTL_RETURN_ALT", 1.0),
    "ardupilot": ("RTL_ALT", 0.01),  # centimetres
}
"""The parameter with the return height above home, and its scale to metres."""


@dataclass(frozen=True, slots=True)
class ParameterKnown:
    """A parameter was read."""

    name: str
    value: float


@dataclass(frozen=True, slots=True)
class SettingsKnown:
    """All of them were: what is weak, in words; the return height above home, if it is known; how
    near its height the vehicle ends a take-off."""

    weak: tuple[str, ...]
    return_up_m: float | None
    climb_ends_within_m: float


Found: TypeAlias = Send | ParameterKnown | SettingsKnown


class Discovery:
    """Once for each time that a vehicle appears; then only what is missing is asked for again."""

    def __init__(self, config: StationConfig) -> None:
        self._own = Address(config.sysid, config.compid)
        self._speedup = config.speedup
        self._reader: ParamReader | None = None
        self._values: dict[str, float] = {}
        self._unanswered: list[str] = []
        self._told: SettingsKnown | None = None
        self._asked_ns = 0
        self._read_again_ns: int | None = None

    @property
    def deadline_ns(self) -> int | None:
        return self._reader.deadline_ns if self._reader else self._read_again_ns

    def start(self, telemetry: Telemetry, now_ns: int) -> list[Found]:
        """Begin to read the failsafes; `missing` tells which commands to send."""
        self._asked_ns = 0
        self._values, self._told = {}, None
        names = [failsafe.name for failsafe in FAILSAFES.get(telemetry.autopilot.name, ())]
        if telemetry.autopilot.name in RETURN_HEIGHT:
            names.append(RETURN_HEIGHT[telemetry.autopilot.name][0])
        if telemetry.autopilot.climb_end is not None:
            names.append(telemetry.autopilot.climb_end[0])
        return self._read(names, telemetry, now_ns)

    def heard(self, heard: Heard, telemetry: Telemetry, now_ns: int) -> list[Found]:
        if self._reader is not None:
            return self._found(self._reader.handle(heard, now_ns), telemetry, now_ns)
        if isinstance(heard.message, ParamValue):
            return self._changed(heard.message, telemetry, now_ns)
        return []

    def _changed(self, news: ParamValue, telemetry: Telemetry, now_ns: int) -> list[Found]:
        """A parameter came unasked, as after another station set it: keep ours up to date."""
        if news.param_id not in self._values or news.param_type not in PARAM_TYPES:
            return []
        kind = ParamType(news.param_type)
        value = float(decode_value(news.param_value, kind, telemetry.autopilot.param_encoding))
        if value == self._values[news.param_id]:
            return []
        effects: list[ParamEffect] = [ParamRead(news.param_id, value, kind), ParamsDone()]
        return self._found(effects, telemetry, now_ns)

    def wake(self, telemetry: Telemetry, now_ns: int) -> list[Found]:
        if self._reader is not None:
            return self._found(self._reader.handle(Wake(), now_ns), telemetry, now_ns)
        if self._read_again_ns is not None and now_ns >= self._read_again_ns:
            return self._read(self._unanswered, telemetry, now_ns)
        return []

    def _read(self, names: list[str], telemetry: Telemetry, now_ns: int) -> list[Found]:
        self._unanswered = []
        self._read_again_ns = None
        self._reader = ParamReader(
            self._own,
            Address(telemetry.sysid, telemetry.compid),
            telemetry.autopilot.param_encoding,
            tuple(names),
        )
        return self._found(self._reader.start(now_ns), telemetry, now_ns)

    def missing(self, telemetry: Telemetry, now_ns: int) -> Iterator[CommandLong]:
        """Commands that ask for what is not there: all at first, then what did not come."""
        first = self._asked_ns == 0
        if not first and now_ns - self._asked_ns < ASK_AGAIN_NS:
            return
        self._asked_ns = now_ns
        if telemetry.origin is None:
            yield _request(telemetry, MsgId.GPS_GLOBAL_ORIGIN)
        if telemetry.home is None:
            yield _request(telemetry, MsgId.HOME_POSITION)
        if first:
            yield _request(telemetry, MsgId.AUTOPILOT_VERSION)
        for msgid, rate_hz in WANTED_HZ:
            silent = now_ns - telemetry.landed_ns > ASK_AGAIN_NS
            unknown = silent and msgid is MsgId.EXTENDED_SYS_STATE
            if first or telemetry.pos_ned is None or unknown:
                yield _interval(telemetry, msgid, min(rate_hz * self._speedup, FASTEST_HZ))

    def _found(self, effects: list[ParamEffect], telemetry: Telemetry, now_ns: int) -> list[Found]:
        out: list[Found] = []
        for effect in effects:
            match effect:
                case Send():
                    out.append(effect)
                case ParamRead(name, value, _):
                    self._values[name] = float(value)
                    out.append(ParameterKnown(name, float(value)))
                case ParamAbsent(name, None):
                    self._unanswered.append(name)
                case ParamAbsent():
                    pass
                case ParamsDone():
                    self._reader = None
                    if self._unanswered:
                        self._read_again_ns = now_ns + READ_AGAIN_NS
                    told, self._told = self._told, self._summary(telemetry.autopilot)
                    if self._told != told:
                        out.append(self._told)
        return out

    def _summary(self, autopilot: Autopilot) -> SettingsKnown:
        weak = []
        for failsafe in FAILSAFES.get(autopilot.name, ()):
            value = self._values.get(failsafe.name)
            if value is None:
                weak.append(f"{failsafe.about}: {failsafe.name} could not be read")
            elif value < failsafe.weak_below:
                weak.append(f"{failsafe.about}: off ({failsafe.name} = {value:g})")
        name, scale = RETURN_HEIGHT.get(autopilot.name, ("", 1.0))
        height = self._values.get(name)
        name, default_m = autopilot.climb_end or ("", 0.0)
        within_m = self._values.get(name, default_m)
        return SettingsKnown(tuple(weak), None if height is None else height * scale, within_m)


def _request(telemetry: Telemetry, msgid: MsgId) -> CommandLong:
    return _command(telemetry, Cmd.REQUEST_MESSAGE, float(msgid), 0.0)


def _interval(telemetry: Telemetry, msgid: MsgId, rate_hz: float) -> CommandLong:
    return _command(telemetry, Cmd.SET_MESSAGE_INTERVAL, float(msgid), round(1e6 / rate_hz))


def _command(telemetry: Telemetry, command: Cmd, param1: float, param2: float) -> CommandLong:
    return CommandLong(
        param1=param1,
        param2=param2,
        param3=0.0,
        param4=0.0,
        param5=0.0,
        param6=0.0,
        param7=0.0,
        command=command,
        target_system=telemetry.sysid,
        target_component=telemetry.compid,
        confirmation=0,
    )
