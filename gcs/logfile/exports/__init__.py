"""Records, and other finished logs, into files for other programs."""
