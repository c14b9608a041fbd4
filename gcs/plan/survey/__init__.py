"""Missions made from a polygon, a line or a point: surveys, corridors, orbits.  Pure geometry."""
