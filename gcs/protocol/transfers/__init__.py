"""What comes and goes in pieces: plans, files, logs, lists of parameters."""
