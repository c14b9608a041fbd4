"""How a fence stands."""

from __future__ import annotations

from typing import NamedTuple


class FenceStatus(NamedTuple):
    breach_time: int
    breach_count: int
    breach_status: int
    breach_type: int
    breach_mitigation: int = 0
