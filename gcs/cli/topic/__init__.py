"""`gcs topic`: messages, live or recorded."""
