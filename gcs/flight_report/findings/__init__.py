"""What was wrong with a flight: one detector a subject, each with its limits and their sources."""
