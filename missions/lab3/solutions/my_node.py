"""A node of one's own: it listens to the state, and publishes the next corner of a square when the
vehicle hovers.  It stops the flight where a leg takes longer than 10 s.

Run it beside `gcs fly --sim --policy lab`, once the vehicle hovers.  One that another program has
left is held: it is resumed first.
"""

import time

import gcs

CORNERS = ((2, 0, 1), (2, 2, 1), (0, 2, 1), (0, 0, 1))
LONGEST_S = 10.0


def main() -> None:
    with gcs.connect(take_control=True, name="my_node") as station:
        if station.state == "HOLDING":
            station.resume()
        for corner in CORNERS:
            leg, began_s, before = station.goto(*corner, wait=False), time.monotonic(), ""
            while leg.state == "running":
                if station.state != before:
                    before = station.state
                    print("state", before, flush=True)
                if time.monotonic() - began_s > LONGEST_S:
                    station.abort()
                    raise SystemExit(f"the leg to {corner} took longer than {LONGEST_S:g} s")
                time.sleep(0.02)
            east_m, north_m, up_m = station.position_enu or corner
            print(f"corner {corner}: at {east_m:.1f} {north_m:.1f} {up_m:.1f}", flush=True)


if __name__ == "__main__":
    main()
