"""What the vehicle makes of its own state: before arming, and for the failsafes in flight."""
