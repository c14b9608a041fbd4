"""Finished logs of other programs into records."""
