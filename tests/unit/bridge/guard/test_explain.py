"""`gcs bridge --explain` of a parameter."""

from __future__ import annotations

from gcs.bridge.guard.explain import parameter_explanation


def test_a_guarded_parameter_is_told_with_the_reason() -> None:
    told = parameter_explanation("gf_action")
    assert told is not None
    assert told.splitlines() == [
        "GF_ACTION, a parameter that safety stands on",
        "  from a client: not written, unless `parameters_allowed` of [bridge] names it",
        "  px4: it is of the vehicle's own fence",
    ]


def test_a_free_parameter_is_told_with_the_reason() -> None:
    told = parameter_explanation("SDLOG_MODE")
    assert told is not None
    assert told.splitlines() == [
        "SDLOG_MODE, a parameter that a client may write",
        "  from a client: forwarded, unless `parameters_guarded` of [bridge] names it",
        "  px4: it says what the vehicle writes into its log",
    ]


def test_of_others_nothing_is_told() -> None:
    assert parameter_explanation("DO_REPOSITION") is None
    assert parameter_explanation("DO_REPOSITION of a client") is None
