"""The mission protocol: missions, fences and rally points."""
