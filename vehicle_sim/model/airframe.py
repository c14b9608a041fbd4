"""What a vehicle is made of, read from the TOML beside the code."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, fields
from importlib import resources
from typing import TypeVar


class AirframeError(Exception):
    """An airframe file that cannot be used: says which file, which key and what is wrong."""


@dataclass(frozen=True, slots=True)
class Body:
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
    time_constant_s: float
    idle: float


@dataclass(frozen=True, slots=True)
class Gear:
    """Four feet, each a spring and a damper, with Coulomb friction sideways."""

    foot_forward_m: float
    foot_right_m: float
    height_m: float
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
    name: str
    body: Body
    motors: MotorSet
    gear: Gear
    battery: BatteryPack


_Section = TypeVar("_Section", Body, MotorSet, Gear, BatteryPack)


def load(name: str = "s500") -> Airframe:
    """The shipped airframe `name`.  Raises AirframeError."""
    file = resources.files(__package__).joinpath("airframes", f"{name}.toml")
    if not file.is_file():
        raise AirframeError(f"no airframe {name!r} is shipped")
    return parse(file.read_text(encoding="utf-8"), f"{name}.toml")


def parse(text: str, where: str) -> Airframe:
    """An airframe from TOML `text`; `where` names it in errors.  Raises AirframeError."""
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise AirframeError(f"{where}: {error}") from error
    unknown = set(document) - {"name", "body", "motors", "gear", "battery"}
    if unknown:
        raise AirframeError(f"{where}: unknown key {min(unknown)!r}")
    return Airframe(
        name=str(document.get("name", where)),
        body=_section(document, "body", Body, where),
        motors=_section(document, "motors", MotorSet, where),
        gear=_section(document, "gear", Gear, where),
        battery=_section(document, "battery", BatteryPack, where),
    )


def _section(document: dict[str, object], key: str, kind: type[_Section], where: str) -> _Section:
    table = document.get(key)
    if not isinstance(table, dict):
        raise AirframeError(f"{where}: section [{key}] is missing")
    names = [field.name for field in fields(kind)]
    for name in table:
        if name not in names:
            raise AirframeError(f"{where}: [{key}] unknown key {name!r}")
    values: dict[str, float] = {}
    for name in names:
        value = table.get(name)
        if isinstance(value, bool) or not isinstance(value, int | float) or not value > 0:
            raise AirframeError(f"{where}: [{key}] {name} must be a positive number, is {value!r}")
        values[name] = float(value)
    return kind(**values)
