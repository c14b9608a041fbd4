"""`python -m vehicle_sim`."""

from __future__ import annotations

from vehicle_sim.cli import main

if __name__ == "__main__":
    main(prog_name="vehicle-sim")
