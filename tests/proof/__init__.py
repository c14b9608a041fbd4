"""The gate explored: every situation that it can be in, and what must hold in each."""
