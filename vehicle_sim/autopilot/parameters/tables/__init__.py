"""Every parameter, in literal tables: a file a subject.

Names, units and meanings are the autopilots' own; defaults and types are those that the real ones
listed in their own simulations (PX4 1.14.3, ArduCopter 4.7.0-dev with copter.parm), but for
`deliberate.py`, which gives a reason for each other one.  ArduCopter's are written by their names
and units of 4.5; `renamed.py` says what 4.7 made of them.  Types of those that 4.7 renamed, as 4.5
has them, and bounds are written from memory.  Parameters that only clients look for are in
`inert_px4.py` and `inert_ardupilot.py`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.tables import (
    failsafes,
    fence,
    flight,
    inert_ardupilot,
    inert_px4,
    loops,
    simulated,
    sticks,
    system,
)
from vehicle_sim.autopilot.parameters.tables.deliberate import DELIBERATE
from vehicle_sim.autopilot.parameters.tables.renamed import COPTER_4_7, Renamed
from vehicle_sim.autopilot.parameters.tables.spec import ParameterSpec, StoredAs

_SUBJECTS = (failsafes, fence, flight, loops, simulated, sticks, system)

RENAMED: dict[Firmware, dict[str, Renamed]] = {"4.7": {each.old: each for each in COPTER_4_7}}
"""By firmware and canonical name."""


def _table(personality: Personality, specs: list[ParameterSpec]) -> tuple[ParameterSpec, ...]:
    own = {name: default for name, (default, _) in DELIBERATE[personality].items()}
    return tuple(
        replace(spec, default=own.get(spec.name, spec.default))
        for spec in sorted(specs, key=lambda spec: spec.name)
    )


TABLES: dict[Personality, tuple[ParameterSpec, ...]] = {
    "px4": _table(
        "px4", [*(spec for subject in _SUBJECTS for spec in subject.PX4), *inert_px4.INERT]
    ),
    "ardupilot": _table(
        "ardupilot",
        [*(spec for subject in _SUBJECTS for spec in subject.ARDUPILOT), *inert_ardupilot.INERT],
    ),
}
"""By canonical names: those of the first firmware of either."""


@cache
def listed(personality: Personality, firmware: Firmware) -> tuple[ParameterSpec, ...]:
    """The parameters as this firmware names and stores them, in the order of their names."""
    renamed = RENAMED.get(firmware, {})
    specs = [
        _as_renamed(spec, renamed[spec.name]) if spec.name in renamed else spec
        for spec in TABLES[personality]
    ]
    return tuple(sorted(specs, key=lambda spec: spec.name))


def _as_renamed(spec: ParameterSpec, renamed: Renamed) -> ParameterSpec:
    low, high = renamed.bounds(spec.low, spec.high)
    return replace(
        spec,
        name=renamed.new,
        stored_as=renamed.stored_as,
        default=renamed.to_new(spec.default),
        low=low,
        high=high,
        what=spec.what.replace("[c", "[") if renamed.factor == 0.01 else spec.what,
    )


__all__ = ["RENAMED", "TABLES", "ParameterSpec", "Renamed", "StoredAs", "listed"]
