"""Builders of messages: what the vehicle tells of itself, one file a subject."""
