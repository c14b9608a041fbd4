"""Fly out until a share of the battery is used, then stop and come home.

Usage: watch_battery.py [PERCENT [LINK]]; it turns round when less than PERCENT is left.
"""

import sys
import time

import gcs


def main(percent: int, link: str | None) -> None:
    with gcs.connect(link, sim=link is None, name="battery") as station:
        station.arm()
        station.takeoff(3)
        flight = station.goto(100, 0, 3, wait=False)
        while flight.state == "running":
            left = station.telemetry("BATTERY_STATUS")["battery_remaining"]
            print(f"{left} % left at {station.position_enu}", flush=True)
            if isinstance(left, int) and left < percent:
                flight.stop()
                print("turning round", flush=True)
                break
            time.sleep(0.5)
        station.land()


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 60,
        sys.argv[2] if len(sys.argv) > 2 else None,
    )
