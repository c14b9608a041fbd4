"""Sockets for a fleet: the soft limit of open files gives way as far as the hard one lets it."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import pytest

from vehicle_sim.shell.limits import SPARE, allow_sockets

if sys.platform == "win32":
    pytest.skip("Windows has no such limit", allow_module_level=True)

import resource


@pytest.fixture
def hard() -> Iterator[int]:
    """The hard limit, with the soft one far below it."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (256, before[1]))
    try:
        yield before[1]
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


def soft() -> int:
    return resource.getrlimit(resource.RLIMIT_NOFILE)[0]


def test_what_is_needed_is_allowed(hard: int) -> None:
    allow_sockets(400)
    assert soft() == 400 + SPARE
    assert resource.getrlimit(resource.RLIMIT_NOFILE)[1] == hard


def test_what_is_allowed_already_stays(hard: int) -> None:
    allow_sockets(10)
    assert soft() == 256


def test_no_more_than_the_hard_limit_is_asked_for(hard: int) -> None:
    if hard == resource.RLIM_INFINITY:
        pytest.skip("this system has no hard limit")
    allow_sockets(hard)
    assert soft() == hard
