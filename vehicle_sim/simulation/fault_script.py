"""A flight's faults, declared beforehand: a TOML file of faults, each at its simulated time.

    [[fault]]
    at_s = 20.0          # simulated seconds since the start
    for_s = 10.0         # how long; without it, for good
    kind = "gps_lost"
    vehicle = 1          # system id; without it, every vehicle

    [[fault]]
    at_s = 5.0
    kind = "link"
    loss = 0.3           # and delay_s, jitter_s, duplicate, reorder, out, direction

payload, centre_of_mass, weak_battery, thrust, inertia and motor change the vehicle alone: the
autopilot goes on believing its airframe's data sheet.

The kinds and their keys are the literal table `KINDS`; what each does and how it is told is its
class in `plant/faults.py`.  Equal files and seeds give equal flights.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Final, Literal, TypeAlias

from vehicle_sim.plant import faults as model
from vehicle_sim.plant.faults import spelled

Direction: TypeAlias = Literal["in", "out", "both"]


class FaultFileError(ValueError):
    """A fault file that cannot be used: says which entry and key, and what would do."""


@dataclass(frozen=True, slots=True)
class LinkFault:
    """What a link does to datagrams; `link` is its number from 0, None = all of them.

    Rates are 0..1; `out` loses everything.  `direction` is seen from the vehicle.
    """

    link: int | None = None
    direction: Direction = "both"
    loss: float = 0.0
    delay_s: float = 0.0
    jitter_s: float = 0.0
    duplicate: float = 0.0
    reorder: float = 0.0
    out: bool = False

    def described(self) -> str:
        which = "every link" if self.link is None else f"link {self.link}"
        way = {"in": " towards the vehicle", "out": " from the vehicle", "both": ""}[self.direction]
        if self.out:
            return f"{which} loses everything{way}"
        parts = [
            f"{verb} {spelled(100.0 * rate)} %"
            for verb, rate in (
                ("loses", self.loss),
                ("doubles", self.duplicate),
                ("reorders", self.reorder),
            )
            if rate
        ]
        if self.delay_s or self.jitter_s:
            parts.append(f"delays by {spelled(self.delay_s)} s, +-{spelled(self.jitter_s)} s")
        return f"{which} {', '.join(parts) if parts else 'is sound'}{way}"

    def ended(self) -> LinkFault:
        return LinkFault(self.link, self.direction)


AnyFault: TypeAlias = model.Fault | LinkFault


@dataclass(frozen=True, slots=True)
class Timed:
    """One thing to happen: `system` None = every vehicle."""

    at_ns: int
    system: int | None
    fault: AnyFault


class _Entry:
    """One table of the file, whose keys are taken one after another.

    `lines`: the table's own lines, the header first, which is line `first` of the file `where`.
    """

    def __init__(
        self,
        keys: Mapping[str, object],
        where: str,
        name: str = "",
        lines: Sequence[str] = (),
        first: int = 0,
    ) -> None:
        self._keys = dict(keys)
        self._where, self._name = where, name
        self._lines, self._first = lines, first

    def number(self, key: str, default: float, low: float, high: float) -> float:
        value = self._keys.pop(key, default)
        good = isinstance(value, int | float) and not isinstance(value, bool)
        if not good or not isfinite(number := float(value)) or not low <= number <= high:  # type: ignore[arg-type]
            raise self.wrong(key, f"must be a number from {low:g} to {high:g}, is {value!r}")
        return number

    def optional(self, key: str, low: float, high: float) -> float | None:
        return self.number(key, low, low, high) if key in self._keys else None

    def required(self, key: str, low: float, high: float) -> float:
        if key not in self._keys:
            raise self.wrong(key, "is missing")
        return self.number(key, low, low, high)

    def vector(self, key: str, most: float) -> model.Vec3:
        value = self._keys.pop(key, [0.0, 0.0, 0.0])
        numbers = [
            float(part)
            for part in (value if isinstance(value, list) else ())
            if isinstance(part, int | float) and not isinstance(part, bool)
        ]
        if len(numbers) != 3 or not all(abs(part) <= most for part in numbers):
            raise self.wrong(key, f"must be three numbers within {most:g}, is {value!r}")
        return (numbers[0], numbers[1], numbers[2])

    def flag(self, key: str, default: bool) -> bool:
        value = self._keys.pop(key, default)
        if not isinstance(value, bool):
            raise self.wrong(key, f"must be true or false, is {value!r}")
        return value

    def word(self, key: str, words: tuple[str, ...], default: str | None = None) -> str:
        value = self._keys.pop(key, default)
        if value not in words:
            import difflib  # only for a file that is wrong

            near = difflib.get_close_matches(str(value), words, n=1)
            meant = f"; did you mean {near[0]}?" if near else ""
            raise self.wrong(key, f"must be one of {', '.join(words)}; is {value!r}{meant}")
        return str(value)

    def finish(self) -> None:
        if self._keys:
            raise self.wrong(min(self._keys), "is no key of this kind of fault")

    def wrong(self, key: str, what: str) -> FaultFileError:
        where = self._where
        if self._lines:
            stands = (n for n, line in enumerate(self._lines) if re.match(rf"\s*{key}\s*=", line))
            where = f"{where}:{self._first + next(stands, 0)}: {self._name}"
        return FaultFileError(f"{where}: {key}: {what}")


def _link(e: _Entry) -> LinkFault:
    number = e.optional("link", 0, 255)
    direction = e.word("direction", ("in", "out", "both"), "both")
    return LinkFault(
        link=None if number is None else int(number),
        direction=direction,  # type: ignore[arg-type]  # one of the three, as just checked
        loss=e.number("loss", 0.0, 0.0, 1.0),
        delay_s=e.number("delay_s", 0.0, 0.0, 60.0),
        jitter_s=e.number("jitter_s", 0.0, 0.0, 60.0),
        duplicate=e.number("duplicate", 0.0, 0.0, 1.0),
        reorder=e.number("reorder", 0.0, 0.0, 1.0),
        out=e.flag("out", False),
    )


KINDS: Final[dict[str, Callable[[_Entry], AnyFault]]] = {
    "gps_lost": lambda e: model.GpsLost(),
    "gps_glitch": lambda e: model.GpsGlitch(e.vector("offset_ned_m", 10_000.0)),
    "motor": lambda e: model.MotorFault(
        int(e.required("motor", 1, 4)), e.number("health", 0.0, 0.0, 1.0)
    ),
    "battery": lambda e: model.CellsLost(e.number("cells", 1.0, 0.0, 12.0)),
    "payload": lambda e: model.Payload(e.required("mass_kg", -10.0, 50.0)),
    "centre_of_mass": lambda e: model.CentreOfMass(
        e.number("forward_m", 0.0, -0.2, 0.2), e.number("right_m", 0.0, -0.2, 0.2)
    ),
    "weak_battery": lambda e: model.WeakBattery(
        e.number("resistance_scale", 1.0, 0.1, 20.0), e.number("capacity_scale", 1.0, 0.05, 2.0)
    ),
    "thrust": lambda e: model.ThrustScale(e.required("scale", 0.0, 2.0)),
    "inertia": lambda e: model.InertiaScale(e.required("scale", 0.5, 4.0)),
    "wind": lambda e: model.WindChange(
        e.vector("wind_ned_m_s", 60.0), e.number("gust_m_s", 0.0, 0.0, 20.0)
    ),
    "accel_bias": lambda e: model.AccelBias(e.vector("offset_m_s2", 50.0)),
    "gyro_bias": lambda e: model.GyroBias(e.vector("offset_rad_s", 10.0)),
    "baro": lambda e: model.BaroFault(
        e.number("offset_m", 0.0, -1000.0, 1000.0), e.flag("lost", False)
    ),
    "mag": lambda e: model.MagFault(e.vector("offset_gauss", 10.0), e.flag("lost", False)),
    "rc_lost": lambda e: model.RcLost(),
    "clock_jump": lambda e: model.ClockJump(int(e.required("by_s", -3600.0, 86_400.0) * 1e9)),
    "reboot": lambda e: model.Reboot(),
    "link": _link,
}


_HEAD: Final = re.compile(r"\s*\[\[\s*fault\s*\]\]")


def parse(text: str, where: str) -> tuple[Timed, ...]:
    """The file's faults in the order of their times.  Raises FaultFileError."""
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise FaultFileError(f"{where}: {error}") from error
    unknown = set(document) - {"fault"}
    if unknown:
        raise FaultFileError(f"{where}: {min(unknown)}: unknown; a file is a list of [[fault]]")
    entries = document.get("fault", [])
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise FaultFileError(f"{where}: fault: write [[fault]], with two brackets")
    lines = text.splitlines()
    heads = [number for number, line in enumerate(lines) if _HEAD.match(line)]
    happenings: list[Timed] = []
    for number, entry in enumerate(entries, 1):
        first, *following = heads[number - 1 :] or [len(lines)]
        own = lines[first : following[0] if following else None]
        happenings += _timed(_Entry(entry, where, f"fault {number}", own, first + 1))
    return tuple(sorted(happenings, key=lambda timed: timed.at_ns))


