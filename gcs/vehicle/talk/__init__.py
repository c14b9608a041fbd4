"""How one vehicle is talked with: commands, discovery, its reports, its texts."""
