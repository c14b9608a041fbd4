"""What an operator may write and read of the set-up, beside what a client may."""

from __future__ import annotations

from typing import Any

import pytest
from msgspec import structs

from gcs.bridge.setup_policy.operator_rules import why_not_read_file, why_not_write
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code


@pytest.mark.parametrize(
    ("name", "rules", "on_ground", "in_air"),
    [
        ("NAV_DLL_ACT", {}, None, Code.IN_AIR),
        ("SDLOG_MODE", {}, None, None),
        ("NOBODY_KNOWS", {}, None, Code.IN_AIR),
        ("NAV_DLL_ACT", {"parameters_allowed": ("NAV_*",)}, None, None),
        ("SDLOG_MODE", {"parameters_guarded": ("SDLOG_*",)}, None, Code.IN_AIR),
        ("SDLOG_MODE", {"parameters": "refuse"}, Code.POLICY, Code.POLICY),
        ("NAV_DLL_ACT", {"parameters": "forward"}, None, None),
    ],
)
def test_which_parameters_are_set_when(
    name: str, rules: dict[str, Any], on_ground: Code | None, in_air: Code | None
) -> None:
    policy = structs.replace(DEFAULT.bridge, **rules)
    for stands, code in ((True, on_ground), (False, in_air)):
        refusal = why_not_write(policy, "px4", name, stands=stands)
        assert (refusal and refusal.code) == code


@pytest.mark.parametrize(
    ("downloads", "on_ground", "in_air"),
    [
        ("on_ground", None, Code.IN_AIR),
        ("refuse", Code.POLICY, Code.POLICY),
        ("forward", None, None),
    ],
)
def test_files_are_read_as_the_policy_has_it_for_clients(
    downloads: str, on_ground: Code | None, in_air: Code | None
) -> None:
    policy = structs.replace(DEFAULT.bridge, downloads=downloads)
    for stands, code in ((True, on_ground), (False, in_air)):
        refusal = why_not_read_file(policy, stands=stands)
        assert (refusal and refusal.code) == code
