"""Words for a person: events, control, numbers."""
