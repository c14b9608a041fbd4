"""Upload a mission file, fly it, and print what happens meanwhile.

Usage: fly_plan.py [FILE [LINK]]; without a FILE it is the shipped square.
"""

import sys
import threading

import gcs
from gcs import ipc


def print_events(station: gcs.Station) -> None:
    """Everything that the station tells is an event; these are three kinds of it."""
    for event in station.events():
        match event:
            case ipc.StateEvent():
                print(f"state {event.before} -> {event.after}", flush=True)
            case ipc.ProgressEvent():
                print(f"{event.what} {event.done:g} of {event.total:g} {event.unit}", flush=True)
            case ipc.LogEvent(level=level) if level >= 3:
                print(f"warning: {event.text}", flush=True)


def main(file: str, link: str | None) -> None:
    with gcs.connect(link, sim=link is None, name="plan") as station:
        threading.Thread(target=print_events, args=(station,), daemon=True).start()
        if station.state == "GROUNDED":
            station.arm()
        try:
            station.fly(file)
        except gcs.NotCompleted as ended:
            print("the mission was", ended.state, ended.sentence)
        station.land()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "square", sys.argv[2] if len(sys.argv) > 2 else None)
