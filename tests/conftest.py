"""One rule for every property: `make test` looks at the same examples each time.

A run that must pass before a change lands must not fail for another change's sake.  New examples
are for `make soak`, which draws them at random and more of them.
"""

from __future__ import annotations

import os

from hypothesis import settings

settings.register_profile("steady", derandomize=True, deadline=None)
settings.register_profile("soak", max_examples=2_000, deadline=None)
settings.load_profile("soak" if "MAVGATE_SOAK" in os.environ else "steady")
