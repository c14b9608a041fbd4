"""Files to read: our own in `tests/samples`, and those of public projects, which are not with us.

`tests/samples/README.md` says which these are and where to get them.  A test that needs one calls
`elsewhere` and is skipped where it is not; the end of a run counts how many were.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

SAMPLES = Path(__file__).parent / "samples"
ELSEWHERE = Path(os.environ.get("MAVGATE_SAMPLES", Path(__file__).parents[2] / "shared" / "data"))
NOT_HERE = "needs sample data from outside the repository"


def elsewhere(*parts: str) -> Path:
    """A file of somebody else's; skips the test where it is not on this machine."""
    path = ELSEWHERE.joinpath(*parts)
    if not path.exists():
        pytest.skip(f"{NOT_HERE}: {path}")
    return path
