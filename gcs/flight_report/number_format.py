"""Numbers and times as the report writes them."""

from __future__ import annotations

from datetime import UTC, datetime


def clock(t_s: float) -> str:
    """Seconds since the start as m:ss.s, or h:mm:ss from an hour on."""
    tenths = round(max(0.0, t_s) * 10)
    minutes, tenths = divmod(tenths, 600)
    if minutes >= 60:
        hours, minutes = divmod(minutes, 60)
        return f"{hours}:{minutes:02d}:{tenths // 10:02d}"
    return f"{minutes}:{tenths // 10:02d}.{tenths % 10}"


def duration(seconds: float) -> str:
    """ "42 s", "3 min 5 s", "1 h 12 min"."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    minutes, rest = divmod(whole, 60)
    if minutes < 60:
        return f"{minutes} min {rest} s" if rest else f"{minutes} min"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if minutes else f"{hours} h"


_CLOCK_SET_NS = 946_684_800_000_000_000
"""The year 2000: a vehicle without a GPS time counts from 1970."""


def metres(value: float) -> str:
    """With a decimal below 100 m."""
    return f"{value:.1f} m" if abs(value) < 100.0 else f"{value:.0f} m"


def utc(start_ns: int | None) -> str:
    """Date and time of day; empty where the time is no date, or of a clock that was never set."""
    if start_ns is None or start_ns < _CLOCK_SET_NS:
        return ""
    try:
        return f"{datetime.fromtimestamp(start_ns / 1e9, UTC):%Y-%m-%d %H:%M:%S} UTC"
    except (OverflowError, ValueError, OSError):
        return ""


def count(number: int, noun: str) -> str:
    """ "1 request", "3 requests"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def sentence(text: str) -> str:
    """With a capital letter; an acronym or a name keeps its letters."""
    return text[:1].upper() + text[1:]
