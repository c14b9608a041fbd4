"""What the screen draws, a part a file."""
