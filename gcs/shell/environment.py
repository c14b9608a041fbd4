"""What this program runs in, in words, for the record."""

from __future__ import annotations

import platform
from importlib.util import find_spec


def environment() -> str:
    """Python, machine, and whether foxglove-sdk draws the picture: an audit elsewhere asks."""
    sdk = "with" if find_spec("foxglove") else "without"
    machine = f"{platform.system()} {platform.machine()}"
    return f"Python {platform.python_version()} on {machine}, {sdk} foxglove-sdk"
