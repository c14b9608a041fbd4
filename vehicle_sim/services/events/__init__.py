"""PX4's events and health report, and what a ground station reads to word them."""
