"""Lines of a plain text file, and the numbers in them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from gcs.plan.build import check_lat_lon
from gcs.plan.errors import PlanError

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)


def content_lines(file: str, data: bytes) -> Iterator[tuple[str, str]]:
    """(line number, text) of every line that is neither empty nor a comment."""
    for number, line in enumerate(decoded(file, data).split("\n"), start=1):
        content = line.partition("#")[0].strip()
        if content:
            yield str(number), content


def decoded(file: str, data: bytes) -> str:
    """UTF-8, with or without a byte order mark.  Raises PlanError with the line."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        bad_line = str(data[: error.start].count(b"\n") + 1)
        raise PlanError(file, bad_line, "text", "is not UTF-8") from None


def read_number(file: str, where: str, name: str, text: str) -> float:
    """A finite number.  Raises PlanError."""
    if _NUMBER.fullmatch(text):
        value = float(text)
        if math.isfinite(value):
            return value
    raise PlanError(file, where, name, f'is "{text[:40]}"', "a number", decimal_hint(text))


def decimal_hint(text: str) -> str:
    return "the decimal mark is a point" if "," in text else ""


def read_lat_lon(
    file: str, where: str, item: str, lat_text: str, lon_text: str
) -> tuple[float, float]:
    """Degrees of a place on Earth.  Raises PlanError."""
    lat_deg = read_number(file, where, f"{item}: latitude", lat_text)
    lon_deg = read_number(file, where, f"{item}: longitude", lon_text)
    check_lat_lon(file, where, item, lat_deg, lon_deg)
    return lat_deg, lon_deg
