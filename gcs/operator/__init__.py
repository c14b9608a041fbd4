"""Everything that a program of an operator needs to talk with a station, without a terminal.

A station is the process that holds the links to the vehicles (`gcs/shell/station.py`).  Its
operators (the keyboard screen, typed lines, one-shot commands, scripts) send it requests and hear
what becomes of them, as JSON lines (`gcs/ipc.py`).
"""
