"""How often a client gets which message of the vehicle."""
