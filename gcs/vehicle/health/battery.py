"""What a vehicle tells of its batteries: is one low or critical, and how much charge is left?

SYS_STATUS has the share of charge and the voltage of the first battery, BATTERY_STATUS has both of
each, and what the vehicle itself calls its state.  Beside the policy's limits the worst counts, and
of the charge the least.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Final

from gcs.gate.condition import Condition
from gcs.gate.policy.policy import BatteryLimits
from gcs.session.work import GateInput, condition
from gcs.wire.ids import BatteryFunction, ChargeState
from gcs.wire.messages import BatteryStatus, SysStatus

SAG_NS: Final = 5_000_000_000
"""A voltage counts where it is low for so long: motors that spin up pull it down for a moment
(ArduPilot waits 10 s: BATT_LOW_TIMER)."""
BETTER_PCT: Final = 2
BETTER_V: Final = 1.02
"""A battery that is low is so until this much more is told than the limit, in per cent of the
charge and as a factor of the voltage: what is told goes up and down with the load."""
UNKNOWN_MV: Final = 0xFFFF
PROPULSION: Final = frozenset(
    {BatteryFunction.UNKNOWN, BatteryFunction.ALL, BatteryFunction.PROPULSION}
)
FIRST: Final = -1
"""The battery of SYS_STATUS."""

MOST_AGE_NS: Final = 15_000_000_000
"""Both messages come about once a second; over a slow radio every few."""


class Level(IntEnum):
    """How much is left, in descending order."""

    GOOD = 0
    LOW = 1
    CRITICAL = 2


BY_STATE: Final = {
    ChargeState.LOW: Level.LOW,
    ChargeState.CRITICAL: Level.CRITICAL,
    ChargeState.EMERGENCY: Level.CRITICAL,
    ChargeState.FAILED: Level.CRITICAL,
    ChargeState.UNHEALTHY: Level.LOW,
}


@dataclass(slots=True)
class _Battery:
    """The latest of one battery, and why it is no better."""

    level: Level = Level.GOOD
    why: str = ""
    since_ns: dict[Level, int] = field(default_factory=dict)
    """Since when its voltage has been below the limit of that level."""


class Batteries:
    """All batteries of one vehicle."""

    def __init__(self, limits: BatteryLimits) -> None:
        self._limits = limits
        self._seen: dict[int, _Battery] = {}

    def system_status(self, message: SysStatus, now_ns: int) -> Iterator[GateInput]:
        """SYS_STATUS; -1 % and 65535 mV are not known, and 0 mV is not measured."""
        yield from self._judge(
            FIRST, message.battery_remaining, message.voltage_battery, Level.GOOD, "", now_ns
        )

    def battery_status(self, message: BatteryStatus, now_ns: int) -> Iterator[GateInput]:
        """BATTERY_STATUS of a battery that drives motors."""
        if message.battery_function not in PROPULSION:
            return
        cells = [mv for mv in message.voltages if mv != UNKNOWN_MV] + [*message.voltages_ext]
        state = ChargeState.UNDEFINED
        if message.charge_state in _STATES:
            state = ChargeState(message.charge_state)
        told = BY_STATE.get(state, Level.GOOD)
        words = f"the vehicle says that it is {state.name.lower()}" if told else ""
        left_pct = message.battery_remaining
        yield from self._judge(message.id, left_pct, sum(cells), told, words, now_ns)

    def _judge(
        self, number: int, left_pct: int, total_mv: int, told: Level, words: str, now_ns: int
    ) -> Iterator[GateInput]:
        limits, battery = self._limits, self._seen.setdefault(number, _Battery())
        found = [(told, words)]
        if left_pct >= 0:
            text = f"{left_pct} % are left"
            for level, limit_pct in (
                (Level.LOW, limits.low_pct),
                (Level.CRITICAL, limits.critical_pct),
            ):
                stays = battery.level >= level and left_pct < min(limit_pct + BETTER_PCT, 100)
                found += [(level, text)] if left_pct <= limit_pct or stays else []
        volts = None if total_mv in (0, UNKNOWN_MV) else total_mv / 1e3
        for level, limit_v in ((Level.LOW, limits.low_v), (Level.CRITICAL, limits.critical_v)):
            better = BETTER_V if battery.level >= level else 1.0
            if volts is None or limit_v is None or volts > limit_v * better:
                battery.since_ns.pop(level, None)
            elif now_ns - battery.since_ns.setdefault(level, now_ns) >= SAG_NS:
                found.append((level, f"{volts:.1f} V"))
        battery.level, battery.why = max(found, key=lambda each: each[0])
        worst = max(self._seen.values(), key=lambda each: each.level)
        for name, level in (
            (Condition.BATTERY_LOW, Level.LOW),
            (Condition.BATTERY_CRITICAL, Level.CRITICAL),
        ):
            yield condition(name, worst.level >= level, worst.why)


_STATES: Final = frozenset(int(state) for state in ChargeState)


@dataclass(slots=True)
class Charge:
    """How much is left of one vehicle: the least of its batteries that drive motors.

    What was told some time ago counts no more, nor what a vehicle does not know any longer (-1 %).
    """

    _told: dict[int, tuple[int, int]] = field(default_factory=dict)
    """Per cent and when, by the battery."""

    def system_status(self, message: SysStatus, now_ns: int) -> None:
        self._told[FIRST] = message.battery_remaining, now_ns

    def battery_status(self, message: BatteryStatus, now_ns: int) -> None:
        if message.battery_function in PROPULSION:
            self._told[message.id] = message.battery_remaining, now_ns

    @property
    def told(self) -> bool:
        """Whether it has told anything of a battery, since it was heard."""
        return bool(self._told)

    def left_pct(self, now_ns: int) -> float | None:
        """None where nobody knows."""
        return min(
            (
                float(pct)
                for pct, told_ns in self._told.values()
                if pct >= 0 and now_ns - told_ns <= MOST_AGE_NS
            ),
            default=None,
        )
