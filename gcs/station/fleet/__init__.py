"""Several vehicles: what is near to what, and whose ways cross."""
