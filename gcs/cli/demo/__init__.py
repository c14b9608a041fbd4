"""`gcs demo`: its script, what it shows and what it leaves."""
