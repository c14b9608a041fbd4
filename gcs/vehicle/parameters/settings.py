"""What the vehicle's own parameters say: failsafes, return height, when it has arrived, speed.

They are read when a vehicle appears, the return height first, because a return and a mission that
ends in one wait for it.  What no answer comes to is asked for again until it is known or the
vehicle says that it does not have it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.enforced_sysid import NAMES_OF_ENFORCED
from gcs.protocol.parameter_names import names_of
from gcs.protocol.parameters import decode_value
from gcs.protocol.settings import USUAL_WAITS, Quantity, SettingsReader, Waits
from gcs.session.speedup_waits import Times
from gcs.vehicle.missions.uploaded_fence import UploadedFence
from gcs.vehicle.parameters.failsafes import (
    CASES,
    FENCE,
    FENCE_ACTION,
    Finding,
    Limits,
    findings,
    parameters_of,
)
from gcs.vehicle.parameters.thrust_meaning import NAMES_OF_THRUST
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import ParamType
from gcs.wire.messages import ParamValue

PARAM_TYPES = frozenset(int(kind) for kind in ParamType)

ASKED_FOR_NS = 1_500_000_000
"""How long what is not answered is asked for at a time, three tries."""
READ_AGAIN_NS = 1_000_000_000
"""Wait before what no answer came to is asked for again."""
LONGEST_READ_AGAIN_NS = 8_000_000_000
"""The wait doubles up to this."""


RETURN_HEIGHT: Final = {"px4": "RTL_RETURN_ALT", "ardupilot": "RTL_ALT_M"}
"""Metres above home, by its newest name."""
RETURN_TYPE: Final = {"px4": "RTL_TYPE"}
"""Where a return leads; ArduCopter's is always straight to home or a rally point."""
ACCEPTANCE_RADIUS: Final = {"px4": "NAV_ACC_RAD", "ardupilot": "WP_RADIUS_M"}
"""How near a waypoint counts as reached, metres, by its newest name."""
CLIMB_END: Final = {"px4": "NAV_MC_ALT_RAD"}
"""How far below the height asked for a take-off may end, metres; ArduCopter has no such range."""
TAKEOFF_HEIGHT: Final = {"px4": "MIS_TAKEOFF_ALT"}
"""How high it takes off without a height, and at least, metres above where it stands; ArduCopter
has no such height."""
READ_FIRST: Final = (RETURN_HEIGHT, RETURN_TYPE, CLIMB_END, ACCEPTANCE_RADIUS, TAKEOFF_HEIGHT)
"""What a flight waits for comes before the failsafes."""
SPEED: Final = {"px4": "MPC_XY_CRUISE", "ardupilot": "WP_SPD"}
"""How fast it flies its legs where nothing else is asked for, m/s, by its newest name."""
READ_LAST: Final = (SPEED,)
"""What only clients' requests for another speed are judged by."""


@dataclass(frozen=True, slots=True)
class ParameterKnown:
    """A parameter was read, under the name that the vehicle has for it."""

    name: str
    value: float


@dataclass(frozen=True, slots=True)
class ReturnHeightKnown:
    """The return height above home in metres; None: the vehicle says that it has none."""

    up_m: float | None


@dataclass(frozen=True, slots=True)
class ReturnTypeKnown:
    """PX4's RTL_TYPE; None: the vehicle says that it has none."""

    kind: int | None


@dataclass(frozen=True, slots=True)
class AcceptanceKnown:
    """How near a waypoint the vehicle itself takes it as reached, metres."""

    radius_m: float


@dataclass(frozen=True, slots=True)
class ClimbEndKnown:
    """How far below the height asked for the vehicle itself may end a take-off, metres."""

    within_m: float


@dataclass(frozen=True, slots=True)
class FailsafesKnown:
    """Every failsafe was asked for: what the vehicle does in each case, in words, and which of
    these are off, weaker than the policy, or not known."""

    weak: tuple[str, ...]
    all: tuple[str, ...] = ()
    mends: tuple[str, ...] = ()
    """The commands with which what is weak would not be."""


Found: TypeAlias = (
    Send
    | ParameterKnown
    | ReturnHeightKnown
    | ReturnTypeKnown
    | AcceptanceKnown
    | ClimbEndKnown
    | FailsafesKnown
)


