"""Noise without a generator's state: a number for every (seed, vehicle, source, step).

Counter-based, so that what one source draws never depends on how often another was asked
(Salmon et al., "Parallel Random Numbers: As Easy as 1, 2, 3", SC11).  The mixing is SplitMix64's
finaliser (Steele, Lea, Flood, OOPSLA 2014); all of it is integer arithmetic.
"""

from __future__ import annotations

from typing import Final

_MASK: Final = 0xFFFFFFFFFFFFFFFF
_GOLDEN: Final = 0x9E3779B97F4A7C15
_SQRT3_OVER_65536: Final = 1.7320508075688772 / 65536.0
_SQRT12_OVER_65536: Final = 3.4641016151377544 / 65536.0


def mix64(x: int) -> int:
    """A bijection of 64-bit integers in which every input bit sways every output bit."""
    x = ((x ^ (x >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    x = ((x ^ (x >> 27)) * 0x94D049BB133111EB) & _MASK
    return x ^ (x >> 31)


def key_of(seed: int, vehicle: int, source: int) -> int:
    """The key of one noise source of one vehicle."""
    key = mix64((seed + _GOLDEN) & _MASK)
    key = mix64((key ^ vehicle) + _GOLDEN & _MASK)
    return mix64((key ^ source) + _GOLDEN & _MASK)


def bits(key: int, step: int) -> int:
    """64 random bits, the same for ever for one key and step."""
    return mix64((key + (step * _GOLDEN & _MASK)) & _MASK)


def uniform(part: int) -> float:
    """Mean 0, variance 1, evenly spread over +-1.73; `part` is 16 of the random bits."""
    return (float(part) - 32767.5) * _SQRT12_OVER_65536


def normal(key: int, step: int) -> float:
    """Mean 0, variance 1, nearly normal, never beyond 3.5: the sum of four uniforms."""
    x = bits(key, step)
    total = (x & 0xFFFF) + ((x >> 16) & 0xFFFF) + ((x >> 32) & 0xFFFF) + (x >> 48)
    return (float(total) - 131070.0) * _SQRT3_OVER_65536
