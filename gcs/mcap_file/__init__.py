"""MCAP files, read and written: the only room that knows how such a file is built."""
