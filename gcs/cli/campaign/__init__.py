"""`gcs campaign`."""
