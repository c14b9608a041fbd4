"""MAVProxy flies both personalities by its own commands, and has nothing to complain of."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.clients.mavutil_client import complaints, in_order, run_script, vehicle

pytestmark = pytest.mark.system

COMPLAINTS = re.compile(
    r"no link|link \d down|[Tt]imed? ?out|[Uu]nknown|ERROR|[Ff]ailed|BUG|Traceback|fence breach"
    r"|re-requesting|[Uu]nexpected|[Ii]nvalid|[Bb]ad|wrapped|stale|fix lost|DENIED|REJECTED"
    r"|UNSUPPORTED"
)
"""What it prints where a vehicle does not do what it expects."""


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
def test_every_command_does_what_it_says(autopilot: str, tmp_path: Path) -> None:
    with vehicle(autopilot, "--speedup", "5") as (url, said):
        lines = run_script("mavproxy", "mavproxy_flight.py", autopilot, url, folder=tmp_path)
    transcript = (tmp_path / "transcript.txt").read_text()
    # Of a reboot it says, rightly, that the time has wrapped.
    before = transcript[: transcript.rindex("PREFLIGHT_REBOOT_SHUTDOWN")]
    complained = [line for line in before.splitlines() if COMPLAINTS.search(line)]
    assert complained == []
    assert complaints(said) == []
    in_order(lines, "^online", "^param fetch", "^wp list", "^fence list", "^rally list")
    in_order(
        lines, "ARMED", "waypoint 3", "DISARMED", "^log download", "^ftp rm", "^reboot", "^link"
    )
    in_order(
        said,
        "mission of . items received",
        "fence of 4 items received",
        "rally of 1 items received",
        "armed$",
        "mission item 2 reached",
        "disarmed$",
    )
