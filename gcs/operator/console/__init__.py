"""`gcs fly --plain`: what is done with lines of words, typed, piped or of a script."""
