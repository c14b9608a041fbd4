"""Standard gravity, for the physics and for whoever flies in it."""

from __future__ import annotations

from typing import Final

GRAVITY_M_S2: Final = 9.80665
