"""The rows of the table, by subject, and what they are written with."""
