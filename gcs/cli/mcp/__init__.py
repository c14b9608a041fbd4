"""`gcs mcp`: a station as tools and resources for an agent, by the Model Context Protocol."""
