"""Other ground stations fly a vehicle through `gcs bridge`, unchanged, and cannot leave its fence.

What the vehicle really did is its own truth, 50 times a second.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs.bridge.conversation.answers import NUMBER_OF
from gcs.gate.refusal import Code
from tests.clients.bridged_flight import bridged, end_peer, start_peer
from tests.clients.mavutil_client import in_order
from tests.shares import one_in
from tests.system.patience import until
from vehicle_sim.testing.process import Personality

pytestmark = pytest.mark.system

URLS = {
    "pymavlink": "udpout:{}",
    "mavproxy": "udpout:{}",
    "mavsdk": "udpout://{}",
    "mavsdk3": "udpout://{}",
}
WORDS = {
    "pymavlink": ("fly", "offboard", "escape", "land"),
    "mavproxy": ("fly", "escape", "land"),
    "mavsdk": ("fly", "offboard", "orbit", "escape", "land"),
    "mavsdk3": ("fly", "offboard", "escape", "land"),
}
FLOWN = {
    "pymavlink": ("^all parameters", "^mission of", "^arm", "^goto", "^mission item 2", "^returns"),
    "mavproxy": ("^online, all", "wp list", "ARM_DISARM: ACC", "DO_REPOSITION: ACC", "waypoint 2"),
    "mavsdk": ("^all parameters", "^mission True", "^took off", "^goto", "^flies the mission"),
    "mavsdk3": ("^all parameters", "^mission True", "^arm", "^goto", "^flies the mission"),
}
REFUSED = 2
"""So many attempts of each script to leave the fence are refused to its face, at least."""


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
@pytest.mark.parametrize("client", one_in(2, ["pymavlink", "mavproxy", "mavsdk", "mavsdk3"]))
def test_it_flies_and_cannot_leave(client: str, personality: Personality, tmp_path: Path) -> None:
    with bridged(personality, tmp_path) as flight:
        url = URLS[client].format(flight.clients[0])
        lines = end_peer(start_peer(client, url, flight, *WORDS[client]))
    print(*lines, sep="\n")
    in_order(lines, *FLOWN[client])
    if "orbit" in WORDS[client]:
        in_order(lines, "^orbit: accepted", "^orbit flown True")
    refused = [line for line in lines if " refused " in line or "NIED" in line or "REJEC" in line]
    assert len(refused) >= REFUSED
    assert flight.refusals()
    assert len(flight.truth.places) > 50 * 60
    # It did fly: each script goes to 12 m north, and comes there within 1.2 m.
    assert max(north_m for north_m, _, _ in flight.truth.places) > 12.0 - 1.2
    assert flight.truth.outside() == []


@pytest.mark.thorough
@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_sticks_of_mavsdk_fly_and_cannot_leave(personality: Personality, tmp_path: Path) -> None:
    """Its manual_control plugin: position control, then full stick at the fence for 25 s."""
    with bridged(personality, tmp_path) as flight:
        url = URLS["mavsdk"].format(flight.clients[0])
        words = ("be_healthy", "take_off", "sticks", "land")
        lines = end_peer(start_peer("mavsdk", url, flight, *words))
    print(*lines, sep="\n")
    in_order(
        lines,
        "^position control: accepted",
        "^full stick: came",
        "^full stick back True",
        "^flew forward True",
        "^goto: accepted",
        "^landed and disarmed",
    )
    assert any("Stream refused (CANNOT_STOP)" in line for line in flight.said)
    assert flight.truth.outside() == []


@pytest.mark.thorough
def test_attitudes_of_mavsdk_fly_and_cannot_leave(tmp_path: Path) -> None:
    """Its offboard plugin's `set_attitude`, for a PX4: leaning at the fence, held, and back."""
    with bridged("px4", tmp_path) as flight:
        url = URLS["mavsdk"].format(flight.clients[0])
        words = ("be_healthy", "take_off", "attitudes", "land")
        lines = end_peer(start_peer("mavsdk", url, flight, *words))
    print(*lines, sep="\n")
    in_order(
        lines,
        "^attitude: accepted",
        "^flies where it leans",
        "^held",
        "^flies back",
        "^landed and disarmed",
    )
    assert any("Stream refused (CANNOT_STOP)" in line for line in flight.said)
    assert flight.truth.outside() == []


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_two_at_once_and_one_in_control(personality: Personality, tmp_path: Path) -> None:
    """Both on one port.  The other one reads everything, and is told who is in control."""
    with bridged(personality, tmp_path) as flight:
        other = start_peer("pymavlink", f"udpout:{flight.clients[0]}", flight, "look_on")
        # Who connects later is not told of what was before, but in refusals.
        until(lambda: any("has connected" in line for line in flight.said), "it looks on")
        in_control = start_peer("mavsdk", f"udpout://{flight.clients[0]}", flight, "fly", "land")
        looked, flown = end_peer(other), end_peer(in_control)
    print(*looked, *flown, sep="\n")
    in_order(flown, *FLOWN["mavsdk"], "^landed and disarmed")
    number = NUMBER_OF[Code.OTHER_OPERATOR]
    in_order(
        looked,
        "^all parameters: True",
        f"^goto of another: refused TEMPORARILY_REJECTED {number} ",
        f"^take-off of another: refused TEMPORARILY_REJECTED {number} ",
        "^mission of another: refused ",
        "^told: gate: in control: MAVLink 245/190",
    )
    assert flight.truth.outside() == []
