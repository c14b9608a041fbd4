"""A square of 4 m, and a goal that the gate refuses."""

import sys

import gcs


def main(link: str | None) -> None:
    with gcs.connect(link, sim=link is None, name="square") as station:
        station.arm()
        station.takeoff(2)
        for east, north in ((4, 0), (4, 4), (0, 4), (0, 0)):
            station.goto(east, north, 2)
            print("at", station.position_enu)
        try:
            station.goto(500, 0, 2)
        except gcs.Refused as refused:
            print(refused.code, refused.numbers)
        station.land()
        print(station.state, station.log_path)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)
