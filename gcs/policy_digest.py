"""A short name for what a policy's file says: the same bytes, the same digest.

It is made without reading the policy itself, so that an operator's program, which loads nothing of
the gate, can tell whether a running station has the policy that it was asked for.
"""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Iterator

from gcs.resources import policy_path


def policy_digest(name: str) -> str:
    """Of `default`, `lab` or a TOML file, with the fence files that it names.

    Raises OSError where the policy's file cannot be read.
    """
    path = policy_path(name)
    text = path.read_bytes()
    digest = hashlib.sha256(text)
    for fence in _fence_files(text):
        try:
            digest.update(hashlib.sha256((path.parent / fence).read_bytes()).digest())
        except OSError:
            digest.update(b"-")  # no station has such a policy
    return digest.hexdigest()[:16]


def _fence_files(text: bytes) -> Iterator[str]:
    """As `gcs.gate.policy.parse` finds them; of what is no policy, none."""
    try:
        zones = tomllib.loads(text.decode()).get("fence", [])
    except ValueError:
        return
    for zone in zones if isinstance(zones, list) else ():
        if isinstance(zone, dict) and zone.get("kind") == "file" and "path" in zone:
            yield str(zone["path"])
