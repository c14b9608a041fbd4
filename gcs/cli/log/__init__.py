"""`gcs log`: commands about records and other logs."""
