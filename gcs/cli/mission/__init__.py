"""`gcs mission`: commands about mission files."""