class Settings:
    """Reads them once for each time that a vehicle appears, and follows what changes later."""

    def __init__(
        self,
        own: Address,
        times: Times,
        limits: Limits,
        *,
        reads_thrust: bool = False,
        reads_enforced: bool = False,
    ) -> None:
        """`reads_thrust`: what a thrust means to the vehicle, too (`thrust_meaning.py`);
        `reads_enforced`: whether it hears one system id alone (`enforced_sysid.py`)."""
        self._own = own
        self._reads_thrust = reads_thrust
        self._reads_enforced = reads_enforced
        self._limits = limits
        self._times = times
        self._reader: SettingsReader | None = None
        self._scales: dict[str, tuple[str, float]] = {}
        """By every name that is asked for: the newest name, and what makes its unit."""
        self._values: dict[str, float] = {}
        self._names: dict[str, str] = {}
        """By the newest name of what was read: the one that this vehicle has it under."""
        self._silent: list[str] = []
        self._told: FailsafesKnown | None = None
        self._read_again_ns: int | None = None
        self._pause_ns = 0

    @property
    def deadline_ns(self) -> int | None:
        return self._reader.deadline_ns if self._reader else self._read_again_ns

    def start(self, telemetry: Telemetry, now_ns: int) -> list[Found]:
        """Begin to read all of them."""
        who = _whose(telemetry)
        wanted = [table[who] for table in READ_FIRST if who in table]
        wanted += [name for name in parameters_of(who) if name not in wanted]
        wanted += [table[who] for table in READ_LAST if who in table]
        wanted += NAMES_OF_THRUST.get(who, ()) if self._reads_thrust else ()
        enforced = NAMES_OF_ENFORCED.get(who, ()) if self._reads_enforced else ()
        wanted += [name for name in enforced if name not in wanted]
        names = [(newest, name) for newest in wanted for name in names_of(newest)]
        self._scales = {name.name: (newest, name.scale) for newest, name in names}
        self._values, self._told = {}, None
        self._pause_ns = self._times.real_ns(READ_AGAIN_NS)
        none: list[Found] = [] if who in RETURN_HEIGHT else [ReturnHeightKnown(None)]
        return none + self._read(wanted, telemetry, now_ns)

    def heard(self, heard: Heard, telemetry: Telemetry, now_ns: int) -> list[Found]:
        found: list[Found] = []
        if isinstance(heard.message, ParamValue) and heard.compid == telemetry.compid:
            found += self._told_value(heard.message, telemetry)
        if self._reader is not None:
            sends = self._reader.handle(heard, now_ns)
            found += self._asked(self._reader, sends, telemetry, now_ns)
        return found

    def wake(self, telemetry: Telemetry, now_ns: int) -> list[Found]:
        if self._reader is not None:
            sends = self._reader.handle(Wake(), now_ns)
            return self._asked(self._reader, sends, telemetry, now_ns)
        if self._read_again_ns is not None and now_ns >= self._read_again_ns:
            return self._read(self._silent, telemetry, now_ns)
        return []

    def _told_value(self, news: ParamValue, telemetry: Telemetry) -> list[Found]:
        """A parameter came, as an answer or unasked, as after another station set it."""
        if news.param_id not in self._scales or news.param_type not in PARAM_TYPES:
            return []
        kind = ParamType(news.param_type)
        encoding = telemetry.autopilot.param_encoding
        value = float(decode_value(news.param_value, kind, encoding))
        newest, scale = self._scales[news.param_id]
        if self._values.get(newest) == value * scale:
            return []
        found = self._known(news.param_id, value, _whose(telemetry))
        return found if self._reader is not None else [*found, *self._summary(telemetry)]

    def _read(self, wanted: list[str], telemetry: Telemetry, now_ns: int) -> list[Found]:
        self._silent = []
        self._read_again_ns = None
        real_ns = self._times.real_ns
        asked_for_ns = real_ns(ASKED_FOR_NS)
        self._reader = SettingsReader(
            self._own,
            Address(telemetry.sysid, telemetry.compid),
            telemetry.autopilot.param_encoding,
            tuple(Quantity(newest, newest) for newest in wanted),
            Waits(real_ns(USUAL_WAITS.again_ns), asked_for_ns, asked_for_ns),
        )
        return self._asked(self._reader, self._reader.start(now_ns), telemetry, now_ns)

    def _asked(
        self, reader: SettingsReader, sends: list[Send], telemetry: Telemetry, now_ns: int
    ) -> list[Found]:
        """What it says, and what follows once it has said its last."""
        out: list[Found] = [*sends]
        if not reader.done:
            return out
        self._reader = None
        if any(each.name == RETURN_HEIGHT.get(_whose(telemetry)) for each in reader.absent):
            out.append(ReturnHeightKnown(None))
        if any(each.name == RETURN_TYPE.get(_whose(telemetry)) for each in reader.absent):
            out.append(ReturnTypeKnown(None))
        self._silent = [each.name for each in reader.silent]
        if self._silent:
            self._read_again_ns = now_ns + self._pause_ns
            longest_ns = self._times.real_ns(LONGEST_READ_AGAIN_NS)
            self._pause_ns = min(2 * self._pause_ns, longest_ns)
        return [*out, *self._summary(telemetry)]

    def _known(self, name: str, read: float, who: str) -> list[Found]:
        newest, scale = self._scales[name]
        value = self._values[newest] = read * scale
        self._names[newest] = name
        if newest in self._silent:
            self._silent.remove(newest)
        found: list[Found] = [ParameterKnown(name, read)]
        if newest == RETURN_HEIGHT.get(who):
            found.append(ReturnHeightKnown(value))
        elif newest == RETURN_TYPE.get(who):
            found.append(ReturnTypeKnown(int(value) if math.isfinite(value) else -1))
        elif newest == ACCEPTANCE_RADIUS.get(who):
            found.append(AcceptanceKnown(value))
        elif newest == CLIMB_END.get(who):
            found.append(ClimbEndKnown(value))
        return found

    def _summary(self, telemetry: Telemetry) -> list[Found]:
        """What is weak, where that is news."""
        told, self._told = self._told, self._failsafes(_whose(telemetry))
        return [] if self._told == told else [self._told]

    def uploaded(self, fence: UploadedFence, telemetry: Telemetry) -> list[Found]:
        """The fence that was uploaded to the vehicle is so now."""
        if fence == self._limits.uploaded:
            return []
        self._limits = replace(self._limits, uploaded=fence)
        # Before its settings were told once, they are still being read.
        return [] if self._told is None else self._summary(telemetry)

    @property
    def asked(self) -> bool:
        """Every failsafe was asked for, since the vehicle appeared."""
        return self._told is not None

    def failsafes(self, telemetry: Telemetry) -> tuple[tuple[Finding, tuple[str, ...]], ...]:
        """What it does in each case, and the commands that mend what is weak; empty before all of
        its settings were asked for, and for an autopilot whose settings are not known here."""
        if self._told is None:
            return ()
        found = findings(_whose(telemetry), self._values, self._limits)
        return tuple((each, tuple(self._command(*one) for one in each.mends)) for each in found)

    def without_fence(self, telemetry: Telemetry) -> str:
        """Why no fence of the vehicle's own would stop it; empty where one would."""
        found = findings(_whose(telemetry), self._values, self._limits)
        for each in found:
            if each.weak and each.about in (FENCE_ACTION, FENCE):
                return each.words
        return "" if found else "its fence is not known here"

    def _failsafes(self, who: str) -> FailsafesKnown:
        if who not in CASES:
            return FailsafesKnown(("not known: which parameters they have is not known here",))
        found = findings(who, self._values, self._limits)
        weak = tuple(each.words for each in found if each.weak)
        mends = tuple(self._command(*each) for one in found for each in one.mends)
        return FailsafesKnown(weak, tuple(each.words for each in found), mends)

    def _command(self, newest: str, value: float) -> str:
        """That sets it, under this vehicle's own name and in its unit."""
        name = self._names.get(newest, newest)
        _, scale = self._scales.get(name, (name, 1.0))
        return f"gcs param set {name} {value / scale:g}"


def _whose(telemetry: Telemetry) -> str:
    """The autopilot whose settings are known here; of other vehicles none is."""
    return telemetry.autopilot.name if telemetry.autopilot.commanded else ""
