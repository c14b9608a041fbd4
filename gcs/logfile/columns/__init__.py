"""The messages of one kind in a log, as one numpy array, without decoding message by message."""
