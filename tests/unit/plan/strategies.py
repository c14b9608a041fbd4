"""Plans as hypothesis draws them."""

from __future__ import annotations

import math
from dataclasses import replace

from hypothesis import strategies as st

from gcs.plan.model import (
    BreachReturn,
    Circle,
    Fence,
    Frame,
    Geodetic,
    Geographic,
    Item,
    LatLon,
    Plain,
    Plan,
    Polygon,
    RallyPoint,
    Zone,
)

latitudes = st.integers(-890_000_000, 890_000_000).map(lambda n: n / 1e7)
longitudes = st.integers(-1_790_000_000, 1_790_000_000).map(lambda n: n / 1e7)
heights = st.integers(-10_000, 100_000).map(lambda n: n / 64)
numbers = st.integers(-1000, 1000).map(lambda n: n / 8)
numbers_or_unset = st.one_of(numbers, st.just(math.nan))
corners = st.builds(LatLon, latitudes, longitudes)

moving = st.builds(
    Item,
    command=st.sampled_from([16, 17, 18, 19, 21, 22, 82]),
    frame=st.sampled_from([Frame.AMSL, Frame.HOME, Frame.TERRAIN]),
    params=st.tuples(numbers, numbers, numbers, numbers_or_unset),
    place=st.builds(Geographic, latitudes, longitudes, heights),
    do_jump_id=st.just(0),
    autocontinue=st.booleans(),
)
acting = st.builds(
    Item,
    command=st.sampled_from([20, 93, 115, 178, 197, 206, 2000]),
    frame=st.just(Frame.MISSION),
    params=st.tuples(numbers, numbers, numbers, numbers),
    place=st.builds(Plain, st.integers(-9, 9).map(float), st.integers(-9, 9).map(float), numbers),
    do_jump_id=st.just(0),
)
jumping = st.builds(
    Item,
    command=st.just(177),
    frame=st.just(Frame.MISSION),
    params=st.tuples(st.integers(0, 100).map(float), numbers, st.just(0.0), st.just(0.0)),
    place=st.just(Plain(0.0, 0.0, 0.0)),
    do_jump_id=st.just(0),
)
zones = st.builds(
    Zone,
    shape=st.one_of(
        st.builds(Circle, corners, st.integers(1, 5000).map(lambda n: n / 8)),
        # A ring that is closed by its first corner said twice is read as the ring without it.
        st.lists(corners, min_size=3, max_size=6)
        .filter(lambda c: c[0] != c[-1])
        .map(lambda c: Polygon(tuple(c))),
    ),
    inclusion=st.booleans(),
)
rally = st.builds(RallyPoint, latitudes, longitudes, heights)


def _numbered(items: list[Item]) -> tuple[Item, ...]:
    """Ids from 1, and jumps to items that are there."""
    out = []
    for number, item in enumerate(items, start=1):
        params = item.params
        if item.command == 177:
            params = (params[0] % len(items) + 1.0, *params[1:])
        out.append(replace(item, do_jump_id=number, params=params))
    return tuple(out)


def _polygons_first(zones: list[Zone]) -> tuple[Zone, ...]:
    """A .plan lists polygons before circles; the order means nothing."""
    return tuple(sorted(zones, key=lambda zone: isinstance(zone.shape, Circle)))


missions = st.lists(st.one_of(moving, moving, acting, jumping), min_size=1, max_size=8).map(
    _numbered
)


def plans(firmware: str) -> st.SearchStrategy[Plan]:
    """Whole plans, named "a", for one firmware."""
    return st.builds(
        Plan,
        name=st.just("a"),
        firmware=st.just(firmware),
        home=st.builds(Geodetic, latitudes.filter(bool), longitudes, heights),
        items=missions,
        fence=st.builds(
            Fence,
            st.lists(zones, max_size=3).map(_polygons_first),
            st.one_of(st.none(), st.builds(BreachReturn, latitudes, longitudes, heights)),
        ),
        rally=st.lists(rally, max_size=2).map(tuple),
    )
