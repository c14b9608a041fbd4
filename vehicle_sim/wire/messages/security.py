"""Who may command the vehicle."""

from __future__ import annotations

from typing import NamedTuple


class SetupSigning(NamedTuple):
    """`initial_timestamp` counts 10 us since 2015-01-01 GMT."""

    initial_timestamp: int
    target_system: int
    target_component: int
    secret_key: bytes


class ControlStatus(NamedTuple):
    """Which ground stations control the vehicle; 0 = none."""

    flags: int
    gcs_main: int
    gcs_secondary: bytes
