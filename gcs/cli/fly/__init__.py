"""`gcs fly` and `gcs attach`: the screen, or lines."""
