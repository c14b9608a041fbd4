"""A circle that the station flies itself, as a stream of velocities that the gate verifies."""
