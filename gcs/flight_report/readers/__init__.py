"""What the messages of a record, of any format, say: facts and samples."""
