"""Bodies to test with: every shipped airframe, in the air or on the ground."""

from __future__ import annotations

import struct
from dataclasses import fields, replace
from math import sqrt
from typing import TypeAlias

from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.airframe import load, shipped
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant, plant_of
from vehicle_sim.plant.quad import advance, begin

DT_S = 0.004
PLANTS = {name: plant_of(load(name), DT_S) for name in shipped()}
Motors: TypeAlias = tuple[float, float, float, float]
OFF: Motors = (0.0, 0.0, 0.0, 0.0)
_LETTERS = {"float": "d", "int": "Q", "bool": "?"}


def state_bytes(body: Body) -> bytes:
    """The whole state, little-endian, in the order of the fields."""
    layout = "<" + "".join(_LETTERS[str(field.type)] for field in fields(Body))
    return struct.pack(layout, *(getattr(body, field.name) for field in fields(Body)))


def standing(plant: Plant, gust_key: int = 1) -> Body:
    body = Body()
    begin(body, gust_key, plant)
    return body


def airborne(plant: Plant, up_m: float = 1000.0) -> Body:
    body = standing(plant)
    body.pos_d = -up_m
    return body


def airless(plant: Plant) -> Plant:
    return replace(plant, drag_n_per_m2_s2=0.0, rotor_drag_n_s_per_m=0.0, inflow_n_s_per_m=0.0)


def run(body: Body, plant: Plant, seconds: float, motors: Motors = OFF) -> None:
    """From step 1 on; the commands stay the same."""
    for k in range(1, round(seconds / plant.dt_s) + 1):
        advance(body, *motors, plant, k)


def hover_speed(plant: Plant) -> float:
    """Of each motor, as a part of full speed."""
    return sqrt(plant.mass_kg * GRAVITY_M_S2 / 4.0 / plant.thrust_max_n)


def hovering(plant: Plant) -> Body:
    """In the air with the motors at hover speed already."""
    body = airborne(plant)
    body.s1 = body.s2 = body.s3 = body.s4 = hover_speed(plant)
    return body


def hover_motors(body: Body, plant: Plant) -> Motors:
    u = hover_speed(plant) / body.strength
    return (u, u, u, u)


def down_of(body: Body) -> tuple[float, float, float]:
    """Body z in NED."""
    w, x, y, z = body.qw, body.qx, body.qy, body.qz
    return (2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y))


def turned(body: Body, vector: tuple[float, float, float]) -> tuple[float, float, float]:
    """A vector of the body frame in NED: v + 2 w (q x v) + 2 q x (q x v)."""
    x, y, z = vector
    w, i, j, k = body.qw, body.qx, body.qy, body.qz
    cx, cy, cz = j * z - k * y, k * x - i * z, i * y - j * x
    return (
        x + 2.0 * (w * cx + j * cz - k * cy),
        y + 2.0 * (w * cy + k * cx - i * cz),
        z + 2.0 * (w * cz + i * cy - j * cx),
    )


def energy_of(body: Body, plant: Plant) -> float:
    """Kinetic and potential [J], over the level of rest."""
    v2 = body.vel_n**2 + body.vel_e**2 + body.vel_d**2
    return (
        0.5 * plant.mass_kg * v2
        - plant.mass_kg * GRAVITY_M_S2 * body.pos_d
        + turning_energy_of(body, plant)
    )


def turning_energy_of(body: Body, plant: Plant) -> float:
    return 0.5 * (
        plant.inertia_xx_kg_m2 * body.rate_x**2
        + plant.inertia_yy_kg_m2 * body.rate_y**2
        + plant.inertia_zz_kg_m2 * body.rate_z**2
    )
