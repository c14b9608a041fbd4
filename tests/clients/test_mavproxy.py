"""MAVProxy flies both personalities by its own commands, and has nothing to complain of."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.clients.mavutil_client import complaints, in_order, run_script, vehicle

pytestmark = pytest.mark.system

COMPLAINTS = re.compile(
    r"no link|link \d down|[Tt]imed? ?out|[Uu]nknown|ERROR|[Ff]ailed|BUG|Traceback|fence breach"
    r"|re-requesting .*\[\d|[Uu]nexpected|[Ii]nvalid|[Bb]ad|wrapped|stale|fix lost|DENIED|REJECTED"
    r"|UNSUPPORTED"
)
"""What it prints where a vehicle does not do what it expects.

It re-requests "[]", which is nothing, whenever its timer strikes within the first two seconds of a
list: it looks when the last MISSION_ITEM came, and items are MISSION_ITEM_INT.
"""
PROMPT = re.compile(r"^[A-Z_]+> ")

EXPECTED = {
    "ardupilot": [],
    "px4": ["fence breach", "Got COMMAND_ACK: DO_SET_MODE: TEMPORARILY_REJECTED"],
}
"""What it prints of a real one, too.  MAVProxy does not look whether there is a fence, and PX4's
SYS_STATUS says of none that it is healthy: 0x2220803f in px4_1_14_flight.tlog, without
MAV_SYS_STATUS_GEOFENCE.  The script asks for POSCTL without sticks: TEMPORARILY_REJECTED in the
scenario B4_posctl_mode_without_stream."""


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4"])
def test_every_command_does_what_it_says(autopilot: str, tmp_path: Path) -> None:
    with vehicle(autopilot, "--speedup", "5") as (url, said):
        lines = run_script("mavproxy", "mavproxy_flight.py", autopilot, url, folder=tmp_path)
    transcript = (tmp_path / "transcript.txt").read_text()
    # Of a reboot it says, rightly, that the time has wrapped.
    before = transcript[: transcript.rindex("PREFLIGHT_REBOOT_SHUTDOWN")]
    lines_before = [PROMPT.sub("", line) for line in before.splitlines()]
    complained = [line for line in lines_before if COMPLAINTS.search(line)]
    assert complained == EXPECTED[autopilot]
    if autopilot == "px4":
        refused = ["ERROR vehicle1: Switching to POSCTL is currently not available\n"]
        assert complaints(said) == refused
    else:
        # Said every 30 s while a log is downloaded, as in the scenario J2.
        assert set(complaints(said)) <= {"ERROR vehicle1: PreArm: Downloading logs\n"}
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
