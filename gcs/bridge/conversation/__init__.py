"""What one MAVLink client has asked for, and what it was answered."""
