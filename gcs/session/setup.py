"""What a session is made of, fixed at its start and recorded first."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec

from gcs.config import StationConfig
from gcs.gate.policy.policy import Policy


@dataclass(frozen=True, slots=True)
class Setup:
    """`policy` has the zones of any fence file in it already; `policy_text` is as it was read."""

    config: StationConfig
    version: str
    policy: Policy
    policy_text: str
    endpoints: tuple[str, ...]
    log_path: str
    streams: frozenset[int] = frozenset()
    """Links that carry a byte stream (TCP, serial), not datagrams."""
    waiting: frozenset[int] = frozenset()
    """Links whose peer is not known before it has sent something (`udpin`)."""
    environment: str = ""
    """Python, machine and libraries that the station runs with: another one may count otherwise
    in the last digit."""
    client_ports: tuple[str, ...] = ()
    """Where MAVLink clients reach the vehicle through this station, a line each."""
    rule_text: str | msgspec.UnsetType = msgspec.UNSET
    """The source of the operator's own rule; unset, there is none, and nothing in the record."""
