"""Files of parameters: read into one model, written in each format, compared."""
