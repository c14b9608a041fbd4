"""Missions, fences and rally points that MAVLink clients send, fetch, clear and start.

`server.py` is the mission protocol towards one client.  What is collected from it is verified and
brought on board by the session's mission jobs (`gcs/vehicle/missions/jobs`).
"""
