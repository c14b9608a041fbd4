"""Outlines for drawing: margins and areas, beside the definition of either."""

from __future__ import annotations

import math
import random

import pytest

from gcs.record.derived.outline import margin_outline, triangles
from gcs.report import FenceShape

L_SHAPE = [(0.0, 0.0), (20.0, 0.0), (20.0, 8.0), (8.0, 8.0), (8.0, 20.0), (0.0, 20.0)]
BOX = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]


def to_boundary(at: tuple[float, float], outline: list[tuple[float, float]]) -> float:
    sides = zip(outline, [*outline[1:], outline[0]], strict=True)
    return min(
        math.dist(at, (a[0] + t / 1000 * (b[0] - a[0]), a[1] + t / 1000 * (b[1] - a[1])))
        for a, b in sides
        for t in range(1001)
    )


@pytest.mark.parametrize("outline", [L_SHAPE, L_SHAPE[::-1], BOX])
@pytest.mark.parametrize("inclusion", [True, False])
def test_every_point_of_the_margin_is_that_far_from_the_boundary(
    outline: list[tuple[float, float]], inclusion: bool
) -> None:
    near = margin_outline(FenceShape("z", inclusion, outline), 2.0)
    assert len(near) >= 4
    for at in near:
        assert to_boundary(at, outline) == pytest.approx(2.0, abs=0.02)
        within = 0 < at[0] < 20 and 0 < at[1] < 20 and not (at[0] > 8 and at[1] > 8)
        if outline is not BOX:
            assert within is inclusion


def test_a_margin_that_leaves_nothing_is_not_drawn() -> None:
    assert margin_outline(FenceShape("z", True, BOX), 7.0) == ()
    assert margin_outline(FenceShape("z", True, [], (0.0, 0.0), 5.0), 5.0) == ()


@pytest.mark.slow
@pytest.mark.parametrize("outline", [BOX, L_SHAPE, L_SHAPE[::-1]])
def test_the_triangles_cover_the_area_once(outline: list[tuple[float, float]]) -> None:
    found = triangles(outline)
    assert len(found) == len(outline) - 2
    rng = random.Random(1)
    for _ in range(500):
        at = (rng.uniform(-1, 21), rng.uniform(-1, 21))
        if to_boundary(at, outline) < 0.05:
            continue
        if outline is BOX:
            inside = 0 < at[0] < 10 and 0 < at[1] < 10
        else:
            inside = 0 < at[0] < 20 and 0 < at[1] < 20 and not (at[0] > 8 and at[1] > 8)
        covers = sum(_covers([outline[i] for i in three], at) for three in found)
        if all(abs(_side(outline[a], outline[b], at)) > 1e-3 for t in found for a, b in _pairs(t)):
            assert covers == int(inside)


def _pairs(three: tuple[int, int, int]) -> list[tuple[int, int]]:
    return [(three[0], three[1]), (three[1], three[2]), (three[2], three[0])]


def _side(a: tuple[float, float], b: tuple[float, float], p: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def _covers(corners: list[tuple[float, float]], at: tuple[float, float]) -> bool:
    a, b, c = corners
    signs = [_side(a, b, at) > 0, _side(b, c, at) > 0, _side(c, a, at) > 0]
    return all(signs) or not any(signs)
