"""A rule of one's own for VERIFYING: no leg longer than 3 m, and no goal nearer than 1 m to a wall.

gcs fly --sim --policy lab --verifier missions/lab3/solutions/my_rule.py
"""

import math

LONGEST_M = 3.0
ROOM_M = 1.0


def verify(start, goal, policy):
    """None permits; a sentence refuses.  Positions are metres east, north, up."""
    leg_m = math.dist(start, goal)
    if leg_m > LONGEST_M:
        return f"the leg is {leg_m:.1f} m long, more than {LONGEST_M:g} m"
    for zone in policy["fence"]:
        if zone["kind"] == "box":
            east, north = zone["east_m"], zone["north_m"]
            room_m = min(
                goal.east_m - east[0],
                east[1] - goal.east_m,
                goal.north_m - north[0],
                north[1] - goal.north_m,
            )
            print(f"{room_m:.2f} m to the nearest wall of {zone['name']}")
            if room_m < ROOM_M:
                return f"the goal is {room_m:.2f} m from a wall of {zone['name']}"
    return None
