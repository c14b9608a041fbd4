"""The record of a session: one MCAP."""
