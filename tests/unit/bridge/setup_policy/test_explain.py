"""`gcs bridge --explain` of a parameter and of a command, by a policy."""

from __future__ import annotations

import pytest

from gcs.bridge.catalog.explain import explain
from gcs.bridge.setup_policy.explain import parameter_explanation, policy_explanation
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import BridgeRules


def rules(text: str) -> BridgeRules:
    return parse_policy(f"[bridge]\n{text}", "my.toml").bridge


def parameter(name: str, of: BridgeRules = DEFAULT.bridge) -> list[str]:
    told = parameter_explanation(name, of)
    assert told is not None
    return told.splitlines()


def test_a_guarded_parameter_is_told_with_the_reason() -> None:
    first, second, *_ = parameter("gf_action")
    assert first == "GF_ACTION, a parameter that safety stands on"
    assert second == (
        "  px4, from a client: not written: GF_ACTION is guarded: it is of the vehicle's own fence"
    )


def test_a_free_parameter_is_told_with_the_reason() -> None:
    assert parameter("SDLOG_MODE")[:3] == [
        "SDLOG_MODE, a parameter that safety does not stand on",
        "  px4, from a client: written",
        "    why: it says what the vehicle writes into its log",
    ]


@pytest.mark.parametrize(
    ("text", "name", "written"),
    [
        ('parameters_allowed = ["GF_*"]', "GF_ACTION", True),
        ('parameters_allowed = ["GF_*"]', "RTL_TYPE", False),
        ('parameters_guarded = ["SDLOG_MODE"]', "SDLOG_MODE", False),
        ('parameters = "refuse"', "SDLOG_MODE", False),
        ('parameters = "forward"', "GF_ACTION", True),
    ],
)
def test_what_the_policy_says_of_a_parameter_is_what_is_told(
    text: str, name: str, written: bool
) -> None:
    said = parameter(name, rules(text))[1]
    assert said.startswith("  px4, from a client: " + ("written" if written else "not written: "))


def test_of_others_nothing_is_told() -> None:
    assert parameter_explanation("DO_REPOSITION", DEFAULT.bridge) is None
    assert parameter_explanation("DO_REPOSITION of a client", DEFAULT.bridge) is None


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("DO_FENCE_ENABLE", "", '`fence` of [bridge] is "refuse"'),
        ("DO_FENCE_ENABLE", "", "in a client's mission: refused POLICY: switching"),
        ("DO_FENCE_ENABLE", 'fence = "forward"', '`fence` of [bridge] is "forward"'),
        ("DO_FENCE_ENABLE", 'fence = "forward"', "in a client's mission: carried"),
        ("NAV_LAND", "", "in a client's mission: carried"),
        ("NAV_LAND", 'extra_denied = ["NAV_LAND"]', "in a client's mission: refused POLICY"),
        ("DO_DIGICAM_CONTROL", 'extra_denied = ["DO_DIGICAM_CONTROL"]', "denied by its name"),
        ("DO_REPOSITION", "", "in a client's mission: refused, as it is none that is verified"),
        ("DO_PARACHUTE", "", "in a client's mission: refused POLICY: It works the parachute"),
    ],
)
def test_a_command_is_told_with_what_the_policy_says_of_it(name: str, text: str, told: str) -> None:
    assert told in policy_explanation(explain(name), rules(text))


def test_a_message_that_the_policy_does_not_name_has_no_more_lines() -> None:
    assert policy_explanation(explain("PARAM_SET"), DEFAULT.bridge) == ""