def fault_of(kind: str, keys: Mapping[str, object], where: str) -> AnyFault:
    """One fault by its kind and keys, as a file has them.  Raises FaultFileError."""
    entry = _Entry({**keys, "kind": kind}, where)
    fault = KINDS[entry.word("kind", tuple(KINDS))](entry)
    entry.finish()
    return fault


def _timed(entry: _Entry) -> list[Timed]:
    at_ns = round(entry.required("at_s", 0.0, 1e6) * 1e9)
    lasts_s = entry.optional("for_s", 0.0, 1e6)
    system = entry.optional("vehicle", 1, 255)
    fault = KINDS[entry.word("kind", tuple(KINDS))](entry)
    entry.finish()
    whose = None if system is None else int(system)
    happenings = [Timed(at_ns, whose, fault)]
    if lasts_s is not None:
        end = fault.ended()
        if end is None:
            raise entry.wrong("for_s", "a reboot does not last")
        happenings.append(Timed(at_ns + round(lasts_s * 1e9), whose, end))
    return happenings


class Schedule:
    """Hands out what is due, once.  Simulated time."""

    def __init__(self, happenings: tuple[Timed, ...] = ()) -> None:
        self._rest = list(happenings)

    def due_ns(self, never_ns: int) -> int:
        return self._rest[0].at_ns if self._rest else never_ns

    def due(self, now_ns: int) -> list[Timed]:
        due: list[Timed] = []
        while self._rest and self._rest[0].at_ns <= now_ns:
            due.append(self._rest.pop(0))
        return due
