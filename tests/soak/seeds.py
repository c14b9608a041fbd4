"""Where the randomness of the soak comes from.

`make test` runs the same cases each time.  `make soak` draws new ones, and every failure names its
seed; `MAVGATE_SEED=N` draws those again.
"""

from __future__ import annotations

import os
import random
from functools import cache

from tests.soaking import SOAKING


@cache
def base_seed() -> int:
    """A multiple of a million, so that chunks can count from it."""
    given = os.environ.get("MAVGATE_SEED")
    if given is not None:
        return int(given)
    return random.SystemRandom().randrange(1, 1_000_000) * 1_000_000 if SOAKING else 0
