"""Missions, fences and rally points of one vehicle: what is on board, and jobs that change it."""
