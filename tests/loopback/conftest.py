"""A share of all flights is recorded, and audited when its test is over."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import nullcontext
from zlib import crc32

import pytest

from tests.loopback.copies import each_flies_itself
from tests.loopback.recorded_flights import flights_recorded

AUDITED_OF = 6
"""One test in so many, by its name; the flights of the others are not recorded."""


@pytest.fixture(autouse=True)
def _altered_programs_fly_themselves(request: pytest.FixtureRequest) -> Iterator[None]:
    with each_flies_itself() if "monkeypatch" in request.fixturenames else nullcontext():
        yield


@pytest.fixture(autouse=True)
def audited(request: pytest.FixtureRequest) -> Iterator[None]:
    """Whatever a flight was: the audit of its record finds no difference.

    A test with `monkeypatch` alters the program, which an audit would not do, or the recorder.
    """
    chosen = crc32(request.node.nodeid.encode()) % AUDITED_OF == 0
    if not chosen or "monkeypatch" in request.fixturenames:
        yield
        return
    with flights_recorded() as recorded:
        yield
    for each in recorded:
        each.audit()
