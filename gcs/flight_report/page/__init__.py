"""The parts of the page: text and pictures of it, its template, style and scripts."""
