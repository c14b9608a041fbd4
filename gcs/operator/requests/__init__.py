"""What a Python program can ask of a station: a class a subject, whose methods `Station` has."""
