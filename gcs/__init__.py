"""A MAVLink ground station that sends no command it cannot justify."""

__version__ = "0.1.0"
