"""A square of about 10 m on the map, with a photo at each corner; at home of the simulated PX4."""

import sys

import gcs

LAT, LON = 47.397742, 8.545594
CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))


def main(link: str | None) -> None:
    with gcs.connect(link, sim=link is None, name="photo_survey") as station:
        station.arm()
        station.takeoff(5)
        for north, east in CORNERS:
            goto = station.goto_global(LAT + 9e-5 * north, LON + 13e-5 * east, 5)
            print("picture", station.photo().picture, "at", goto.goal_enu)
        station.rtl()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)
