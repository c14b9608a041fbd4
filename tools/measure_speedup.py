"""The factor that a vehicle's time reaches while MAVSDK is attached and flies a mission.

Run: python -m tools.measure_speedup [--factors 10,50] [--seconds 10]
The factor is the vehicle's own time stamps against the wall, as MAVSDK receives them.
"""

from __future__ import annotations

import argparse
import os
import sys

from tests.clients.client_script import CLIENTS, end, start
from tests.system.vehicle_program import free_port, vehicle_sim

PERSONALITIES = ("px4", "ardupilot")
CLIENT = "mavsdk"
WRONG_MOST = 0.05


def flown(personality: str, factor: float, seconds: float) -> tuple[dict[str, float], list[str]]:
    """What the script measured (nothing if it failed), and what the vehicle said above INFO."""
    place = f"127.0.0.1:{free_port()}"
    arguments = ("--autopilot", personality, "--speedup", f"{factor:g}")
    with vehicle_sim(*arguments, "--link", f"udpout://{place}") as lines:
        script = start(
            CLIENT,
            "mavsdk_speedup.py",
            f"udpin://{place}",
            personality,
            f"{factor:g}",
            f"{seconds:g}",
        )
        try:
            output, _ = script.communicate(timeout=8.0 * seconds + 60.0)
        finally:
            end(script)
    if script.returncode != 0:
        return {}, [*output.splitlines(), *(line.rstrip() for line in lines)]
    measured = dict(line.removesuffix(" s").rsplit(" ", 1) for line in output.splitlines())
    said = [line.rstrip() for line in lines if not line.startswith("INFO")]
    return {name: float(value) for name, value in measured.items()}, said


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--factors", default="10,50")
    parser.add_argument("--seconds", type=float, default=10.0)
    asked = parser.parse_args()
    if not (CLIENTS / CLIENT / "bin" / "python").exists():
        print("MAVSDK's environment is not there: make .clients/mavsdk/.installed")
        return 0
    worst = 0.0
    for personality in PERSONALITIES:
        for factor in (float(part) for part in asked.factors.split(",")):
            measured, said = flown(personality, factor, asked.seconds)
            if not measured:
                print(f"{personality} at {factor:g}: the flight failed", *said, sep="\n  ")
                worst = 1.0
                continue
            wrong = abs(measured["factor"] / factor - 1.0)
            worst = max(worst, wrong + measured["link lost"] + len(said))
            print(
                f"{personality} at {factor:g}: {measured['factor']:.3f} over "
                f"{measured['wall']:.1f} s of wall time with MAVSDK flying, "
                f"link lost {measured['link lost']:.0f} times, load {os.getloadavg()[0]:.2f}"
            )
            for line in said:
                print(f"  {line}")
    return int(worst > WRONG_MOST)


if __name__ == "__main__":
    sys.exit(main())
