"""What the vehicle can be asked for, and in which words it is refused: one file a subject."""
