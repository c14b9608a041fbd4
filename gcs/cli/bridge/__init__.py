"""`gcs bridge` and what it shows."""
