"""Mission files of every format: read into a plan, and written from one."""
