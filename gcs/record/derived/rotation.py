"""Quaternions of a pose in the frames that viewers draw; each is (w, x, y, z)."""

from __future__ import annotations

from math import sqrt

from gcs.frames import Vec3
from gcs.report import Quat

NED_IN_MAP: Quat = (0.0, sqrt(0.5), sqrt(0.5), 0.0)
"""Swaps x and y and turns z round: a half turn about the diagonal of north and east."""

FLU_IN_FRD: Quat = (0.0, 1.0, 0.0, 0.0)
"""A half turn about the forward axis."""


def product(a: Quat, b: Quat) -> Quat:
    """First `b`, then `a` (Hamilton's product)."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def conjugate(q: Quat) -> Quat:
    """The turn back."""
    w, x, y, z = q
    return (w, -x, -y, -z)


def turned(q: Quat, v: Vec3) -> Vec3:
    """`v` rotated by `q`."""
    _, x, y, z = product(product(q, (0.0, *v)), conjugate(q))
    return (x, y, z)


def map_from_flu(q_ned_from_frd: Quat) -> Quat:
    """The attitude as a pose in `map` (ENU) of a body with x forward, y left, z up."""
    return product(product(NED_IN_MAP, q_ned_from_frd), FLU_IN_FRD)
