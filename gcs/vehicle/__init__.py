"""One vehicle on a link: what it sends, what it is told, and what is known of it."""
