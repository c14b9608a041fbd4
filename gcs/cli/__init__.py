"""The command line: `main.py` has the table of commands, each imported when it is called."""
