"""What all flights share: either autopilot flies, and some are recorded and audited afterwards."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import nullcontext

import pytest

from tests.loopback.copies import each_flies_itself
from tests.loopback.flight import PERSONALITIES, Personality
from tests.loopback.recorded_flights import flights_recorded
from tests.shares import place_in_file

AUDITED_OF = 6
"""One test in so many of each file; the flights of the others are not recorded."""


@pytest.fixture(params=PERSONALITIES)
def personality(request: pytest.FixtureRequest) -> Personality:
    """Of the vehicle: a test that asks for it flies as PX4 and as ArduCopter."""
    asked: Personality = request.param
    return asked


@pytest.fixture(autouse=True)
def _altered_programs_fly_themselves(request: pytest.FixtureRequest) -> Iterator[None]:
    with each_flies_itself() if "monkeypatch" in request.fixturenames else nullcontext():
        yield


@pytest.fixture(autouse=True)
def audited(request: pytest.FixtureRequest) -> Iterator[None]:
    """Whatever a flight was: the audit of its record finds no difference.

    A test with `monkeypatch` alters the program, which an audit would not do, or the recorder.
    """
    chosen = place_in_file(request.node) % AUDITED_OF == 0
    if not chosen or "monkeypatch" in request.fixturenames:
        yield
        return
    with flights_recorded() as recorded:
        yield
    for each in recorded:
        each.audit()
