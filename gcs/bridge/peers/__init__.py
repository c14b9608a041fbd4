"""MAVLink clients as they come and go: who each one is, and which are heard."""
