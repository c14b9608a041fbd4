"""From a second terminal: stop what the running station flies, whoever is in control of it.

Usage: stop.py [LINK]; without one it is the only station that runs.
"""

import sys

import gcs

with gcs.connect(sys.argv[1] if len(sys.argv) > 1 else None, name="stop") as station:
    print(f"{station.state} at {station.position_enu}")
    station.abort()
    print(f"{station.state} at {station.position_enu}")
