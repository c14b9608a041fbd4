"""Options for how a session is recorded: in how many files, and what becomes of them."""

from __future__ import annotations

import re

import click
import msgspec

from gcs.config import StationConfig

_SIZE = re.compile(r"([0-9]+(?:\.[0-9]+)?)\s*(k|M|G)?B?", re.IGNORECASE)
_UNIT_BYTES = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9}
_AGE = re.compile(r"([0-9]+(?:\.[0-9]+)?)\s*(s|min|m|h)?", re.IGNORECASE)
_UNIT_S = {"": 1.0, "s": 1.0, "min": 60.0, "m": 60.0, "h": 3600.0}
SMALLEST_BYTES = 1_000_000
SHORTEST_S = 10.0


class Size(click.ParamType[int]):
    """Bytes, as in 500MB or 2GB; units of a thousand, as disks are sold."""

    name = "SIZE"

    def convert(self, value: str | int, param: click.Parameter | None, ctx: object) -> int:
        if isinstance(value, int):
            return value
        found = _SIZE.fullmatch(value.strip())
        if found is None:
            self.fail(f"{value!r} is not as in 500MB or 2GB.", param)
        size = round(float(found[1]) * _UNIT_BYTES[(found[2] or "").lower()])
        if size < SMALLEST_BYTES:
            self.fail(f"{value!r} is too small: at least 1MB.", param)
        return size


class Age(click.ParamType[float]):
    """Seconds, as in 90s, 30min or 1h."""

    name = "AGE"

    def convert(self, value: str | float, param: click.Parameter | None, ctx: object) -> float:
        if isinstance(value, float):
            return value
        found = _AGE.fullmatch(value.strip())
        if found is None:
            self.fail(f"{value!r} is not as in 90s, 30min or 1h.", param)
        age_s = float(found[1]) * _UNIT_S[(found[2] or "").lower()]
        if age_s < SHORTEST_S:
            self.fail(f"{value!r} is too short: at least 10s.", param)
        return age_s


ROTATE_SIZE = click.Option(
    ["--rotate-size"],
    type=Size(),
    default=0,
    metavar="SIZE",
    help="Begin a new file of the record at this size, as in 500MB: <name>_part2, _part3.",
)
ROTATE_AGE = click.Option(
    ["--rotate-age"],
    type=Age(),
    default=0.0,
    metavar="AGE",
    help="Begin a new file of the record after so long, as in 30min or 1h.",
)
COMPACT = click.Option(
    ["--compact/--no-compact"],
    default=True,
    help="Rewrite the record in larger chunks when the station has ended.  [default: compact]",
)


def with_files(
    config: StationConfig, rotate_size: int, rotate_age: float, compact: bool
) -> StationConfig:
    """The configuration with these."""
    return msgspec.structs.replace(
        config, rotate_bytes=rotate_size, rotate_s=rotate_age, compact=compact
    )
