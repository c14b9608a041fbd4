"""COMMAND_LONG and COMMAND_INT: `commands.py` is the table, one file a subject beside it."""
