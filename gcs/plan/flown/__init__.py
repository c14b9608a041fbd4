"""The path of a plan as the vehicle flies it: legs, turns, curves, circles, returns."""
