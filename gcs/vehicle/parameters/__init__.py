"""What a vehicle's own parameters say, and what follows for a flight."""
