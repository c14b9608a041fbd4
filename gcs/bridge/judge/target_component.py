"""Whether a client's message is for the vehicle's autopilot, for another component, or for nobody.

https://mavlink.io/en/guide/routing.html: what is for a component is acted on by that one alone,
and component 0 is all of them.  PX4 keeps to it; an ArduPilot takes for its own what it has no
route for (both from memory of their sources).  So what would move the vehicle or change its set-up
is not forwarded to a component that nobody has heard.

What is refused so is answered in the name of the component that was addressed, as all answers are:
MAVSDK and QGroundControl take a COMMAND_ACK for the answer to their command only where it comes
from the component that they sent it to (from memory).
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.judge.received import Received
from gcs.bridge.plans.replies import MISSION_PLANNER
from gcs.gate.refusal import Code, Refusal
from gcs.wire.messages import Message, MissionItem, MissionItemInt, MissionSetCurrent

_OF_MISSIONS: Final = (MissionItem, MissionItemInt, MissionSetCurrent)


def is_for_another(given: Received, message: Message | None) -> bool:
    """It names a component that is not the autopilot.  Old clients send what is about missions to
    MAV_COMP_ID_MISSIONPLANNER, which stands for the autopilot, too."""
    compid = given.by.addressed.compid
    if compid == MISSION_PLANNER and isinstance(message, _OF_MISSIONS):
        return False
    return compid != given.autopilot.compid


def why_not_component(given: Received, message: Message | None) -> Refusal | None:
    """Why nothing that moves or changes is done with it: no such component was ever heard.

    None where it may be looked at, and where no vehicle is heard yet, which is refused as that.
    """
    if not is_for_another(given, message):
        return None
    seen, addressed = given.look(), given.by.addressed
    if seen is None or seen.hears(addressed.compid):
        return None
    autopilot = f"{given.autopilot.sysid}/{given.autopilot.compid}"
    return Refusal(
        Code.UNSUPPORTED,
        f"there is no component {addressed.compid} of system {addressed.sysid} "
        f"(the autopilot is {autopilot})",
    )


def only_autopilot(given: Received) -> Refusal:
    """Why what moves a vehicle is not sent to a component that is there."""
    autopilot = f"{given.autopilot.sysid}/{given.autopilot.compid}"
    return Refusal(
        Code.UNSUPPORTED,
        f"component {given.by.addressed.compid} flies nothing (the autopilot is {autopilot})",
    )
