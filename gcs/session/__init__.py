"""What reaches a station, what it answers, and the work between: the words of every part of it."""
