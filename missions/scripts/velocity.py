"""A velocity for two seconds, one that the gate refuses, and a circle flown as a stream."""

import math
import sys

import gcs


def main(link: str | None) -> None:
    with gcs.connect(link, sim=link is None, name="velocity") as station:
        station.arm()
        station.takeoff(3)
        station.velocity(1, 0, 0, seconds=2)
        print("at", station.position_enu)
        try:
            station.velocity(50, 0, 0, seconds=2)
        except gcs.Refused as refused:
            print(refused.code, refused.numbers)
        with station.stream() as stream:
            for seconds in stream.ticks(6):
                stream.velocity(math.cos(seconds), math.sin(seconds), 0)
                if stream.refusal is not None:
                    print("held:", stream.refusal.sentence)
        print("at", station.position_enu)
        station.land()
        print(station.state, station.log_path)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)
