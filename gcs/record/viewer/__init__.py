"""What a viewer shows of a record: layout, panels, how large the flight is."""
