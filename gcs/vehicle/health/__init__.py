"""How well one vehicle is: battery, GPS, link and position, beside the policy's limits."""
