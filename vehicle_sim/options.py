"""What the words on the command line mean: types for click, and the plan that they make."""

from __future__ import annotations

import re
from fractions import Fraction
from math import cos, radians, sin
from typing import Final

import click

SPEEDUP_MAX: Final = 200
GUST_MAX_M_S: Final = 20.0


_NUMBER: Final = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def _number(text: str) -> float:
    """`float()` takes more than anybody means: 1_0, digits of other scripts, nan.

    Raises ValueError.
    """
    if not _NUMBER.fullmatch(text.strip()):
        raise ValueError(text)
    return float(text)


class SeedType(click.ParamType[int]):
    """A whole number from 0."""

    name = "SEED"

    def convert(
        self, value: str | int, param: click.Parameter | None, ctx: click.Context | None
    ) -> int:
        if not isinstance(value, str):
            return value
        if not re.fullmatch(r"\d{1,18}", value, re.ASCII):
            self.fail(f"{value!r} is not a whole number from 0", param, ctx)
        return int(value)


class HomeType(click.ParamType[tuple[float, float, float]]):
    """LAT,LON,ALT: degrees, degrees, metres above mean sea level."""

    name = "LAT,LON,ALT"

    def convert(
        self,
        value: str | tuple[float, float, float],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> tuple[float, float, float]:
        if not isinstance(value, str):
            return value
        try:
            lat_deg, lon_deg, alt_m = (_number(part) for part in value.split(","))
        except ValueError:
            self.fail(f"{value!r} is not LAT,LON,ALT, as in 47.397742,8.545594,488", param, ctx)
        if not (abs(lat_deg) < 90.0 and abs(lon_deg) <= 180.0 and -500.0 <= alt_m <= 9000.0):
            self.fail(
                f"{value!r} is not on Earth: latitude within 90, longitude within 180 degrees, "
                "height from -500 to 9000 m",
                param,
                ctx,
            )
        return (lat_deg, lon_deg, alt_m)


class AssignmentType(click.ParamType[tuple[str, float]]):
    """NAME=VALUE."""

    name = "NAME=VALUE"

    def convert(
        self,
        value: str | tuple[str, float],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> tuple[str, float]:
        if not isinstance(value, str):
            return value
        name, _, number = value.partition("=")
        try:
            return (name, _number(number))
        except ValueError:
            self.fail(f"{value!r} is not NAME=VALUE, as in MIS_TAKEOFF_ALT=5", param, ctx)


class SpeedType(click.ParamType[Fraction]):
    """How many simulated seconds make a second."""

    name = "FACTOR"

    def convert(
        self, value: str | Fraction, param: click.Parameter | None, ctx: click.Context | None
    ) -> Fraction:
        if not isinstance(value, str):
            return value
        try:
            factor = Fraction(_number(value)).limit_denominator(1000)
        except (ValueError, OverflowError):
            self.fail(f"{value!r} is no number", param, ctx)
        if not 0 < factor <= SPEEDUP_MAX:
            self.fail(f"{value} is not in 0.001 to {SPEEDUP_MAX}", param, ctx)
        return factor


class WindType(click.ParamType[tuple[float, float, float]]):
    """SPEED[,FROM[,GUSTS]]: m/s, degrees that it comes from, standard deviation in m/s."""

    name = "SPEED[,FROM[,GUSTS]]"

    def convert(
        self,
        value: str | tuple[float, float, float],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> tuple[float, float, float]:
        """North and east parts of the air's velocity, and the gusts [m/s]."""
        if not isinstance(value, str):
            return value
        try:
            speed, from_deg, gust = (*(_number(part) for part in value.split(",")), 0.0, 0.0)[:3]
        except ValueError:
            self.fail(f"{value!r} is not {self.name}, as in 8,270,1.5", param, ctx)
        good = 0.0 <= speed <= 60.0 and abs(from_deg) <= 360.0 and 0.0 <= gust <= GUST_MAX_M_S
        if not good or value.count(",") > 2:
            self.fail(
                f"{value!r}: up to 60 m/s, from a direction within 360 degrees, "
                f"gusts up to {GUST_MAX_M_S:g} m/s",
                param,
                ctx,
            )
        from_rad = radians(from_deg)
        return (-speed * cos(from_rad), -speed * sin(from_rad), gust)
