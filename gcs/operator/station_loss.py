"""What is known of a vehicle whose station process has died: its own setting for that.

Nobody asks it for anything any more, and nothing can be read of it: what counts is what the last
snapshot has of its failsafes (`gcs/vehicle/parameters/failsafes.py` words them).
"""

from __future__ import annotations

from typing import Final

from gcs import ipc

STATION_LOSS: Final = "ground-station loss: "
OFFBOARD_LOSS: Final = "offboard loss: "
SETPOINT_MODES: Final = frozenset({"OFFBOARD", "GUIDED"})
"""In which it flies setpoints: without them it acts by a setting of its own."""
UNREAD: Final = "could not be read"
GOES_ON: Final = (
    "it goes on with what it was told: an ArduPilot flies to its last goal and stays there, "
    "a mission is flown to its end"
)


def after_station_died(seen: ipc.Snapshot | None) -> str:
    """One sentence; `seen` is the last that the station told."""
    if seen is None or not seen.vehicle:
        return "no vehicle had been heard"
    if seen.armed is False:
        return "the vehicle was disarmed"
    said = [_station_loss(_of(seen, STATION_LOSS))]
    offboard = _of(seen, OFFBOARD_LOSS)
    if seen.mode in SETPOINT_MODES and offboard:
        said.append(f"in {seen.mode} it does this as its setpoints have ended: {offboard}")
    others = len(seen.vehicles) - 1
    if others > 0:
        said.append(f"that is {seen.vehicle}; of {others} more nothing is known here")
    return "; ".join(said)


def record_hint(log_path: str) -> str:
    """How the file that was not closed is made whole; empty where there is none."""
    if not log_path:
        return ""
    return f"the record was not closed: gcs log recover {log_path} -o WHOLE.mcap"


def _of(seen: ipc.Snapshot, about: str) -> str:
    """What the vehicle does in that case; empty where it is not known."""
    found = (each.removeprefix(about) for each in seen.failsafes if each.startswith(about))
    return next(found, "")


def _station_loss(said: str) -> str:
    if not said:
        return "what the vehicle does without a ground station is not known: it was not read"
    if said.endswith(UNREAD):
        return f"what the vehicle does without a ground station is not known: {said}"
    if said.startswith("off"):
        return f"the vehicle's own ground-station failsafe is {said}: {GOES_ON}"
    if said.startswith("it watches another station"):
        return f"the vehicle's own ground-station failsafe does not act on this: {said}: {GOES_ON}"
    return f"the vehicle's own ground-station failsafe, unless it hears another station: {said}"
