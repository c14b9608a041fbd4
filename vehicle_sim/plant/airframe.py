"""What a vehicle is made of, read from the TOML beside the code."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, fields
from math import inf
from pathlib import Path
from typing import Final, TypeVar

from vehicle_sim.numerics.gravity import GRAVITY_M_S2


class AirframeError(Exception):
    """An airframe file that cannot be used: says which file, which key and what is wrong."""


@dataclass(frozen=True, slots=True)
class Hull:
    """Mass, principal inertia about body x, y, z, and quadratic drag (half rho c_d A)."""

    mass_kg: float
    inertia_xx_kg_m2: float
    inertia_yy_kg_m2: float
    inertia_zz_kg_m2: float
    drag_n_per_m2_s2: float


@dataclass(frozen=True, slots=True)
class MotorSet:
    """Four equal motors on the corners of a rectangle."""

    arm_forward_m: float
    arm_right_m: float
    thrust_max_n: float
    torque_per_thrust_m: float
    rotor_drag_n_s_per_m: float
    inflow_n_s_per_m: float
    time_constant_s: float
    idle: float


@dataclass(frozen=True, slots=True)
class Gear:
    """Four feet, each a spring and a damper, with Coulomb friction sideways; turned over, the
    propellers above the centre of mass take their place."""

    foot_forward_m: float
    foot_right_m: float
    height_m: float
    top_m: float
    stiffness_n_per_m: float
    damping_n_s_per_m: float
    friction: float


@dataclass(frozen=True, slots=True)
class BatteryPack:
    """Lithium polymer cells in series behind one internal resistance."""

    cells: float
    capacity_mah: float
    resistance_ohm: float
    idle_current_a: float
    motor_current_max_a: float


@dataclass(frozen=True, slots=True)
class Airframe:
    """All of it; every number is positive, and the file's comments say what it stands for."""

    name: str
    body: Hull
    motors: MotorSet
    gear: Gear
    battery: BatteryPack


_Section = TypeVar("_Section", Hull, MotorSet, Gear, BatteryPack)
# importlib.resources would load archives and temporary files at every start.
_SHIPPED: Final = Path(__file__).with_name("airframes")
_KEYS: Final = ("name", "body", "motors", "gear", "battery")


def shipped() -> tuple[str, ...]:
    """The names that `load` knows, sorted."""
    return tuple(sorted(file.stem for file in _SHIPPED.glob("*.toml")))


def load(name: str = "s500") -> Airframe:
    """The shipped airframe `name`.  Raises AirframeError."""
    if name not in shipped():
        raise AirframeError(f"no airframe {name!r} is shipped; there are {', '.join(shipped())}")
    file = _SHIPPED / f"{name}.toml"
    return parse(file.read_text(encoding="utf-8"), file.name)


def parse(text: str, where: str) -> Airframe:
    """An airframe from TOML `text`; `where` names it in errors.  Raises AirframeError."""
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise AirframeError(f"{where}: {error}") from error
    for key in document:
        if key not in _KEYS:
            raise AirframeError(f"{where}: unknown key {key!r}{_perhaps(key, _KEYS)}")
    airframe = Airframe(
        name=str(document.get("name", where)),
        body=_section(document, "body", Hull, where),
        motors=_section(document, "motors", MotorSet, where),
        gear=_section(document, "gear", Gear, where),
        battery=_section(document, "battery", BatteryPack, where),
    )
    _check_sense(airframe, where)
    return airframe


def _section(document: dict[str, object], key: str, kind: type[_Section], where: str) -> _Section:
    table = document.get(key)
    if not isinstance(table, dict):
        raise AirframeError(f"{where}: section [{key}] is missing")
    names = tuple(field.name for field in fields(kind))
    for name in table:
        if name not in names:
            raise AirframeError(f"{where}: [{key}] unknown key {name!r}{_perhaps(name, names)}")
    values: dict[str, float] = {}
    for name in names:
        if name not in table:
            raise AirframeError(f"{where}: [{key}] {name} is missing")
        value = table[name]
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < inf:
            raise AirframeError(f"{where}: [{key}] {name} must be a positive number, is {value!r}")
        values[name] = float(value)
    return kind(**values)


def _perhaps(name: str, names: tuple[str, ...]) -> str:
    from difflib import get_close_matches  # only for who writes an airframe

    near = get_close_matches(name, names, 1)
    return f"; did you mean {near[0]!r}?" if near else ""


def _check_sense(airframe: Airframe, where: str) -> None:
    """What no body of matter can be, and what cannot fly."""
    body, motors = airframe.body, airframe.motors
    moments = sorted((body.inertia_xx_kg_m2, body.inertia_yy_kg_m2, body.inertia_zz_kg_m2))
    if moments[2] > moments[0] + moments[1]:
        raise AirframeError(
            f"{where}: [body] inertia: the largest moment, {moments[2]:g}, is more than the sum "
            f"of the other two, {moments[0] + moments[1]:g}; no body has that"
        )
    weight_n, thrust_n = body.mass_kg * GRAVITY_M_S2, 4.0 * motors.thrust_max_n
    if thrust_n < 1.2 * weight_n:
        raise AirframeError(
            f"{where}: [motors] thrust_max_n: four times {motors.thrust_max_n:g} N cannot fly a "
            f"weight of {weight_n:.3g} N; it takes {0.3 * weight_n:.3g} N each at least"
        )
    if motors.idle >= 0.5:
        raise AirframeError(f"{where}: [motors] idle is a part of full speed, not {motors.idle:g}")
