"""What a program that decides by itself (an agent) may do with a station; nothing of MCP."""
